//! Samples of a structure of which every stiffness may vary (C3).
//!
//! What does not depend on the stiffness is done once: checks, supports and ties, the structure as
//! sums over the factors of its elements (`system`), the pattern of the reduced matrix and its
//! symbolic Cholesky analysis. A sample fills in values, factorises, and solves for its one load.
//! Its derivatives share the factorisation:
//!
//!   K dz = B dq + dB q - dK z,    dy = S dz + T dq + dS z + dT q.

use std::ops::Range;

use crate::check::not_negative;
use crate::check_loads::{check_loads, check_outputs};
use crate::check_structure::check_structure;
use crate::constraint::Constraints;
use crate::directions::Directions;
use crate::equilibrium::{LOOSE_MOMENT, loose_moment};
use crate::error::{Error, Result};
use crate::input::{Array, Loads, Outputs, Structure};
use crate::model::Model;
use crate::observe::read_outputs;
use crate::parallel::in_chunks;
use crate::reduction::Reduction;
use crate::stability::Solver;
use crate::system::System;

/// Rows that a thread takes at a time.
const CHUNK: usize = 16;

pub struct Refactored {
    model: Model,
    reduction: Reduction,
    system: System,
    /// Analysed, not factorised.
    solver: Solver,
    patterns: usize,
    outputs: usize,
}

/// Samples: factors `[rows, members + springs]` multiply the whole stiffness of a member or of a
/// spring; 0 removes it. The load of a sample is the sum of all patterns times its coefficients
/// `[rows, patterns]`.
#[derive(Debug, Clone, Copy)]
pub struct Samples<'a> {
    pub factors: Array<'a, f64>,
    pub coefficients: Array<'a, f64>,
}

/// A solved sample, and what a thread needs for it.
struct Solved {
    solver: Solver,
    weights: Vec<f64>,
    load: Vec<f64>,
    /// z
    unknowns: Vec<f64>,
}

impl Refactored {
    pub fn new(structure: &Structure, loads: &Loads, outputs: &Outputs) -> Result<Self> {
        check_structure(structure)?;
        check_loads(structure, loads)?;
        check_outputs(structure, outputs)?;
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let wanted = read_outputs(outputs);
        let (system, matrix) = System::new(&model, &constraints, &reduction, loads, &wanted)?;
        let mut solver = Solver::analyse(matrix)?;
        let mut weights = vec![0.0; system.weights.count()];
        (system.weights).fill(&vec![1.0; system.weights.elements], &mut weights);
        system.fill(&weights, solver.values_mut());
        solver.find_turns(&reduction);
        Ok(Self {
            solver,
            patterns: loads.pattern_count(),
            outputs: wanted.len(),
            model,
            reduction,
            system,
        })
    }

    /// Number of outputs.
    pub fn width(&self) -> usize {
        self.outputs
    }

    /// Number of members and springs.
    pub fn elements(&self) -> usize {
        self.system.weights.elements
    }

    /// Number of load patterns.
    pub fn patterns(&self) -> usize {
        self.patterns
    }

    /// The outputs of all samples, `[rows, outputs]` in C order.
    pub fn respond(&self, samples: Samples, threads: usize) -> Result<Vec<f64>> {
        self.each(samples, self.outputs, threads, |solved, row, shown| {
            let System {
                shown: s,
                direct: t,
                ..
            } = &self.system;
            s.add(&solved.weights, &solved.unknowns, shown);
            t.add(&solved.weights, samples.coefficients.row(row), shown);
            Ok(())
        })
    }

    /// Derivatives of the outputs along directions, `[rows, directions, outputs]` in C order.
    ///
    /// `rates` hold, row by row, the derivatives of the coefficients and of the factors that the
    /// directions name.
    pub fn differentiate(
        &self,
        samples: Samples,
        directions: &Directions,
        rates: (Array<f64>, Array<f64>),
        threads: usize,
    ) -> Result<Vec<f64>> {
        directions.check(self.patterns, self.elements())?;
        let rows = samples.factors.len();
        for (name, rates, entries) in [
            ("coefficient_rates", rates.0, &directions.loads),
            ("factor_rates", rates.1, &directions.changes),
        ] {
            rates.check_shape(name, &[rows, entries.len()])?;
            rates.check_finite(name)?;
        }
        let width = directions.count * self.outputs;
        self.each(samples, width, threads, |solved, row, shown| {
            let q = samples.coefficients.row(row);
            let rates = (rates.0.row(row), rates.1.row(row));
            let moved = self.moved(directions, rates, samples.factors.row(row));
            let size = solved.unknowns.len();
            let mut motions = vec![0.0; size * moved.len()];
            let System {
                stiffness,
                load,
                shown: s,
                direct: t,
                ..
            } = &self.system;
            for (direction, right) in moved.iter().zip(motions.chunks_exact_mut(size.max(1))) {
                load.add(&solved.weights, &direction.coefficients, right);
                for &(weight, rate) in &direction.weights {
                    load.add_one(weight, rate, q, right);
                    stiffness.add_one(weight, -rate, &solved.unknowns, right);
                }
            }
            if !solved
                .solver
                .solve_checked(&mut motions, self.resisted(&solved.weights))?
            {
                return Err(solved.solver.unstable(&self.model, &self.reduction));
            }
            for (at, direction) in moved.iter().enumerate() {
                let shown = &mut shown[at * self.outputs..(at + 1) * self.outputs];
                s.add(&solved.weights, &motions[at * size..(at + 1) * size], shown);
                t.add(&solved.weights, &direction.coefficients, shown);
                for &(weight, rate) in &direction.weights {
                    s.add_one(weight, rate, &solved.unknowns, shown);
                    t.add_one(weight, rate, q, shown);
                }
            }
            Ok(())
        })
    }

