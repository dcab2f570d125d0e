//! What is read off solved samples: outputs, and their derivatives
//!
//!   K dz = B dq + dB q - dK z,    dy = S dz + T dq + dS z + dT q.

use pulp::Simd;

use super::batch::{Batch, Solve};
use crate::directions::Directions;
use crate::error::Result;
use crate::input::Array;
use crate::lanes::gather;
use crate::system::System;

/// Rows of the samples in the lanes.
#[derive(Clone, Copy)]
pub struct Rows {
    pub from: usize,
    pub count: usize,
}

pub trait Reading: Sync {
    /// Numbers of a sample.
    fn width(&self) -> usize;

    /// Adds them to `shown`.
    fn read<S: Simd>(
        &self,
        simd: S,
        system: &System,
        rows: Rows,
        batch: &Batch<S>,
        solver: &mut impl Solve<S>,
        shown: &mut [S::f64s],
    ) -> Result<()>;
}

/// The outputs themselves.
pub struct Outputs {
    pub outputs: usize,
}

impl Reading for Outputs {
    fn width(&self) -> usize {
        self.outputs
    }

    #[inline(always)]
    fn read<S: Simd>(
        &self,
        simd: S,
        system: &System,
        _: Rows,
        batch: &Batch<S>,
        _: &mut impl Solve<S>,
        shown: &mut [S::f64s],
    ) -> Result<()> {
        system
            .shown
            .add(simd, &batch.weights, &batch.unknowns, shown);
        system
            .direct
            .add(simd, &batch.weights, &batch.coefficients, shown);
        Ok(())
    }
}

/// Derivatives along directions, `[directions, outputs]`.
pub struct Forward<'a> {
    pub outputs: usize,
    pub directions: &'a Directions,
    /// Derivatives of the coefficients that the directions name, row by row.
    pub coefficients: Array<'a, f64>,
    /// The same of the factors.
    pub factors: Array<'a, f64>,
}

impl Reading for Forward<'_> {
    fn width(&self) -> usize {
        self.directions.count * self.outputs
    }

    #[inline(always)]
    fn read<S: Simd>(
        &self,
        simd: S,
        system: &System,
        rows: Rows,
        batch: &Batch<S>,
        solver: &mut impl Solve<S>,
        shown: &mut [S::f64s],
    ) -> Result<()> {
        let Batch { weights, coefficients, unknowns, .. } = batch;
        let size = unknowns.len();
        let moved = self.moved(simd, system, rows, batch);
        let mut motions = vec![simd.splat_f64s(0.0); size * moved.len()];
        for (at, direction) in moved.iter().enumerate() {
            let right = &mut motions[at * size..(at + 1) * size];
            system.load.add(simd, weights, &direction.coefficients, right);
            for &(weight, rate) in &direction.weights {
                let taken = (weight, simd.neg_f64s(rate));
                system.load.add_one(simd, (weight, rate), coefficients, right);
                system.stiffness.add_one(simd, taken, unknowns, right);
            }
        }
        solver.solve(simd, batch, &mut motions)?;
        for (at, direction) in moved.iter().enumerate() {
            let shown = &mut shown[at * self.outputs..(at + 1) * self.outputs];
            let motion = &motions[at * size..(at + 1) * size];
            system.shown.add(simd, weights, motion, shown);
            system.direct.add(simd, weights, &direction.coefficients, shown);
            for &rate in &direction.weights {
                system.shown.add_one(simd, rate, unknowns, shown);
                system.direct.add_one(simd, rate, coefficients, shown);
            }
        }
        Ok(())
    }
}

/// Of one direction: derivatives of the coefficients, and of the weights that change.
struct Moved<S: Simd> {
    coefficients: Vec<S::f64s>,
    weights: Vec<(usize, S::f64s)>,
}

