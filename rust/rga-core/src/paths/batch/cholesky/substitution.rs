//! Solutions with the factor of many samples, one a lane: panel by panel, and back.

use pulp::NullaryFnOnce;
use rga_simd::f64::Lanes;

use super::Cholesky;
use crate::paths::batch::panels::Panel;
use crate::paths::batch::tiles::{columns, load, store};

/// Columns that are solved together; or half of them, or one.
const TOGETHER: usize = 6;
const HALF: usize = 3;

impl<L: Lanes> Cholesky<'_, L> {
    /// Solves L x = `right` as far as one panel goes.
    #[inline(always)]
    pub(super) fn forward<const N: usize>(
        &self,
        lanes: L,
        panel: &Panel,
        right: &mut [L::Numbers],
    ) {
        let mut column = 0;
        while column + TOGETHER <= panel.width {
            self.forward_columns::<N, TOGETHER>(lanes, panel, column, right);
            column += TOGETHER;
        }
        if column + HALF <= panel.width {
            self.forward_columns::<N, HALF>(lanes, panel, column, right);
            column += HALF;
        }
        while column < panel.width {
            self.forward_columns::<N, 1>(lanes, panel, column, right);
            column += 1;
        }
    }

    #[inline(always)]
    fn forward_columns<const N: usize, const WIDE: usize>(
        &self,
        lanes: L,
        panel: &Panel,
        column: usize,
        right: &mut [L::Numbers],
    ) {
        let rows = panel.rows();
        let lines = columns::<L, WIDE>(&self.values[panel.numbers()], rows, column);
        let first = panel.first + column;
        let mut known = load::<L, N, WIDE>(lanes, &right[first * N..], N, 0);
        for at in 0..WIDE {
            for value in &mut known[at] {
                *value = lanes.mul(*value, self.inverse[first + at]);
            }
            for row in 0..WIDE {
                if row > at {
                    for n in 0..N {
                        let (factor, sum) = (lines[at][column + row], known[row][n]);
                        known[row][n] = lanes.take_product(factor, known[at][n], sum);
                    }
                }
            }
        }
        store(lanes, &mut right[first * N..], N, 0, &known);
        for row in column + WIDE..rows {
            let place = &mut right[panel.unknown(row) * N..][..N];
            for (n, place) in place.iter_mut().enumerate() {
                let mut sum = *place;
                for at in 0..WIDE {
                    sum = lanes.take_product(lines[at][row], known[at][n], sum);
                }
                *place = sum;
            }
        }
    }

    /// Solves L' x = `right`, `N` right-hand sides beside each other.
    #[inline(always)]
    pub(super) fn backward<const N: usize>(&self, lanes: L, right: &mut [L::Numbers]) {
        for panel in self.panels.panels.iter().rev() {
            let mut column = panel.width - panel.width % TOGETHER % HALF;
            for single in (column..panel.width).rev() {
                self.backward_columns::<N, 1>(lanes, panel, single, right);
            }
            if column % TOGETHER == HALF {
                column -= HALF;
                self.backward_columns::<N, HALF>(lanes, panel, column, right);
            }
            while column > 0 {
                column -= TOGETHER;
                self.backward_columns::<N, TOGETHER>(lanes, panel, column, right);
            }
        }
    }

    #[inline(always)]
    fn backward_columns<const N: usize, const WIDE: usize>(
        &self,
        lanes: L,
        panel: &Panel,
        column: usize,
        right: &mut [L::Numbers],
    ) {
        let rows = panel.rows();
        let lines = columns::<L, WIDE>(&self.values[panel.numbers()], rows, column);
        let first = panel.first + column;
        let mut sums = load::<L, N, WIDE>(lanes, &right[first * N..], N, 0);
        for row in column + WIDE..rows {
            let known = &right[panel.unknown(row) * N..][..N];
            for at in 0..WIDE {
                for n in 0..N {
                    sums[at][n] = lanes.take_product(lines[at][row], known[n], sums[at][n]);
                }
            }
        }
        for back in 0..WIDE {
            let at = WIDE - 1 - back;
            for value in &mut sums[at] {
                *value = lanes.mul(*value, self.inverse[first + at]);
            }
            for other in 0..WIDE {
                if other < at {
                    for n in 0..N {
                        let (factor, sum) = (lines[other][column + at], sums[other][n]);
                        sums[other][n] = lanes.take_product(factor, sums[at][n], sum);
                    }
                }
            }
        }
        store(lanes, &mut right[first * N..], N, 0, &sums);
    }
}

/// Compiled once for an instruction set, not wherever it is called.
pub(super) struct Substitute<'a, 'b, L: Lanes, const N: usize> {
    pub lanes: L,
    pub cholesky: &'a Cholesky<'b, L>,
    pub right: &'a mut [L::Numbers],
}

impl<L: Lanes, const N: usize> NullaryFnOnce for Substitute<'_, '_, L, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for panel in &self.cholesky.panels.panels {
            self.cholesky.forward::<N>(self.lanes, panel, self.right);
        }
        self.cholesky.backward::<N>(self.lanes, self.right);
    }
}
