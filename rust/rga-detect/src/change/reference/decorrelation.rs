//! From scores to independent scores.

use rga_simd::f32::{Lanes, SIXTEEN};

use super::Reference;
use crate::change::Block;

/// Sweeps that fill missing scores with what the others of the row let expect.
const SWEEPS: usize = 8;

impl Reference {
    /// N rows, from one on, worked out in as much space. `GAPS`: some scores are NaN, which stays.
    #[inline(always)]
    pub(super) fn mix<L: Lanes, const N: usize, const GAPS: bool>(
        &self,
        lanes: L,
        scores: &mut [Block],
        mixed: &mut [Block],
        first: usize,
    ) {
        if GAPS {
            self.products_with_gaps(lanes, scores, mixed, first);
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

    /// Missing scores take the values that are likeliest beside the others: those that make the
    /// sum of squares of the independent scores least, found one after the other.
    #[inline(always)]
    fn products_with_gaps<L: Lanes>(
        &self,
        lanes: L,
        scores: &mut [Block],
        mixed: &mut [Block],
        row: usize,
    ) {
        let sensors = self.sensors();
        let place = |sensor: usize| (sensor / SIXTEEN, sensor % SIXTEEN);
        let mut missing = Vec::new();
        for sensor in 0..sensors {
            let (block, lane) = place(sensor);
            let score = &mut scores[block][row][lane];
            if score.is_nan() {
                missing.push(sensor);
                *score = 0.0;
            }
        }
        self.products::<L, 1>(lanes, scores, mixed, row);
        for _ in 0..SWEEPS {
            for sensor in &missing {
                let own = &self.mixing[sensor * sensors..][..sensors];
                let blocks = own.chunks(SIXTEEN).zip(&mut *mixed);
                let mut along = 0.0;
                for (own, block) in blocks {
                    for (w, score) in own.iter().zip(&block[row]) {
                        along += w * f64::from(*score);
                    }
                }
                let length: f64 = own.iter().map(|w| w * w).sum();
                let step = -along / length;
                for (own, block) in own.chunks(SIXTEEN).zip(&mut *mixed) {
                    for (w, score) in own.iter().zip(&mut block[row]) {
                        *score += (step * w) as f32;
                    }
                }
            }
        }
        for sensor in missing {
            let (block, lane) = place(sensor);
            scores[block][row][lane] = f32::NAN;
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
