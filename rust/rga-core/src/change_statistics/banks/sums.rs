//! Steps in sums over all sensors.

use super::likelihood::replaced;
use super::{Banks, SUM_STEPS, SUMS};
use crate::change_statistics::powers::powers;
use crate::change_statistics::reference::LARGEST_SCORE;
use crate::change_statistics::sixteen::{Lanes, SIXTEEN};

/// Lanes of the steps that fall: behind those that rise.
const FALLING: usize = SIXTEEN / 2;

impl Banks {
    #[inline(always)]
    pub(super) fn watch_sums<L: Lanes>(
        &mut self,
        lanes: L,
        sums: [f32; SUMS],
        found: &mut [L::Numbers],
    ) {
        let (sizes, scales) = sum_steps();
        let (sizes, scales) = (L::vectors(&sizes)[0], L::vectors(&scales)[0]);
        let states = L::vectors_mut(&mut self.sums).iter_mut();
        for ((state, sum), found) in states.zip(sums).zip(found) {
            let sum = sum.clamp(-LARGEST_SCORE, LARGEST_SCORE);
            let (power, _) = powers(lanes, lanes.mul(sizes, lanes.splat(sum)), 6);
            *state = replaced(lanes, *state, lanes.mul(power, scales), 1.0);
            *found = lanes.mul(lanes.halves(*state), lanes.splat(0.5));
        }
    }
}

/// Sizes of the steps of a sum, lane by lane, with what exp(d z) is scaled by.
#[inline(always)]
fn sum_steps() -> ([f32; SIXTEEN], [f32; SIXTEEN]) {
    let (mut sizes, mut scales) = ([0.0; SIXTEEN], [0.0; SIXTEEN]);
    for (lane, size) in SUM_STEPS.into_iter().enumerate() {
        (sizes[lane], sizes[FALLING + lane]) = (size, -size);
        let scale = (-size * size / 2.0).exp();
        (scales[lane], scales[FALLING + lane]) = (scale, scale);
    }
    (sizes, scales)
}
