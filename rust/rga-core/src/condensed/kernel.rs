//! The condensed solve, one sample a SIMD lane.
//!
//! Every sum is a chain of fused multiply-adds, so a row has the same bits in any lane of any
//! instruction set.

use pulp::bytemuck::{cast_slice, cast_slice_mut};
use pulp::{Simd, WithSimd};

use super::Condensed;

/// A pivot below this part of its diagonal has no digits left.
const SINGULAR: f64 = 1e-12;

/// Outputs of rows; gives the first row whose structure is not stable.
pub struct Kernel<'a> {
    pub condensed: &'a Condensed,
    pub coefficients: &'a [f64],
    pub changes: &'a [f64],
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
        let many = PACK * S::F64_LANES;
        let rows = self.results.len() / outputs.max(1);
        let mut samples = Samples::new(simd, self.condensed);
        let mut shown = vec![[simd.splat_f64s(0.0); PACK]; outputs];
        for from in (0..rows).step_by(many) {
            let count = many.min(rows - from);
            samples.load(self.coefficients, self.changes, from, count);
            if let Some(lane) = samples.solve(simd, count) {
                return Some(from + lane);
            }
            shown.fill([simd.splat_f64s(0.0); PACK]);
            add_product::<S>(simd, &samples.coefficients, loaded, &mut shown);
            add_product::<S>(simd, &samples.pseudo, influence, &mut shown);
            scatter::<S>(&shown, &mut self.results[from * outputs..], outputs, count);
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

/// Vectors that are worked on together: their sums do not wait for each other.
pub const PACK: usize = 2;

/// One number of as many samples as there are lanes in a pack of vectors.
pub type Pack<S> = [<S as Simd>::f64s; PACK];

/// As many samples as a pack has lanes.
pub struct Samples<'a, S: Simd> {
    condensed: &'a Condensed,
    /// `[p]` q
    pub coefficients: Vec<Pack<S>>,
    /// `[r]` d
    pub changes: Vec<Pack<S>>,
    /// Lower triangle of H + diag(d) column by column; then L of L D L', with 1 / D on its
    /// diagonal.
    factor: Vec<Pack<S>>,
    /// `[r]` v
    pub elongations: Vec<Pack<S>>,
    /// `[r]` minus w
    pub pseudo: Vec<Pack<S>>,
}

impl<'a, S: Simd> Samples<'a, S> {
    #[inline(always)]
    pub fn new(simd: S, condensed: &'a Condensed) -> Self {
        let zero = [simd.splat_f64s(0.0); PACK];
        let Condensed {
            patterns, terms, ..
        } = *condensed;
        Self {
            condensed,
            coefficients: vec![zero; patterns],
            changes: vec![zero; terms],
            factor: vec![zero; terms * (terms + 1) / 2],
            elongations: vec![zero; terms],
            pseudo: vec![zero; terms],
        }
    }

    /// Lanes behind the last row hold the last row again.
    #[inline(always)]
    pub fn load(&mut self, coefficients: &[f64], changes: &[f64], from: usize, count: usize) {
        gather::<S>(&mut self.coefficients, coefficients, from, count);
        gather::<S>(&mut self.changes, changes, from, count);
    }

    /// Factorises H + diag(d) and finds v and w; gives the first lane that is not stable.
    #[inline(always)]
    pub fn solve(&mut self, simd: S, count: usize) -> Option<usize> {
        if let Some(lane) = self.factorise(simd, count) {
            return Some(lane);
        }
        let mut elongations = std::mem::take(&mut self.elongations);
        elongations.fill([simd.splat_f64s(0.0); PACK]);
        add_product::<S>(
            simd,
            &self.coefficients,
            &self.condensed.driven,
            &mut elongations,
        );
        self.substitute(simd, &mut elongations);
        for ((w, v), d) in self.pseudo.iter_mut().zip(&elongations).zip(&self.changes) {
            *w = [simd.splat_f64s(0.0); PACK];
            take_product::<S>(simd, d, v, w);
        }
        self.elongations = elongations;
        None
    }

