//! Sixteen sensors side by side, in vectors of whatever width the instructions have.
//!
//! Nothing is fused, and sums of lanes are formed in one order, so that results have the same
//! bits on all instructions.

use pulp::bytemuck::{cast_slice, cast_slice_mut};
use pulp::{Arch, Simd, WithSimd};

pub const SIXTEEN: usize = 16;

/// Sixteen numbers of single precision in `P` vectors.
#[derive(Debug, Clone, Copy)]
pub struct Sixteen<S, const P: usize>(S);

/// What is done with sixteen numbers.
pub trait Lanes: Copy {
    type Numbers: Copy;
    type Mask: Copy;

    fn splat(self, value: f32) -> Self::Numbers;
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    fn select(self, mask: Self::Mask, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;

    /// Numbers that lie in whole sixteens.
    fn vectors(flat: &[f32]) -> &[Self::Numbers];
    fn vectors_mut(flat: &mut [f32]) -> &mut [Self::Numbers];
    fn flat(numbers: &Self::Numbers) -> &[f32];

    /// Halves are added until one number is left.
    fn sum(self, numbers: Self::Numbers) -> f32;
    /// Halves are multiplied until one number is left.
    fn product(self, numbers: Self::Numbers) -> f32;
    /// Number n and number n + 8 added, for n below 8, twice over.
    fn halves(self, numbers: Self::Numbers) -> Self::Numbers;
    /// Whether some number of `a` is that of `b` or more.
    fn any_reaches(self, a: Self::Numbers, b: Self::Numbers) -> bool;
}

/// Work that is done sixteen numbers at a time.
pub trait OnSixteen {
    fn run<L: Lanes>(self, lanes: L);
}

/// Runs work on the vectors of an instruction set.
pub fn on_sixteen(arch: Arch, work: impl OnSixteen) {
    arch.dispatch(Dispatched(work));
}

/// Sixteens that hold so many numbers.
pub fn sixteens(numbers: usize) -> usize {
    numbers.div_ceil(SIXTEEN)
}

struct Dispatched<W>(W);

impl<W: OnSixteen> WithSimd for Dispatched<W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match S::F32_LANES {
            16 => self.0.run(Sixteen::<S, 1>(simd)),
            8 => self.0.run(Sixteen::<S, 2>(simd)),
            4 => self.0.run(Sixteen::<S, 4>(simd)),
            _ => self.0.run(Sixteen::<S, 16>(simd)),
        }
    }
}

impl<S: Simd, const P: usize> Sixteen<S, P> {
    #[inline(always)]
    fn each(
        a: [S::f32s; P],
        b: [S::f32s; P],
        with: impl Fn(S::f32s, S::f32s) -> S::f32s,
    ) -> [S::f32s; P] {
        let mut found = a;
        for at in 0..P {
            found[at] = with(a[at], b[at]);
        }
        found
    }

    /// Joins halves until one number is left.
    #[inline(always)]
    fn fold(self, numbers: [S::f32s; P], with: impl Fn(S::f32s, S::f32s) -> S::f32s) -> f32 {
        let mut rest = numbers;
        let mut vectors = P;
        while vectors > 1 {
            vectors /= 2;
            for at in 0..vectors {
                rest[at] = with(rest[at], rest[at + vectors]);
            }
        }
        let mut numbers = S::F32_LANES;
        while numbers > 1 {
            numbers /= 2;
            rest[0] = with(rest[0], self.0.rotate_right_f32s(rest[0], numbers));
        }
        cast_slice(&rest[..1])[0]
    }
}

macro_rules! each {
    ($($name:ident => $with:ident),*) => {$(
        #[inline(always)]
        fn $name(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
            Self::each(
                a,
                b,
                #[inline(always)]
                |a, b| self.0.$with(a, b),
            )
        }
    )*};
}

impl<S: Simd, const P: usize> Lanes for Sixteen<S, P> {
    type Numbers = [S::f32s; P];
    type Mask = [S::m32s; P];

    each!(
        add => add_f32s,
        sub => sub_f32s,
        mul => mul_f32s,
        min => min_f32s,
        max => max_f32s
    );

    #[inline(always)]
    fn sum(self, numbers: Self::Numbers) -> f32 {
        self.fold(
            numbers,
            #[inline(always)]
            |a, b| self.0.add_f32s(a, b),
        )
    }

    #[inline(always)]
    fn product(self, numbers: Self::Numbers) -> f32 {
        self.fold(
            numbers,
            #[inline(always)]
            |a, b| self.0.mul_f32s(a, b),
        )
    }

    #[inline(always)]
    fn halves(self, numbers: Self::Numbers) -> Self::Numbers {
        let mut found = numbers;
        for at in 0..P {
            let other = if P == 1 {
                self.0.rotate_right_f32s(numbers[0], SIXTEEN / 2)
            } else {
                numbers[(at + P / 2) % P]
            };
            found[at] = self.0.add_f32s(numbers[at], other);
        }
        found
    }

    #[inline(always)]
    fn any_reaches(self, a: Self::Numbers, b: Self::Numbers) -> bool {
        (0..P).any(
            #[inline(always)]
            |at| {
                let reaches = self.0.greater_than_or_equal_f32s(a[at], b[at]);
                self.0.first_true_m32s(reaches) < S::F32_LANES
            },
        )
    }

    #[inline(always)]
    fn splat(self, value: f32) -> Self::Numbers {
        [self.0.splat_f32s(value); P]
    }

    #[inline(always)]
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask {
        let mut found = [self.0.equal_f32s(a[0], b[0]); P];
        for at in 1..P {
            found[at] = self.0.equal_f32s(a[at], b[at]);
        }
        found
    }

    #[inline(always)]
    fn select(self, mask: Self::Mask, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers {
        let mut found = a;
        for at in 0..P {
            found[at] = self.0.select_f32s(mask[at], a[at], b[at]);
        }
        found
    }

    #[inline(always)]
    fn vectors(flat: &[f32]) -> &[Self::Numbers] {
        cast_slice::<f32, S::f32s>(flat).as_chunks().0
    }

    #[inline(always)]
    fn vectors_mut(flat: &mut [f32]) -> &mut [Self::Numbers] {
        cast_slice_mut::<f32, S::f32s>(flat).as_chunks_mut().0
    }

    #[inline(always)]
    fn flat(numbers: &Self::Numbers) -> &[f32] {
        cast_slice(numbers)
    }
}
