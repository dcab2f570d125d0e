//! Vectors of many samples, one sample a lane: `BESIDE` of them beside each other, unknown by
//! unknown, and group behind group.
//!
//! Sums are chains of fused multiply-adds in a fixed order; each is compiled once for an
//! instruction set, not wherever it is called.

// Loops of fixed lengths are unrolled.
#![allow(clippy::needless_range_loop)]

use pulp::NullaryFnOnce;
use rga_simd::f64::Lanes;

use super::swinging::SymmetricRows;

/// Vectors of a group: they share what is read of a matrix.
pub(super) const BESIDE: usize = 4;

/// Vectors of one group that a sum of products takes at a time: more leave no registers.
const HALF: usize = 2;

/// M x
pub(super) struct MassTimes<'a, L: Lanes> {
    pub lanes: L,
    pub mass: &'a SymmetricRows,
    pub x: &'a [L::Numbers],
    pub product: &'a mut [L::Numbers],
}

impl<L: Lanes> NullaryFnOnce for MassTimes<'_, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self {
            lanes,
            mass,
            x,
            product,
        } = self;
        let group = BESIDE * mass.size();
        for (x, product) in x.chunks_exact(group).zip(product.chunks_exact_mut(group)) {
            for (row, place) in product.chunks_exact_mut(BESIDE).enumerate() {
                let mut sums = [lanes.splat(0.0); BESIDE];
                for &(column, value) in mass.row(row) {
                    let value = lanes.splat(value);
                    let own = &x[BESIDE * column..][..BESIDE];
                    for at in 0..BESIDE {
                        sums[at] = lanes.mul_add(value, own[at], sums[at]);
                    }
                }
                place.copy_from_slice(&sums);
            }
        }
    }
}

/// Products of all vectors with all others, of which it is known that they are symmetric: row by
/// row.
pub(super) struct Products<'a, L: Lanes> {
    pub lanes: L,
    pub size: usize,
    pub ones: &'a [L::Numbers],
    pub others: &'a [L::Numbers],
    pub products: &'a mut [L::Numbers],
}

impl<L: Lanes> NullaryFnOnce for Products<'_, L> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        let groups = self.ones.len() / (BESIDE * self.size);
        for row in 0..groups {
            for column in 0..=row {
                self.tile::<0>(row, column);
                self.tile::<HALF>(row, column);
            }
        }
    }
}

impl<L: Lanes> Products<'_, L> {
    #[inline(always)]
    fn tile<const FROM: usize>(&mut self, row: usize, column: usize) {
        let (lanes, group) = (self.lanes, BESIDE * self.size);
        let (ones, _) = self.ones[row * group..][..group].as_chunks::<BESIDE>();
        let (others, _) = self.others[column * group..][..group].as_chunks::<BESIDE>();
        let mut sums = [[lanes.splat(0.0); BESIDE]; HALF];
        for (one, other) in ones.iter().zip(others) {
            for at in 0..HALF {
                for beside in 0..BESIDE {
                    sums[at][beside] =
                        lanes.mul_add(one[FROM + at], other[beside], sums[at][beside]);
                }
            }
        }
        let width = self.ones.len() / self.size;
        for at in 0..HALF {
            for beside in 0..BESIDE {
                let (i, j) = (BESIDE * row + FROM + at, BESIDE * column + beside);
                self.products[i * width + j] = sums[at][beside];
                self.products[j * width + i] = sums[at][beside];
            }
        }
    }
}

/// Product of each vector with the other of its place.
#[inline(always)]
pub(super) fn product_each<L: Lanes>(
    lanes: L,
    size: usize,
    ones: &[L::Numbers],
    others: &[L::Numbers],
    products: &mut [L::Numbers],
) {
    let group = BESIDE * size;
    let pairs = ones.chunks_exact(group).zip(others.chunks_exact(group));
    for ((ones, others), products) in pairs.zip(products.chunks_exact_mut(BESIDE)) {
        let mut sums = [lanes.splat(0.0); BESIDE];
        let pairs = ones.chunks_exact(BESIDE).zip(others.chunks_exact(BESIDE));
        for (one, other) in pairs {
            for at in 0..BESIDE {
                sums[at] = lanes.mul_add(one[at], other[at], sums[at]);
            }
        }
        products.copy_from_slice(&sums);
    }
}

/// Vectors as sums of others times shares, `[others, vectors]`.
pub(super) struct Sums<'a, L: Lanes> {
    pub lanes: L,
    pub size: usize,
    pub others: &'a [L::Numbers],
    pub shares: &'a [L::Numbers],
    pub vectors: &'a mut [L::Numbers],
}

impl<L: Lanes> NullaryFnOnce for Sums<'_, L> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        for group in 0..self.vectors.len() / (BESIDE * self.size) {
            let mut unknown = 0;
            while unknown + 2 <= self.size {
                self.rows::<2>(group, unknown);
                unknown += 2;
            }
            if unknown < self.size {
                self.rows::<1>(group, unknown);
            }
        }
    }
}

impl<L: Lanes> Sums<'_, L> {
    #[inline(always)]
    fn rows<const ROWS: usize>(&mut self, group: usize, unknown: usize) {
        let (lanes, size) = (self.lanes, BESIDE * self.size);
        let width = self.others.len() / self.size;
        let mut sums = [[lanes.splat(0.0); BESIDE]; ROWS];
        for (from, others) in self.others.chunks_exact(size).enumerate() {
            let given = &others[BESIDE * unknown..][..BESIDE * ROWS];
            for other in 0..BESIDE {
                let at = (BESIDE * from + other) * width + BESIDE * group;
                let shares = &self.shares[at..][..BESIDE];
                for row in 0..ROWS {
                    for beside in 0..BESIDE {
                        let value = given[BESIDE * row + other];
                        sums[row][beside] = lanes.mul_add(value, shares[beside], sums[row][beside]);
                    }
                }
            }
        }
        let place = &mut self.vectors[group * size + BESIDE * unknown..][..BESIDE * ROWS];
        place.copy_from_slice(sums.as_flattened());
    }
}
