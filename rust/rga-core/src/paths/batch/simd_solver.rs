//! Samples that are solved together, one a lane.

use rga_simd::f64::Lanes;

use super::cholesky::Cholesky;
use super::panels::Panels;
use super::system::System;
use crate::error::Result;
use crate::fe::equilibrium::{LOOSE_MOMENT, REFINE};
use crate::fe::stability::{DELICATE_PIVOT, SOFTEST};

/// What is given of samples, and what was found.
pub(super) struct Batch<L: Lanes> {
    pub weights: Vec<L::Numbers>,
    /// q
    pub coefficients: Vec<L::Numbers>,
    /// z
    pub unknowns: Vec<L::Numbers>,
    pub load: Vec<L::Numbers>,
}

/// Solves K x = right for the samples at hand.
pub(super) trait Solve<L: Lanes> {
    /// In place; right-hand sides one behind the other.
    fn solve(&mut self, lanes: L, batch: &Batch<L>, right: &mut [L::Numbers]) -> Result<()>;
}

impl<L: Lanes> Batch<L> {
    pub(super) fn new(lanes: L, system: &System, patterns: usize) -> Self {
        let zero = lanes.splat(0.0);
        Self {
            weights: vec![zero; system.weights.count()],
            coefficients: vec![zero; patterns],
            unknowns: vec![zero; system.order.len()],
            load: vec![zero; system.order.len()],
        }
    }

    /// Rows of factors and coefficients, `count` from `from` on, and the loads that they make.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        lanes: L,
        system: &System,
        (factors, coefficients): (&[f64], &[f64]),
        from: usize,
        count: usize,
    ) {
        let elements = system.weights.elements;
        lanes.gather(&mut self.weights[..elements], factors, from, count);
        lanes.gather(&mut self.coefficients, coefficients, from, count);
        system.weights.complete(lanes, &mut self.weights);
        self.load.fill(lanes.splat(0.0));
        system
            .load
            .add(lanes, &self.weights, &self.coefficients, &mut self.load);
    }
}

/// Factorises and solves all lanes at once. A sample that asks for care, since it may be unstable
/// or lose digits, is only marked.
pub(super) struct SimdSolver<'a, L: Lanes> {
    system: &'a System,
    cholesky: Cholesky<'a, L>,
    /// One over the diagonal of K.
    softness: Vec<L::Numbers>,
    /// Lanes that need no care.
    sound: L::Mask,
    residual: Vec<L::Numbers>,
    beside: Vec<L::Numbers>,
    on_held: Vec<L::Numbers>,
}

/// Right-hand sides that share what is read of the factor.
const BESIDE: usize = 4;

impl<'a, L: Lanes> SimdSolver<'a, L> {
    pub(super) fn new(lanes: L, system: &'a System, panels: &'a Panels) -> Self {
        let zero = lanes.splat(0.0);
        let size = system.order.len();
        Self {
            cholesky: Cholesky::new(lanes, panels),
            softness: vec![zero; size],
            sound: lanes.at_most(zero, zero),
            residual: vec![zero; size],
            beside: vec![zero; BESIDE * size],
            on_held: vec![zero; system.held],
            system,
        }
    }

    /// Finds the unknowns under the load.
    #[inline(always)]
    pub(super) fn factorise(&mut self, lanes: L, batch: &mut Batch<L>) {
        batch.unknowns.copy_from_slice(&batch.load);
        self.cholesky
            .factorise(lanes, &batch.weights, DELICATE_PIVOT, &mut batch.unknowns);
        self.sound = self.cholesky.sound;
        self.check_given(lanes, batch);
        let zero = lanes.splat(0.0);
        let (mut least, mut most) = (lanes.splat(f64::INFINITY), zero);
        for (soft, stiffness) in self.softness.iter_mut().zip(&self.cholesky.diagonal) {
            *soft = lanes.div(lanes.splat(1.0), *stiffness);
            least = lanes.min(least, *stiffness);
            most = lanes.max(most, *stiffness);
        }
        let softest = lanes.mul(lanes.splat(SOFTEST), most);
        self.require(lanes, softest, least);
        self.check(lanes, &batch.weights, &batch.unknowns, &batch.load);
        self.check_free_rotations(lanes, batch);
    }

