//! The condensed solve, one sample a SIMD lane.
//!
//! Every sum is a chain of fused multiply-adds, so a row has the same bits in any lane of any
//! instruction set.

use pulp::{Simd, WithSimd};
use rga_simd::f64::{Lanes, Packs};

use super::Condensed;
use super::samples::{Samples, Together, add_product};

/// Outputs of rows; gives the first row whose structure is not stable.
pub(super) struct Kernel<'a> {
    pub condensed: &'a Condensed,
    pub coefficients: &'a [f64],
    pub stiffness: &'a [f64],
    pub results: &'a mut [f64],
}

impl WithSimd for Kernel<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<usize> {
        let Condensed {
            patterns,
            terms,
            outputs,
            ref loaded,
            ref influence,
            ..
        } = *self.condensed;
        if terms == 0 {
            combine(
                simd,
                self.coefficients,
                patterns,
                loaded,
                outputs,
                self.results,
            );
            return None;
        }
        let lanes: Together<S> = Packs(simd);
        let many = Together::<S>::COUNT;
        let rows = self.results.len() / outputs.max(1);
        let mut samples = Samples::new(lanes, self.condensed);
        let mut shown = vec![lanes.splat(0.0); outputs];
        for from in (0..rows).step_by(many) {
            let count = many.min(rows - from);
            samples.load(self.coefficients, self.stiffness, from, count);
            if let Some(lane) = samples.solve(count) {
                return Some(from + lane);
            }
            shown.fill(lanes.splat(0.0));
            add_product(lanes, &samples.coefficients, loaded, &mut shown);
            add_product(lanes, &samples.pseudo, influence, &mut shown);
            lanes.scatter(&shown, &mut self.results[from * outputs..], outputs, count);
        }
        None
    }
}

/// y = q Y for many rows: the outputs of a row lie in the lanes.
#[inline(always)]
fn combine<S: Simd>(
    simd: S,
    coefficients: &[f64],
    patterns: usize,
    loaded: &[f64],
    outputs: usize,
    results: &mut [f64],
) {
    if patterns == 0 || outputs == 0 {
        return;
    }
    // Outputs in bands of whole vectors, each band one pattern behind the other.
    let band = WIDE * S::F64_LANES;
    let zero = simd.splat_f64s(0.0);
    for first in (0..outputs).step_by(band) {
        let mut units = vec![[zero; WIDE]; patterns];
        for (row, unit) in loaded.chunks_exact(outputs).zip(&mut units) {
            let part = &row[first..outputs.min(first + band)];
            for (part, vector) in part.chunks(S::F64_LANES).zip(unit) {
                *vector = simd.partial_load_f64s(part);
            }
        }
        let mut given = coefficients.chunks_exact(TALL * patterns);
        let mut shown = results.chunks_exact_mut(TALL * outputs);
        for (given, shown) in (&mut given).zip(&mut shown) {
            tile::<S, TALL>(simd, given, &units, &mut shown[first..], outputs, first);
        }
        let left = given.remainder().chunks_exact(patterns);
        for (given, shown) in left.zip(shown.into_remainder().chunks_exact_mut(outputs)) {
            tile::<S, 1>(simd, given, &units, &mut shown[first..], outputs, first);
        }
    }
}

/// Rows and vectors of a tile whose sums stay in registers.
const TALL: usize = 6;
const WIDE: usize = 2;

/// `shown` begins at the output `first` of the first row.
#[inline(always)]
fn tile<S: Simd, const ROWS: usize>(
    simd: S,
    given: &[f64],
    units: &[[S::f64s; WIDE]],
    shown: &mut [f64],
    outputs: usize,
    first: usize,
) {
    let patterns = units.len();
    // Slices of one length: no index is checked in the loop.
    let rows: [&[f64]; ROWS] = std::array::from_fn(|row| &given[row * patterns..][..patterns]);
    let mut sums = [[simd.splat_f64s(0.0); WIDE]; ROWS];
    for pattern in 0..patterns {
        let unit = units[pattern];
        for row in 0..ROWS {
            let q = simd.splat_f64s(rows[row][pattern]);
            for at in 0..WIDE {
                sums[row][at] = simd.mul_add_f64s(q, unit[at], sums[row][at]);
            }
        }
    }
    let width = (outputs - first).min(WIDE * S::F64_LANES);
    for (row, sums) in sums.into_iter().enumerate() {
        let part = &mut shown[row * outputs..row * outputs + width];
        let (whole, rest) = S::as_mut_simd_f64s(part);
        whole.copy_from_slice(&sums[..whole.len()]);
        if let Some(last) = sums.get(whole.len()) {
            simd.partial_store_f64s(rest, *last);
        }
    }
}
