//! Exponentials.

use super::sixteen::Lanes;

/// e^x and e^-x where |x| is 3/8 times 2^halvings at most, to five digits.
///
/// Series of cosh and sinh at x / 2^halvings; then squares.
#[inline(always)]
pub fn powers<L: Lanes>(lanes: L, x: L::Numbers, halvings: i32) -> (L::Numbers, L::Numbers) {
    let small = lanes.mul(x, lanes.splat(0.5f32.powi(halvings)));
    let square = lanes.mul(small, small);
    let even = series(lanes, square, 1.0 / 24.0, 1.0 / 2.0);
    let odd = lanes.mul(series(lanes, square, 1.0 / 120.0, 1.0 / 6.0), small);
    let (mut up, mut down) = (lanes.add(even, odd), lanes.sub(even, odd));
    for _ in 0..halvings {
        (up, down) = (lanes.mul(up, up), lanes.mul(down, down));
    }
    (up, down)
}

/// 1 + second x^2 + third x^4
#[inline(always)]
fn series<L: Lanes>(lanes: L, square: L::Numbers, third: f32, second: f32) -> L::Numbers {
    let inner = lanes.add(lanes.mul(square, lanes.splat(third)), lanes.splat(second));
    lanes.add(lanes.mul(inner, square), lanes.splat(1.0))
}
