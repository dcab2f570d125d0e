//! Samples that are solved together, one a lane.

use pulp::Simd;
use pulp::bytemuck::cast_slice;

use super::cholesky::Cholesky;
use super::panels::Panels;
use crate::equilibrium::{LOOSE_MOMENT, REFINE};
use crate::error::Result;
use crate::lanes::gather;
use crate::stability::{DELICATE_PIVOT, SOFTEST};
use crate::system::System;

/// What is given of samples, and what was found.
pub struct Batch<S: Simd> {
    pub weights: Vec<S::f64s>,
    /// q
    pub coefficients: Vec<S::f64s>,
    /// z
    pub unknowns: Vec<S::f64s>,
    pub load: Vec<S::f64s>,
}

/// Solves K x = right for the samples at hand.
pub trait Solve<S: Simd> {
    /// In place; right-hand sides one behind the other.
    fn solve(&mut self, simd: S, batch: &Batch<S>, right: &mut [S::f64s]) -> Result<()>;
}

impl<S: Simd> Batch<S> {
    pub fn new(simd: S, system: &System, patterns: usize) -> Self {
        let zero = simd.splat_f64s(0.0);
        Self {
            weights: vec![zero; system.weights.count()],
            coefficients: vec![zero; patterns],
            unknowns: vec![zero; system.order.len()],
            load: vec![zero; system.order.len()],
        }
    }

    /// Rows of factors and coefficients, `count` from `from` on, and the loads that they make.
    #[inline(always)]
    pub fn take(
        &mut self,
        simd: S,
        system: &System,
        (factors, coefficients): (&[f64], &[f64]),
        from: usize,
        count: usize,
    ) {
        let elements = system.weights.elements;
        gather::<S>(&mut self.weights[..elements], factors, from, count);
        gather::<S>(&mut self.coefficients, coefficients, from, count);
        system.weights.complete(simd, &mut self.weights);
        self.load.fill(simd.splat_f64s(0.0));
        system
            .load
            .add(simd, &self.weights, &self.coefficients, &mut self.load);
    }
}

/// Factorises and solves all lanes at once. A sample that asks for care, since it may be unstable
/// or lose digits, is only marked.
pub struct Together<'a, S: Simd> {
    system: &'a System,
    cholesky: Cholesky<'a, S>,
    /// One over the diagonal of K.
    softness: Vec<S::f64s>,
    /// Lanes that need no care.
    sound: S::m64s,
    residual: Vec<S::f64s>,
    beside: Vec<S::f64s>,
    on_held: Vec<S::f64s>,
}

/// Right-hand sides that share what is read of the factor.
const BESIDE: usize = 4;

impl<'a, S: Simd> Together<'a, S> {
    pub fn new(simd: S, system: &'a System, panels: &'a Panels) -> Self {
        let zero = simd.splat_f64s(0.0);
        let size = system.order.len();
        Self {
            cholesky: Cholesky::new(simd, panels),
            softness: vec![zero; size],
            sound: simd.less_than_or_equal_f64s(zero, zero),
            residual: vec![zero; size],
            beside: vec![zero; BESIDE * size],
            on_held: vec![zero; system.held],
            system,
        }
    }

    /// Finds the unknowns under the load.
    #[inline(always)]
    pub fn factorise(&mut self, simd: S, batch: &mut Batch<S>) {
        batch.unknowns.copy_from_slice(&batch.load);
        self.cholesky
            .factorise(simd, &batch.weights, DELICATE_PIVOT, &mut batch.unknowns);
        self.sound = self.cholesky.sound;
        self.check_given(simd, batch);
        let zero = simd.splat_f64s(0.0);
        let (mut least, mut most) = (simd.splat_f64s(f64::INFINITY), zero);
        for (soft, stiffness) in self.softness.iter_mut().zip(&self.cholesky.diagonal) {
            *soft = simd.div_f64s(simd.splat_f64s(1.0), *stiffness);
            least = simd.min_f64s(least, *stiffness);
            most = simd.max_f64s(most, *stiffness);
        }
        let softest = simd.mul_f64s(simd.splat_f64s(SOFTEST), most);
        self.require(simd, softest, least);
        self.check(simd, &batch.weights, &batch.unknowns, &batch.load);
        self.check_turns(simd, batch);
    }