    /// Derivatives of the sum of the outputs times `gradients` `[rows, outputs]`, by the
    /// coefficients and then by the factors: `[rows, patterns + elements]` in C order. One solve a
    /// row, however many there are.
    pub fn pull_back(
        &self,
        samples: Samples,
        gradients: Array<f64>,
        threads: usize,
    ) -> Result<Vec<f64>> {
        gradients.check_shape("gradients", &[samples.factors.len(), self.outputs])?;
        gradients.check_finite("gradients")?;
        let width = self.patterns + self.elements();
        self.each(samples, width, threads, |solved, row, found| {
            let (q, g) = (samples.coefficients.row(row), gradients.row(row));
            let system = &self.system;
            let weights = &solved.weights;
            let mut adjoint = vec![0.0; solved.unknowns.len()];
            system.shown.add_transposed(weights, g, &mut adjoint);
            if !solved
                .solver
                .solve_checked(&mut adjoint, self.resisted(&solved.weights))?
            {
                return Err(solved.solver.unstable(&self.model, &self.reduction));
            }
            let (by_coefficients, by_factors) = found.split_at_mut(self.patterns);
            system
                .load
                .add_transposed(weights, &adjoint, by_coefficients);
            system.direct.add_transposed(weights, g, by_coefficients);
            let mut by_weights = vec![0.0; weights.len()];
            system
                .stiffness
                .add_to_weights(&adjoint, &solved.unknowns, &mut by_weights);
            by_weights.iter_mut().for_each(|value| *value = -*value);
            system.load.add_to_weights(&adjoint, q, &mut by_weights);
            system
                .shown
                .add_to_weights(g, &solved.unknowns, &mut by_weights);
            system.direct.add_to_weights(g, q, &mut by_weights);
            by_factors.copy_from_slice(&by_weights[..self.elements()]);
            let inverses = system.weights.inverse(0)..;
            let inverses = by_weights[inverses.clone()].iter().zip(&weights[inverses]);
            for (by_factor, (by_inverse, inverse)) in by_factors.iter_mut().zip(inverses) {
                if *by_inverse != 0.0 {
                    *by_factor -= by_inverse * inverse.powi(2);
                }
            }
            Ok(())
        })
    }

    /// Solves every sample; `read` fills `width` numbers of its row, which are zero before.
    fn each(
        &self,
        samples: Samples,
        width: usize,
        threads: usize,
        read: impl Fn(&Solved, usize, &mut [f64]) -> Result<()> + Sync,
    ) -> Result<Vec<f64>> {
        let Samples {
            factors,
            coefficients,
        } = samples;
        let rows = factors.len();
        factors.check_shape("factors", &[rows, self.elements()])?;
        coefficients.check_shape("coefficients", &[rows, self.patterns])?;
        factors.check_each("factors", "finite and not negative", not_negative)?;
        coefficients.check_finite("coefficients")?;
        self.check_yielding(factors)?;
        // Without outputs the samples are still checked: one place a row, left empty.
        let place = width.max(1);
        let mut results = vec![0.0; rows * place];
        let prepare = || self.scratch();
        let work = |solved: &mut Solved, own: Range<usize>, part: &mut [f64]| {
            for (row, found) in own.zip(part.chunks_exact_mut(place)) {
                let sample = self.solve(solved, factors.row(row), coefficients.row(row));
                sample
                    .and_then(|()| read(solved, row, &mut found[..width]))
                    .and_then(|()| finite(found))
                    .map_err(|error| error.of_row(row))?;
            }
            Ok(())
        };
        in_chunks(&mut results, place, CHUNK, threads, prepare, work)?;
        results.truncate(rows * width);
        Ok(results)
    }

    fn scratch(&self) -> Result<Solved> {
        let size = self.reduction.unknowns.len();
        Ok(Solved {
            solver: self.solver.another()?,
            weights: vec![0.0; self.system.weights.count()],
            load: vec![0.0; size],
            unknowns: vec![0.0; size],
        })
    }