    /// Numbers that may not stand are refused by name where care is taken.
    #[inline(always)]
    fn check_given(&mut self, lanes: L, batch: &Batch<L>) {
        let zero = lanes.splat(0.0);
        let mut good = self.sound;
        for factor in &batch.weights[..self.system.weights.elements] {
            good = lanes.and(good, lanes.at_most(zero, *factor));
        }
        let largest = lanes.splat(f64::MAX);
        for coefficient in &batch.coefficients {
            let finite = lanes.at_most(lanes.abs(*coefficient), largest);
            good = lanes.and(good, finite);
        }
        self.sound = good;
    }

    /// A moment on a rotation that nothing stiffens asks for care.
    #[inline(always)]
    fn check_free_rotations(&mut self, lanes: L, batch: &Batch<L>) {
        if self.on_held.is_empty() && self.system.free_rotations.is_empty() {
            return;
        }
        let zero = lanes.splat(0.0);
        let mut largest = zero;
        for force in &batch.load {
            largest = lanes.max(largest, lanes.abs(*force));
        }
        let most = lanes.mul(lanes.splat(LOOSE_MOMENT), largest);
        self.on_held.fill(zero);
        (self.system.on_held).add(
            lanes,
            &batch.weights,
            &batch.coefficients,
            &mut self.on_held,
        );
        for at in 0..self.on_held.len() {
            let moment = lanes.abs(self.on_held[at]);
            self.require(lanes, moment, most);
        }
        for rotation in &self.system.free_rotations {
            let mut moment = zero;
            for &(unknown, part) in &rotation.terms {
                let force = batch.load[self.system.place[unknown]];
                moment = lanes.mul_add(lanes.splat(part), force, moment);
            }
            self.require(lanes, lanes.abs(moment), most);
        }
    }

    /// The residual of a solution, element by element, beside its load.
    #[inline(always)]
    fn check(
        &mut self,
        lanes: L,
        weights: &[L::Numbers],
        unknowns: &[L::Numbers],
        load: &[L::Numbers],
    ) {
        self.residual.fill(lanes.splat(0.0));
        self.system
            .stiffness
            .add(lanes, weights, unknowns, &mut self.residual);
        let mut left = lanes.splat(0.0);
        let mut applied = lanes.splat(0.0);
        for ((taken, load), soft) in self.residual.iter().zip(load).zip(&self.softness) {
            let rest = lanes.sub(*load, *taken);
            left = lanes.mul_add(lanes.mul(rest, rest), *soft, left);
            applied = lanes.mul_add(lanes.mul(*load, *load), *soft, applied);
        }
        let most = lanes.mul(lanes.splat(REFINE * REFINE), applied);
        self.require(lanes, left, most);
    }

    /// Where `value` is not at most `most`, or is no number, a lane is not sound.
    #[inline(always)]
    fn require(&mut self, lanes: L, value: L::Numbers, most: L::Numbers) {
        self.sound = lanes.and(self.sound, lanes.at_most(value, most));
    }

    /// Whether a sample of a lane stands as it is.
    #[inline(always)]
    pub(super) fn sound(&self, lanes: L, lane: usize) -> bool {
        let told = [lanes.select(self.sound, lanes.splat(1.0), lanes.splat(0.0))];
        L::flat(&told)[lane] == 1.0
    }
}

impl<L: Lanes> Solve<L> for SimdSolver<'_, L> {
    #[inline(always)]
    fn solve(&mut self, lanes: L, batch: &Batch<L>, right: &mut [L::Numbers]) -> Result<()> {
        let size = batch.unknowns.len();
        if size == 0 {
            return Ok(());
        }
        for columns in right.chunks_mut(BESIDE * size) {
            let given = columns.to_vec();
            if columns.len() == BESIDE * size {
                for (at, column) in columns.chunks_exact(size).enumerate() {
                    for (place, value) in self.beside[at..].iter_mut().step_by(BESIDE).zip(column) {
                        *place = *value;
                    }
                }
                self.cholesky.solve::<BESIDE>(lanes, &mut self.beside);
                for (at, column) in columns.chunks_exact_mut(size).enumerate() {
                    for (value, place) in column
                        .iter_mut()
                        .zip(self.beside[at..].iter().step_by(BESIDE))
                    {
                        *value = *place;
                    }
                }
            } else {
                for column in columns.chunks_exact_mut(size) {
                    self.cholesky.solve::<1>(lanes, column);
                }
            }
            for (column, given) in columns.chunks_exact(size).zip(given.chunks_exact(size)) {
                self.check(lanes, &batch.weights, column, given);
            }
        }
        Ok(())
    }
}
