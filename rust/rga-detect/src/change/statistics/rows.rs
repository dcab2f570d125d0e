//! What every row changes.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::likelihood::{LARGEST, Several, grown};
use super::{Banks, Found, OF_AVERAGES, OF_ROW_STEPS, QUICK, ROW_AVERAGES, ROW_STEPS, SUMS};
use crate::change::exponentials::powers;
use crate::change::{BLOCK_ROWS, Block};

/// Keeps products finite.
pub(super) const LARGEST_PRODUCT: f32 = 1e30;

/// Keeps the statistics of steps in rows finite until the next block.
const LARGEST_STEPS: [f32; ROW_STEPS.len()] = [LARGEST, LARGEST, 1e10];

/// Sum, sum of squares and missing scores of a block, averages, and steps of sixteen sensors.
const AVERAGES_FROM: usize = 3;
const STEPS_FROM: usize = AVERAGES_FROM + ROW_AVERAGES.len();

impl Banks {
    /// Averages of the latest rows; and gives the two sums of each row.
    #[inline(always)]
    pub(super) fn watch_averages<L: Lanes, const N: usize, const GAPS: bool>(
        &mut self,
        lanes: L,
        scores: &[Block],
        signature: &[f32],
        first: usize,
        found: &mut [Found],
    ) -> [[f32; SUMS]; N] {
        let mut totals = Totals::<L, N>::new(lanes, self.several, self.rows);
        let (states, _) = L::vectors_mut(&mut self.quick).as_chunks_mut::<QUICK>();
        let weights = L::vectors(signature);
        // Lanes behind the last sensor are always missing.
        let whole = if GAPS { 0 } else { self.sensors / SIXTEEN };
        for number in 0..whole {
            let scores = lanes.load(&scores[number], first);
            totals.take::<true>(scores, weights[number], &mut states[number]);
        }
        for number in whole..weights.len() {
            let scores = lanes.load(&scores[number], first);
            totals.take::<false>(scores, weights[number], &mut states[number]);
        }
        for (number, products) in totals.products.into_iter().enumerate() {
            let products = lanes.products(products);
            for (row, (product, found)) in products.into_iter().zip(&mut *found).enumerate() {
                if looked::<N>(self.rows, number, row) {
                    found[OF_AVERAGES + number] = product.min(LARGEST_PRODUCT);
                }
            }
        }
        let mut counts = [self.sensors as f32; N];
        if GAPS {
            let behind = (weights.len() * SIXTEEN - self.sensors) as f32;
            for (count, missing) in counts.iter_mut().zip(totals.missing) {
                *count += behind - lanes.sum(missing);
            }
        }
        let (mut alike, squares) = (lanes.sums(totals.alike), lanes.sums(totals.squares));
        if GAPS {
            for (row, lengths) in totals.lengths.into_iter().enumerate() {
                // What is there of the signature has norm 1 again.
                if counts[row] < self.sensors as f32 {
                    alike[row] /= lanes.sum(lengths).sqrt().max(f32::MIN_POSITIVE);
                }
            }
        }
        let mut sums = [[0.0; SUMS]; N];
        for (row, sums) in sums.iter_mut().enumerate() {
            let count = counts[row];
            let squares = (squares[row] - count) / (2.0 * count.max(1.0)).sqrt();
            *sums = [alike[row], squares];
        }
        sums
    }

    /// Steps in rows.
    #[inline(always)]
    pub(super) fn watch_steps<L: Lanes, const N: usize, const GAPS: bool>(
        &mut self,
        lanes: L,
        scores: &[Block],
        first: usize,
        found: &mut [Found],
    ) {
        let mut sums = [[lanes.splat(0.0); N]; ROW_STEPS.len()];
        let (states, _) = L::vectors_mut(&mut self.quick).as_chunks_mut::<QUICK>();
        let whole = if GAPS { 0 } else { self.sensors / SIXTEEN };
        let last = N == BLOCK_ROWS || (self.rows + 1).is_multiple_of(BLOCK_ROWS as u64);
        for (number, state) in states[..whole].iter_mut().enumerate() {
            let scores = lanes.load(&scores[number], first);
            step::<L, N, true>(lanes, scores, state, &mut sums, last);
        }
        for (number, state) in states.iter_mut().enumerate().skip(whole) {
            let scores = lanes.load(&scores[number], first);
            step::<L, N, false>(lanes, scores, state, &mut sums, last);
        }
        for (sums, number) in sums.into_iter().zip(OF_ROW_STEPS..) {
            for (sum, found) in lanes.sums(sums).into_iter().zip(&mut *found) {
                found[number] = sum / (2 * self.sensors) as f32;
            }
        }
    }
}

