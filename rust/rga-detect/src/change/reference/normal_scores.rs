//! From units to scores.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::Reference;
use crate::change::Block;

/// Readings further from their level, in units, are taken for this.
const FARTHEST: f32 = 1e3;

impl Reference {
    /// N rows, from one on. `GAPS`: some scores are NaN, which stays.
    #[inline(always)]
    pub(super) fn bend<L: Lanes, const N: usize, const GAPS: bool>(
        &self,
        lanes: L,
        scores: &mut [Block],
        first: usize,
    ) {
        let each = self.derived.bending.len() / scores.len();
        let whole = if GAPS { 0 } else { self.sensors() / SIXTEEN };
        for (number, block) in scores.iter_mut().enumerate() {
            let bending = L::vectors(&self.derived.bending[number * each..][..each]);
            let given = lanes.load::<N>(block, first);
            let mut bent = bent(lanes, bending, given);
            for (bent, given) in bent.iter_mut().zip(given) {
                *bent = self.cut(lanes, *bent);
                if number >= whole {
                    *bent = lanes.select(lanes.equal(given, given), *bent, given);
                }
            }
            lanes.store(bent, block, first);
        }
    }

    /// To what a baseline can tell of.
    #[inline(always)]
    pub(super) fn cut<L: Lanes>(&self, lanes: L, score: L::Numbers) -> L::Numbers {
        let largest = self.largest[0] as f32;
        lanes.min(
            lanes.max(score, lanes.splat(-largest)),
            lanes.splat(largest),
        )
    }
}

#[inline(always)]
fn bent<L: Lanes, const N: usize>(
    lanes: L,
    bending: &[L::Numbers],
    given: [L::Numbers; N],
) -> [L::Numbers; N] {
    let mut units = given;
    let mut bent = given;
    for (units, bent) in units.iter_mut().zip(&mut bent) {
        *units = lanes.max(*units, lanes.splat(-FARTHEST));
        *units = lanes.min(*units, lanes.splat(FARTHEST));
        *bent = lanes.mul_add(bending[1], *units, bending[0]);
    }
    let (knots, _) = bending[2..].as_chunks::<2>();
    for [knot, bend] in knots {
        for (bent, units) in bent.iter_mut().zip(units) {
            *bent = lanes.mul_add(*bend, lanes.max(units, *knot), *bent);
        }
    }
    bent
}
