//! Likelihood ratios, and what they make of the statistics.

use rga_simd::f32::Lanes;

use super::SPREADS;
use crate::change::BLOCK_ROWS;
use crate::change::exponentials::powers;

/// Number of sensors that q stands for.
const SEVERAL: f32 = 5.0;
/// f(u) = (1 + u^2 / WIDE)^16 / FLAT
const WIDE: f32 = 22.0;
const FLAT: f32 = 5.2;
/// Largest factor of one sensor in the product: one sensor is not several.
const LARGEST_FACTOR: f32 = 1e3;
/// Keeps statistics finite after a change.
pub(super) const LARGEST: f32 = 1e20;

/// (rows + R) L of a step: L = power exp(-d^2 rows / 2).
#[inline(always)]
pub(super) fn grown<L: Lanes>(
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
pub(super) fn replaced<L: Lanes>(
    lanes: L,
    state: L::Numbers,
    ratio: L::Numbers,
    rows: f32,
) -> L::Numbers {
    if rows == 1.0 {
        lanes.mul_add(state, ratio, ratio)
    } else {
        lanes.mul(lanes.add(state, lanes.splat(rows)), ratio)
    }
}

/// Likelihood ratios of a standard deviation s of sqrt(2), 2 and 1/2 times what it was, from the
/// sum T of the squares of so many scores of a block: s^-count times powers of e whose exponents are
/// T / 4, 3 T / 8 and - 3 T / 2. `WHOLE`: the scores are those of all rows of the block.
#[inline(always)]
pub(super) fn spread_ratios<L: Lanes, const WHOLE: bool>(
    lanes: L,
    squares: L::Numbers,
    count: L::Numbers,
) -> [L::Numbers; SPREADS] {
    let (grow, shrink) = powers(lanes, lanes.mul(squares, lanes.splat(1.0 / 8.0)));
    let (grow_2, shrink_4) = (square(lanes, grow), square(lanes, square(lanes, shrink)));
    let mut ratios = [
        grow_2,
        lanes.mul(grow_2, grow),
        lanes.mul(square(lanes, shrink_4), shrink_4),
    ];
    for (ratio, factor) in ratios.iter_mut().zip([0.5f32.sqrt(), 0.5, 2.0]) {
        let mut power = lanes.splat(factor.powi(BLOCK_ROWS as i32));
        if !WHOLE {
            for fewer in 1..BLOCK_ROWS as i32 {
                let same = lanes.equal(count, lanes.splat(fewer as f32));
                power = lanes.select(same, lanes.splat(factor.powi(fewer)), power);
            }
        }
        *ratio = lanes.mul(*ratio, power);
    }
    ratios
}

#[inline(always)]
fn square<L: Lanes>(lanes: L, number: L::Numbers) -> L::Numbers {
    lanes.mul(number, number)
}

/// The mixture over which sensors have changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Several {
    unchanged: f32,
    changed: f32,
    /// Largest 1 + u^2 / WIDE: that of the largest factor.
    largest: f32,
}

impl Several {
    pub(super) fn new(sensors: usize) -> Self {
        let share = (SEVERAL / sensors as f32).min(0.5);
        let (unchanged, changed) = (1.0 - share, share / FLAT);
        let largest = (LARGEST_FACTOR - unchanged) / changed;
        Self {
            unchanged,
            changed,
            // A root of order 16.
            largest: (0..4).fold(largest, |power, _| power.sqrt()),
        }
    }

    /// Of an average over what has `rows` each.
    #[inline(always)]
    pub(super) fn factor<L: Lanes>(
        &self,
        lanes: L,
        average: L::Numbers,
        forget: f32,
        rows: f32,
    ) -> L::Numbers {
        // The variance of the average is forget / (2 - forget) / rows.
        let scale = (2.0 - forget) / forget * rows / WIDE;
        let square = lanes.mul(average, average);
        let mut power = lanes.mul_add(square, lanes.splat(scale), lanes.splat(1.0));
        power = lanes.min(power, lanes.splat(self.largest));
        for _ in 0..4 {
            power = lanes.mul(power, power);
        }
        lanes.mul_add(
            power,
            lanes.splat(self.changed),
            lanes.splat(self.unchanged),
        )
    }
}
