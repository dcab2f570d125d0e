//! Numbers of many samples side by side, one a lane of SIMD vectors.

use std::fmt::Debug;

use pulp::bytemuck::{cast, cast_slice, cast_slice_mut};
use pulp::{NullaryFnOnce, Scalar, Simd};

/// What is done with a number of each sample. Products are added without rounding in between, on
/// every processor, so that a sample has the same bits in any lane.
pub trait Lanes: Copy + Send + Sync {
    type Numbers: Debug + Copy + Send + Sync;
    type Mask: Copy + Send + Sync;

    /// Samples.
    const COUNT: usize;

    /// Sums of so many numbers times three others stay in registers.
    const TALL: usize;

    fn splat(self, value: f64) -> Self::Numbers;
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn div(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a b + c
    fn mul_add(self, a: Self::Numbers, b: Self::Numbers, c: Self::Numbers) -> Self::Numbers;
    /// c - a b
    fn take_product(self, a: Self::Numbers, b: Self::Numbers, c: Self::Numbers) -> Self::Numbers;
    fn neg(self, a: Self::Numbers) -> Self::Numbers;
    fn abs(self, a: Self::Numbers) -> Self::Numbers;
    fn sqrt(self, a: Self::Numbers) -> Self::Numbers;
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// Whether a <= b; not where one of them is no number.
    fn at_most(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    /// Whether a > b; not where one of them is no number.
    fn above(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn all(self, mask: Self::Mask) -> bool;
    fn any(self, mask: Self::Mask) -> bool;
    fn select(self, mask: Self::Mask, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// Bits of the lanes that are marked, that of the first lowest.
    fn bits(self, mask: Self::Mask) -> u64;

    /// The same, lane by lane.
    fn flat(numbers: &[Self::Numbers]) -> &[f64];
    fn flat_mut(numbers: &mut [Self::Numbers]) -> &mut [f64];

    /// Runs a function compiled for the instructions of these lanes.
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output;

    /// One number a lane.
    #[inline(always)]
    fn load(self, numbers: &[f64]) -> Self::Numbers {
        let mut loaded = [self.splat(0.0)];
        Self::flat_mut(&mut loaded).copy_from_slice(numbers);
        loaded[0]
    }

    #[inline(always)]
    fn store(self, numbers: Self::Numbers, places: &mut [f64]) {
        places.copy_from_slice(Self::flat(&[numbers]));
    }

    /// Columns of rows of numbers into lanes; lanes behind the last row hold the last row again.
    #[inline(always)]
    fn gather(self, lanes: &mut [Self::Numbers], rows: &[f64], from: usize, count: usize) {
        let width = lanes.len();
        if width == 0 {
            return;
        }
        let mut given = [&rows[..0]; MOST];
        for (lane, row) in given[..Self::COUNT].iter_mut().enumerate() {
            *row = &rows[(from + lane.min(count - 1)) * width..][..width];
        }
        let flat = Self::flat_mut(lanes);
        // Squares of numbers, turned one by one: compilers would scatter longer runs, which is
        // slower.
        for (square, places) in flat.chunks_mut(SQUARE * Self::COUNT).enumerate() {
            let first = square * SQUARE;
            if places.len() == SQUARE * Self::COUNT {
                for (lane, row) in given[..Self::COUNT].iter().enumerate() {
                    let row = &row[first..first + SQUARE];
                    for at in 0..SQUARE {
                        places[at * Self::COUNT + lane] = row[at];
                    }
                }
            } else {
                for (column, place) in places.chunks_exact_mut(Self::COUNT).enumerate() {
                    for (value, row) in place.iter_mut().zip(&given) {
                        *value = row[first + column];
                    }
                }
            }
        }
    }

    /// Lanes into the beginnings of rows of `stride` numbers.
    #[inline(always)]
    fn scatter(self, lanes: &[Self::Numbers], rows: &mut [f64], stride: usize, count: usize) {
        let flat = Self::flat(lanes);
        for (lane, row) in rows.chunks_mut(stride).take(count).enumerate() {
            for (column, value) in flat.chunks_exact(Self::COUNT).zip(row) {
                *value = column[lane];
            }
        }
    }
}

/// Samples of the widest lanes, or more.
pub const MOST: usize = 32;

/// Columns that are turned together.
const SQUARE: usize = 8;

/// `P` vectors together: what is worked out for all of them, where numbers stand above all, is
/// worked out once, and their sums do not wait for each other.
#[derive(Debug, Clone, Copy)]
pub struct Packs<S, const P: usize>(pub S);

/// One sample.
pub type One = Packs<Scalar, 1>;
pub const ONE: One = Packs(Scalar);

impl<S: Simd, const P: usize> Packs<S, P> {
    #[inline(always)]
    fn each(
        self,
        a: [S::f64s; P],
        b: [S::f64s; P],
        with: impl Fn(S, S::f64s, S::f64s) -> S::f64s,
    ) -> [S::f64s; P] {
        let mut found = a;
        for at in 0..P {
            found[at] = with(self.0, a[at], b[at]);
        }
        found
    }

    #[inline(always)]
    fn masked(
        self,
        a: [S::f64s; P],
        b: [S::f64s; P],
        with: impl Fn(S, S::f64s, S::f64s) -> S::m64s,
    ) -> [S::m64s; P] {
        let mut found = [with(self.0, a[0], b[0]); P];
        for at in 1..P {
            found[at] = with(self.0, a[at], b[at]);
        }
        found
    }
}

impl<S: Simd, const P: usize> Lanes for Packs<S, P> {
    type Numbers = [S::f64s; P];
    type Mask = [S::m64s; P];

    const COUNT: usize = P * S::F64_LANES;
    const TALL: usize = if S::REGISTER_COUNT >= 32 { 4 } else { 3 };

    #[inline(always)]
    fn splat(self, value: f64) -> Self::Numbers {
        [self.0.splat_f64s(value); P]
    }

    #[inline(always)]
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.add_f64s(a, b),
        )
    }

    #[inline(always)]
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.sub_f64s(a, b),
        )
    }

