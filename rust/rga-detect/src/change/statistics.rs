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
//! What is slow is looked at in blocks of a few rows.

mod likelihood;
mod row_blocks;
mod rows;
mod sums;

use std::slice;

use rga_simd::f32::{Lanes, SIXTEEN, sixteens};

use crate::change::{BLOCK_ROWS, Block};
use likelihood::Several;

/// Blocks of a long block.
const LONG_BLOCK: u64 = 2;

/// Steps d in the scores of rows, of blocks and of long blocks.
const ROW_STEPS: [f32; 3] = [1.0, 2.0, 4.0];
const BLOCK_STEP: f32 = 0.5;
const LONG_BLOCK_STEP: f32 = 0.25;
/// Steps in sums.
const SUM_STEPS: [f32; 4] = [0.5, 1.0, 2.0, 4.0];
/// Sums that are watched: of all that rise alike, and of the squares of all.
const SUMS: usize = 2;
/// Factors on the standard deviation: sqrt(2), 2, 1/2.
const SPREADS: usize = 3;

/// What an average of rows, or of blocks, forgets with each, and after how many it is looked at.
const ROW_AVERAGES: [(f32, u64); 3] = [(1.0 / 2.0, 1), (1.0 / 4.0, 1), (1.0 / 8.0, 2)];
const BLOCK_AVERAGES: [(f32, u64); 5] = [
    (1.0 / 4.0, 1),
    (1.0 / 8.0, 1),
    (1.0 / 16.0, 2),
    (1.0 / 32.0, 4),
    (1.0 / 64.0, 8),
];

/// In this order: a step in one sensor, small to large; a spread; a step in several, slow to forget
/// last; a step in all alike; one in the squares of all.
pub const STATISTICS: usize = SIXTEEN + SUMS * SUM_STEPS.len();
const STEPS: usize = 2 + ROW_STEPS.len();
const AVERAGES: usize = ROW_AVERAGES.len() + BLOCK_AVERAGES.len();
const _: () = assert!(STEPS + SPREADS + AVERAGES == SIXTEEN);
const _: () = assert!(2 * SUMS * SUM_STEPS.len() == SIXTEEN);

/// Where statistics of rows begin among all; those of blocks lie before the steps, and behind the
/// averages.
const OF_ROW_STEPS: usize = STEPS - ROW_STEPS.len();
const OF_SPREADS: usize = STEPS;
const OF_AVERAGES: usize = STEPS + SPREADS;

/// Two sixteens; what is behind the last statistic means nothing.
pub(super) type Found = [f32; 2 * SIXTEEN];

/// Vectors of sixteen sensors: what every row changes, and what blocks change.
const QUICK: usize = 3 + ROW_AVERAGES.len() + 2 * ROW_STEPS.len();
const SLOW: usize = 1 + 2 + 2 + SPREADS + BLOCK_AVERAGES.len();

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Banks {
    sensors: usize,
    several: Several,
    /// `[sixteens, QUICK, 16]`
    pub(super) quick: Vec<f32>,
    /// `[sixteens, SLOW, 16]`
    pub(super) slow: Vec<f32>,
    /// `[2, SUMS, SUM_STEPS]`: steps that rise, then steps that fall
    pub(super) sums: Vec<f32>,
    pub(super) rows: u64,
}

impl Banks {
    pub(super) fn new(sensors: usize) -> Self {
        let width = sixteens(sensors) * SIXTEEN;
        Self {
            sensors,
            several: Several::new(sensors),
            quick: vec![0.0; width * QUICK],
            slow: vec![0.0; width * SLOW],
            sums: vec![0.0; SIXTEEN],
            rows: 0,
        }
    }

    /// Rows until a block is full.
    pub(super) fn rows_to_beat(&self) -> usize {
        BLOCK_ROWS - (self.rows % BLOCK_ROWS as u64) as usize
    }

    /// Takes the scores of rows of one block, NaN where they are missing, and gives the statistics
    /// of each; one that is not looked at in a row is 0.
    #[inline(always)]
    pub(super) fn advance<L: Lanes>(
        &mut self,
        lanes: L,
        scores: &[Block],
        signature: &[f32],
        gaps: bool,
        found: &mut [Found],
    ) {
        found.fill([0.0; _]);
        if found.len() == BLOCK_ROWS && !gaps {
            self.take::<L, BLOCK_ROWS, false>(lanes, scores, signature, 0, found);
            self.watch_block::<L, true>(lanes, &mut found[BLOCK_ROWS - 1]);
            return;
        }
        for (row, found) in found.iter_mut().enumerate() {
            let one = slice::from_mut(found);
            if gaps {
                self.take::<L, 1, true>(lanes, scores, signature, row, one);
            } else {
                self.take::<L, 1, false>(lanes, scores, signature, row, one);
            }
            if self.rows.is_multiple_of(BLOCK_ROWS as u64) {
                self.watch_block::<L, false>(lanes, found);
            }
        }
    }

    /// N rows, one or all of a block, from one on. `GAPS`: some scores are missing.
    #[inline(always)]
    fn take<L: Lanes, const N: usize, const GAPS: bool>(
        &mut self,
        lanes: L,
        scores: &[Block],
        signature: &[f32],
        first: usize,
        found: &mut [Found],
    ) {
        let totals = self.watch_averages::<L, N, GAPS>(lanes, scores, signature, first, found);
        self.watch_steps::<L, N, GAPS>(lanes, scores, first, found);
        for (totals, found) in totals.into_iter().zip(found) {
            let of_sums = &mut found[SIXTEEN..];
            L::vectors_mut(of_sums)[0] = self.watch_sums(lanes, totals);
        }
        self.rows += N as u64;
    }
}
