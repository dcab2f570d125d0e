//! Modes of structures near one whose modes are known.
//!
//! What does not depend on stiffness and mass is done once: in which order unknowns are eliminated.
//! The space in which modes are sought starts with what K^-1 M makes of the known ones, so that few
//! steps lead to the modes of a structure near by (block inverse iteration with all its iterates
//! kept; Parlett, The Symmetric Eigenvalue Problem, 1980, chapters 13 and 14). They are
//! counted as those of a structure by itself, and their frequencies as exact as its own; shapes are
//! to a millionth, in the norm of the stiffness.

use super::motion::Motion;
use super::{BEYOND, Modes, lowest};
use crate::error::{Error, Result};
use crate::input::{Masses, Structure};
use crate::sparse::lanczos::{Lanczos, RitzPairs};
use crate::validate::masses::check_masses;
use crate::validate::structure::check_structure;

/// Modes whose eigenvalues differ by this part or less are found together: between those of another
/// structure there may be no gap for the count.
const TOGETHER: f64 = 1e-3;

/// A structure that swings, with its modes.
pub struct ModalReanalysis {
    motion: Motion,
    known: RitzPairs,
}

impl ModalReanalysis {
    /// `count` modes are known of it.
    pub fn new(structure: &Structure, masses: &Masses, count: usize) -> Result<Self> {
        check_structure(structure)?;
        check_masses(structure, masses)?;
        let motion = Motion::new(structure, masses)?;
        let found = lowest(&motion, count, BEYOND, Lanczos::new(&motion))?;
        Ok(Self {
            motion,
            known: found,
        })
    }

    /// The `count` lowest modes of another structure, or all where there are fewer.
    pub fn modes(&self, other: &Structure, masses: &Masses, count: usize) -> Result<Modes> {
        self.some_modes(other, masses, |_| Ok(count))
    }

    /// The modes of another structure below an eigenvalue, and the next; at least and at most so
    /// many, or all where there are fewer.
    pub fn modes_below(
        &self,
        other: &Structure,
        masses: &Masses,
        eigenvalue: f64,
        (least, most): (usize, usize),
    ) -> Result<Modes> {
        if !(eigenvalue > 0.0 && eigenvalue.is_finite()) {
            return Err(Error::invalid("the eigenvalue must be above zero"));
        }
        let count = |motion: &Motion| Ok((motion.below(eigenvalue)? + 1).min(most).max(least));
        self.some_modes(other, masses, count)
    }

    fn some_modes(
        &self,
        other: &Structure,
        masses: &Masses,
        count: impl Fn(&Motion) -> Result<usize>,
    ) -> Result<Modes> {
        check_structure(other)?;
        check_masses(other, masses)?;
        let Some(motion) = self.motion.near(other, masses)? else {
            let motion = Motion::new(other, masses)?;
            let count = count(&motion)?;
            let found = lowest(&motion, count, BEYOND, Lanczos::new(&motion))?;
            return Ok(motion.modes(&found, count));
        };
        modes_of_another(&motion, &self.known, count(&motion)?)
    }
}

/// Those of a structure near that of which modes are known.
pub(in crate::paths) fn modes_of_another(
    motion: &Motion,
    known: &RitzPairs,
    count: usize,
) -> Result<Modes> {
    let space = Lanczos::near(motion, &known.vectors)?;
    let found = lowest(motion, count, beyond(known, count), space)?;
    Ok(motion.modes(&found, count))
}

/// Modes beyond so many that lie where the last of these does.
fn beyond(known: &RitzPairs, count: usize) -> usize {
    let pairs = known.values.windows(2).skip(count.saturating_sub(1));
    pairs
        .take_while(|pair| pair[0] <= pair[1] * (1.0 + TOGETHER))
        .count()
}
