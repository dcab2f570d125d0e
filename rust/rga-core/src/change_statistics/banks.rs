//! Banks of statistics over the scores of a stream: one for every kind and scale of change.
//!
//! Let L be the likelihood ratio of a score under a change against none. The statistic of Shiryaev
//! and Roberts, R' = (1 + R) L, is the sum over all onsets of the likelihood ratio since then. A
//! mean of such statistics over sensors and signs, less the number of rows, is a martingale while
//! nothing changes, whatever goes together with what (Pollak, 1985).
//!
//! - A step in the mean of one sensor by d: L = exp(d z - d^2 / 2), up and down.
//! - The same of two sums: of all sensors that rise alike, and of the squares of all.
//! - A change of the standard deviation of one sensor to s: L = exp(z^2 (1 - s^-2) / 2) / s.
//! - A step in several sensors, which ones unknown: averages of recent scores that forget
//!   exponentially, each in standard deviations u, enter a mixture over subsets of sensors (Xie
//!   and Siegmund, 2013), the product of 1 - q + q f(u). For f, the likelihood ratio of a shift by
//!   3.2, e^(3.2 |u| - 5.12) / 2, a power stands that follows it where it decides.
//!
//! What is slow is looked at in beats of a few rows.

use super::powers::powers;
use super::reference::LARGEST_SCORE;
use super::sixteen::{Lanes, SIXTEEN, sixteens};

/// Rows of a beat, and beats of a bar.
const BEAT: u64 = 4;
const BAR: u64 = 2;

/// Steps d in the scores of rows, of beats and of bars.
const ROW_STEPS: [f32; 3] = [1.0, 2.0, 4.0];
const BEAT_STEP: f32 = 0.5;
const BAR_STEP: f32 = 0.25;
/// Steps in sums.
const SUM_STEPS: [f32; 5] = [0.25, 0.5, 1.0, 2.0, 4.0];
/// Sums that are watched: of all that rise alike, and of the squares of all.
const SUMS: usize = 2;
/// Factors on the standard deviation: sqrt(2), 2, 1/2.
const SPREADS: usize = 3;

/// What an average of rows, or of beats, forgets with each, and after how many it is looked at.
const ROW_AVERAGES: [(f32, u64); 3] = [(1.0 / 2.0, 1), (1.0 / 4.0, 1), (1.0 / 8.0, 2)];
const BEAT_AVERAGES: [(f32, u64); 5] = [
    (1.0 / 4.0, 1),
    (1.0 / 8.0, 1),
    (1.0 / 16.0, 2),
    (1.0 / 32.0, 4),
    (1.0 / 64.0, 8),
];

/// Number of sensors that q stands for.
const SEVERAL: f32 = 5.0;
/// f(u) = (1 + u^2 / WIDE)^16 / FLAT
const WIDE: f32 = 22.0;
const FLAT: f32 = 5.2;
/// Largest factor of one sensor in the product: one sensor is not several.
const LARGEST_FACTOR: f32 = 1e3;
/// Keeps products finite.
const LARGEST_PRODUCT: f32 = 1e30;
/// Keeps statistics finite after a change.
const LARGEST: f32 = 1e20;

/// In this order: a step in one sensor, small to large; in all alike; in the squares of all; a
/// spread; a step in several, slow to forget last.
pub const STATISTICS: usize = STEPS + SUMS * SUM_STEPS.len() + SPREADS + AVERAGES;
const STEPS: usize = 2 + ROW_STEPS.len();
const AVERAGES: usize = ROW_AVERAGES.len() + BEAT_AVERAGES.len();

/// Vectors of sixteen sensors: what every row changes, and what beats change.
const QUICK: usize = 3 + ROW_AVERAGES.len() + 2 * ROW_STEPS.len();
const SLOW: usize = 1 + 2 + 2 + SPREADS + BEAT_AVERAGES.len();

#[derive(Debug, Clone, PartialEq)]
pub struct Banks {
    sensors: usize,
    /// `[sixteens, QUICK, 16]`
    pub(super) quick: Vec<f32>,
    /// `[sixteens, SLOW, 16]`
    pub(super) slow: Vec<f32>,
    /// `[2 SUM_STEPS, 16]`; lanes beyond the sums mean nothing
    pub(super) sums: Vec<f32>,
    pub(super) rows: u64,
}

