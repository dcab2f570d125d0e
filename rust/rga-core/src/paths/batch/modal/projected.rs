//! Small pencils of many samples, one a lane: G x = m H x with H positive definite.
//!
//! H is factorised, and what is left is turned into a diagonal by Jacobi's rotations (Golub and Van
//! Loan, Matrix Computations, 2013, section 8.5). A lane in which nothing is left to turn stays as
//! it is while others turn: its bits do not depend on them.

use pulp::NullaryFnOnce;
use rga_simd::f64::Lanes;

/// Least pivot of H scaled to a diagonal of one. Below it vectors are too much alike.
const LEAST_PIVOT: f64 = 1e-4;
/// Square of an entry off the diagonal over the product of those on it, which is rounding.
const ROUNDING: f64 = 1e-31;
const SWEEPS: usize = 30;

pub(super) struct Projected<L: Lanes> {
    pub width: usize,
    /// H and G, row by row.
    pub stiff: Vec<L::Numbers>,
    pub heavy: Vec<L::Numbers>,
    /// m, the largest first.
    pub values: Vec<L::Numbers>,
    /// The eigenvectors, `[width, vectors]`, of length one in the norm of H.
    pub shares: Vec<L::Numbers>,
    /// Lanes that were solved.
    pub sound: L::Mask,
    /// One vector behind the other.
    columns: Vec<L::Numbers>,
    factor: Vec<L::Numbers>,
    scale: Vec<L::Numbers>,
    inverse: Vec<L::Numbers>,
}

impl<L: Lanes> Projected<L> {
    pub(super) fn new(lanes: L, width: usize) -> Self {
        let zero = lanes.splat(0.0);
        let (square, line) = (vec![zero; width * width], vec![zero; width]);
        Self {
            width,
            stiff: square.clone(),
            heavy: square.clone(),
            values: line.clone(),
            shares: square.clone(),
            sound: lanes.at_most(zero, zero),
            columns: square.clone(),
            factor: square,
            scale: line.clone(),
            inverse: line,
        }
    }

    pub(super) fn solve(&mut self, lanes: L) {
        let pencil = self;
        lanes.vectorize(Solve { lanes, pencil });
    }

    /// H = L L', scaled, and the columns of L'^-1.
    #[inline(always)]
    fn factorise(&mut self, lanes: L) {
        let (width, one) = (self.width, lanes.splat(1.0));
        self.sound = lanes.at_most(one, one);
        for at in 0..width {
            let root = lanes.sqrt(self.stiff[at * width + at]);
            self.scale[at] = lanes.div(one, root);
        }
        for column in 0..width {
            for row in column..width {
                let scale = lanes.mul(self.scale[row], self.scale[column]);
                let mut sum = lanes.mul(self.stiff[row * width + column], scale);
                for before in 0..column {
                    let one = self.factor[row * width + before];
                    sum = lanes.take_product(one, self.factor[column * width + before], sum);
                }
                if row == column {
                    let strong = lanes.at_most(lanes.splat(LEAST_PIVOT), sum);
                    self.sound = lanes.and(self.sound, strong);
                    self.inverse[column] = lanes.div(one, lanes.sqrt(sum));
                } else {
                    self.factor[row * width + column] = lanes.mul(sum, self.inverse[column]);
                }
            }
        }
        self.columns.fill(lanes.splat(0.0));
        for row in 0..width {
            for column in 0..=row {
                let mut sum = if row == column {
                    self.scale[column]
                } else {
                    lanes.splat(0.0)
                };
                for before in column..row {
                    let one = self.factor[row * width + before];
                    sum = lanes.take_product(one, self.columns[before * width + column], sum);
                }
                self.columns[row * width + column] = lanes.mul(sum, self.inverse[row]);
            }
        }
    }

    /// L^-1 G L'^-1 in the place of G.
    #[inline(always)]
    fn transform(&mut self, lanes: L) {
        let width = self.width;
        for row in 0..width {
            for column in 0..width {
                let scale = lanes.mul(self.scale[row], self.scale[column]);
                let mut sum = lanes.mul(self.heavy[row * width + column], scale);
                for before in 0..row {
                    let one = self.factor[row * width + before];
                    sum = lanes.take_product(one, self.heavy[before * width + column], sum);
                }
                self.heavy[row * width + column] = lanes.mul(sum, self.inverse[row]);
            }
        }
        for row in 0..width {
            for column in 0..=row {
                let mut sum = self.heavy[row * width + column];
                for before in 0..column {
                    let one = self.factor[column * width + before];
                    sum = lanes.take_product(one, self.heavy[row * width + before], sum);
                }
                let value = lanes.mul(sum, self.inverse[column]);
                self.heavy[row * width + column] = value;
            }
        }
    }

