//! The stiffness of many samples, one a lane: filled in, factorised and solved panel by panel.
//!
//! Every sum is a chain of fused multiply-adds in a fixed order, so that a sample has the same bits
//! in any lane of any instruction set. Tiles of sums stay in registers: loops over them have fixed
//! lengths.

// Tiles are indexed by loops of fixed lengths, which are unrolled.
#![allow(clippy::needless_range_loop)]

use pulp::NullaryFnOnce;

use super::panels::{Panel, Panels, Update};
use crate::lanes::Lanes;

/// L of K = L L', with one over its diagonal beside it.
pub struct Cholesky<'a, L: Lanes> {
    panels: &'a Panels,
    values: Vec<L::Numbers>,
    inverse: Vec<L::Numbers>,
    /// The diagonal of K.
    pub diagonal: Vec<L::Numbers>,
    /// Lanes of which every pivot is at least a share of the diagonal.
    pub sound: L::Mask,
}

impl<'a, L: Lanes> Cholesky<'a, L> {
    pub fn new(lanes: L, panels: &'a Panels) -> Self {
        let zero = lanes.splat(0.0);
        Self {
            values: vec![zero; panels.numbers],
            inverse: vec![zero; panels.size()],
            diagonal: vec![zero; panels.size()],
            sound: lanes.at_most(zero, zero),
            panels,
        }
    }

    /// Fills K in, factorises it and solves K x = `right` in place; the first half of that while a
    /// panel is at hand.
    ///
    /// `share` is that of `sound`.
    pub fn factorise(
        &mut self,
        lanes: L,
        weights: &[L::Numbers],
        share: f64,
        right: &mut [L::Numbers],
    ) {
        let cholesky = self;
        lanes.vectorize(Factorise {
            lanes,
            cholesky,
            weights,
            share,
            right,
        });
    }

    /// Solves K x = `right` in place, `N` right-hand sides beside each other.
    pub fn solve<const N: usize>(&self, lanes: L, right: &mut [L::Numbers]) {
        let cholesky = self;
        lanes.vectorize(Substitute::<L, N> {
            lanes,
            cholesky,
            right,
        });
    }

    #[inline(always)]
    fn fill(&mut self, lanes: L, panel: &Panel, weights: &[L::Numbers]) {
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
        let own = &mut self.diagonal[panel.first..panel.first + panel.width];
        for (place, value) in own.iter_mut().zip(values.iter().step_by(panel.rows() + 1)) {
            *place = *value;
        }
    }

    /// Columns of one panel, some at a time.
    #[inline(always)]
    fn factorise_panel<const TALL: usize, const WIDE: usize>(
        &mut self,
        lanes: L,
        panel: &Panel,
        share: f64,
    ) {
        let mut column = 0;
        while column + WIDE <= panel.width {
            self.factorise_columns::<TALL, WIDE>(lanes, panel, column, share);
            column += WIDE;
        }
        match panel.width - column {
            3 => self.factorise_columns::<TALL, 3>(lanes, panel, column, share),
            2 => self.factorise_columns::<TALL, 2>(lanes, panel, column, share),
            1 => self.factorise_columns::<TALL, 1>(lanes, panel, column, share),
            _ => {}
        }
    }