impl Banks {
    pub fn new(sensors: usize) -> Self {
        let width = sixteens(sensors) * SIXTEEN;
        Self {
            sensors,
            quick: vec![0.0; width * QUICK],
            slow: vec![0.0; width * SLOW],
            sums: vec![0.0; 2 * SUM_STEPS.len() * SIXTEEN],
            rows: 0,
        }
    }

    /// Takes the scores of a row, whole sixteens with NaN where they are missing, and gives the
    /// statistics; one that is not looked at in this row is 0.
    #[inline(always)]
    pub fn advance<L: Lanes>(
        &mut self,
        lanes: L,
        scores: &[f32],
        signature: &[f32],
        gaps: bool,
    ) -> [f32; STATISTICS] {
        self.rows += 1;
        let mut found = [0.0; STATISTICS];
        let (steps, rest) = found.split_at_mut(STEPS);
        let (sums, rest) = rest.split_at_mut(SUMS * SUM_STEPS.len());
        let (spreads, averages) = rest.split_at_mut(SPREADS);
        let (quick_averages, slow_averages) = averages.split_at_mut(ROW_AVERAGES.len());
        let (alike, squares) = if gaps {
            self.each_row::<L, true>(lanes, scores, signature, &mut steps[2..], quick_averages)
        } else {
            self.each_row::<L, false>(lanes, scores, signature, &mut steps[2..], quick_averages)
        };
        self.watch_sums(lanes, alike, squares, sums);
        if self.rows.is_multiple_of(BEAT) {
            self.each_beat(lanes, &mut steps[..2], spreads, slow_averages);
        }
        found
    }

    /// Gives the two sums.
    #[inline(always)]
    fn each_row<L: Lanes, const GAPS: bool>(
        &mut self,
        lanes: L,
        scores: &[f32],
        signature: &[f32],
        steps: &mut [f32],
        averages: &mut [f32],
    ) -> (f32, f32) {
        let several = Several::new(lanes, self.sensors);
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let mut step_sums = [zero; ROW_STEPS.len()];
        let mut products = [one; ROW_AVERAGES.len()];
        let (mut alike, mut squares, mut count) = (zero, zero, zero);
        let vectors = L::vectors(scores).iter().zip(L::vectors(signature));
        let states = L::vectors_mut(&mut self.quick).chunks_exact_mut(QUICK);
        let last = sixteens(self.sensors) - 1;
        for (number, ((given, weight), state)) in vectors.zip(states).enumerate() {
            // Lanes behind the last sensor are always missing.
            let whole = !GAPS && (number < last || self.sensors.is_multiple_of(SIXTEEN));
            let present = lanes.equal(*given, *given);
            let score = if whole {
                *given
            } else {
                lanes.select(present, *given, zero)
            };
            let ones = if whole {
                one
            } else {
                lanes.select(present, one, zero)
            };
            let square = lanes.mul(score, score);

            let [sum, square_sum, seen, rest @ ..] = state else {
                continue;
            };
            *sum = lanes.add(*sum, score);
            *square_sum = lanes.add(*square_sum, square);
            *seen = lanes.add(*seen, ones);
            let (averaging, stepping) = rest.split_at_mut(ROW_AVERAGES.len());

            for ((average, (forget, every)), product) in
                averaging.iter_mut().zip(ROW_AVERAGES).zip(&mut products)
            {
                let change = lanes.mul(lanes.sub(score, *average), lanes.splat(forget));
                let moved = lanes.add(*average, change);
                *average = if whole {
                    moved
                } else {
                    lanes.select(present, moved, *average)
                };
                if self.rows.is_multiple_of(every) {
                    *product = lanes.mul(*product, several.factor(*average, forget, 1.0));
                }
            }

            let (mut up, mut down) = powers(lanes, score, 4);
            for ((both, size), sum) in stepping
                .chunks_exact_mut(2)
                .zip(ROW_STEPS)
                .zip(&mut step_sums)
            {
                let [rising, falling] = both else { continue };
                for (state, power) in [(&mut *rising, up), (&mut *falling, down)] {
                    let next = grown(lanes, *state, power, size, 1.0);
                    *state = if whole {
                        next
                    } else {
                        lanes.select(present, next, *state)
                    };
                }
                *sum = lanes.add(*sum, lanes.add(*rising, *falling));
                (up, down) = (lanes.mul(up, up), lanes.mul(down, down));
            }

            alike = lanes.add(alike, lanes.mul(*weight, score));
            squares = lanes.add(squares, square);
            count = lanes.add(count, ones);
        }
        for (found, sum) in steps.iter_mut().zip(step_sums) {
            *found = lanes.sum(sum) / (2 * self.sensors) as f32;
        }
        for ((found, product), (_, every)) in averages.iter_mut().zip(products).zip(ROW_AVERAGES) {
            if self.rows.is_multiple_of(every) {
                *found = lanes.product(product).min(LARGEST_PRODUCT);
            }
        }
        let count = lanes.sum(count).max(1.0);
        let squares = (lanes.sum(squares) - count) / (2.0 * count).sqrt();
        (lanes.sum(alike), squares)
    }

