//! Inverse iteration: towards the motion that a factorised matrix resists least.

use crate::error::Result;
use crate::sparse::factor::Factor;

/// Least part of the start that any motion has, over what it has on average: the start is
/// irregular, so that no motion is square to it.
const SHARE: f64 = 1e-6;

pub(crate) struct InverseIteration<'a> {
    factor: &'a Factor,
    /// Of norm 1.
    pub motion: Vec<f64>,
    steps: f64,
    /// Logarithm of how much longer all steps have made the start.
    growth: f64,
}

impl<'a> InverseIteration<'a> {
    pub(crate) fn new(factor: &'a Factor, size: usize) -> Self {
        let golden = 0.618_033_988_749_895;
        let start = |at: usize| 0.5 + (golden * (at + 1) as f64).fract();
        let mut motion: Vec<f64> = (0..size).map(start).collect();
        normalise(&mut motion);
        Self {
            factor,
            motion,
            steps: 0.0,
            growth: 0.0,
        }
    }

    /// How much the motion has changed.
    pub(crate) fn step(&mut self) -> Result<f64> {
        let before = self.motion.clone();
        self.factor.solve(&mut self.motion, 1)?;
        self.growth += normalise(&mut self.motion).ln();
        self.steps += 1.0;
        let pairs = self.motion.iter().zip(&before);
        Ok(pairs.fold(0.0, |most, (now, before)| (now - before).abs().max(most)))
    }

    /// No motion of norm 1 has less energy: its part of the start would have grown more.
    pub(crate) fn least_energy(&self) -> f64 {
        let share = SHARE / (self.motion.len() as f64).sqrt();
        ((share.ln() - self.growth) / self.steps).exp()
    }
}

/// The norm that it had.
fn normalise(motion: &mut [f64]) -> f64 {
    let norm = motion.iter().map(|value| value * value).sum::<f64>().sqrt();
    motion.iter_mut().for_each(|value| *value /= norm);
    norm
}