    /// Turns the lower triangle of G into a diagonal, and the columns with it.
    #[inline(always)]
    fn diagonalise(&mut self, lanes: L) {
        let width = self.width;
        for _ in 0..SWEEPS {
            let mut turned = false;
            for high in 1..width {
                for low in 0..high {
                    turned |= self.turn(lanes, low, high);
                }
            }
            if !turned {
                return;
            }
        }
        // Numbers that are none: what they lead to is refused by its residual.
    }

    /// Whether any lane was turned.
    #[inline(always)]
    fn turn(&mut self, lanes: L, low: usize, high: usize) -> bool {
        let width = self.width;
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let off = self.heavy[high * width + low];
        let (first, last) = (
            self.heavy[low * width + low],
            self.heavy[high * width + high],
        );
        let size = lanes.abs(lanes.mul(first, last));
        let counts = lanes.above(lanes.mul(off, off), lanes.mul(lanes.splat(ROUNDING), size));
        if !lanes.any(counts) {
            return false;
        }
        let (apart, twice) = (lanes.sub(last, first), lanes.add(off, off));
        let root = lanes.sqrt(lanes.mul_add(apart, apart, lanes.mul(twice, twice)));
        let along = lanes.select(lanes.at_most(zero, apart), root, lanes.neg(root));
        let tangent = lanes.div(twice, lanes.add(apart, along));
        let tangent = lanes.select(counts, tangent, zero);
        let cosine = lanes.div(one, lanes.sqrt(lanes.mul_add(tangent, tangent, one)));
        let sine = lanes.mul(tangent, cosine);
        let turn = |a: L::Numbers, b: L::Numbers| {
            (
                lanes.take_product(sine, b, lanes.mul(cosine, a)),
                lanes.mul_add(sine, a, lanes.mul(cosine, b)),
            )
        };
        let place = |row: usize, column: usize| row.max(column) * width + row.min(column);
        for other in 0..width {
            if other != low && other != high {
                let (at, beside) = (place(other, low), place(other, high));
                let (a, b) = turn(self.heavy[at], self.heavy[beside]);
                (self.heavy[at], self.heavy[beside]) = (a, b);
            }
            let (at, beside) = (low * width + other, high * width + other);
            let (a, b) = turn(self.columns[at], self.columns[beside]);
            (self.columns[at], self.columns[beside]) = (a, b);
        }
        self.heavy[low * width + low] = lanes.take_product(tangent, off, first);
        self.heavy[high * width + high] = lanes.mul_add(tangent, off, last);
        self.heavy[high * width + low] = lanes.select(counts, zero, off);
        true
    }

    /// The largest first.
    #[inline(always)]
    fn sort(&mut self, lanes: L) {
        let width = self.width;
        for at in 0..width {
            self.values[at] = self.heavy[at * width + at];
        }
        for end in (1..width).rev() {
            for at in 0..end {
                let (one, other) = (self.values[at], self.values[at + 1]);
                let swapped = lanes.above(other, one);
                if !lanes.any(swapped) {
                    continue;
                }
                self.values[at] = lanes.select(swapped, other, one);
                self.values[at + 1] = lanes.select(swapped, one, other);
                for row in 0..width {
                    let (here, there) = (at * width + row, (at + 1) * width + row);
                    let (one, other) = (self.columns[here], self.columns[there]);
                    self.columns[here] = lanes.select(swapped, other, one);
                    self.columns[there] = lanes.select(swapped, one, other);
                }
            }
        }
        for column in 0..width {
            for row in 0..width {
                self.shares[row * width + column] = self.columns[column * width + row];
            }
        }
    }
}

struct Solve<'a, L: Lanes> {
    lanes: L,
    pencil: &'a mut Projected<L>,
}

impl<L: Lanes> NullaryFnOnce for Solve<'_, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { lanes, pencil } = self;
        pencil.factorise(lanes);
        pencil.transform(lanes);
        pencil.diagonalise(lanes);
        pencil.sort(lanes);
    }
}
