//! Sixteen numbers of single precision side by side, in vectors of whatever width the
//! instructions have.
//!
//! Products are added without rounding in between, and sums of lanes are formed in one order, so
//! that results have the same bits on all instructions.

use pulp::bytemuck::{cast, cast_slice, cast_slice_mut};
use pulp::{Arch, Simd, WithSimd};

pub const SIXTEEN: usize = 16;

/// Sixteen numbers of single precision in `P` vectors.
#[derive(Debug, Clone, Copy)]
struct Sixteen<S, const P: usize>(S);

/// What is done with sixteen numbers.
pub trait Lanes: Copy {
    type Numbers: Copy;
    type Mask: Copy;

    fn splat(self, value: f32) -> Self::Numbers;
    fn add(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn sub(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn mul(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    /// a b + c
    fn mul_add(self, a: Self::Numbers, b: Self::Numbers, c: Self::Numbers) -> Self::Numbers;
    fn min(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn max(self, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;
    fn equal(self, a: Self::Numbers, b: Self::Numbers) -> Self::Mask;
    fn select(self, mask: Self::Mask, a: Self::Numbers, b: Self::Numbers) -> Self::Numbers;

    /// Doubled as many times as the last bits of `times` tell.
    fn doubled(self, a: Self::Numbers, times: Self::Numbers) -> Self::Numbers;
    fn halved(self, a: Self::Numbers, times: Self::Numbers) -> Self::Numbers;

    /// Numbers that lie in whole sixteens.
    fn vectors(flat: &[f32]) -> &[Self::Numbers];
    fn vectors_mut(flat: &mut [f32]) -> &mut [Self::Numbers];
    fn flat(numbers: &Self::Numbers) -> &[f32];

    /// Of N rows, from one on.
    #[inline(always)]
    fn load<const N: usize>(self, rows: &[[f32; SIXTEEN]], first: usize) -> [Self::Numbers; N] {
        let mut found = [self.splat(0.0); N];
        for (found, row) in found.iter_mut().zip(&rows[first..]) {
            *found = Self::vectors(row)[0];
        }
        found
    }

    #[inline(always)]
    fn store<const N: usize>(
        self,
        numbers: [Self::Numbers; N],
        rows: &mut [[f32; SIXTEEN]],
        first: usize,
    ) {
        for (numbers, row) in numbers.into_iter().zip(&mut rows[first..]) {
            Self::vectors_mut(row)[0] = numbers;
        }
    }

    /// Halves are added until one number is left.
    fn sum(self, numbers: Self::Numbers) -> f32;
    /// Halves are multiplied until one number is left.
    fn product(self, numbers: Self::Numbers) -> f32;
    /// The same of each of N sixteens.
    fn sums<const N: usize>(self, numbers: [Self::Numbers; N]) -> [f32; N];
    fn products<const N: usize>(self, numbers: [Self::Numbers; N]) -> [f32; N];
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
#[inline]
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
        let mut rest = Self::in_vector(numbers, &with);
        let mut numbers = S::F32_LANES;
        while numbers > 1 {
            numbers /= 2;
            rest = with(rest, self.0.rotate_right_f32s(rest, numbers));
        }
        cast_slice(&[rest])[0]
    }

    #[inline(always)]
    fn in_vector(numbers: [S::f32s; P], with: impl Fn(S::f32s, S::f32s) -> S::f32s) -> S::f32s {
        let mut rest = numbers;
        let mut vectors = P;
        while vectors > 1 {
            vectors /= 2;
            for at in 0..vectors {
                rest[at] = with(rest[at], rest[at + vectors]);
            }
        }
        rest[0]
    }

    #[inline(always)]
    fn fold_each<const N: usize>(
        self,
        numbers: [[S::f32s; P]; N],
        with: impl Fn(S::f32s, S::f32s) -> S::f32s,
    ) -> [f32; N] {
        let mut found = [0.0; N];
        let (fours, rest) = numbers.as_chunks::<4>();
        let (found_fours, found_rest) = found.as_chunks_mut::<4>();
        for (found, four) in found_fours.iter_mut().zip(fours) {
            *found = self.fold_four(*four, &with);
        }
        for (found, one) in found_rest.iter_mut().zip(rest) {
            *found = self.fold(*one, &with);
        }
        found
    }

    /// Halves of two share a vector, then quarters of four.
    #[inline(always)]
    fn fold_four(
        self,
        numbers: [[S::f32s; P]; 4],
        with: impl Fn(S::f32s, S::f32s) -> S::f32s,
    ) -> [f32; 4] {
        let lanes = S::F32_LANES;
        let [a, b, c, d] = numbers;
        if lanes < 4 {
            return [
                self.fold(a, &with),
                self.fold(b, &with),
                self.fold(c, &with),
                self.fold(d, &with),
            ];
        }
        let (half, quarter) = (lanes / 2, lanes / 4);
        let (a, b) = (Self::in_vector(a, &with), Self::in_vector(b, &with));
        let (c, d) = (Self::in_vector(c, &with), Self::in_vector(d, &with));
        let (ab, cd) = (self.join(a, b, half, &with), self.join(c, d, half, &with));
        let mut rest = self.join(ab, cd, quarter, &with);
        let mut numbers = quarter;
        while numbers > 1 {
            numbers /= 2;
            rest = with(rest, self.0.rotate_left_f32s(rest, numbers));
        }
        let found = [rest];
        let flat = cast_slice(&found);
        [flat[0], flat[half], flat[quarter], flat[half + quarter]]
    }

    /// The last bits, where numbers have their exponents.
    #[inline(always)]
    fn in_exponent(self, times: S::f32s) -> S::u32s {
        let bits = self.0.splat_u32s(f32::MANTISSA_DIGITS - 1);
        self.0.wrapping_dyn_shl_u32s(cast(times), bits)
    }

    /// Lanes joined with those so many further on: of `a` where that bit of the lane is 0, of `b`
    /// where it is 1.
    #[inline(always)]
    fn join(
        self,
        a: S::f32s,
        b: S::f32s,
        distance: usize,
        with: impl Fn(S::f32s, S::f32s) -> S::f32s,
    ) -> S::f32s {
        let mut bits = [0.0; SIXTEEN];
        for (lane, bit) in bits.iter_mut().enumerate() {
            *bit = f32::from(u8::from(lane & distance > 0));
        }
        let bits = cast_slice::<f32, S::f32s>(&bits[..S::F32_LANES])[0];
        let first = self.0.equal_f32s(bits, self.0.splat_f32s(0.0));
        let near = self.0.select_f32s(first, a, b);
        let above = self.0.rotate_left_f32s(a, distance);
        let below = self.0.rotate_right_f32s(b, distance);
        with(near, self.0.select_f32s(first, above, below))
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
    fn mul_add(self, a: Self::Numbers, b: Self::Numbers, c: Self::Numbers) -> Self::Numbers {
        let mut found = a;
        for at in 0..P {
            found[at] = self.0.mul_add_f32s(a[at], b[at], c[at]);
        }
        found
    }

    #[inline(always)]
    fn doubled(self, a: Self::Numbers, times: Self::Numbers) -> Self::Numbers {
        let mut found = a;
        for at in 0..P {
            let sum = self.0.add_u32s(cast(a[at]), self.in_exponent(times[at]));
            found[at] = cast(sum);
        }
        found
    }

    #[inline(always)]
    fn halved(self, a: Self::Numbers, times: Self::Numbers) -> Self::Numbers {
        let mut found = a;
        for at in 0..P {
            let difference = self.0.sub_u32s(cast(a[at]), self.in_exponent(times[at]));
            found[at] = cast(difference);
        }
        found
    }

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
    fn sums<const N: usize>(self, numbers: [Self::Numbers; N]) -> [f32; N] {
        self.fold_each(
            numbers,
            #[inline(always)]
            |a, b| self.0.add_f32s(a, b),
        )
    }

    #[inline(always)]
    fn products<const N: usize>(self, numbers: [Self::Numbers; N]) -> [f32; N] {
        self.fold_each(
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