    #[inline(always)]
    fn watch_sums<L: Lanes>(&mut self, lanes: L, alike: f32, squares: f32, found: &mut [f32]) {
        let mut scores = [0.0; SIXTEEN];
        for (score, sum) in scores.iter_mut().zip([alike, squares]) {
            *score = sum.clamp(-LARGEST_SCORE, LARGEST_SCORE);
        }
        let smallest = lanes.mul(L::vectors(&scores)[0], lanes.splat(SUM_STEPS[0]));
        let (mut up, mut down) = powers(lanes, smallest, 2);
        let states = L::vectors_mut(&mut self.sums).chunks_exact_mut(2);
        for (number, (both, size)) in states.zip(SUM_STEPS).enumerate() {
            let [rising, falling] = both else { continue };
            *rising = grown(lanes, *rising, up, size, 1.0);
            *falling = grown(lanes, *falling, down, size, 1.0);
            let (rising, falling) = (L::flat(rising), L::flat(falling));
            for sum in 0..SUMS {
                found[sum * SUM_STEPS.len() + number] = (rising[sum] + falling[sum]) / 2.0;
            }
            (up, down) = (lanes.mul(up, up), lanes.mul(down, down));
        }
    }

    #[inline(always)]
    fn each_beat<L: Lanes>(
        &mut self,
        lanes: L,
        steps: &mut [f32],
        spreads: &mut [f32],
        averages: &mut [f32],
    ) {
        let several = Several::new(lanes, self.sensors);
        let beat = self.rows / BEAT;
        let bar = beat.is_multiple_of(BAR);
        let zero = lanes.splat(0.0);
        let (mut bar_sum, mut beat_sum) = (zero, zero);
        let mut spread_sums = [zero; SPREADS];
        let mut products = [lanes.splat(1.0); BEAT_AVERAGES.len()];
        let quick = L::vectors_mut(&mut self.quick).chunks_exact_mut(QUICK);
        let slow = L::vectors_mut(&mut self.slow).chunks_exact_mut(SLOW);
        for (quick, slow) in quick.zip(slow) {
            let [row_sum, square_sum, seen, ..] = quick else {
                continue;
            };
            let (sum, squares) = (*row_sum, *square_sum);
            let missing = lanes.equal(*seen, zero);
            (*row_sum, *square_sum, *seen) = (zero, zero, zero);
            let (whole, rest) = slow.split_at_mut(1);
            let (in_beats, rest) = rest.split_at_mut(2);
            let (in_bars, rest) = rest.split_at_mut(2);
            let (spreading, averaging) = rest.split_at_mut(SPREADS);

            let sized = lanes.mul(sum, lanes.splat(BEAT_STEP));
            let (up, down) = powers(lanes, sized, 5);
            for (state, power) in in_beats.iter_mut().zip([up, down]) {
                let next = grown(lanes, *state, power, BEAT_STEP, BEAT as f32);
                *state = lanes.select(missing, *state, next);
                beat_sum = lanes.add(beat_sum, *state);
            }
            whole[0] = lanes.add(whole[0], sum);
            if bar {
                let sized = lanes.mul(whole[0], lanes.splat(BAR_STEP));
                let (up, down) = powers(lanes, sized, 5);
                let rows = (BEAT * BAR) as f32;
                for (state, power) in in_bars.iter_mut().zip([up, down]) {
                    let next = grown(lanes, *state, power, BAR_STEP, rows);
                    *state = lanes.select(missing, *state, next);
                    bar_sum = lanes.add(bar_sum, *state);
                }
                whole[0] = zero;
            }
            let ratios = spread_ratios(lanes, squares);
            for ((state, ratio), sum) in spreading.iter_mut().zip(ratios).zip(&mut spread_sums) {
                let next = replaced(lanes, *state, ratio, BEAT as f32);
                *state = lanes.select(missing, *state, next);
                *sum = lanes.add(*sum, *state);
            }
            let mean = lanes.mul(sum, lanes.splat(1.0 / BEAT as f32));
            for ((average, (forget, every)), product) in
                averaging.iter_mut().zip(BEAT_AVERAGES).zip(&mut products)
            {
                let change = lanes.mul(lanes.sub(mean, *average), lanes.splat(forget));
                let moved = lanes.add(*average, change);
                *average = lanes.select(missing, *average, moved);
                if beat.is_multiple_of(every) {
                    let factor = several.factor(*average, forget, BEAT as f32);
                    *product = lanes.mul(*product, factor);
                }
            }
        }
        let sensors = self.sensors as f32;
        if bar {
            steps[0] = lanes.sum(bar_sum) / (2.0 * sensors);
        }
        steps[1] = lanes.sum(beat_sum) / (2.0 * sensors);
        for (found, sum) in spreads.iter_mut().zip(spread_sums) {
            *found = lanes.sum(sum) / sensors;
        }
        for ((found, product), (_, every)) in averages.iter_mut().zip(products).zip(BEAT_AVERAGES) {
            if beat.is_multiple_of(every) {
                *found = lanes.product(product).min(LARGEST_PRODUCT);
            }
        }
    }
}

