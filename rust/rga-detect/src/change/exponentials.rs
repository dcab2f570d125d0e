//! Exponentials.

use std::f32::consts::{LN_2, LOG2_E};

use rga_simd::f32::Lanes;

/// Added to a number below 2^22 in size, it leaves the nearest whole number in the last bits.
const ROUNDING: f32 = 1.5 * (1 << 23) as f32;

/// e^x and e^-x where |x| is 80 at most, to five digits.
///
/// Series of cosh and sinh of what x differs by from the nearest multiple of ln 2; then powers of 2.
#[inline(always)]
pub(super) fn powers<L: Lanes>(lanes: L, x: L::Numbers) -> (L::Numbers, L::Numbers) {
    let rounding = lanes.splat(ROUNDING);
    let times = lanes.mul_add(x, lanes.splat(LOG2_E), rounding);
    let rest = lanes.mul_add(lanes.sub(times, rounding), lanes.splat(-LN_2), x);
    let square = lanes.mul(rest, rest);
    let even = series(lanes, square, 1.0 / 24.0, 1.0 / 2.0);
    let odd = lanes.mul(series(lanes, square, 1.0 / 120.0, 1.0 / 6.0), rest);
    (
        lanes.doubled(lanes.add(even, odd), times),
        lanes.halved(lanes.sub(even, odd), times),
    )
}

/// 1 + second x^2 + third x^4
#[inline(always)]
fn series<L: Lanes>(lanes: L, square: L::Numbers, third: f32, second: f32) -> L::Numbers {
    let inner = lanes.mul_add(square, lanes.splat(third), lanes.splat(second));
    lanes.mul_add(inner, square, lanes.splat(1.0))
}