    /// What the columns before take, then the columns themselves.
    #[inline(always)]
    fn factorise_columns<const TALL: usize, const WIDE: usize>(
        &mut self,
        lanes: L,
        panel: &Panel,
        column: usize,
        share: f64,
    ) {
        let rows = panel.rows();
        let (before, own) = self.values[panel.numbers()].split_at_mut(column * rows);
        let mut triangle = load::<L, WIDE, WIDE>(lanes, own, rows, column);
        take_products(lanes, before, rows, (column, column), &mut triangle);
        let mut inverse = [lanes.splat(0.0); WIDE];
        for at in 0..WIDE {
            let unknown = panel.first + column + at;
            let pivot = triangle[at][at];
            let least = lanes.mul(lanes.splat(share), self.diagonal[unknown]);
            let strong = lanes.at_most(least, pivot);
            self.sound = lanes.and(self.sound, strong);
            // The next pivot waits for this division, and not for the root as well.
            let of_one = lanes.div(lanes.splat(1.0), pivot);
            inverse[at] = lanes.sqrt(of_one);
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
        let below = Below {
            before,
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
    fn hand_on<const TALL: usize, const WIDE: usize>(
        &mut self,
        lanes: L,
        panel: &Panel,
        update: &Update,
    ) {
        let other = &self.panels.panels[update.to];
        let (before, behind) = self.values.split_at_mut(other.start);
        let hand = Hand {
            given: &before[panel.numbers()],
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

    /// Solves L x = `right` as far as one panel goes.
    #[inline(always)]
    fn forward<const N: usize>(&self, lanes: L, panel: &Panel, right: &mut [L::Numbers]) {
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
    fn backward<const N: usize>(&self, lanes: L, right: &mut [L::Numbers]) {
        for panel in self.panels.panels.iter().rev() {
            let whole = panel.width / TOGETHER * TOGETHER;
            let mut column = panel.width;
            while column > whole + HALF || (whole < column && column < whole + HALF) {
                column -= 1;
                self.backward_columns::<N, 1>(lanes, panel, column, right);
            }
            if column > whole {
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

/// Columns that are factorised together. Bits depend on it.
const WIDE: usize = 4;

/// Columns that are solved together; or half of them, or one.
const TOGETHER: usize = 6;
const HALF: usize = 3;

// Each of these is compiled once for an instruction set, not wherever it is called.

struct Factorise<'a, 'b, L: Lanes> {
    lanes: L,
    cholesky: &'a mut Cholesky<'b, L>,
    weights: &'a [L::Numbers],
    share: f64,
    right: &'a mut [L::Numbers],
}

impl<L: Lanes> NullaryFnOnce for Factorise<'_, '_, L> {
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

impl<L: Lanes> Factorise<'_, '_, L> {
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
        cholesky.sound = lanes.at_most(zero, zero);
        for panel in &panels.panels {
            if panel.is_first {
                cholesky.fill(lanes, panel, weights);
            }
            cholesky.factorise_panel::<TALL, WIDE>(lanes, panel, share);
            cholesky.forward::<1>(lanes, panel, right);
            for &other in &panel.fills {
                cholesky.fill(lanes, &panels.panels[other], weights);
            }
            for update in &panel.updates {
                cholesky.hand_on::<TALL, WIDE>(lanes, panel, update);
            }
        }
        cholesky.backward::<1>(lanes, right);
    }
}

struct Substitute<'a, 'b, L: Lanes, const N: usize> {
    lanes: L,
    cholesky: &'a Cholesky<'b, L>,
    right: &'a mut [L::Numbers],
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

/// Rows of a panel below columns of which the triangle is factorised.
struct Below<'a, V, const WIDE: usize> {
    /// The columns before.
    before: &'a [V],
    rows: usize,
    column: usize,
    triangle: &'a [[V; WIDE]; WIDE],
    inverse: &'a [V; WIDE],
}

impl<V: Copy, const WIDE: usize> Below<'_, V, WIDE> {
    #[inline(always)]
    fn factorise<const TALL: usize>(
        &self,
        lanes: impl Lanes<Numbers = V>,
        row: usize,
        own: &mut [V],
    ) {
        let mut sums = load::<_, TALL, WIDE>(lanes, own, self.rows, row);
        take_products(lanes, self.before, self.rows, (row, self.column), &mut sums);
        for at in 0..WIDE {
            for before in 0..WIDE {
                if before < at {
                    let factor = self.triangle[before][at];
                    for i in 0..TALL {
                        sums[at][i] = lanes.take_product(sums[before][i], factor, sums[at][i]);
                    }
                }
            }
            for value in &mut sums[at] {
                *value = lanes.mul(*value, self.inverse[at]);
            }
        }
        store(lanes, own, self.rows, row, &sums);
    }
}

/// Products of rows of a panel, taken from another.
struct Hand<'a, V> {
    /// The panel that hands on, of columns as high as this.
    given: &'a [V],
    height: usize,
    /// Rows before the first that is a column of the other panel.
    skipped: usize,
    /// Rows in the other panel.
    rows: &'a [usize],
    /// From a column of the other panel to the next.
    offset: usize,
}

impl<V: Copy> Hand<'_, V> {
    /// `WIDE` columns, and all rows from the first of them on. What falls above the diagonal of
    /// the other panel counts for nothing.
    #[inline(always)]
    fn columns<L: Lanes<Numbers = V>, const TALL: usize, const WIDE: usize>(
        &self,
        lanes: L,
        column: usize,
        to: &mut [V],
    ) {
        let mut row = column;
        while row + TALL <= self.rows.len() {
            self.tile::<L, TALL, WIDE>(lanes, row, column, to);
            row += TALL;
        }
        if row + 2 <= self.rows.len() {
            self.tile::<L, 2, WIDE>(lanes, row, column, to);
            row += 2;
        }
        if row < self.rows.len() {
            self.tile::<L, 1, WIDE>(lanes, row, column, to);
        }
    }

    #[inline(always)]
    fn tile<L: Lanes<Numbers = V>, const TALL: usize, const WIDE: usize>(
        &self,
        lanes: L,
        row: usize,
        column: usize,
        to: &mut [V],
    ) {
        let mut sums = [[lanes.splat(0.0); TALL]; WIDE];
        let rows = &self.rows[row..row + TALL];
        let together = rows[TALL - 1] - rows[0] == TALL - 1;
        for (sums, column) in sums.iter_mut().zip(&self.rows[column..column + WIDE]) {
            let line = &to[column * self.offset..][..self.offset];
            if together {
                for (sum, value) in sums.iter_mut().zip(&line[rows[0]..rows[0] + TALL]) {
                    *sum = *value;
                }
            } else {
                for (sum, row) in sums.iter_mut().zip(rows) {
                    *sum = line[*row];
                }
            }
        }
        let places = (self.skipped + row, self.skipped + column);
        take_products(lanes, self.given, self.height, places, &mut sums);
        for (sums, column) in sums.iter().zip(&self.rows[column..column + WIDE]) {
            let line = &mut to[column * self.offset..][..self.offset];
            if together {
                for (sum, place) in sums.iter().zip(&mut line[rows[0]..rows[0] + TALL]) {
                    *place = *sum;
                }
            } else {
                for (sum, row) in sums.iter().zip(rows) {
                    line[*row] = *sum;
                }
            }
        }
    }
}

/// `sums` -= the products of rows from each of two places on, over all columns.
#[inline(always)]
fn take_products<L: Lanes, const TALL: usize, const WIDE: usize>(
    lanes: L,
    columns: &[L::Numbers],
    height: usize,
    (row, other): (usize, usize),
    sums: &mut [[L::Numbers; TALL]; WIDE],
) {
    let mut held = *sums;
    let mut rest = columns;
    while rest.len() >= height && height > 0 {
        let (line, further) = rest.split_at(height);
        let (own, factors) = (&line[row..row + TALL], &line[other..other + WIDE]);
        for (sums, factor) in held.iter_mut().zip(factors) {
            for (sum, value) in sums.iter_mut().zip(own) {
                *sum = lanes.take_product(*value, *factor, *sum);
            }
        }
        rest = further;
    }
    *sums = held;
}

/// A tile from `row` on of the first columns.
#[inline(always)]
fn load<L: Lanes, const TALL: usize, const WIDE: usize>(
    lanes: L,
    columns: &[L::Numbers],
    height: usize,
    row: usize,
) -> [[L::Numbers; TALL]; WIDE] {
    let mut tile = [[lanes.splat(0.0); TALL]; WIDE];
    for (at, line) in tile.iter_mut().enumerate() {
        let given = &columns[at * height + row..][..TALL];
        for (place, value) in line.iter_mut().zip(given) {
            *place = *value;
        }
    }
    tile
}

#[inline(always)]
fn store<L: Lanes, const TALL: usize, const WIDE: usize>(
    _: L,
    columns: &mut [L::Numbers],
    height: usize,
    row: usize,
    tile: &[[L::Numbers; TALL]; WIDE],
) {
    for (at, line) in tile.iter().enumerate() {
        let places = &mut columns[at * height + row..][..TALL];
        for (place, value) in places.iter_mut().zip(line) {
            *place = *value;
        }
    }
}

/// Whole columns, from one on.
#[inline(always)]
fn columns<L: Lanes, const WIDE: usize>(
    values: &[L::Numbers],
    height: usize,
    column: usize,
) -> [&[L::Numbers]; WIDE] {
    let mut lines = [&values[..0]; WIDE];
    for (at, line) in lines.iter_mut().enumerate() {
        *line = &values[(column + at) * height..][..height];
    }
    lines
}