/// Scores of sixteen sensors in N rows enter the statistics of steps; `WHOLE`: none is missing;
/// `last`: they are the last of a block.
#[inline(always)]
fn step<L: Lanes, const N: usize, const WHOLE: bool>(
    lanes: L,
    given: [L::Numbers; N],
    state: &mut [L::Numbers; QUICK],
    sums: &mut [[L::Numbers; N]; ROW_STEPS.len()],
    last: bool,
) {
    let mut power = [[lanes.splat(0.0); 2]; N];
    for (power, given) in power.iter_mut().zip(given) {
        let score = if WHOLE { given } else { known(lanes, given) };
        let (up, down) = powers(lanes, score);
        *power = [up, down];
    }
    let (states, _) = state[STEPS_FROM..].as_chunks_mut::<2>();
    for (number, size) in ROW_STEPS.into_iter().enumerate() {
        let [mut rising, mut falling] = states[number];
        for row in 0..N {
            let [up, down] = power[row];
            let more = grown(lanes, rising, up, size, 1.0);
            let less = grown(lanes, falling, down, size, 1.0);
            if WHOLE {
                (rising, falling) = (more, less);
            } else {
                let present = lanes.equal(given[row], given[row]);
                rising = lanes.select(present, more, rising);
                falling = lanes.select(present, less, falling);
            }
            sums[number][row] = lanes.add(sums[number][row], lanes.add(rising, falling));
            power[row] = [lanes.mul(up, up), lanes.mul(down, down)];
        }
        if last {
            let largest = lanes.splat(LARGEST_STEPS[number]);
            (rising, falling) = (lanes.min(rising, largest), lanes.min(falling, largest));
        }
        states[number] = [rising, falling];
    }
}

/// 0 for what is missing.
#[inline(always)]
fn known<L: Lanes>(lanes: L, score: L::Numbers) -> L::Numbers {
    lanes.select(lanes.equal(score, score), score, lanes.splat(0.0))
}

/// Whether an average is looked at after one of N rows, of which so many came before.
#[inline(always)]
fn looked<const N: usize>(before: u64, average: usize, row: usize) -> bool {
    let rows = if N == BLOCK_ROWS {
        row as u64 + 1
    } else {
        before + 1
    };
    rows.is_multiple_of(ROW_AVERAGES[average].1)
}

/// Sums over the sensors of N rows, and products.
struct Totals<L: Lanes, const N: usize> {
    lanes: L,
    several: Several,
    /// Rows before the first one.
    before: u64,
    products: [[L::Numbers; N]; ROW_AVERAGES.len()],
    alike: [L::Numbers; N],
    squares: [L::Numbers; N],
    missing: [L::Numbers; N],
    /// Sums of the squares of the signature where scores are there.
    lengths: [L::Numbers; N],
}

impl<L: Lanes, const N: usize> Totals<L, N> {
    #[inline(always)]
    fn new(lanes: L, several: Several, before: u64) -> Self {
        let zero = lanes.splat(0.0);
        Self {
            lanes,
            several,
            before,
            products: [[lanes.splat(1.0); N]; _],
            alike: [zero; N],
            squares: [zero; N],
            missing: [zero; N],
            lengths: [zero; N],
        }
    }

    /// Sixteen sensors; `WHOLE`: none is missing.
    #[inline(always)]
    fn take<const WHOLE: bool>(
        &mut self,
        given: [L::Numbers; N],
        weight: L::Numbers,
        state: &mut [L::Numbers; QUICK],
    ) {
        let lanes = self.lanes;
        let mut scores = given;
        if !WHOLE {
            for row in 0..N {
                scores[row] = known(lanes, given[row]);
                let present = lanes.equal(given[row], given[row]);
                let missing = lanes.select(present, lanes.splat(0.0), lanes.splat(1.0));
                self.missing[row] = lanes.add(self.missing[row], missing);
                state[2] = lanes.add(state[2], missing);
                let there = lanes.select(present, weight, lanes.splat(0.0));
                self.lengths[row] = lanes.mul_add(there, there, self.lengths[row]);
            }
        }
        let [sum, squares, ..] = state;
        for (row, score) in scores.into_iter().enumerate() {
            let square = lanes.mul(score, score);
            *sum = lanes.add(*sum, score);
            *squares = lanes.add(*squares, square);
            self.alike[row] = lanes.mul_add(weight, score, self.alike[row]);
            self.squares[row] = lanes.add(self.squares[row], square);
        }
        for (number, (forget, _)) in ROW_AVERAGES.into_iter().enumerate() {
            let average = &mut state[AVERAGES_FROM + number];
            for row in 0..N {
                let change = lanes.sub(scores[row], *average);
                let moved = lanes.mul_add(change, lanes.splat(forget), *average);
                *average = if WHOLE {
                    moved
                } else {
                    let present = lanes.equal(given[row], given[row]);
                    lanes.select(present, moved, *average)
                };
                if looked::<N>(self.before, number, row) {
                    let factor = self.several.factor(lanes, *average, forget, 1.0);
                    self.products[number][row] = lanes.mul(self.products[number][row], factor);
                }
            }
        }
    }
}
