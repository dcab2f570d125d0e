//! Steps in sums over all sensors.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::likelihood::{LARGEST, replaced};
use super::{Banks, SUM_STEPS, SUMS};
use crate::change::exponentials::powers;
use crate::change::reference::LARGEST_SCORE;

impl Banks {
    /// Takes the two sums of a row, and gives the statistics of the steps of one, then of the
    /// other.
    #[inline(always)]
    pub(super) fn watch_sums<L: Lanes>(&mut self, lanes: L, sums: [f32; SUMS]) -> L::Numbers {
        let mut sized = lanes.splat(0.0);
        for (number, sum) in sums.into_iter().enumerate() {
            let sum = lanes.splat(sum.clamp(-LARGEST_SCORE, LARGEST_SCORE));
            let sizes = by_lane(number, |size, sign| sign * size);
            sized = lanes.mul_add(L::vectors(&sizes)[0], sum, sized);
        }
        let (power, _) = powers(lanes, sized);
        let mut scales = [0.0; SIXTEEN];
        for number in 0..SUMS {
            let own = by_lane(number, |size, _| (-size * size / 2.0).exp());
            for (scale, own) in scales.iter_mut().zip(own) {
                *scale += own;
            }
        }
        let ratio = lanes.mul(power, L::vectors(&scales)[0]);
        let state = &mut L::vectors_mut(&mut self.sums)[0];
        *state = lanes.min(replaced(lanes, *state, ratio, 1.0), lanes.splat(LARGEST));
        lanes.mul(lanes.halves(*state), lanes.splat(0.5))
    }
}

/// What belongs to the steps of a sum, in their lanes: those that rise, and those that fall.
#[inline(always)]
fn by_lane(sum: usize, what: impl Fn(f32, f32) -> f32) -> [f32; SIXTEEN] {
    let mut lanes = [0.0; SIXTEEN];
    for (number, size) in SUM_STEPS.into_iter().enumerate() {
        let lane = sum * SUM_STEPS.len() + number;
        lanes[lane] = what(size, 1.0);
        lanes[SIXTEEN / 2 + lane] = what(size, -1.0);
    }
    lanes
}