    #[inline(always)]
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.mul_f64s(a, b),
        )
    }

    #[inline(always)]
    fn div(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.div_f64s(a, b),
        )
    }

    #[inline(always)]
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.min_f64s(a, b),
        )
    }

    #[inline(always)]
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.max_f64s(a, b),
        )
    }

    #[inline(always)]
    fn mul_add(self, a: Self::Numbers, b: Self::Numbers, c: Self::Numbers) -> Self::Numbers {
        let mut found = c;
        for at in 0..P {
            found[at] = self.0.mul_add_f64s(a[at], b[at], c[at]);
        }
        found
    }

    #[inline(always)]
    fn take_product(self, a: Self::Numbers, b: Self::Numbers, c: Self::Numbers) -> Self::Numbers {
        let mut found = c;
        for at in 0..P {
            found[at] = self.0.negate_mul_add_f64s(a[at], b[at], c[at]);
        }
        found
    }

    #[inline(always)]
    fn neg(self, a: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            a,
            #[inline(always)]
            |simd, a, _| simd.neg_f64s(a),
        )
    }

    #[inline(always)]
    fn abs(self, a: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            a,
            #[inline(always)]
            |simd, a, _| simd.abs_f64s(a),
        )
    }

    #[inline(always)]
    fn sqrt(self, a: Self::Numbers) -> Self::Numbers {
        self.each(
            a,
            a,
            #[inline(always)]
            |simd, a, _| simd.sqrt_f64s(a),
        )
    }

    #[inline(always)]
    fn at_most(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask {
        self.masked(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.less_than_or_equal_f64s(a, b),
        )
    }

    #[inline(always)]
    fn above(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask {
        self.masked(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.less_than_f64s(b, a),
        )
    }

    #[inline(always)]
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask {
        self.masked(
            a,
            b,
            #[inline(always)]
            |simd, a, b| simd.equal_f64s(a, b),
        )
    }

    #[inline(always)]
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        let mut found = a;
        for at in 0..P {
            found[at] = self.0.and_m64s(a[at], b[at]);
        }
        found
    }

    #[inline(always)]
    fn all(self, mask: Self::Mask) -> bool {
        let first = |mask| self.0.first_true_m64s(self.0.not_m64s(mask));
        mask.into_iter().all(|mask| first(mask) >= S::F64_LANES)
    }

    #[inline(always)]
    fn any(self, mask: Self::Mask) -> bool {
        let first = |mask| self.0.first_true_m64s(mask);
        mask.into_iter().any(|mask| first(mask) < S::F64_LANES)
    }

    #[inline(always)]
    fn select(self, mask: Self::Mask, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        let mut found = a;
        for at in 0..P {
            found[at] = self.0.select_f64s(mask[at], a[at], b[at]);
        }
        found
    }

    #[inline(always)]
    fn bits(self, mask: Self::Mask) -> u64 {
        let mut bits = 0;
        for (at, mask) in mask.into_iter().enumerate() {
            bits |= if const { size_of::<S::m64s>() == 1 } {
                u64::from(cast::<_, u8>(mask)) << (at * S::F64_LANES)
            } else {
                let lanes = [cast::<_, S::u64s>(mask)];
                let mut own = 0;
                for (lane, marked) in cast_slice::<_, u64>(&lanes).iter().enumerate() {
                    own |= (marked & 1) << (at * S::F64_LANES + lane);
                }
                own
            };
        }
        bits
    }

    #[inline(always)]
    fn flat(numbers: &[Self::Numbers]) -> &[f64] {
        cast_slice(numbers.as_flattened())
    }

    #[inline(always)]
    fn flat_mut(numbers: &mut [Self::Numbers]) -> &mut [f64] {
        cast_slice_mut(numbers.as_flattened_mut())
    }

    #[inline(always)]
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output {
        self.0.vectorize(function)
    }
}
