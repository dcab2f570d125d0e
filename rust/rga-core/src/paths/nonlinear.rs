//! Samples in the equilibrium of the deformed structure (C4).
//!
//! Loads do not superpose here: each row takes the sum of its load patterns, and Newton's method
//! finds its equilibrium. The load grows from nothing in levels, so that the state found is the
//! one that the structure reaches. A level is taken where corrections are small beside its step
//! (Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 5.1) and the flexibility to
//! it changes little (the current stiffness parameter of Bergan et al., Solution techniques for
//! non-linear finite element problems, IJNME 12, 1978); most rows need one level. A tangent that
//! is not positive definite on the way means that the structure buckles or snaps through
//! (`load_steps`). Loads are combined from patterns (`load_combination`), and a state has its
//! forces and its tangent (`state`), whose entries have their places in K (`tangent_placement`).
//!
//! The tension in the tangent is the one that the step before led to expect, as if tensions were
//! unknowns of their own: the residual is the same, and a slender member that bends far in a step
//! is not stiffened by a stretch that the next step takes back (Magisano, Leonetti and Garcea,
//! Advantages of the mixed format in geometrically nonlinear analysis of beams and shells using
//! solid finite elements, IJNME 109, 2017).

mod load_combination;
mod load_steps;
mod state;
mod tangent_placement;

use rga_simd::Array;

use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::deformed_member::Flexible;
use crate::fe::equilibrium::Equilibrium;
use crate::fe::model::Model;
use crate::fe::outputs::{Observer, Output, State, read_outputs};
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Loads, Outputs, Structure};
use crate::paths::parallel::in_chunks;
use crate::sparse::ordering::OFTEN;
use crate::validate::arrays::{CheckNumbers, CheckShape};
use crate::validate::loads::check_loads;
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;
use load_combination::Combination;
use state::Scratch;
use tangent_placement::TangentPlacement;

/// Rows that a thread takes at a time.
const CHUNK: usize = 4;

/// A residual above this part of motions and forces is refused.
const REFUSE: f64 = 1e-9;

struct Analysis {
    model: Model,
    flexible: Vec<Flexible>,
    constraints: Constraints,
    reduction: Reduction,
    placement: TangentPlacement,
    /// Of the unloaded structure; nothing where it moves freely before it is stretched.
    rest: Option<Solver>,
    /// Analysed, not factorised.
    solver: Solver,
    combination: Combination,
    wanted: Vec<Output>,
    arm: f64,
}

/// Outputs `[rows, outputs]` in C order; the load of a row is the sum of all patterns times its
/// `coefficients` `[rows, patterns]`.
pub fn respond_nonlinear(
    structure: &Structure,
    loads: &Loads,
    outputs: &Outputs,
    coefficients: Array<f64>,
    threads: usize,
) -> Result<Vec<f64>> {
    check_structure(structure)?;
    check_loads(structure, loads)?;
    check_outputs(structure, outputs)?;
    let rows = coefficients.len();
    coefficients.check_shape("coefficients", &[rows, loads.pattern_count()])?;
    coefficients.check_finite("coefficients")?;
    let analysis = Analysis::new(structure, loads, outputs)?;
    // Without outputs the rows are still solved: one place a row, left empty.
    let width = analysis.wanted.len();
    let place = width.max(1);
    let mut results = vec![0.0; rows * place];
    in_chunks(
        &mut results,
        place,
        CHUNK,
        threads,
        || analysis.scratch(),
        |scratch, own, part| {
            for (row, shown) in own.zip(part.chunks_exact_mut(place)) {
                let read = (analysis.sample(scratch, coefficients.row(row)))
                    .map_err(|error| error.of_row(row))?;
                shown[..width].copy_from_slice(&read);
            }
            Ok(())
        },
    )?;
    results.truncate(rows * width);
    Ok(results)
}

impl Analysis {
    fn new(structure: &Structure, loads: &Loads, outputs: &Outputs) -> Result<Self> {
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let (placement, matrix) = TangentPlacement::new(&model, &reduction);
        let places = reduction.places(&model.nodes);
        let solver = Solver::analyse(matrix, Vec::new(), &places, OFTEN)?;
        let mut analysis = Self {
            flexible: model.members.iter().map(Flexible::new).collect(),
            combination: Combination::new(loads, &constraints, model.members.len())?,
            wanted: read_outputs(outputs),
            rest: None,
            arm: model.arm(),
            model,
            constraints,
            reduction,
            placement,
            solver,
        };
        let mut scratch = analysis.scratch()?;
        let still = vec![0.0; analysis.reduction.unknowns.len()];
        let nothing = vec![0.0; loads.pattern_count()];
        analysis.load(&mut scratch, &nothing, &nothing)?;
        if analysis.balance(&mut scratch, &still) {
            scratch.take_tensions();
            if analysis.factorise(&mut scratch) {
                analysis.rest = Some(scratch.solver);
            }
        }
        Ok(analysis)
    }

    fn scratch(&self) -> Result<Scratch> {
        let (dofs, size) = (self.model.dofs, self.reduction.unknowns.len());
        Ok(Scratch {
            solver: self.solver.another()?,
            load: self.combination.room(),
            fixed_end: Vec::new(),
            deformed: Vec::new(),
            tensions: Vec::new(),
            displacements: vec![0.0; dofs],
            unbalanced: Vec::new(),
            residual: vec![0.0; size],
            sizes: Vec::new(),
        })
    }

    fn sample(&self, scratch: &mut Scratch, coefficients: &[f64]) -> Result<Vec<f64>> {
        let unknowns = self.follow(scratch, coefficients)?;
        self.load(scratch, coefficients, coefficients)?;
        let finite = self.balance(scratch, &unknowns);
        let residual = scratch.solver.force_norm(&scratch.residual);
        // Written so that NaN is refused as well.
        if !(finite && residual <= REFUSE * scratch.size(&unknowns)) {
            return Err(Error::invalid(
                "the equilibrium of the deformed structure is not found to 1e-9; check the sizes \
                 of loads and stiffnesses",
            ));
        }
        let state = State {
            loads: &scratch.load.members,
            strain: &scratch.load.strain,
            forces: &scratch.load.forces,
            fixed_end: Vec::new(),
            displacements: scratch.displacements.clone(),
            unbalanced: scratch.unbalanced.clone(),
            deformed: Some(&scratch.deformed),
        };
        let equilibrium = Equilibrium {
            model: &self.model,
            reduction: &self.reduction,
            solver: &scratch.solver,
        };
        equilibrium.check_loose(&state, "the load")?;
        let mut read = Vec::with_capacity(self.wanted.len());
        Observer::new(&self.model, &self.constraints, &self.wanted).read(&state, &mut read);
        match read.iter().position(|value| !value.is_finite()) {
            None => Ok(read),
            Some(at) => Err(Error::invalid(format!(
                "output {at} overflows; check the sizes of loads and stiffnesses"
            ))),
        }
    }
}