    fn solve(&self, solved: &mut Solved, factors: &[f64], coefficients: &[f64]) -> Result<()> {
        let Solved {
            solver,
            weights,
            load,
            unknowns,
        } = solved;
        let system = &self.system;
        system.weights.fill(factors, weights);
        load.fill(0.0);
        system.load.add(weights, coefficients, load);
        if !load.iter().all(|force| force.is_finite()) {
            return Err(Error::invalid("the load overflows; lower the coefficients"));
        }
        system.fill(weights, solver.values_mut());
        if !solver.values_mut().iter().all(|value| value.is_finite()) {
            return Err(Error::invalid("the stiffness overflows; lower the factors"));
        }
        solver.hold_turns();
        let mut loose = Vec::new();
        if !solver.factorise(&self.model, &self.reduction) {
            // Without some members, nothing may stiffen a rotation.
            system.fill(weights, solver.values_mut());
            solver.hold_turns();
            loose = solver.hold_loose(&self.reduction, self.model.dofs);
            if !solver.factorise(&self.model, &self.reduction) {
                return Err(solver.unstable(&self.model, &self.reduction));
            }
        }
        if solver.moves_freely(&self.model, &self.reduction, |element| weights[element])? {
            return Err(solver.unstable(&self.model, &self.reduction));
        }
        self.check_loose(weights, coefficients, load, &loose)?;
        solver.check_turns(load, "the load")?;
        unknowns.copy_from_slice(load);
        let resisted = self.resisted(weights);
        if solver.solve_checked(unknowns, resisted)? {
            Ok(())
        } else {
            Err(solver.unstable(&self.model, &self.reduction))
        }
    }

    /// K z, element by element.
    fn resisted(&self, weights: &[f64]) -> impl Fn(&[f64]) -> Vec<f64> {
        |unknowns| {
            let mut displacements = vec![0.0; self.model.dofs];
            self.reduction.expand(unknowns, &mut displacements);
            let forces = self
                .model
                .elastic_forces(&displacements, |element| weights[element]);
            let mut reduced = vec![0.0; unknowns.len()];
            self.reduction.collect(&forces, &mut reduced);
            reduced
        }
    }

    /// A moment on a rotation that nothing stiffens must not vanish silently.
    fn check_loose(
        &self,
        weights: &[f64],
        coefficients: &[f64],
        load: &[f64],
        loose: &[usize],
    ) -> Result<()> {
        let Reduction { held, unknowns, .. } = &self.reduction;
        let mut on_held = vec![0.0; held.len()];
        self.system.on_held.add(weights, coefficients, &mut on_held);
        let forces = load.iter().chain(&on_held);
        let largest = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
        let of_loose = loose.iter().map(|&at| (unknowns[at], load[at]));
        let of_held = held.iter().copied().zip(on_held);
        let mut turned = of_loose.chain(of_held);
        match turned.find(|(_, moment)| moment.abs() > LOOSE_MOMENT * largest) {
            None => Ok(()),
            Some((dof, _)) => Err(loose_moment("the load", dof)),
        }
    }

    fn check_yielding(&self, factors: Array<f64>) -> Result<()> {
        let members = self.model.members.iter().enumerate();
        for (index, _) in members.filter(|(_, member)| !member.is_proportional()) {
            if let Some(row) = (0..factors.len()).find(|&row| factors.row(row)[index] != 1.0) {
                return Err(Error::invalid(format!(
                    "factors[{row}, {index}] is {}, but the ends of member {index} yield and do \
                     not scale with it; it must be 1",
                    factors.row(row)[index]
                )));
            }
        }
        Ok(())
    }

    /// What changes along each direction.
    fn moved(
        &self,
        directions: &Directions,
        rates: (&[f64], &[f64]),
        factors: &[f64],
    ) -> Vec<Moved> {
        let mut moved: Vec<Moved> = (0..directions.count)
            .map(|_| Moved {
                coefficients: vec![0.0; self.patterns],
                weights: Vec::new(),
            })
            .collect();
        for (&(direction, pattern), rate) in directions.loads.iter().zip(rates.0) {
            moved[direction].coefficients[pattern] += rate;
        }
        for (&(direction, element), &rate) in directions.changes.iter().zip(rates.1) {
            let weights = &mut moved[direction].weights;
            weights.push((element, rate));
            if element < self.system.weights.members {
                let of_inverse = -rate / factors[element].powi(2);
                weights.push((self.system.weights.inverse(element), of_inverse));
            }
        }
        moved
    }
}

/// Of one direction: derivatives of the coefficients, and of the weights that change.
struct Moved {
    coefficients: Vec<f64>,
    weights: Vec<(usize, f64)>,
}

fn finite(found: &[f64]) -> Result<()> {
    match found.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(Error::invalid(format!(
            "number {at} of the result overflows; check the sizes of loads and stiffnesses"
        ))),
    }
}
