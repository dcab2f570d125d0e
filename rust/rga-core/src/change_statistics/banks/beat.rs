//! What every beat of rows changes.

use super::likelihood::{LARGEST, Several, grown, replaced, spread_ratios};
use super::row::LARGEST_PRODUCT;
use super::{
    BAR, BAR_STEP, BEAT, BEAT_AVERAGES, BEAT_STEP, Banks, QUICK, ROW_AVERAGES, ROW_STEPS, SLOW,
    SPREADS,
};
use crate::change_statistics::powers::powers;
use crate::change_statistics::sixteen::Lanes;

/// Keeps the statistics of steps in rows finite until the next beat.
const LARGEST_STEPS: [f32; ROW_STEPS.len()] = [LARGEST, LARGEST, 1e10];

impl Banks {
    #[inline(always)]
    pub(super) fn each_beat<L: Lanes>(
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
            let (sum, squares) = (quick[0], quick[1]);
            let count = lanes.sub(lanes.splat(BEAT as f32), quick[2]);
            let missing = lanes.equal(count, zero);
            quick[..3].fill(zero);
            let stepping = quick[3 + ROW_AVERAGES.len()..].chunks_exact_mut(2);
            for (states, largest) in stepping.zip(LARGEST_STEPS) {
                for state in states {
                    *state = lanes.min(*state, lanes.splat(largest));
                }
            }
            let (whole, rest) = slow.split_at_mut(1);
            let (in_beats, rest) = rest.split_at_mut(2);
            let (in_bars, rest) = rest.split_at_mut(2);
            let (spreading, averaging) = rest.split_at_mut(SPREADS);

            let sized = lanes.mul(sum, lanes.splat(BEAT_STEP));
            let (up, down) = powers(lanes, sized, 5);
            for (state, power) in in_beats.iter_mut().zip([up, down]) {
                let next = grown(lanes, *state, power, BEAT_STEP, BEAT as f32);
                let next = lanes.min(next, lanes.splat(LARGEST));
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
                    let next = lanes.min(next, lanes.splat(LARGEST));
                    *state = lanes.select(missing, *state, next);
                    bar_sum = lanes.add(bar_sum, *state);
                }
                whole[0] = zero;
            }
            let ratios = spread_ratios(lanes, squares, count);
            for ((state, ratio), sum) in spreading.iter_mut().zip(ratios).zip(&mut spread_sums) {
                let next = replaced(lanes, *state, ratio, BEAT as f32);
                let next = lanes.min(next, lanes.splat(LARGEST));
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
