//! How a reading goes with the ones before, some of which may be missing.

/// Doublings of the time over which a stream has been remembered before it began.
const DOUBLINGS: usize = 20;

/// Variances beyond this, over that of an innovation, are those of a stream that is not stationary.
const MOST_VARIANCE: f64 = 1e12;

/// What is remembered of a sensor, of order q: deviations from its level, and what is not known of
/// them where readings were missing.
pub(super) struct Memory<'a> {
    /// `[q]` of earlier deviations, the latest first
    pub weights: &'a [f64],
    /// `[q]` these deviations, as far as they can be told
    pub past: &'a mut [f64],
    /// `[q, q]` their covariance, over the variance of an innovation; 0 where they are known
    pub doubt: &'a mut [f64],
}

impl Memory<'_> {
    /// Takes the next deviation, NaN where it is missing. Gives what was expected of it, by what is
    /// there of the ones before, and the variance about that over the variance of an innovation
    /// (Jones, Technometrics 22, 1980).
    pub(super) fn take(&mut self, deviation: f64) -> (f64, f64) {
        let order = self.weights.len();
        let along = |values: &[f64]| -> f64 {
            let products = self.weights.iter().zip(values);
            products.map(|(weight, value)| weight * value).sum()
        };
        let expected = along(self.past);
        let rows = self.doubt.chunks_exact(order.max(1));
        let common: Vec<f64> = rows.map(along).collect();
        let variance = (1.0 + along(&common)).max(1.0);
        let known = !deviation.is_nan();
        if known {
            for (at, own) in common.iter().enumerate() {
                self.past[at] += own / variance * (deviation - expected);
                for (other, its) in common.iter().enumerate() {
                    self.doubt[at * order + other] -= own * its / variance;
                }
            }
        }
        for lag in (1..order).rev() {
            self.past[lag] = self.past[lag - 1];
            for other in (1..order).rev() {
                self.doubt[lag * order + other] = self.doubt[(lag - 1) * order + other - 1];
            }
        }
        if order > 0 {
            self.past[0] = if known { deviation } else { expected };
            self.doubt[0] = if known { 0.0 } else { variance };
            for lag in 1..order {
                let beside = if known { 0.0 } else { common[lag - 1] };
                self.doubt[lag] = beside;
                self.doubt[lag * order] = beside;
            }
        }
        (expected, variance)
    }
}

/// Covariance `[q, q]` of q deviations of which nothing is there, over the variance of an
/// innovation: the sum of A^k e e' A'^k, by doubling.
pub(super) fn unknown(weights: &[f64]) -> Vec<f64> {
    let order = weights.len();
    let at = |row: usize, column: usize| row * order + column;
    let mut step = vec![0.0; order * order];
    let mut sum = vec![0.0; order * order];
    for (lag, weight) in weights.iter().enumerate() {
        step[lag] = *weight;
        if lag + 1 < order {
            step[at(lag + 1, lag)] = 1.0;
        }
    }
    if order > 0 {
        sum[0] = 1.0;
    }
    let product = |one: &[f64], other: &[f64], turned: bool| {
        let mut found = vec![0.0; order * order];
        for row in 0..order {
            for column in 0..order {
                for between in 0..order {
                    let right = if turned {
                        other[at(column, between)]
                    } else {
                        other[at(between, column)]
                    };
                    found[at(row, column)] += one[at(row, between)] * right;
                }
            }
        }
        found
    };
    for _ in 0..DOUBLINGS {
        let earlier = product(&product(&step, &sum, false), &step, true);
        if !earlier.iter().all(|value| value.abs() < MOST_VARIANCE) {
            break;
        }
        for (sum, earlier) in sum.iter_mut().zip(earlier) {
            *sum += earlier;
        }
        step = product(&step, &step, false);
    }
    sum
}

/// Lags up to the last that has a weight; `weights`: `[order, p]`.
pub(super) fn reach(weights: &[f64], sensors: usize, sensor: usize) -> usize {
    let orders = (0..weights.len() / sensors.max(1)).rev();
    let mut used = orders.filter(|lag| weights[lag * sensors + sensor] != 0.0);
    used.next().map_or(0, |lag| lag + 1)
}

/// What readings differ by from what those before let expect, to one variance whatever is missing.
///
/// Args: `deviations` `[n, p]` from the level, NaN where missing; `weights` `[order, p]`.
pub fn innovations(deviations: &[f64], weights: &[f64], sensors: usize) -> Vec<f64> {
    let mut found = vec![f64::NAN; deviations.len()];
    for sensor in 0..sensors {
        let order = reach(weights, sensors, sensor);
        let own: Vec<f64> = (0..order)
            .map(|lag| weights[lag * sensors + sensor])
            .collect();
        let (mut past, mut doubt) = (vec![0.0; order], unknown(&own));
        let mut memory = Memory {
            weights: &own,
            past: &mut past,
            doubt: &mut doubt,
        };
        for at in (sensor..deviations.len()).step_by(sensors) {
            let (expected, variance) = memory.take(deviations[at]);
            found[at] = (deviations[at] - expected) / variance.sqrt();
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{innovations, unknown};

    #[test]
    fn a_stream_of_which_nothing_is_known_has_its_stationary_variance() {
        let found = unknown(&[0.6]);
        assert!((found[0] - 1.0 / (1.0 - 0.36)).abs() < 1e-12);
        // AR(2): variance (1 - b) / ((1 + b) ((1 - b)^2 - a^2)), lag-one correlation a / (1 - b).
        let (a, b) = (0.5, 0.3);
        let variance = (1.0 - b) / ((1.0 + b) * ((1.0 - b) * (1.0 - b) - a * a));
        let found = unknown(&[a, b]);
        assert!((found[0] - variance).abs() < 1e-9 && (found[3] - variance).abs() < 1e-9);
        assert!((found[1] - variance * a / (1.0 - b)).abs() < 1e-9);
    }

    #[test]
    fn a_gap_is_bridged_by_what_is_known_of_both_its_sides() {
        let (a, gap) = (0.6, f64::NAN);
        let found = innovations(&[2.0, 1.0, gap, 3.0, 0.5], &[a], 1);
        let spread = (1.0 + a * a).sqrt();
        let right = [
            2.0 * (1.0 - a * a).sqrt(),
            1.0 - a * 2.0,
            gap,
            (3.0 - a * a) / spread,
            0.5 - a * 3.0,
        ];
        for (found, right) in found.iter().zip(right) {
            assert!((found - right).abs() < 1e-12 || found.is_nan() && right.is_nan());
        }
    }
}
