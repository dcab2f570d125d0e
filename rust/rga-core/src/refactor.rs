//! Samples of a structure of which every stiffness may vary (C3).
//!
//! What does not depend on the stiffness is done once: checks, supports and
//! ties, the pattern of the reduced matrix, its symbolic Cholesky analysis.
//! A sample combines the load patterns, fills in values, factorises, and
//! solves for its one load.

use crate::check::not_negative;
use crate::check_loads::{check_loads, check_outputs};
use crate::check_structure::check_structure;
use crate::combination::{Combination, Combined};
use crate::constraint::Constraints;
use crate::equilibrium::Equilibrium;
use crate::error::{Error, Result};
use crate::input::{Array, Loads, Outputs, Structure};
use crate::model::Model;
use crate::observe::{Observer, Output, read_outputs};
use crate::parallel::in_chunks;
use crate::reduction::Reduction;
use crate::scatter::Scatter;
use crate::stability::Solver;

/// Rows that a thread takes at a time.
const CHUNK: usize = 16;

pub struct Refactored {
    model: Model,
    constraints: Constraints,
    reduction: Reduction,
    scatter: Scatter,
    /// Analysed, not factorised.
    solver: Solver,
    combination: Combination,
    patterns: usize,
    wanted: Vec<Output>,
}

/// What a thread needs for a sample.
struct Scratch {
    model: Model,
    solver: Solver,
    load: Combined,
}

impl Refactored {
    pub fn new(structure: &Structure, loads: &Loads, outputs: &Outputs) -> Result<Self> {
        check_structure(structure)?;
        check_loads(structure, loads)?;
        check_outputs(structure, outputs)?;
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let (scatter, matrix) = Scatter::new(&model, &reduction);
        Ok(Self {
            solver: Solver::analyse(matrix)?,
            combination: Combination::new(loads, &constraints, model.members.len())?,
            patterns: loads.pattern_count(),
            wanted: read_outputs(outputs),
            model,
            constraints,
            reduction,
            scatter,
        })
    }

    /// Number of outputs.
    pub fn width(&self) -> usize {
        self.wanted.len()
    }

    /// The outputs of all samples, `[rows, outputs]` in C order.
    ///
    /// `factors` `[rows, members + springs]` multiply the whole stiffness of
    /// a member, without its end connections, or of a spring; 0 removes it.
    /// The load of a sample is the sum of all patterns times `coefficients`
    /// `[rows, patterns]`.
    pub fn respond(
        &self,
        factors: Array<f64>,
        coefficients: Array<f64>,
        threads: usize,
    ) -> Result<Vec<f64>> {
        let rows = factors.len();
        let elements = self.model.members.len() + self.model.springs.len();
        factors.check_shape("factors", &[rows, elements])?;
        coefficients.check_shape("coefficients", &[rows, self.patterns])?;
        factors.check_each("factors", "finite and not negative", not_negative)?;
        coefficients.check_finite("coefficients")?;
        let prepare = || self.scratch();
        // Without outputs the samples are still checked: one place a row, left empty.
        let (width, place) = (self.width(), self.width().max(1));
        let mut results = vec![0.0; rows * place];
        in_chunks(
            &mut results,
            place,
            CHUNK,
            threads,
            prepare,
            |scratch, own, part| {
                for (row, shown) in own.zip(part.chunks_exact_mut(place)) {
                    let mut read = Vec::with_capacity(width);
                    self.sample(scratch, factors.row(row), coefficients.row(row), &mut read)
                        .map_err(|error| error.of_row(row))?;
                    shown[..width].copy_from_slice(&read);
                }
                Ok(())
            },
        )?;
        results.truncate(rows * width);
        Ok(results)
    }

    fn scratch(&self) -> Result<Scratch> {
        Ok(Scratch {
            model: self.model.clone(),
            solver: self.solver.another()?,
            load: self.combination.room(),
        })
    }

    fn sample(
        &self,
        scratch: &mut Scratch,
        factors: &[f64],
        coefficients: &[f64],
        results: &mut Vec<f64>,
    ) -> Result<()> {
        let Scratch {
            model,
            solver,
            load,
        } = scratch;
        self.combination.combine(coefficients, load)?;
        model.scale(&self.model, factors);
        let values = solver.values_mut();
        self.scatter.fill(model, factors, values);
        if !values.iter().all(|value| value.is_finite()) {
            return Err(Error::invalid("the stiffness overflows; lower the factors"));
        }
        let first = results.len();
        if solver.factorise(model, &self.reduction) {
            self.solve(model, &self.reduction, solver, load, results)?;
        } else {
            // Without some members, nothing may stiffen a rotation.
            let reduction = Reduction::new(&self.constraints, &model.diagonal()?);
            if reduction.unknowns == self.reduction.unknowns {
                return Err(solver.unstable(model, &reduction));
            }
            let solver = Solver::new(model, &reduction)?;
            self.solve(model, &reduction, &solver, load, results)?;
        }
        match results[first..].iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(at) => Err(self.not_finite(at, factors)),
        }
    }

    fn solve(
        &self,
        model: &Model,
        reduction: &Reduction,
        solver: &Solver,
        load: &Combined,
        results: &mut Vec<f64>,
    ) -> Result<()> {
        let equilibrium = Equilibrium {
            model,
            reduction,
            solver,
        };
        let base = load.displacements.clone();
        let mut state = equilibrium.start(&load.members, &load.strain, &load.forces, base)?;
        equilibrium.check_loose(&state, "the load")?;
        let mut unknowns = vec![0.0; reduction.unknowns.len()];
        reduction.collect(&state.unbalanced, &mut unknowns);
        let applied = solver.force_norm(&unknowns);
        solver.solve(&mut unknowns)?;
        equilibrium.finish(&mut state, applied, &unknowns)?;
        Observer::new(model, &self.constraints, &self.wanted).read(&state, results);
        Ok(())
    }

    fn not_finite(&self, output: usize, factors: &[f64]) -> Error {
        match self.wanted[output] {
            Output::Strain(member, ..) if factors[member] == 0.0 => Error::invalid(format!(
                "output {output} reads a strain of frame member {member}, which a factor of 0 \
                 removes; read no strain there or keep the factor above 0"
            )),
            _ => Error::invalid(format!(
                "output {output} overflows; check the sizes of loads and stiffnesses"
            )),
        }
    }
}
