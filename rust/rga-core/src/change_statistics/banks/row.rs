//! What every row changes.

use super::likelihood::{Several, grown};
use super::{Banks, QUICK, ROW_AVERAGES, ROW_STEPS, SUMS};
use crate::change_statistics::powers::powers;
use crate::change_statistics::sixteen::{Lanes, SIXTEEN, sixteens};

/// Keeps products finite.
pub const LARGEST_PRODUCT: f32 = 1e30;

impl Banks {
    /// Takes the scores of a row, and gives the two sums of them.
    #[inline(always)]
    pub(super) fn each_row<L: Lanes>(
        &mut self,
        lanes: L,
        scores: &[f32],
        signature: &[f32],
        gaps: bool,
        steps: &mut [f32],
        averages: &mut [f32],
    ) -> [f32; SUMS] {
        let looked = ROW_AVERAGES.map(|(_, every)| self.rows.is_multiple_of(every));
        let mut row = Row::new(lanes, self.sensors, looked);
        let vectors = L::vectors(scores).iter().zip(L::vectors(signature));
        let (states, _) = L::vectors_mut(&mut self.quick).as_chunks_mut::<QUICK>();
        let whole = if gaps { 0 } else { self.sensors / SIXTEEN };
        for (number, ((score, weight), state)) in vectors.zip(states).enumerate() {
            // Lanes behind the last sensor are always missing.
            if number < whole {
                row.take::<true>(*score, *weight, state);
            } else {
                row.take::<false>(*score, *weight, state);
            }
        }
        for (found, sum) in steps.iter_mut().zip(row.steps) {
            *found = lanes.sum(sum) / (2 * self.sensors) as f32;
        }
        for ((found, product), looked) in averages.iter_mut().zip(row.products).zip(looked) {
            if looked {
                *found = lanes.product(product).min(LARGEST_PRODUCT);
            }
        }
        let mut count = self.sensors as f32;
        if gaps {
            let behind = (sixteens(self.sensors) * SIXTEEN - self.sensors) as f32;
            count += behind - lanes.sum(row.missing);
        }
        let squares = (lanes.sum(row.squares) - count) / (2.0 * count.max(1.0)).sqrt();
        [lanes.sum(row.alike), squares]
    }
}

/// Sums over the sensors of a row.
struct Row<L: Lanes> {
    lanes: L,
    several: Several<L>,
    looked: [bool; ROW_AVERAGES.len()],
    steps: [L::Numbers; ROW_STEPS.len()],
    products: [L::Numbers; ROW_AVERAGES.len()],
    alike: L::Numbers,
    squares: L::Numbers,
    missing: L::Numbers,
}

impl<L: Lanes> Row<L> {
    #[inline(always)]
    fn new(lanes: L, sensors: usize, looked: [bool; ROW_AVERAGES.len()]) -> Self {
        let zero = lanes.splat(0.0);
        Self {
            lanes,
            several: Several::new(lanes, sensors),
            looked,
            steps: [zero; _],
            products: [lanes.splat(1.0); _],
            alike: zero,
            squares: zero,
            missing: zero,
        }
    }

    /// Sixteen sensors; `WHOLE`: none is missing.
    #[inline(always)]
    fn take<const WHOLE: bool>(
        &mut self,
        given: L::Numbers,
        weight: L::Numbers,
        state: &mut [L::Numbers; QUICK],
    ) {
        let lanes = self.lanes;
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let present = lanes.equal(given, given);
        let mut score = given;
        if !WHOLE {
            score = lanes.select(present, given, zero);
            let missing = lanes.select(present, zero, one);
            self.missing = lanes.add(self.missing, missing);
            state[2] = lanes.add(state[2], missing);
        }
        let square = lanes.mul(score, score);
        state[0] = lanes.add(state[0], score);
        state[1] = lanes.add(state[1], square);

        for (number, (forget, _)) in ROW_AVERAGES.into_iter().enumerate() {
            let old = state[3 + number];
            let change = lanes.mul(lanes.sub(score, old), lanes.splat(forget));
            let mut average = lanes.add(old, change);
            if !WHOLE {
                average = lanes.select(present, average, old);
            }
            state[3 + number] = average;
            if self.looked[number] {
                let factor = self.several.factor(average, forget, 1.0);
                self.products[number] = lanes.mul(self.products[number], factor);
            }
        }

        let (mut up, mut down) = powers(lanes, score, 4);
        for (number, size) in ROW_STEPS.into_iter().enumerate() {
            let first = 3 + ROW_AVERAGES.len() + 2 * number;
            let (old_up, old_down) = (state[first], state[first + 1]);
            let mut rising = grown(lanes, old_up, up, size, 1.0);
            let mut falling = grown(lanes, old_down, down, size, 1.0);
            if !WHOLE {
                rising = lanes.select(present, rising, old_up);
                falling = lanes.select(present, falling, old_down);
            }
            (state[first], state[first + 1]) = (rising, falling);
            self.steps[number] = lanes.add(self.steps[number], lanes.add(rising, falling));
            (up, down) = (lanes.mul(up, up), lanes.mul(down, down));
        }

        self.alike = lanes.add(self.alike, lanes.mul(weight, score));
        self.squares = lanes.add(self.squares, square);
    }
}
