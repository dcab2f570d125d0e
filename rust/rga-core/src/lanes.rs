//! Rows of numbers in the lanes of SIMD vectors, and the instruction sets that a processor has.

use pulp::bytemuck::{cast_slice, cast_slice_mut};
use pulp::{Arch, Simd};

use crate::error::{Error, Result};

/// Instruction sets of this processor that samples can be solved with, the best first.
pub fn instructions() -> Vec<&'static str> {
    known().into_iter().map(|(name, _)| name).collect()
}

/// The instruction set of a name; nothing names the best.
pub fn instructions_named(name: Option<&str>) -> Result<Arch> {
    let Some(wanted) = name else {
        return Ok(Arch::new());
    };
    let known = known();
    match known.iter().find(|(name, _)| *name == wanted) {
        Some((_, arch)) => Ok(*arch),
        None => Err(Error::invalid(format!(
            "instructions is {wanted:?}; this processor has {}",
            instructions().join(", ")
        ))),
    }
}

#[cfg(target_arch = "x86_64")]
fn known() -> Vec<(&'static str, Arch)> {
    use pulp::x86::{V3, V4};
    let avx512 = V4::try_new().map(|simd| ("avx512", Arch::V4(simd)));
    let avx2 = V3::try_new().map(|simd| ("avx2", Arch::V3(simd)));
    let all = [avx512, avx2, Some(("portable", Arch::Scalar))];
    all.into_iter().flatten().collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn known() -> Vec<(&'static str, Arch)> {
    let mut known = vec![("portable", Arch::Scalar)];
    if !matches!(Arch::new(), Arch::Scalar) {
        known.insert(0, (std::env::consts::ARCH, Arch::new()));
    }
    known
}

/// Columns of rows of numbers into lanes; lanes behind the last row hold the last row again.
#[inline(always)]
pub fn gather<S: Simd>(lanes: &mut [S::f64s], rows: &[f64], from: usize, count: usize) {
    let width = lanes.len();
    if width == 0 {
        return;
    }
    let mut given = [&rows[..0]; MOST_LANES];
    for (lane, row) in given[..S::F64_LANES].iter_mut().enumerate() {
        *row = &rows[(from + lane.min(count - 1)) * width..][..width];
    }
    let flat: &mut [f64] = cast_slice_mut(lanes);
    // Squares of numbers, turned one by one: compilers would scatter longer runs, which is slower.
    for (square, places) in flat.chunks_mut(S::F64_LANES * S::F64_LANES).enumerate() {
        let first = square * S::F64_LANES;
        if places.len() == S::F64_LANES * S::F64_LANES {
            for (lane, row) in given[..S::F64_LANES].iter().enumerate() {
                let row = &row[first..first + S::F64_LANES];
                for at in 0..S::F64_LANES {
                    places[at * S::F64_LANES + lane] = row[at];
                }
            }
        } else {
            for (column, place) in places.chunks_exact_mut(S::F64_LANES).enumerate() {
                for (value, row) in place.iter_mut().zip(&given) {
                    *value = row[first + column];
                }
            }
        }
    }
}

/// Lanes of the widest vectors, or more.
pub const MOST_LANES: usize = 16;

/// Lanes into the beginnings of rows of `stride` numbers.
#[inline(always)]
pub fn scatter<S: Simd>(lanes: &[S::f64s], rows: &mut [f64], stride: usize, count: usize) {
    let flat: &[f64] = cast_slice(lanes);
    for (lane, row) in rows.chunks_mut(stride).take(count).enumerate() {
        for (column, value) in flat.chunks_exact(S::F64_LANES).zip(row) {
            *value = column[lane];
        }
    }
}

