//! What every block of rows changes.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::likelihood::{LARGEST, Several, grown, replaced, spread_ratios};
use super::rows::LARGEST_PRODUCT;
use super::{
    BLOCK_AVERAGES, BLOCK_STEP, Banks, Found, LONG_BLOCK, LONG_BLOCK_STEP, OF_AVERAGES, OF_SPREADS,
    QUICK, ROW_AVERAGES, SLOW, SPREADS,
};
use crate::change::BLOCK_ROWS;
use crate::change::exponentials::powers;

impl Banks {
    /// `WHOLE`: no score of the block was missing.
    #[inline(always)]
    pub(super) fn watch_block<L: Lanes, const WHOLE: bool>(&mut self, lanes: L, found: &mut Found) {
        let zero = lanes.splat(0.0);
        let mut sums = Sums {
            lanes,
            several: self.several,
            block: self.rows / BLOCK_ROWS as u64,
            of_long_block: zero,
            of_block: zero,
            of_spreads: [zero; _],
            products: [lanes.splat(1.0); _],
        };
        let (quick, _) = L::vectors_mut(&mut self.quick).as_chunks_mut::<QUICK>();
        let (slow, _) = L::vectors_mut(&mut self.slow).as_chunks_mut::<SLOW>();
        let whole = if WHOLE { self.sensors / SIXTEEN } else { 0 };
        for (number, (quick, slow)) in quick.iter_mut().zip(slow).enumerate() {
            if number < whole {
                sums.take::<true>(quick, slow);
            } else {
                sums.take::<false>(quick, slow);
            }
        }
        let sensors = self.sensors as f32;
        let [grow, grow_more, shrink] = sums.of_spreads;
        let [of_block, spreads @ ..] = lanes.sums([sums.of_block, grow, grow_more, shrink]);
        if sums.is_long_block() {
            found[0] = lanes.sum(sums.of_long_block) / (2.0 * sensors);
        }
        found[1] = of_block / (2.0 * sensors);
        for (found, sum) in found[OF_SPREADS..].iter_mut().zip(spreads) {
            *found = sum / sensors;
        }
        let averages = found[OF_AVERAGES + ROW_AVERAGES.len()..].iter_mut();
        let products = lanes.products(sums.products);
        for ((found, product), (_, every)) in averages.zip(products).zip(BLOCK_AVERAGES) {
            if sums.block.is_multiple_of(every) {
                *found = product.min(LARGEST_PRODUCT);
            }
        }
    }
}

/// Sums over sensors, and products.
struct Sums<L: Lanes> {
    lanes: L,
    several: Several,
    /// Blocks with this one.
    block: u64,
    of_long_block: L::Numbers,
    of_block: L::Numbers,
    of_spreads: [L::Numbers; SPREADS],
    products: [L::Numbers; BLOCK_AVERAGES.len()],
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    fn is_long_block(&self) -> bool {
        self.block.is_multiple_of(LONG_BLOCK)
    }

    /// Sixteen sensors; `WHOLE`: no score of theirs was missing.
    #[inline(always)]
    fn take<const WHOLE: bool>(
        &mut self,
        quick: &mut [L::Numbers; QUICK],
        slow: &mut [L::Numbers; SLOW],
    ) {
        let lanes = self.lanes;
        let zero = lanes.splat(0.0);
        let (sum, squares) = (quick[0], quick[1]);
        let count = lanes.sub(lanes.splat(BLOCK_ROWS as f32), quick[2]);
        let missing = lanes.equal(count, zero);
        quick[..3].fill(zero);
        let (whole, rest) = slow.split_at_mut(1);
        let (in_blocks, rest) = rest.split_at_mut(2);
        let (in_long_blocks, rest) = rest.split_at_mut(2);
        let (spreading, averaging) = rest.split_at_mut(SPREADS);

        let (up, down) = powers(lanes, lanes.mul(sum, lanes.splat(BLOCK_STEP)));
        for (state, power) in in_blocks.iter_mut().zip([up, down]) {
            *state = kept::<L, WHOLE>(
                lanes,
                missing,
                *state,
                grown(lanes, *state, power, BLOCK_STEP, BLOCK_ROWS as f32),
            );
            self.of_block = lanes.add(self.of_block, *state);
        }
        whole[0] = lanes.add(whole[0], sum);
        if self.is_long_block() {
            let (up, down) = powers(lanes, lanes.mul(whole[0], lanes.splat(LONG_BLOCK_STEP)));
            let rows = BLOCK_ROWS as f32 * LONG_BLOCK as f32;
            for (state, power) in in_long_blocks.iter_mut().zip([up, down]) {
                *state = kept::<L, WHOLE>(
                    lanes,
                    missing,
                    *state,
                    grown(lanes, *state, power, LONG_BLOCK_STEP, rows),
                );
                self.of_long_block = lanes.add(self.of_long_block, *state);
            }
            whole[0] = zero;
        }
        let ratios = spread_ratios::<L, WHOLE>(lanes, squares, count);
        for ((state, ratio), sum) in spreading.iter_mut().zip(ratios).zip(&mut self.of_spreads) {
            *state = kept::<L, WHOLE>(
                lanes,
                missing,
                *state,
                replaced(lanes, *state, ratio, BLOCK_ROWS as f32),
            );
            *sum = lanes.add(*sum, *state);
        }
        let mean = lanes.mul(sum, lanes.splat(1.0 / BLOCK_ROWS as f32));
        let averages = averaging.iter_mut().zip(BLOCK_AVERAGES);
        for ((average, (forget, every)), product) in averages.zip(&mut self.products) {
            let change = lanes.sub(mean, *average);
            let moved = lanes.mul_add(change, lanes.splat(forget), *average);
            *average = if WHOLE {
                moved
            } else {
                lanes.select(missing, *average, moved)
            };
            if self.block.is_multiple_of(every) {
                let factor = self
                    .several
                    .factor(lanes, *average, forget, BLOCK_ROWS as f32);
                *product = lanes.mul(*product, factor);
            }
        }
    }
}

/// A new state, finite, or the old one where all scores were missing.
#[inline(always)]
fn kept<L: Lanes, const WHOLE: bool>(
    lanes: L,
    missing: L::Mask,
    old: L::Numbers,
    new: L::Numbers,
) -> L::Numbers {
    let new = lanes.min(new, lanes.splat(LARGEST));
    if WHOLE {
        new
    } else {
        lanes.select(missing, old, new)
    }
}
