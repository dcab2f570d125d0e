//! What readings are expected to be, from the ones before them.

use super::Reference;
use super::memory::Memory;

impl Reference {
    /// What the next readings are expected to be, `[p]`; of an order above 0.
    #[inline(always)]
    pub(super) fn expect(&self, expected: &mut [f64]) {
        let deviations = self.weights.iter().zip(&self.past);
        let by_sensor = expected.iter_mut().zip(&self.level).zip(deviations);
        for ((expected, level), (weight, past)) in by_sensor {
            *expected = level + weight * past;
        }
        self.expect_from_earlier(expected);
    }

    /// Adds what all but the latest deviations let expect.
    #[inline(always)]
    fn expect_from_earlier(&self, expected: &mut [f64]) {
        let sensors = self.sensors();
        for first in (sensors..self.past.len()).step_by(sensors) {
            let (weights, past) = (&self.weights[first..], &self.past[first..]);
            for ((expected, weight), past) in expected.iter_mut().zip(weights).zip(past) {
                *expected += weight * past;
            }
        }
    }

    /// Whether the deviations that predict the next readings are known.
    pub(super) fn settled(&self) -> bool {
        self.doubt.iter().all(|variance| *variance == 0.0)
    }

    /// Takes a row of which nothing is missing, and tells what the next one is expected to be.
    #[inline(always)]
    pub(super) fn remember(&mut self, readings: &[f64], expected: &mut [f64]) {
        let sensors = readings.len();
        let earlier = self.past.len() - sensors;
        if earlier > 0 {
            self.past.copy_within(..earlier, sensors);
        }
        let (level, weights) = (&self.level[..sensors], &self.weights[..sensors]);
        let (past, expected) = (&mut self.past[..sensors], &mut expected[..sensors]);
        for sensor in 0..sensors {
            let deviation = readings[sensor] - level[sensor];
            past[sensor] = deviation;
            expected[sensor] = level[sensor] + weights[sensor] * deviation;
        }
        self.expect_from_earlier(expected);
    }

    /// A missing reading is taken for the expected one. What is expected of the next is the less
    /// sure the more is missing before it: scores are drawn in by `shrink`, and stay as rare.
    #[inline(never)]
    pub(super) fn remember_with_gaps(
        &mut self,
        readings: &[f64],
        mut shrink: impl FnMut(usize, f64),
    ) {
        let (sensors, order) = (self.sensors(), self.order());
        for (sensor, reading) in readings.iter().enumerate() {
            let own = self.derived.reach[sensor];
            let lags = (0..own).map(|lag| lag * sensors + sensor);
            let weights: Vec<f64> = lags.clone().map(|at| self.weights[at]).collect();
            let mut past: Vec<f64> = lags.clone().map(|at| self.past[at]).collect();
            let mut memory = Memory {
                weights: &weights,
                past: &mut past,
                doubt: &mut self.doubt[sensor * order * order..][..own * own],
            };
            let (_, variance) = memory.take(reading - self.level[sensor]);
            shrink(sensor, 1.0 / variance.sqrt());
            for (at, deviation) in lags.zip(past) {
                self.past[at] = deviation;
            }
        }
    }
}

/// A number times 0 is 0, and what is none stays none: eight sums of that, side by side.
#[inline(always)]
pub(super) fn any_missing(values: &[f64]) -> bool {
    let (eights, rest) = values.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for eight in eights {
        for (sum, value) in sums.iter_mut().zip(eight) {
            *sum += value * 0.0;
        }
    }
    sums.iter().chain(rest).any(|value| value.is_nan())
}
