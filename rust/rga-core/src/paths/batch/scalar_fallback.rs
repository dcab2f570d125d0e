//! One sample at a time, refined and with every refusal named: what the lanes leave over, and
//! structures that are too large for them.

use rga_simd::f64::{Lanes, ONE, One};

use super::simd_solver::{Batch, Solve};
use super::system::System;
use crate::error::{Error, Result};
use crate::fe::equilibrium::{LOOSE_MOMENT, loose_moment};
use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;

pub(super) struct ScalarFallback<'a> {
    pub model: &'a Model,
    pub reduction: &'a Reduction,
    pub system: &'a System,
    pub solver: Solver,
}

impl ScalarFallback<'_> {
    /// Finds the unknowns under the load.
    pub(super) fn factorise(&mut self, batch: &mut Batch<One>) -> Result<()> {
        let (system, solver) = (self.system, &mut self.solver);
        let load = One::flat(&batch.load);
        if !load.iter().all(|force| force.is_finite()) {
            return Err(Error::invalid("the load overflows; lower the coefficients"));
        }
        let weights = One::flat(&batch.weights);
        system.fill(weights, solver.values_mut());
        if !solver.values_mut().iter().all(|value| value.is_finite()) {
            return Err(Error::invalid("the stiffness overflows; lower the factors"));
        }
        solver.hold_free_rotations();
        let mut loose = Vec::new();
        if !solver.factorise(self.model, self.reduction) {
            // Without some members, nothing may stiffen a rotation.
            system.fill(weights, solver.values_mut());
            solver.hold_free_rotations();
            loose = solver.hold_loose(self.reduction, self.model.dofs);
            if !solver.factorise(self.model, self.reduction) {
                return Err(solver.unstable(self.model, self.reduction));
            }
        }
        if solver.moves_freely(self.model, self.reduction, |element| weights[element])? {
            return Err(solver.unstable(self.model, self.reduction));
        }
        let load = system.by_unknown(load);
        self.check_loose(batch, &load, &loose)?;
        self.solver.check_free_rotations(&load, "the load")?;
        let mut unknowns = batch.load.clone();
        self.solve(ONE, batch, &mut unknowns)?;
        batch.unknowns = unknowns;
        Ok(())
    }

    /// A moment on a rotation that nothing stiffens must not vanish silently.
    fn check_loose(&self, batch: &Batch<One>, load: &[f64], loose: &[usize]) -> Result<()> {
        let Reduction { held, unknowns, .. } = self.reduction;
        let mut on_held = vec![[0.0]; held.len()];
        let Batch {
            weights,
            coefficients,
            ..
        } = batch;
        (self.system.on_held).add(ONE, weights, coefficients, &mut on_held);
        let on_held = One::flat(&on_held);
        let forces = load.iter().chain(on_held);
        let largest = forces.fold(0.0_f64, |most, force| most.max(force.abs()));
        let of_loose = loose.iter().map(|&at| (unknowns[at], load[at]));
        let of_held = held.iter().copied().zip(on_held.iter().copied());
        let mut turned = of_loose.chain(of_held);
        match turned.find(|(_, moment)| moment.abs() > LOOSE_MOMENT * largest) {
            None => Ok(()),
            Some((dof, _)) => Err(loose_moment("the load", dof)),
        }
    }

    /// K z, element by element.
    fn resisted(&self, weights: &[f64], unknowns: &[f64]) -> Vec<f64> {
        let mut displacements = vec![0.0; self.model.dofs];
        self.reduction.expand(unknowns, &mut displacements);
        let factor = |element: usize| weights[element];
        let forces = self.model.elastic_forces(&displacements, factor);
        let mut reduced = vec![0.0; unknowns.len()];
        self.reduction.collect(&forces, &mut reduced);
        reduced
    }
}

impl Solve<One> for ScalarFallback<'_> {
    fn solve(&mut self, _: One, batch: &Batch<One>, right: &mut [[f64; 1]]) -> Result<()> {
        let size = batch.load.len().max(1);
        for column in right.chunks_exact_mut(size) {
            let column = column.as_flattened_mut();
            let mut values = self.system.by_unknown(column);
            let resisted = |unknowns: &[f64]| self.resisted(One::flat(&batch.weights), unknowns);
            if !self.solver.solve_checked(&mut values, resisted)? {
                return Err(self.solver.unstable(self.model, self.reduction));
            }
            for (value, &unknown) in column.iter_mut().zip(&self.system.order) {
                *value = values[unknown];
            }
        }
        Ok(())
    }
}
