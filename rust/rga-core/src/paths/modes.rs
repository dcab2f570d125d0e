//! Natural frequencies and mode shapes of one structure.

use crate::error::{Error, Result};
use crate::fe::assembly::{assemble_mass, assemble_shifted};
use crate::fe::constraint::Constraints;
use crate::fe::mass::for_each_mass;
use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Masses, Structure};
use crate::sparse::inertia::negative_eigenvalues;
use crate::sparse::lanczos::{Lanczos, Pencil, RitzPairs, dot};
use crate::sparse::lower_triangle::LowerTriangle;
use crate::validate::masses::check_masses;
use crate::validate::structure::check_structure;

/// Modes whose eigenvalues differ by this part or less are not cut apart by the count.
const ALIKE: f64 = 1e-6;
/// Modes that are looked at beyond those that are wanted, so that a gap to cut in is among them.
const BEYOND: usize = 4;
/// Times that modes which were missed are looked for.
const SEARCHES: usize = 20;
/// Among motions within this part of the largest, the first is positive.
const AS_LARGE: f64 = 1.0 - 1e-6;

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
///
/// That none is missed is proved by the inertia of K - s M (Parlett, The Symmetric Eigenvalue
/// Problem, 1980, section 3.3), with s above the last.
pub fn modes(structure: &Structure, masses: &Masses, count: usize) -> Result<Modes> {
    check_structure(structure)?;
    check_masses(structure, masses)?;
    let motion = Motion::new(structure, masses)?;
    let mut space = Lanczos::new(&motion);
    let mut sought = count.saturating_add(BEYOND);
    for _ in 0..SEARCHES {
        let found = space.grow(sought)?;
        let Some((kept, shift)) = cut(&found, count) else {
            return Ok(motion.modes(&found, masses, count));
        };
        let below = motion.below(shift, masses)?;
        if below == kept {
            return Ok(motion.modes(&found, masses, count));
        }
        sought = sought.max(below);
        space.start_anew()?;
    }
    Err(Error::invalid(
        "the modes cannot be told apart; check for masses that differ by many powers of ten",
    ))
}

/// How many modes lie below a shift, at least as many as are wanted; nothing where no mode is left
/// to be missed.
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

/// A structure that moves, as matrices of its unknowns.
struct Motion {
    model: Model,
    reduction: Reduction,
    solver: Solver,
    mass: LowerTriangle,
}

impl Motion {
    fn new(structure: &Structure, masses: &Masses) -> Result<Self> {
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let solver = Solver::new(&model, &reduction)?;
        let mass = assemble_mass(&model, &reduction, masses);
        if let Some(at) = mass.diagonal().iter().position(|&value| value < 0.0) {
            return Err(Error::invalid(format!(
                "more mass is taken off node {} than there is",
                reduction.unknowns[at] / 6
            )));
        }
        if mass.values.iter().all(|&value| value == 0.0) {
            return Err(Error::invalid(
                "nothing that can move has a mass; state densities or masses",
            ));
        }
        if !mass.values.iter().all(|value| value.is_finite()) {
            return Err(Error::invalid("the masses overflow; check their sizes"));
        }
        Ok(Self {
            model,
            reduction,
            solver,
            mass,
        })
    }

    /// Modes below a shift.
    fn below(&self, shift: f64, masses: &Masses) -> Result<usize> {
        let mut shifted = assemble_shifted(&self.model, &self.reduction, masses, shift);
        for rotation in self.solver.free_rotations() {
            rotation.hold(&mut shifted);
        }
        let places = self.reduction.places(&self.model.nodes);
        negative_eigenvalues(&shifted, &places)
    }

    fn modes(&self, found: &RitzPairs, masses: &Masses, count: usize) -> Modes {
        let wanted = count.min(found.converged);
        let together = self.moved_together(masses);
        let mut modes = Modes {
            eigenvalues: Vec::with_capacity(wanted),
            shapes: Vec::with_capacity(wanted * self.model.dofs),
            participation: Vec::with_capacity(3 * wanted),
            mass: [0, 1, 2].map(|axis| together[axis].iter().skip(axis).step_by(6).sum()),
        };
        for vector in found.vectors.iter().take(wanted) {
            let mut shape = vec![0.0; self.model.dofs];
            self.reduction.expand(vector, &mut shape);
            let modal_mass = dot(vector, &self.mass_times(vector));
            // Element by element: what the assembled stiffness rounds away counts.
            let energy = self.model.energy(&shape, |_| 1.0);
            let scale = sign(&shape, self.model.arm()) / modal_mass.sqrt();
            modes.eigenvalues.push(energy / modal_mass);
            shape.iter_mut().for_each(|value| *value *= scale);
            let products = together.iter().map(|forces| dot(&shape, forces));
            modes.participation.extend(products);
            modes.shapes.extend(shape);
        }
        modes
    }
}

impl Motion {
    /// M times a unit motion of all nodes along each axis, on all dofs.
    fn moved_together(&self, masses: &Masses) -> [Vec<f64>; 3] {
        let mut forces = [0, 1, 2].map(|_| vec![0.0; self.model.dofs]);
        for_each_mass(&self.model, masses, |row, column, value| {
            if column % 6 < 3 {
                forces[column % 6][row] += value;
            }
        });
        forces
    }
}

impl Pencil for Motion {
    fn size(&self) -> usize {
        self.mass.size()
    }

    fn solve(&self, right: &mut [f64]) -> Result<()> {
        self.solver.solve(right)
    }

    /// Without what turns freely, whose inertia nothing excites.
    fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        let mut held = x.to_vec();
        self.hold(&mut held);
        let mut product = self.mass.product(&held);
        self.hold(&mut product);
        product
    }
}

impl Motion {
    fn hold(&self, motion: &mut [f64]) {
        for rotation in self.solver.free_rotations() {
            let turned: f64 = rotation
                .terms
                .iter()
                .map(|&(at, part)| motion[at] * part)
                .sum();
            for &(at, part) in &rotation.terms {
                motion[at] -= turned * part;
            }
        }
    }
}

/// By which the largest motion is positive; `arm` makes rotations count as translations.
fn sign(shape: &[f64], arm: f64) -> f64 {
    let size = |(dof, value): (usize, &f64)| value.abs() * if dof % 6 < 3 { 1.0 } else { arm };
    let most = shape.iter().enumerate().map(size).fold(0.0, f64::max);
    let first = shape
        .iter()
        .enumerate()
        .find(|&one| size(one) >= AS_LARGE * most);
    first.map_or(1.0, |(_, value)| 1.0_f64.copysign(*value))
}
