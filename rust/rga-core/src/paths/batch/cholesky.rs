//! The stiffness of many samples, one a lane: filled in, factorised and solved panel by panel.
//!
//! Every sum is a chain of fused multiply-adds in a fixed order, so that a sample has the same bits
//! in any lane of any instruction set. Sums stay in registers (`tiles`).
//! Right-hand sides go through the factor in `substitution`. With signs to its pivots the factor is
//! that of a matrix that need not be positive definite, of which eigenvalues are counted.

// Tiles are indexed by loops of fixed lengths, which are unrolled.
#![allow(clippy::needless_range_loop)]

mod substitution;

use pulp::NullaryFnOnce;
use rga_simd::f64::Lanes;

use super::panels::{Panel, Panels, Update};
use super::tiles::{Below, Hand, load, store, take_products};
use substitution::Substitute;

/// L of K = L L', with one over its diagonal beside it.
pub(super) struct Cholesky<'a, L: Lanes> {
    panels: &'a Panels,
    values: Vec<L::Numbers>,
    inverse: Vec<L::Numbers>,
    /// The diagonal of K.
    pub diagonal: Vec<L::Numbers>,
    /// Lanes of which every pivot is at least a share of the diagonal.
    pub sound: L::Mask,
    /// Signs of the pivots, and how many are negative, of a matrix that was counted.
    signs: Vec<L::Numbers>,
    negative: L::Numbers,
}

impl<'a, L: Lanes> Cholesky<'a, L> {
    pub(super) fn new(lanes: L, panels: &'a Panels) -> Self {
        let zero = lanes.splat(0.0);
        Self {
            values: vec![zero; panels.numbers],
            inverse: vec![zero; panels.size()],
            diagonal: vec![zero; panels.size()],
            sound: lanes.at_most(zero, zero),
            signs: vec![zero; panels.size()],
            negative: zero,
            panels,
        }
    }

    /// Fills K in, factorises it and solves K x = `right` in place; the first half of that while a
    /// panel is at hand.
    ///
    /// `share` is that of `sound`.
    pub(super) fn factorise(
        &mut self,
        lanes: L,
        weights: &[L::Numbers],
        share: f64,
        right: &mut [L::Numbers],
    ) {
        let cholesky = self;
        lanes.vectorize(Factorise::<L, false> {
            lanes,
            cholesky,
            weights,
            share,
            right,
        });
    }

    /// How many eigenvalues are negative of a matrix that need not be positive definite: as many
    /// as pivots (Sylvester's law of inertia). Pivots are held against the diagonal of the K that
    /// was factorised before; its factor is lost.
    pub(super) fn negative_eigenvalues(
        &mut self,
        lanes: L,
        weights: &[L::Numbers],
        share: f64,
    ) -> L::Numbers {
        let cholesky = &mut *self;
        lanes.vectorize(Factorise::<L, true> {
            lanes,
            cholesky,
            weights,
            share,
            right: &mut [],
        });
        self.negative
    }

    /// Solves K x = `right` in place, `N` right-hand sides beside each other.
    pub(super) fn solve<const N: usize>(&self, lanes: L, right: &mut [L::Numbers]) {
        let cholesky = self;
        lanes.vectorize(Substitute::<L, N> {
            lanes,
            cholesky,
            right,
        });
    }

    #[inline(always)]
    fn fill<const SIGNED: bool>(&mut self, lanes: L, panel: &Panel, weights: &[L::Numbers]) {
        let values = &mut self.values[panel.numbers()];
        for &place in &panel.empty {
            values[place as usize] = lanes.splat(0.0);
        }
        for term in self.panels.alone(panel) {
            let value = lanes.splat(term.value);
            values[term.place as usize] = lanes.mul(weights[term.weight as usize], value);
        }
        for sum in self
            .panels
            .sums(panel)
            .chunk_by(|one, other| one.place == other.place)
        {
            let mut total = lanes.splat(0.0);
            for term in sum {
                let value = lanes.splat(term.value);
                total = lanes.mul_add(weights[term.weight as usize], value, total);
            }
            values[sum[0].place as usize] = total;
        }
        if SIGNED {
            return;
        }
        let own = &mut self.diagonal[panel.first..panel.first + panel.width];
        for (place, value) in own.iter_mut().zip(values.iter().step_by(panel.rows() + 1)) {
            *place = *value;
        }
    }

    /// Columns of one panel, some at a time.
    #[inline(always)]
    fn factorise_panel<const TALL: usize, const WIDE: usize, const SIGNED: bool>(
        &mut self,
        lanes: L,
        panel: &Panel,
        share: f64,
    ) {
        let mut column = 0;
        while column + WIDE <= panel.width {
            self.factorise_columns::<TALL, WIDE, SIGNED>(lanes, panel, column, share);
            column += WIDE;
        }
        match panel.width - column {
            3 => self.factorise_columns::<TALL, 3, SIGNED>(lanes, panel, column, share),
            2 => self.factorise_columns::<TALL, 2, SIGNED>(lanes, panel, column, share),
            1 => self.factorise_columns::<TALL, 1, SIGNED>(lanes, panel, column, share),
            _ => {}
        }
    }