    /// Right-looking: the updates of a column do not wait for each other.
    #[inline(always)]
    fn factorise(&mut self, simd: S, count: usize) -> Option<usize> {
        let (terms, stiffness) = (self.condensed.terms, &self.condensed.stiffness);
        let mut rest = &mut self.factor[..];
        for column in 0..terms {
            let (own, behind) = rest.split_at_mut(terms - column);
            let given = &stiffness[column * terms + column..(column + 1) * terms];
            for (entry, value) in own.iter_mut().zip(given) {
                *entry = [simd.splat_f64s(*value); PACK];
            }
            for (entry, change) in own[0].iter_mut().zip(self.changes[column]) {
                *entry = simd.add_f64s(*entry, change);
            }
            rest = behind;
        }
        let mut rest = &mut self.factor[..];
        for column in 0..terms {
            let (own, mut behind) = rest.split_at_mut(terms - column);
            let least = simd.splat_f64s(SINGULAR * stiffness[column * terms + column]);
            let mut inverse = own[0];
            for at in 0..PACK {
                // Written so that NaN is refused as well.
                let weak = simd.not_m64s(simd.less_than_f64s(least, own[0][at]));
                if simd.first_true_m64s(weak) < S::F64_LANES {
                    let stable =
                        |pivot: &f64| *pivot > SINGULAR * stiffness[column * terms + column];
                    let pivots: &[f64] = cast_slice(own[0].as_slice());
                    // Lanes behind the last row repeat it.
                    let lane = pivots
                        .iter()
                        .position(|pivot| !stable(pivot))
                        .unwrap_or_default();
                    return Some(lane.min(count - 1));
                }
                inverse[at] = simd.div_f64s(simd.splat_f64s(1.0), own[0][at]);
            }
            own[0] = inverse;
            for row in 1..own.len() {
                let mut scaled = own[row];
                for at in 0..PACK {
                    scaled[at] = simd.mul_f64s(scaled[at], inverse[at]);
                }
                let (other, further) = behind.split_at_mut(terms - column - row);
                for (entry, before) in other.iter_mut().zip(&own[row..]) {
                    take_product::<S>(simd, &scaled, before, entry);
                }
                behind = further;
            }
            for entry in &mut own[1..] {
                for at in 0..PACK {
                    entry[at] = simd.mul_f64s(entry[at], inverse[at]);
                }
            }
            rest = &mut rest[terms - column..];
        }
        None
    }

    /// Solves (H + diag(d)) x = right in place.
    #[inline(always)]
    pub fn substitute(&self, simd: S, right: &mut [Pack<S>]) {
        let terms = right.len();
        let mut rest = &self.factor[..];
        for column in 0..terms {
            let (own, behind) = rest.split_at(terms - column);
            let (known, below) = right[column..].split_at_mut(1);
            for (value, factor) in below.iter_mut().zip(&own[1..]) {
                take_product::<S>(simd, factor, &known[0], value);
            }
            for at in 0..PACK {
                known[0][at] = simd.mul_f64s(known[0][at], own[0][at]);
            }
            rest = behind;
        }
        let mut end = self.factor.len();
        for column in (0..terms).rev() {
            let own = &self.factor[end - (terms - column)..end];
            let (known, below) = right[column..].split_at_mut(1);
            for (value, factor) in below.iter().zip(&own[1..]) {
                take_product::<S>(simd, factor, value, &mut known[0]);
            }
            end -= terms - column;
        }
    }
}

/// `sum` -= `left` times `right`
#[inline(always)]
pub fn take_product<S: Simd>(simd: S, left: &Pack<S>, right: &Pack<S>, sum: &mut Pack<S>) {
    for ((sum, left), right) in sum.iter_mut().zip(left).zip(right) {
        *sum = simd.negate_mul_add_f64s(*left, *right, *sum);
    }
}

/// `sums` `[n]` += `factors` `[k]` times `matrix` `[k, n]`, for each lane.
#[inline(always)]
pub fn add_product<S: Simd>(simd: S, factors: &[Pack<S>], matrix: &[f64], sums: &mut [Pack<S>]) {
    const BAND: usize = 4;
    let width = sums.len();
    let mut bands = sums.chunks_exact_mut(BAND);
    let mut first = 0;
    for band in &mut bands {
        let mut own = [band[0], band[1], band[2], band[3]];
        for (factor, row) in factors.iter().zip(matrix.chunks_exact(width)) {
            let row = &row[first..first + BAND];
            for (sum, value) in own.iter_mut().zip(row) {
                let value = simd.splat_f64s(*value);
                for at in 0..PACK {
                    sum[at] = simd.mul_add_f64s(factor[at], value, sum[at]);
                }
            }
        }
        band.copy_from_slice(&own);
        first += BAND;
    }
    for (place, sum) in bands.into_remainder().iter_mut().enumerate() {
        for (factor, row) in factors.iter().zip(matrix.chunks_exact(width)) {
            let value = simd.splat_f64s(row[first + place]);
            for at in 0..PACK {
                sum[at] = simd.mul_add_f64s(factor[at], value, sum[at]);
            }
        }
    }
}

/// Columns of rows into lanes.
#[inline(always)]
pub fn gather<S: Simd>(packs: &mut [Pack<S>], rows: &[f64], from: usize, count: usize) {
    let width = packs.len();
    if width == 0 {
        return;
    }
    let many = PACK * S::F64_LANES;
    let flat: &mut [f64] = cast_slice_mut(packs.as_flattened_mut());
    for lane in 0..many {
        let row = &rows[(from + lane.min(count - 1)) * width..][..width];
        for (column, value) in flat.chunks_exact_mut(many).zip(row) {
            column[lane] = *value;
        }
    }
}

/// Lanes into the beginnings of rows of `stride` numbers.
#[inline(always)]
pub fn scatter<S: Simd>(packs: &[Pack<S>], rows: &mut [f64], stride: usize, count: usize) {
    let many = PACK * S::F64_LANES;
    let flat: &[f64] = cast_slice(packs.as_flattened());
    for (lane, row) in rows.chunks_mut(stride).take(count).enumerate() {
        for (column, value) in flat.chunks_exact(many).zip(row) {
            *value = column[lane];
        }
    }
}
