//! What is read off solved samples: outputs, and their derivatives
//!
//!   K dz = B dq + dB q - dK z,    dy = S dz + T dq + dS z + dT q.

use rga_simd::Array;
use rga_simd::f64::Lanes;

use super::simd_solver::{Batch, Solve};
use super::system::System;
use crate::error::Result;
use crate::paths::directions::Directions;

/// Rows of the samples in the lanes.
#[derive(Clone, Copy)]
pub(super) struct Rows {
    pub from: usize,
    pub count: usize,
}

pub(super) trait Reading: Sync {
    /// Numbers of a sample.
    fn width(&self) -> usize;

    /// Adds them to `shown`.
    fn read<L: Lanes>(
        &self,
        lanes: L,
        system: &System,
        rows: Rows,
        batch: &Batch<L>,
        solver: &mut impl Solve<L>,
        shown: &mut [L::Numbers],
    ) -> Result<()>;
}

/// The outputs themselves.
pub(super) struct Outputs {
    pub outputs: usize,
}

impl Reading for Outputs {
    fn width(&self) -> usize {
        self.outputs
    }

    #[inline(always)]
    fn read<L: Lanes>(
        &self,
        lanes: L,
        system: &System,
        _: Rows,
        batch: &Batch<L>,
        _: &mut impl Solve<L>,
        shown: &mut [L::Numbers],
    ) -> Result<()> {
        system
            .shown
            .add(lanes, &batch.weights, &batch.unknowns, shown);
        system
            .direct
            .add(lanes, &batch.weights, &batch.coefficients, shown);
        Ok(())
    }
}

/// Derivatives along directions, `[directions, outputs]`.
pub(super) struct Forward<'a> {
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
    fn read<L: Lanes>(
        &self,
        lanes: L,
        system: &System,
        rows: Rows,
        batch: &Batch<L>,
        solver: &mut impl Solve<L>,
        shown: &mut [L::Numbers],
    ) -> Result<()> {
        let Batch {
            weights,
            coefficients,
            unknowns,
            ..
        } = batch;
        let size = unknowns.len();
        let moved = self.moved(lanes, system, rows, batch);
        let mut motions = vec![lanes.splat(0.0); size * moved.len()];
        for (at, direction) in moved.iter().enumerate() {
            let right = &mut motions[at * size..(at + 1) * size];
            system
                .load
                .add(lanes, weights, &direction.coefficients, right);
            for &(weight, rate) in &direction.weights {
                let taken = (weight, lanes.neg(rate));
                system
                    .load
                    .add_one(lanes, (weight, rate), coefficients, right);
                system.stiffness.add_one(lanes, taken, unknowns, right);
            }
        }
        solver.solve(lanes, batch, &mut motions)?;
        for (at, direction) in moved.iter().enumerate() {
            let shown = &mut shown[at * self.outputs..(at + 1) * self.outputs];
            let motion = &motions[at * size..(at + 1) * size];
            system.shown.add(lanes, weights, motion, shown);
            system
                .direct
                .add(lanes, weights, &direction.coefficients, shown);
            for &rate in &direction.weights {
                system.shown.add_one(lanes, rate, unknowns, shown);
                system.direct.add_one(lanes, rate, coefficients, shown);
            }
        }
        Ok(())
    }
}

/// Of one direction: derivatives of the coefficients, and of the weights that change.
struct Moved<L: Lanes> {
    coefficients: Vec<L::Numbers>,
    weights: Vec<(usize, L::Numbers)>,
}

impl Forward<'_> {
    #[inline(always)]
    fn moved<L: Lanes>(
        &self,
        lanes: L,
        system: &System,
        rows: Rows,
        batch: &Batch<L>,
    ) -> Vec<Moved<L>> {
        let Directions {
            count,
            loads,
            changes,
        } = self.directions;
        let zero = lanes.splat(0.0);
        let mut moved: Vec<Moved<L>> = Vec::with_capacity(*count);
        for _ in 0..*count {
            moved.push(Moved {
                coefficients: vec![zero; batch.coefficients.len()],
                weights: Vec::new(),
            });
        }
        let mut rates = vec![zero; loads.len()];
        lanes.gather(&mut rates, self.coefficients.values, rows.from, rows.count);
        for (&(direction, pattern), rate) in loads.iter().zip(rates) {
            let place = &mut moved[direction].coefficients[pattern];
            *place = lanes.add(*place, rate);
        }
        let mut rates = vec![zero; changes.len()];
        lanes.gather(&mut rates, self.factors.values, rows.from, rows.count);
        for (&(direction, element), rate) in changes.iter().zip(rates) {
            let weights = &mut moved[direction].weights;
            weights.push((element, rate));
            if system.weights.inverses && element < system.weights.members {
                let inverse = system.weights.inverse(element);
                let of_one = batch.weights[inverse];
                let change = lanes.mul(rate, lanes.mul(of_one, of_one));
                weights.push((inverse, lanes.neg(change)));
            }
        }
        moved
    }
}

/// Derivatives of the sum of the outputs times gradients, by the coefficients and then by the
/// factors, `[patterns + elements]`: the adjoint.
pub(super) struct Adjoint<'a> {
    pub patterns: usize,
    pub elements: usize,
    pub gradients: Array<'a, f64>,
}

impl Reading for Adjoint<'_> {
    fn width(&self) -> usize {
        self.patterns + self.elements
    }

    #[inline(always)]
    fn read<L: Lanes>(
        &self,
        lanes: L,
        system: &System,
        rows: Rows,
        batch: &Batch<L>,
        solver: &mut impl Solve<L>,
        shown: &mut [L::Numbers],
    ) -> Result<()> {
        let Batch {
            weights,
            coefficients,
            unknowns,
            ..
        } = batch;
        let zero = lanes.splat(0.0);
        let mut gradients = vec![zero; self.gradients.shape[1]];
        lanes.gather(&mut gradients, self.gradients.values, rows.from, rows.count);
        let mut adjoint = vec![zero; unknowns.len()];
        system
            .shown
            .add_transposed(lanes, weights, &gradients, &mut adjoint);
        solver.solve(lanes, batch, &mut adjoint)?;
        let (by_coefficients, by_factors) = shown.split_at_mut(self.patterns);
        system
            .load
            .add_transposed(lanes, weights, &adjoint, by_coefficients);
        system
            .direct
            .add_transposed(lanes, weights, &gradients, by_coefficients);
        let mut by_weights = vec![zero; weights.len()];
        system
            .stiffness
            .add_to_weights(lanes, &adjoint, unknowns, &mut by_weights);
        for value in &mut by_weights {
            *value = lanes.neg(*value);
        }
        system
            .load
            .add_to_weights(lanes, &adjoint, coefficients, &mut by_weights);
        system
            .shown
            .add_to_weights(lanes, &gradients, unknowns, &mut by_weights);
        system
            .direct
            .add_to_weights(lanes, &gradients, coefficients, &mut by_weights);
        by_factors.copy_from_slice(&by_weights[..self.elements]);
        if !system.weights.inverses {
            return Ok(());
        }
        for (member, by_factor) in by_factors[..system.weights.members].iter_mut().enumerate() {
            let inverse = system.weights.inverse(member);
            let (rate, of_one) = (by_weights[inverse], weights[inverse]);
            // A factor of zero has no inverse; where nothing depends on it, that is no matter.
            let change = lanes.mul(rate, lanes.mul(of_one, of_one));
            let change = lanes.select(lanes.equal(rate, zero), zero, change);
            *by_factor = lanes.sub(*by_factor, change);
        }
        Ok(())
    }
}
