//! Natural frequencies and mode shapes: of one structure, and of those near it.
//!
//! A structure is `motion`, which is solved as a pencil of stiffness and mass; `reanalysis` starts
//! from the modes of a structure that is solved; `energies` are derivatives of the eigenvalues.

mod energies;
pub(super) mod motion;
mod reanalysis;

use crate::error::{Error, Result};
use crate::input::{Masses, Structure};
use crate::sparse::lanczos::{Lanczos, RitzPairs};
use crate::validate::masses::check_masses;
use crate::validate::structure::check_structure;
pub use energies::{ModalEnergies, modal_energies};
use motion::Motion;
pub use reanalysis::ModalReanalysis;
pub(super) use reanalysis::modes_of_another;

/// Modes whose eigenvalues differ by this part or less are not cut apart by the count.
const ALIKE: f64 = 1e-6;
/// Modes that are looked at beyond those that are wanted: a gap to cut in is among them, and a space
/// that starts with all of them soon has those that are wanted.
const BEYOND: usize = 4;
/// Times that modes which were missed are looked for.
const SEARCHES: usize = 20;

/// Modes, the lowest first.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Squares of the circular frequencies.
    pub eigenvalues: Vec<f64>,
    /// `[modes, n, 6]` with a modal mass of one; the largest motion is positive.
    pub shapes: Vec<f64>,
    /// `[modes, 3]` products of shapes, masses and a unit motion of all nodes along each axis;
    /// their squares are effective modal masses.
    pub participation: Vec<f64>,
    /// That moves along each axis.
    pub mass: [f64; 3],
}

/// The `count` lowest modes, or all where there are fewer.
pub fn modes(structure: &Structure, masses: &Masses, count: usize) -> Result<Modes> {
    check_structure(structure)?;
    check_masses(structure, masses)?;
    let motion = Motion::new(structure, masses)?;
    let found = lowest(&motion, count, BEYOND, Lanczos::new(&motion))?;
    Ok(motion.modes(&found, count))
}

/// At least the `count` lowest, or all where there are fewer; `beyond` more are looked for.
///
/// That none is missed is proved by the inertia of K - s M (Parlett, The Symmetric Eigenvalue
/// Problem, 1980, section 3.3), with s above the last.
pub(super) fn lowest(
    motion: &Motion,
    count: usize,
    beyond: usize,
    mut space: Lanczos<Motion>,
) -> Result<RitzPairs> {
    let mut sought = count.saturating_add(beyond);
    for _ in 0..SEARCHES {
        let found = space.grow(sought)?;
        if found.values.is_empty() {
            return Ok(found);
        }
        let Some((kept, shift)) = cut(&found, count) else {
            break;
        };
        let below = motion.below(shift)?;
        if below == kept {
            return Ok(found);
        }
        sought = sought.max(below);
        space.start_anew()?;
    }
    Err(Error::invalid(
        "the modes cannot be told apart; check for masses that differ by many powers of ten",
    ))
}

/// How many modes lie below a shift, at least as many as are wanted; nothing where none is found.
fn cut(found: &RitzPairs, count: usize) -> Option<(usize, f64)> {
    let squares: Vec<f64> = found.values.iter().map(|value| 1.0 / value).collect();
    let wanted = count.min(found.converged);
    let last = found.converged.checked_sub(1)?;
    let gap = (wanted..=last).find(|&at| at > 0 && squares[at] > squares[at - 1] * (1.0 + ALIKE));
    let kept = gap.unwrap_or(found.converged);
    let shift = match gap {
        Some(at) => 0.5 * (squares[at - 1] + squares[at]),
        None => squares[last] * (1.0 + 0.5 * ALIKE),
    };
    Some((kept, shift))
}
