//! Likelihood ratios, and what they make of the statistics.

use super::{BEAT, SPREADS};
use crate::change_statistics::powers::powers;
use crate::change_statistics::sixteen::Lanes;

/// Number of sensors that q stands for.
const SEVERAL: f32 = 5.0;
/// f(u) = (1 + u^2 / WIDE)^16 / FLAT
const WIDE: f32 = 22.0;
const FLAT: f32 = 5.2;
/// Largest factor of one sensor in the product: one sensor is not several.
const LARGEST_FACTOR: f32 = 1e3;
/// Keeps statistics finite after a change.
pub const LARGEST: f32 = 1e20;

/// (rows + R) L of a step: L = power exp(-d^2 rows / 2).
#[inline(always)]
pub fn grown<L: Lanes>(
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
pub fn replaced<L: Lanes>(lanes: L, state: L::Numbers, ratio: L::Numbers, rows: f32) -> L::Numbers {
    lanes.mul(lanes.add(state, lanes.splat(rows)), ratio)
}

/// Likelihood ratios of a standard deviation s of sqrt(2), 2 and 1/2 times what it was, from the
/// sum T of the squares of so many scores of a beat: s^-count times powers of e whose exponents are
/// T / 4, 3 T / 8 and - 3 T / 2.
#[inline(always)]
pub fn spread_ratios<L: Lanes>(
    lanes: L,
    squares: L::Numbers,
    count: L::Numbers,
) -> [L::Numbers; SPREADS] {
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
        let mut power = lanes.splat(factor.powi(BEAT as i32));
        for fewer in 1..BEAT as i32 {
            let same = lanes.equal(count, lanes.splat(fewer as f32));
            power = lanes.select(same, lanes.splat(factor.powi(fewer)), power);
        }
        *ratio = lanes.mul(*ratio, power);
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
pub struct Several<L: Lanes> {
    lanes: L,
    unchanged: L::Numbers,
    changed: L::Numbers,
}

impl<L: Lanes> Several<L> {
    #[inline(always)]
    pub fn new(lanes: L, sensors: usize) -> Self {
        let share = (SEVERAL / sensors as f32).min(0.5);
        Self {
            lanes,
            unchanged: lanes.splat(1.0 - share),
            changed: lanes.splat(share / FLAT),
        }
    }

    /// Of an average over what has `rows` each.
    #[inline(always)]
    pub fn factor(&self, average: L::Numbers, forget: f32, rows: f32) -> L::Numbers {
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