    /// What the columns before take, then the columns themselves.
    #[inline(always)]
    fn factorise_columns<const TALL: usize, const WIDE: usize, const SIGNED: bool>(
        &mut self,
        lanes: L,
        panel: &Panel,
        column: usize,
        share: f64,
    ) {
        let rows = panel.rows();
        let (before, own) = self.values[panel.numbers()].split_at_mut(column * rows);
        let mut triangle = load::<L, WIDE, WIDE>(lanes, own, rows, column);
        let given = (&*before, &self.signs[panel.first..panel.first + column]);
        take_products::<L, WIDE, WIDE, SIGNED>(lanes, given, rows, (column, column), &mut triangle);
        let mut inverse = [lanes.splat(0.0); WIDE];
        for at in 0..WIDE {
            let unknown = panel.first + column + at;
            let pivot = triangle[at][at];
            let least = lanes.mul(lanes.splat(share), self.diagonal[unknown]);
            let size = if SIGNED { lanes.abs(pivot) } else { pivot };
            let strong = lanes.at_most(least, size);
            self.sound = lanes.and(self.sound, strong);
            // The next pivot waits for this division, and not for the root as well.
            let of_one = lanes.div(lanes.splat(1.0), pivot);
            let of_size = if SIGNED { lanes.abs(of_one) } else { of_one };
            inverse[at] = lanes.sqrt(of_size);
            if SIGNED {
                let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
                let negative = lanes.above(zero, pivot);
                self.signs[unknown] = lanes.select(negative, lanes.neg(one), one);
                let counted = lanes.select(negative, one, zero);
                self.negative = lanes.add(self.negative, counted);
            }
            self.inverse[unknown] = inverse[at];
            for other in 0..WIDE {
                if other > at {
                    let factor = lanes.mul(triangle[at][other], of_one);
                    for row in 0..WIDE {
                        if row >= other {
                            let (left, sum) = (triangle[at][row], triangle[other][row]);
                            triangle[other][row] = lanes.take_product(left, factor, sum);
                        }
                    }
                }
            }
        }
        for (line, inverse) in triangle.iter_mut().zip(inverse) {
            for value in line {
                *value = lanes.mul(*value, inverse);
            }
        }
        // What stands above the diagonal counts for nothing.
        store(lanes, own, rows, column, &triangle);
        if SIGNED {
            for at in 0..WIDE {
                let sign = self.signs[panel.first + column + at];
                for value in &mut triangle[at] {
                    *value = lanes.mul(*value, sign);
                }
            }
        }
        let below = Below::<_, WIDE, SIGNED> {
            before,
            signs: &self.signs[panel.first..panel.first + column],
            rows,
            column,
            triangle: &triangle,
            inverse: &inverse,
        };
        let mut row = column + WIDE;
        while row + TALL <= rows {
            below.factorise::<TALL>(lanes, row, own);
            row += TALL;
        }
        if row + 2 <= rows {
            below.factorise::<2>(lanes, row, own);
            row += 2;
        }
        if row < rows {
            below.factorise::<1>(lanes, row, own);
        }
    }

    #[inline(always)]
    fn hand_on<const TALL: usize, const WIDE: usize, const SIGNED: bool>(
        &mut self,
        lanes: L,
        panel: &Panel,
        update: &Update,
    ) {
        let other = &self.panels.panels[update.to];
        let (before, behind) = self.values.split_at_mut(other.start);
        let hand = Hand::<_, SIGNED> {
            given: &before[panel.numbers()],
            signs: &self.signs[panel.first..panel.first + panel.width],
            height: panel.rows(),
            skipped: panel.width + update.from,
            rows: &update.rows,
            offset: other.rows(),
        };
        let to = &mut behind[..other.rows() * other.width];
        let columns = update.end - update.from;
        let mut column = 0;
        while column + WIDE <= columns {
            hand.columns::<L, TALL, WIDE>(lanes, column, to);
            column += WIDE;
        }
        match columns - column {
            3 => hand.columns::<L, TALL, 3>(lanes, column, to),
            2 => hand.columns::<L, TALL, 2>(lanes, column, to),
            1 => hand.columns::<L, TALL, 1>(lanes, column, to),
            _ => {}
        }
    }
}

/// Columns that are factorised together. Bits depend on it.
const WIDE: usize = 4;

/// Compiled once for an instruction set, not wherever it is called.
struct Factorise<'a, 'b, L: Lanes, const SIGNED: bool> {
    lanes: L,
    cholesky: &'a mut Cholesky<'b, L>,
    weights: &'a [L::Numbers],
    share: f64,
    right: &'a mut [L::Numbers],
}

impl<L: Lanes, const SIGNED: bool> NullaryFnOnce for Factorise<'_, '_, L, SIGNED> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        if L::TALL == 4 {
            self.factorise::<4>();
        } else {
            self.factorise::<3>();
        }
    }
}

impl<L: Lanes, const SIGNED: bool> Factorise<'_, '_, L, SIGNED> {
    #[inline(always)]
    fn factorise<const TALL: usize>(self) {
        let Self {
            lanes,
            cholesky,
            weights,
            share,
            right,
        } = self;
        let panels = cholesky.panels;
        let zero = lanes.splat(0.0);
        (cholesky.sound, cholesky.negative) = (lanes.at_most(zero, zero), zero);
        for panel in &panels.panels {
            if panel.is_first {
                cholesky.fill::<SIGNED>(lanes, panel, weights);
            }
            cholesky.factorise_panel::<TALL, WIDE, SIGNED>(lanes, panel, share);
            if !SIGNED {
                cholesky.forward::<1>(lanes, panel, right);
            }
            for &other in &panel.fills {
                cholesky.fill::<SIGNED>(lanes, &panels.panels[other], weights);
            }
            for update in &panel.updates {
                cholesky.hand_on::<TALL, WIDE, SIGNED>(lanes, panel, update);
            }
        }
        if !SIGNED {
            cholesky.backward::<1>(lanes, right);
        }
    }
}