/// (rows + R) L of a step: L = power exp(-d^2 rows / 2).
#[inline(always)]
fn grown<L: Lanes>(
    lanes: L,
    state: L::Numbers,
    power: L::Numbers,
    size: f32,
    rows: f32,
) -> L::Numbers {
    let ratio = lanes.mul(power, lanes.splat((-size * size * rows / 2.0).exp()));
    replaced(lanes, state, ratio, rows)
}

/// (rows + R) L
#[inline(always)]
fn replaced<L: Lanes>(lanes: L, state: L::Numbers, ratio: L::Numbers, rows: f32) -> L::Numbers {
    let next = lanes.mul(lanes.add(state, lanes.splat(rows)), ratio);
    lanes.min(next, lanes.splat(LARGEST))
}

/// Likelihood ratios of a standard deviation sqrt(2), 2 and 1/2 times what it was, from the sum T
/// of the squares of a beat: their exponents are T / 4, 3 T / 8 and - 3 T / 2.
#[inline(always)]
fn spread_ratios<L: Lanes>(lanes: L, squares: L::Numbers) -> [L::Numbers; SPREADS] {
    let small = lanes.mul(squares, lanes.splat(1.0 / 512.0));
    let (grow, shrink) = powers(lanes, small, 0);
    let (grow_64, shrink_256) = (squared(lanes, grow, 6), squared(lanes, shrink, 8));
    let grow_128 = squared(lanes, grow_64, 1);
    let mut ratios = [
        grow_128,
        lanes.mul(grow_128, grow_64),
        lanes.mul(squared(lanes, shrink_256, 1), shrink_256),
    ];
    for (ratio, factor) in ratios.iter_mut().zip([0.5f32.sqrt(), 0.5, 2.0]) {
        *ratio = lanes.mul(*ratio, lanes.splat(factor.powi(BEAT as i32)));
    }
    ratios
}

/// Squared so many times.
#[inline(always)]
fn squared<L: Lanes>(lanes: L, mut number: L::Numbers, times: usize) -> L::Numbers {
    for _ in 0..times {
        number = lanes.mul(number, number);
    }
    number
}

/// The mixture over which sensors have changed.
struct Several<L: Lanes> {
    lanes: L,
    unchanged: L::Numbers,
    changed: L::Numbers,
}

impl<L: Lanes> Several<L> {
    #[inline(always)]
    fn new(lanes: L, sensors: usize) -> Self {
        let share = (SEVERAL / sensors as f32).min(0.5);
        Self {
            lanes,
            unchanged: lanes.splat(1.0 - share),
            changed: lanes.splat(share / FLAT),
        }
    }

    /// Of an average over what has `rows` each.
    #[inline(always)]
    fn factor(&self, average: L::Numbers, forget: f32, rows: f32) -> L::Numbers {
        let lanes = self.lanes;
        // The variance of the average is forget / (2 - forget) / rows.
        let scale = (2.0 - forget) / forget * rows / WIDE;
        let scaled = lanes.mul(lanes.mul(average, average), lanes.splat(scale));
        let mut power = lanes.add(scaled, lanes.splat(1.0));
        power = lanes.min(power, lanes.splat(3.0));
        for _ in 0..4 {
            power = lanes.mul(power, power);
        }
        let factor = lanes.add(lanes.mul(power, self.changed), self.unchanged);
        lanes.min(factor, lanes.splat(LARGEST_FACTOR))
    }
}