impl Forward<'_> {
    #[inline(always)]
    fn moved<S: Simd>(
        &self,
        simd: S,
        system: &System,
        rows: Rows,
        batch: &Batch<S>,
    ) -> Vec<Moved<S>> {
        let Directions { count, loads, changes } = self.directions;
        let zero = simd.splat_f64s(0.0);
        let mut moved: Vec<Moved<S>> = Vec::with_capacity(*count);
        for _ in 0..*count {
            moved.push(Moved {
                coefficients: vec![zero; batch.coefficients.len()],
                weights: Vec::new(),
            });
        }
        let mut rates = vec![zero; loads.len()];
        gather::<S>(&mut rates, self.coefficients.values, rows.from, rows.count);
        for (&(direction, pattern), rate) in loads.iter().zip(rates) {
            let place = &mut moved[direction].coefficients[pattern];
            *place = simd.add_f64s(*place, rate);
        }
        let mut rates = vec![zero; changes.len()];
        gather::<S>(&mut rates, self.factors.values, rows.from, rows.count);
        for (&(direction, element), rate) in changes.iter().zip(rates) {
            let weights = &mut moved[direction].weights;
            weights.push((element, rate));
            if system.weights.inverses && element < system.weights.members {
                let inverse = system.weights.inverse(element);
                let of_one = batch.weights[inverse];
                let change = simd.mul_f64s(rate, simd.mul_f64s(of_one, of_one));
                weights.push((inverse, simd.neg_f64s(change)));
            }
        }
        moved
    }
}

/// Derivatives of the sum of the outputs times gradients, by the coefficients and then by the
/// factors, `[patterns + elements]`: the adjoint.
pub struct Adjoint<'a> {
    pub patterns: usize,
    pub elements: usize,
    pub gradients: Array<'a, f64>,
}

impl Reading for Adjoint<'_> {
    fn width(&self) -> usize {
        self.patterns + self.elements
    }

    #[inline(always)]
    fn read<S: Simd>(
        &self,
        simd: S,
        system: &System,
        rows: Rows,
        batch: &Batch<S>,
        solver: &mut impl Solve<S>,
        shown: &mut [S::f64s],
    ) -> Result<()> {
        let Batch { weights, coefficients, unknowns, .. } = batch;
        let zero = simd.splat_f64s(0.0);
        let mut gradients = vec![zero; self.gradients.shape[1]];
        gather::<S>(&mut gradients, self.gradients.values, rows.from, rows.count);
        let mut adjoint = vec![zero; unknowns.len()];
        system.shown.add_transposed(simd, weights, &gradients, &mut adjoint);
        solver.solve(simd, batch, &mut adjoint)?;
        let (by_coefficients, by_factors) = shown.split_at_mut(self.patterns);
        system.load.add_transposed(simd, weights, &adjoint, by_coefficients);
        system.direct.add_transposed(simd, weights, &gradients, by_coefficients);
        let mut by_weights = vec![zero; weights.len()];
        system.stiffness.add_to_weights(simd, &adjoint, unknowns, &mut by_weights);
        for value in &mut by_weights {
            *value = simd.neg_f64s(*value);
        }
        system.load.add_to_weights(simd, &adjoint, coefficients, &mut by_weights);
        system.shown.add_to_weights(simd, &gradients, unknowns, &mut by_weights);
        system.direct.add_to_weights(simd, &gradients, coefficients, &mut by_weights);
        by_factors.copy_from_slice(&by_weights[..self.elements]);
        if !system.weights.inverses {
            return Ok(());
        }
        for (member, by_factor) in by_factors[..system.weights.members].iter_mut().enumerate() {
            let inverse = system.weights.inverse(member);
            let (rate, of_one) = (by_weights[inverse], weights[inverse]);
            // A factor of zero has no inverse; where nothing depends on it, that is no matter.
            let change = simd.mul_f64s(rate, simd.mul_f64s(of_one, of_one));
            let change = simd.select_f64s(simd.equal_f64s(rate, zero), zero, change);
            *by_factor = simd.sub_f64s(*by_factor, change);
        }
        Ok(())
    }
}
