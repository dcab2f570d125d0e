//! A structure that moves, as stiffness and mass of its unknowns.

use std::sync::{Arc, OnceLock};

use super::Modes;
use crate::error::{Error, Result};
use crate::fe::assembly::assemble_mass;
use crate::fe::constraint::Constraints;
use crate::fe::mass::ElementMasses;
use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Masses, Structure};
use crate::sparse::inertia::Inertia;
use crate::sparse::lanczos::{Pencil, RitzPairs, dot};
use crate::sparse::lower_triangle::LowerTriangle;

/// Among motions within this part of the largest, the first is positive.
const AS_LARGE: f64 = 1.0 - 1e-6;

/// A structure that moves, as matrices of its unknowns.
pub(in crate::paths) struct Motion {
    pub(in crate::paths) model: Model,
    pub(in crate::paths) reduction: Reduction,
    solver: Solver,
    masses: Arc<ElementMasses>,
    mass: Arc<LowerTriangle>,
    counted: OnceLock<Arc<Count>>,
}

/// How modes below a shift are counted.
struct Count {
    pattern: LowerTriangle,
    inertia: Inertia,
}

impl Motion {
    pub(in crate::paths) fn new(structure: &Structure, masses: &Masses) -> Result<Self> {
        let (model, reduction) = reduced(structure)?;
        let solver = Solver::new(&model, &reduction)?;
        Self::with(model, reduction, solver, masses)
    }

    /// With a factor on the whole stiffness of each member, then of each spring. What turns freely
    /// is held as it is here.
    pub(in crate::paths) fn with_factors(&self, factors: &[f64]) -> Result<Self> {
        let (model, reduction) = (self.model.with_factors(factors), self.reduction.clone());
        let Some(solver) = self.solver.of_another(&model, &reduction)? else {
            return Err(Error::invalid("the stiffness overflows; lower the factors"));
        };
        Ok(Self {
            model,
            reduction,
            solver,
            masses: Arc::clone(&self.masses),
            mass: Arc::clone(&self.mass),
            counted: self.counted.clone(),
        })
    }

    /// Whether no rotation is held because nothing stiffens it.
    pub(in crate::paths) fn turns_nowhere_freely(&self) -> bool {
        self.solver.free_rotations().is_empty()
    }

    /// K x
    pub(in crate::paths) fn stiffness_times(&self, x: &[f64]) -> Vec<f64> {
        self.solver.resisted(x)
    }

    /// M
    pub(in crate::paths) fn mass(&self) -> &LowerTriangle {
        &self.mass
    }

    /// With the analysis of another; nothing where the unknowns are not coupled as there.
    pub(super) fn near(&self, structure: &Structure, masses: &Masses) -> Result<Option<Self>> {
        let (model, reduction) = reduced(structure)?;
        if reduction.unknowns != self.reduction.unknowns {
            return Ok(None);
        }
        let Some(solver) = self.solver.of_another(&model, &reduction)? else {
            return Ok(None);
        };
        let motion = Self::with(model, reduction, solver, masses)?;
        if let Some(count) = self.counted.get() {
            let _ = motion.counted.set(Arc::clone(count));
        }
        Ok(Some(motion))
    }

    fn with(model: Model, reduction: Reduction, solver: Solver, masses: &Masses) -> Result<Self> {
        let masses = ElementMasses::new(&model, masses);
        let mass = assemble_mass(&reduction, &masses);
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
            masses: Arc::new(masses),
            mass: Arc::new(mass),
            counted: OnceLock::new(),
        })
    }

    /// Modes below a shift.
    pub(super) fn below(&self, shift: f64) -> Result<usize> {
        let shifted = self.solver.shifted(&self.mass, shift);
        if let Some(known) = self.counted.get()
            && let Some(moved) = shifted.in_places_of(&known.pattern)
        {
            return known.inertia.negative_eigenvalues(&moved);
        }
        let places = self.reduction.places(&self.model.nodes);
        let inertia = Inertia::analyse(&shifted, &places, 1.0)?;
        let below = inertia.negative_eigenvalues(&shifted)?;
        let _ = self.counted.set(Arc::new(Count {
            pattern: shifted,
            inertia,
        }));
        Ok(below)
    }

    pub(super) fn modes(&self, found: &RitzPairs, count: usize) -> Modes {
        let wanted = count.min(found.converged);
        let together = self.moved_together();
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

fn reduced(structure: &Structure) -> Result<(Model, Reduction)> {
    let model = Model::new(structure)?;
    let constraints = Constraints::new(structure);
    let reduction = Reduction::new(&constraints, &model.diagonal()?);
    Ok((model, reduction))
}

impl Motion {
    /// M times a unit motion of all nodes along each axis, on all dofs.
    fn moved_together(&self) -> [Vec<f64>; 3] {
        let mut forces = [0, 1, 2].map(|_| vec![0.0; self.model.dofs]);
        self.masses.for_each(|row, column, value| {
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
pub(in crate::paths) fn sign(shape: &[f64], arm: f64) -> f64 {
    let size = |(dof, value): (usize, &f64)| value.abs() * if dof % 6 < 3 { 1.0 } else { arm };
    let most = shape.iter().enumerate().map(size).fold(0.0, f64::max);
    let first = shape
        .iter()
        .enumerate()
        .find(|&one| size(one) >= AS_LARGE * most);
    first.map_or(1.0, |(_, value)| 1.0_f64.copysign(*value))
}
