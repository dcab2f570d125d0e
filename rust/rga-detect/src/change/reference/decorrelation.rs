//! From scores to independent scores.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::Reference;
use super::gaps::{Gaps, missing};
use crate::change::Block;

impl Reference {
    /// N rows, from one on, worked out in as much space. `GAPS`: some scores are NaN, which stays.
    #[inline(always)]
    pub(super) fn mix<L: Lanes, const N: usize, const GAPS: bool>(
        &self,
        lanes: L,
        scores: &mut [Block],
        mixed: &mut [Block],
        first: usize,
        gaps: &mut Gaps,
    ) {
        if GAPS {
            self.products_with_gaps(lanes, scores, mixed, first, gaps);
        } else {
            self.products::<L, N>(lanes, scores, mixed, first);
        }
        for (scores, mixed) in scores.iter_mut().zip(mixed) {
            let mut found = lanes.load::<N>(mixed, first);
            let given = lanes.load::<N>(scores, first);
            for (found, given) in found.iter_mut().zip(given) {
                let present = lanes.equal(given, given);
                *found = lanes.select(present, self.cut(lanes, *found), given);
            }
            lanes.store(found, scores, first);
        }
    }

    /// W times scores.
    #[inline(always)]
    fn products<L: Lanes, const N: usize>(
        &self,
        lanes: L,
        scores: &[Block],
        mixed: &mut [Block],
        first: usize,
    ) {
        let columns = L::vectors(&self.derived.columns);
        let sensors = self.sensors();
        let (pairs, last) = mixed.as_chunks_mut::<2>();
        for (number, [one, other]) in pairs.iter_mut().enumerate() {
            let own = &columns[2 * number * sensors..][..2 * sensors];
            let [sums, others] = product(lanes, own.split_at(sensors).into(), scores, first);
            lanes.store::<N>(sums, one, first);
            lanes.store::<N>(others, other, first);
        }
        if let [last] = last {
            let own = &columns[columns.len() - sensors..];
            let [sums] = product(lanes, [own], scores, first);
            lanes.store::<N>(sums, last, first);
        }
    }

    /// What is there becomes independent by its own law; what is missing stays so.
    #[inline(always)]
    fn products_with_gaps<L: Lanes>(
        &self,
        lanes: L,
        scores: &mut [Block],
        mixed: &mut [Block],
        row: usize,
        gaps: &mut Gaps,
    ) {
        let sensors = self.sensors();
        let missing = missing(scores, row, sensors);
        let place = |sensor: usize| (sensor / SIXTEEN, sensor % SIXTEEN);
        for (block, lane) in missing.iter().copied().map(place) {
            scores[block][row][lane] = 0.0;
        }
        self.products::<L, 1>(lanes, scores, mixed, row);
        for (block, lane) in missing.iter().copied().map(place) {
            scores[block][row][lane] = f32::NAN;
        }
        if missing.is_empty() || missing.len() == sensors {
            return;
        }
        gaps.again(missing, &self.mixing, sensors);
        let among = |sensor: usize| {
            let (block, lane) = place(sensor);
            f64::from(mixed[block][row][lane])
        };
        let mut whole: Vec<f64> = (0..sensors).map(among).collect();
        gaps.close(&mut whole);
        for (sensor, score) in whole.into_iter().enumerate() {
            let (block, lane) = place(sensor);
            mixed[block][row][lane] = score as f32;
        }
    }
}

/// Some sixteens of W times the scores of N rows.
#[inline(always)]
fn product<L: Lanes, const N: usize, const T: usize>(
    lanes: L,
    columns: [&[L::Numbers]; T],
    scores: &[Block],
    first: usize,
) -> [[L::Numbers; N]; T] {
    let mut sums = [[lanes.splat(0.0); N]; T];
    for (number, block) in scores.iter().enumerate() {
        let from = number * SIXTEEN;
        let count = SIXTEEN.min(columns[0].len() - from);
        for at in 0..count {
            for (sums, columns) in sums.iter_mut().zip(columns) {
                for (sum, row) in sums.iter_mut().zip(&block[first..]) {
                    *sum = lanes.mul_add(columns[from + at], lanes.splat(row[at]), *sum);
                }
            }
        }
    }
    sums
}