    /// Numbers that may not stand are refused by name where care is taken.
    #[inline(always)]
    fn check_given(&mut self, simd: S, batch: &Batch<S>) {
        let zero = simd.splat_f64s(0.0);
        let mut good = self.sound;
        for factor in &batch.weights[..self.system.weights.elements] {
            good = simd.and_m64s(good, simd.less_than_or_equal_f64s(zero, *factor));
        }
        let largest = simd.splat_f64s(f64::MAX);
        for coefficient in &batch.coefficients {
            let finite = simd.less_than_or_equal_f64s(simd.abs_f64s(*coefficient), largest);
            good = simd.and_m64s(good, finite);
        }
        self.sound = good;
    }

    /// A moment on a rotation that nothing stiffens asks for care.
    #[inline(always)]
    fn check_turns(&mut self, simd: S, batch: &Batch<S>) {
        if self.on_held.is_empty() && self.system.turns.is_empty() {
            return;
        }
        let zero = simd.splat_f64s(0.0);
        let mut largest = zero;
        for force in &batch.load {
            largest = simd.max_f64s(largest, simd.abs_f64s(*force));
        }
        let most = simd.mul_f64s(simd.splat_f64s(LOOSE_MOMENT), largest);
        self.on_held.fill(zero);
        (self.system.on_held).add(simd, &batch.weights, &batch.coefficients, &mut self.on_held);
        for at in 0..self.on_held.len() {
            let moment = simd.abs_f64s(self.on_held[at]);
            self.require(simd, moment, most);
        }
        for turn in &self.system.turns {
            let mut moment = zero;
            for &(unknown, part) in &turn.terms {
                let force = batch.load[self.system.place[unknown]];
                moment = simd.mul_add_f64s(simd.splat_f64s(part), force, moment);
            }
            self.require(simd, simd.abs_f64s(moment), most);
        }
    }

    /// The residual of a solution, element by element, beside its load.
    #[inline(always)]
    fn check(&mut self, simd: S, weights: &[S::f64s], unknowns: &[S::f64s], load: &[S::f64s]) {
        self.residual.fill(simd.splat_f64s(0.0));
        self.system
            .stiffness
            .add(simd, weights, unknowns, &mut self.residual);
        let mut left = simd.splat_f64s(0.0);
        let mut applied = simd.splat_f64s(0.0);
        for ((taken, load), soft) in self.residual.iter().zip(load).zip(&self.softness) {
            let rest = simd.sub_f64s(*load, *taken);
            left = simd.mul_add_f64s(simd.mul_f64s(rest, rest), *soft, left);
            applied = simd.mul_add_f64s(simd.mul_f64s(*load, *load), *soft, applied);
        }
        let most = simd.mul_f64s(simd.splat_f64s(REFINE * REFINE), applied);
        self.require(simd, left, most);
    }

    /// Where `value` is not at most `most`, or is no number, a lane is not sound.
    #[inline(always)]
    fn require(&mut self, simd: S, value: S::f64s, most: S::f64s) {
        self.sound = simd.and_m64s(self.sound, simd.less_than_or_equal_f64s(value, most));
    }

    /// Whether a sample of a lane stands as it is.
    #[inline(always)]
    pub fn sound(&self, simd: S, lane: usize) -> bool {
        let told = [simd.select_f64s(self.sound, simd.splat_f64s(1.0), simd.splat_f64s(0.0))];
        let told: &[f64] = cast_slice(&told);
        told[lane] == 1.0
    }
}

impl<S: Simd> Solve<S> for Together<'_, S> {
    #[inline(always)]
    fn solve(&mut self, simd: S, batch: &Batch<S>, right: &mut [S::f64s]) -> Result<()> {
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
                self.cholesky.solve::<BESIDE>(simd, &mut self.beside);
                for (at, column) in columns.chunks_exact_mut(size).enumerate() {
                    for (value, place) in column.iter_mut().zip(self.beside[at..].iter().step_by(BESIDE)) {
                        *value = *place;
                    }
                }
            } else {
                for column in columns.chunks_exact_mut(size) {
                    self.cholesky.solve::<1>(simd, column);
                }
            }
            for (column, given) in columns.chunks_exact(size).zip(given.chunks_exact(size)) {
                self.check(simd, &batch.weights, column, given);
            }
        }
        Ok(())
    }
}
