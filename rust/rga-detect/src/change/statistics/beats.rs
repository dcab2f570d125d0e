//! What every beat of rows changes.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::likelihood::{LARGEST, Several, grown, replaced, spread_ratios};
use super::rows::LARGEST_PRODUCT;
use super::{
    BAR, BAR_STEP, BEAT_AVERAGES, BEAT_STEP, Banks, Found, OF_AVERAGES, OF_SPREADS, QUICK,
    ROW_AVERAGES, SLOW, SPREADS,
};
use crate::change::BEAT;
use crate::change::exponentials::powers;

impl Banks {
    /// `WHOLE`: no score of the beat was missing.
    #[inline(always)]
    pub(super) fn watch_beat<L: Lanes, const WHOLE: bool>(&mut self, lanes: L, found: &mut Found) {
        let zero = lanes.splat(0.0);
        let mut sums = Sums {
            lanes,
            several: self.several,
            beat: self.rows / BEAT as u64,
            of_bar: zero,
            of_beat: zero,
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
        let [of_beat, spreads @ ..] = lanes.sums([sums.of_beat, grow, grow_more, shrink]);
        if sums.is_bar() {
            found[0] = lanes.sum(sums.of_bar) / (2.0 * sensors);
        }
        found[1] = of_beat / (2.0 * sensors);
        for (found, sum) in found[OF_SPREADS..].iter_mut().zip(spreads) {
            *found = sum / sensors;
        }
        let averages = found[OF_AVERAGES + ROW_AVERAGES.len()..].iter_mut();
        let products = lanes.products(sums.products);
        for ((found, product), (_, every)) in averages.zip(products).zip(BEAT_AVERAGES) {
            if sums.beat.is_multiple_of(every) {
                *found = product.min(LARGEST_PRODUCT);
            }
        }
    }
}

/// Sums over sensors, and products.
struct Sums<L: Lanes> {
    lanes: L,
    several: Several,
    /// Beats with this one.
    beat: u64,
    of_bar: L::Numbers,
    of_beat: L::Numbers,
    of_spreads: [L::Numbers; SPREADS],
    products: [L::Numbers; BEAT_AVERAGES.len()],
}

impl<L: Lanes> Sums<L> {
    #[inline(always)]
    fn is_bar(&self) -> bool {
        self.beat.is_multiple_of(BAR)
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
        let count = lanes.sub(lanes.splat(BEAT as f32), quick[2]);
        let missing = lanes.equal(count, zero);
        quick[..3].fill(zero);
        let (whole, rest) = slow.split_at_mut(1);
        let (in_beats, rest) = rest.split_at_mut(2);
        let (in_bars, rest) = rest.split_at_mut(2);
        let (spreading, averaging) = rest.split_at_mut(SPREADS);

        let (up, down) = powers(lanes, lanes.mul(sum, lanes.splat(BEAT_STEP)));
        for (state, power) in in_beats.iter_mut().zip([up, down]) {
            *state = kept::<L, WHOLE>(
                lanes,
                missing,
                *state,
                grown(lanes, *state, power, BEAT_STEP, BEAT as f32),
            );
            self.of_beat = lanes.add(self.of_beat, *state);
        }
        whole[0] = lanes.add(whole[0], sum);
        if self.is_bar() {
            let (up, down) = powers(lanes, lanes.mul(whole[0], lanes.splat(BAR_STEP)));
            let rows = BEAT as f32 * BAR as f32;
            for (state, power) in in_bars.iter_mut().zip([up, down]) {
                *state = kept::<L, WHOLE>(
                    lanes,
                    missing,
                    *state,
                    grown(lanes, *state, power, BAR_STEP, rows),
                );
                self.of_bar = lanes.add(self.of_bar, *state);
            }
            whole[0] = zero;
        }
        let ratios = spread_ratios::<L, WHOLE>(lanes, squares, count);
        for ((state, ratio), sum) in spreading.iter_mut().zip(ratios).zip(&mut self.of_spreads) {
            *state = kept::<L, WHOLE>(
                lanes,
                missing,
                *state,
                replaced(lanes, *state, ratio, BEAT as f32),
            );
            *sum = lanes.add(*sum, *state);
        }
        let mean = lanes.mul(sum, lanes.splat(1.0 / BEAT as f32));
        let averages = averaging.iter_mut().zip(BEAT_AVERAGES);
        for ((average, (forget, every)), product) in averages.zip(&mut self.products) {
            let change = lanes.sub(mean, *average);
            let moved = lanes.mul_add(change, lanes.splat(forget), *average);
            *average = if WHOLE {
                moved
            } else {
                lanes.select(missing, *average, moved)
            };
            if self.beat.is_multiple_of(every) {
                let factor = self.several.factor(lanes, *average, forget, BEAT as f32);
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
