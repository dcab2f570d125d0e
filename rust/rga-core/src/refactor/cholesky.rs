//! The stiffness of many samples, one a lane: filled in, factorised and solved panel by panel.
//!
//! Every sum is a chain of fused multiply-adds in a fixed order, so that a sample has the same bits
//! in any lane of any instruction set. Tiles of sums stay in registers: loops over them have fixed
//! lengths.

use pulp::{NullaryFnOnce, Simd};

use super::panels::{Panel, Panels, Update};

/// L of K = L L', with one over its diagonal beside it.
pub struct Cholesky<'a, S: Simd> {
    panels: &'a Panels,
    values: Vec<S::f64s>,
    inverse: Vec<S::f64s>,
    /// The diagonal of K.
    pub diagonal: Vec<S::f64s>,
    /// Lanes of which every pivot is at least a share of the diagonal.
    pub sound: S::m64s,
}

impl<'a, S: Simd> Cholesky<'a, S> {
    pub fn new(simd: S, panels: &'a Panels) -> Self {
        let zero = simd.splat_f64s(0.0);
        Self {
            values: vec![zero; panels.numbers],
            inverse: vec![zero; panels.size()],
            diagonal: vec![zero; panels.size()],
            sound: simd.less_than_or_equal_f64s(zero, zero),
            panels,
        }
    }

    /// Fills K in, factorises it and solves K x = `right` in place; the first half of that while a
    /// panel is at hand.
    ///
    /// `share` is that of `sound`.
    pub fn factorise(&mut self, simd: S, weights: &[S::f64s], share: f64, right: &mut [S::f64s]) {
        let cholesky = self;
        simd.vectorize(Factorise {
            simd,
            cholesky,
            weights,
            share,
            right,
        });
    }

    /// Solves K x = `right` in place, `N` right-hand sides beside each other.
    pub fn solve<const N: usize>(&self, simd: S, right: &mut [S::f64s]) {
        let cholesky = self;
        simd.vectorize(Substitute::<S, N> {
            simd,
            cholesky,
            right,
        });
    }

    #[inline(always)]
    fn fill(&mut self, simd: S, panel: &Panel, weights: &[S::f64s]) {
        let values = &mut self.values[panel.numbers()];
        for &place in &panel.empty {
            values[place as usize] = simd.splat_f64s(0.0);
        }
        for term in self.panels.alone(panel) {
            let value = simd.splat_f64s(term.value);
            values[term.place as usize] = simd.mul_f64s(weights[term.weight as usize], value);
        }
        for sum in self.panels.sums(panel).chunk_by(|one, other| one.place == other.place) {
            let mut total = simd.splat_f64s(0.0);
            for term in sum {
                let value = simd.splat_f64s(term.value);
                total = simd.mul_add_f64s(weights[term.weight as usize], value, total);
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
        simd: S,
        panel: &Panel,
        share: f64,
    ) {
        let mut column = 0;
        while column + WIDE <= panel.width {
            self.factorise_columns::<TALL, WIDE>(simd, panel, column, share);
            column += WIDE;
        }
        while column < panel.width {
            self.factorise_columns::<TALL, 1>(simd, panel, column, share);
            column += 1;
        }
    }

    /// What the columns before take, then the columns themselves.
    #[inline(always)]
    fn factorise_columns<const TALL: usize, const WIDE: usize>(
        &mut self,
        simd: S,
        panel: &Panel,
        column: usize,
        share: f64,
    ) {
        let rows = panel.rows();
        let (before, own) = self.values[panel.numbers()].split_at_mut(column * rows);
        let mut triangle = load::<S, WIDE, WIDE>(simd, own, rows, column);
        take_products(simd, before, rows, (column, column), &mut triangle);
        let mut inverse = [simd.splat_f64s(0.0); WIDE];
        for at in 0..WIDE {
            let unknown = panel.first + column + at;
            let pivot = triangle[at][at];
            let least = simd.mul_f64s(simd.splat_f64s(share), self.diagonal[unknown]);
            let strong = simd.less_than_or_equal_f64s(least, pivot);
            self.sound = simd.and_m64s(self.sound, strong);
            // The next pivot waits for this division, and not for the root as well.
            let of_one = simd.div_f64s(simd.splat_f64s(1.0), pivot);
            inverse[at] = simd.sqrt_f64s(of_one);
            self.inverse[unknown] = inverse[at];
            for other in 0..WIDE {
                if other > at {
                    let factor = simd.mul_f64s(triangle[at][other], of_one);
                    for row in 0..WIDE {
                        if row >= other {
                            let (left, sum) = (triangle[at][row], triangle[other][row]);
                            triangle[other][row] = simd.negate_mul_add_f64s(left, factor, sum);
                        }
                    }
                }
            }
        }
        for (line, inverse) in triangle.iter_mut().zip(inverse) {
            for value in line {
                *value = simd.mul_f64s(*value, inverse);
            }
        }
        // What stands above the diagonal counts for nothing.
        store(simd, own, rows, column, &triangle);
        let below = Below {
            before,
            rows,
            column,
            triangle: &triangle,
            inverse: &inverse,
        };
        let mut row = column + WIDE;
        while row + TALL <= rows {
            below.factorise::<TALL>(simd, row, own);
            row += TALL;
        }
        if row + 2 <= rows {
            below.factorise::<2>(simd, row, own);
            row += 2;
        }
        if row < rows {
            below.factorise::<1>(simd, row, own);
        }
    }

    #[inline(always)]
    fn hand_on<const TALL: usize, const WIDE: usize>(
        &mut self,
        simd: S,
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
            hand.columns::<S, TALL, WIDE>(simd, column, to);
            column += WIDE;
        }
        while column < columns {
            hand.columns::<S, TALL, 1>(simd, column, to);
            column += 1;
        }
    }

    /// Solves L x = `right` as far as one panel goes.
    #[inline(always)]
    fn forward<const N: usize>(&self, simd: S, panel: &Panel, right: &mut [S::f64s]) {
        let mut column = 0;
        while column + TOGETHER <= panel.width {
            self.forward_columns::<N, TOGETHER>(simd, panel, column, right);
            column += TOGETHER;
        }
        while column < panel.width {
            self.forward_columns::<N, 1>(simd, panel, column, right);
            column += 1;
        }
    }

    #[inline(always)]
    fn forward_columns<const N: usize, const WIDE: usize>(
        &self,
        simd: S,
        panel: &Panel,
        column: usize,
        right: &mut [S::f64s],
    ) {
        let rows = panel.rows();
        let lines = columns::<S, WIDE>(&self.values[panel.numbers()], rows, column);
        let first = panel.first + column;
        let mut known = load::<S, N, WIDE>(simd, &right[first * N..], N, 0);
        for at in 0..WIDE {
            for value in &mut known[at] {
                *value = simd.mul_f64s(*value, self.inverse[first + at]);
            }
            for row in 0..WIDE {
                if row > at {
                    for n in 0..N {
                        let (factor, sum) = (lines[at][column + row], known[row][n]);
                        known[row][n] = simd.negate_mul_add_f64s(factor, known[at][n], sum);
                    }
                }
            }
        }
        store(simd, &mut right[first * N..], N, 0, &known);
        for row in column + WIDE..rows {
            let place = &mut right[panel.unknown(row) * N..][..N];
            for (n, place) in place.iter_mut().enumerate() {
                let mut sum = *place;
                for at in 0..WIDE {
                    sum = simd.negate_mul_add_f64s(lines[at][row], known[at][n], sum);
                }
                *place = sum;
            }
        }
    }

    /// Solves L' x = `right`, `N` right-hand sides beside each other.
    #[inline(always)]
    fn backward<const N: usize>(&self, simd: S, right: &mut [S::f64s]) {
        for panel in self.panels.panels.iter().rev() {
            let mut column = panel.width;
            while column % TOGETHER > 0 {
                column -= 1;
                self.backward_columns::<N, 1>(simd, panel, column, right);
            }
            while column > 0 {
                column -= TOGETHER;
                self.backward_columns::<N, TOGETHER>(simd, panel, column, right);
            }
        }
    }

    #[inline(always)]
    fn backward_columns<const N: usize, const WIDE: usize>(
        &self,
        simd: S,
        panel: &Panel,
        column: usize,
        right: &mut [S::f64s],
    ) {
        let rows = panel.rows();
        let lines = columns::<S, WIDE>(&self.values[panel.numbers()], rows, column);
        let first = panel.first + column;
        let mut sums = load::<S, N, WIDE>(simd, &right[first * N..], N, 0);
        for row in column + WIDE..rows {
            let known = &right[panel.unknown(row) * N..][..N];
            for at in 0..WIDE {
                for n in 0..N {
                    sums[at][n] = simd.negate_mul_add_f64s(lines[at][row], known[n], sums[at][n]);
                }
            }
        }
        for back in 0..WIDE {
            let at = WIDE - 1 - back;
            for value in &mut sums[at] {
                *value = simd.mul_f64s(*value, self.inverse[first + at]);
            }
            for other in 0..WIDE {
                if other < at {
                    for n in 0..N {
                        let (factor, sum) = (lines[other][column + at], sums[other][n]);
                        sums[other][n] = simd.negate_mul_add_f64s(factor, sums[at][n], sum);
                    }
                }
            }
        }
        store(simd, &mut right[first * N..], N, 0, &sums);
    }
}

/// Columns that are solved together.
const TOGETHER: usize = 4;

// Each of these is compiled once for an instruction set, not wherever it is called.

struct Factorise<'a, 'b, S: Simd> {
    simd: S,
    cholesky: &'a mut Cholesky<'b, S>,
    weights: &'a [S::f64s],
    share: f64,
    right: &'a mut [S::f64s],
}

impl<S: Simd> NullaryFnOnce for Factorise<'_, '_, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        // As many sums as registers hold beside what is added to them.
        if S::REGISTER_COUNT >= 32 {
            self.factorise::<4, 4>();
        } else {
            self.factorise::<3, 4>();
        }
    }
}

impl<S: Simd> Factorise<'_, '_, S> {
    #[inline(always)]
    fn factorise<const TALL: usize, const WIDE: usize>(self) {
        let Self {
            simd,
            cholesky,
            weights,
            share,
            right,
        } = self;
        let panels = cholesky.panels;
        let zero = simd.splat_f64s(0.0);
        cholesky.sound = simd.less_than_or_equal_f64s(zero, zero);
        for panel in &panels.panels {
            for &other in &panel.fills {
                cholesky.fill(simd, &panels.panels[other], weights);
            }
            cholesky.factorise_panel::<TALL, WIDE>(simd, panel, share);
            for update in &panel.updates {
                cholesky.hand_on::<TALL, WIDE>(simd, panel, update);
            }
            cholesky.forward::<1>(simd, panel, right);
        }
        cholesky.backward::<1>(simd, right);
    }
}

struct Substitute<'a, 'b, S: Simd, const N: usize> {
    simd: S,
    cholesky: &'a Cholesky<'b, S>,
    right: &'a mut [S::f64s],
}

impl<S: Simd, const N: usize> NullaryFnOnce for Substitute<'_, '_, S, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for panel in &self.cholesky.panels.panels {
            self.cholesky.forward::<N>(self.simd, panel, self.right);
        }
        self.cholesky.backward::<N>(self.simd, self.right);
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
        simd: impl Simd<f64s = V>,
        row: usize,
        own: &mut [V],
    ) {
        let mut sums = load::<_, TALL, WIDE>(simd, own, self.rows, row);
        take_products(simd, self.before, self.rows, (row, self.column), &mut sums);
        for at in 0..WIDE {
            for before in 0..WIDE {
                if before < at {
                    let factor = self.triangle[before][at];
                    for i in 0..TALL {
                        sums[at][i] =
                            simd.negate_mul_add_f64s(sums[before][i], factor, sums[at][i]);
                    }
                }
            }
            for value in &mut sums[at] {
                *value = simd.mul_f64s(*value, self.inverse[at]);
            }
        }
        store(simd, own, self.rows, row, &sums);
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
    fn columns<S: Simd<f64s = V>, const TALL: usize, const WIDE: usize>(
        &self,
        simd: S,
        column: usize,
        to: &mut [V],
    ) {
        let mut row = column;
        while row + TALL <= self.rows.len() {
            self.tile::<S, TALL, WIDE>(simd, row, column, to);
            row += TALL;
        }
        if row + 2 <= self.rows.len() {
            self.tile::<S, 2, WIDE>(simd, row, column, to);
            row += 2;
        }
        if row < self.rows.len() {
            self.tile::<S, 1, WIDE>(simd, row, column, to);
        }
    }

    #[inline(always)]
    fn tile<S: Simd<f64s = V>, const TALL: usize, const WIDE: usize>(
        &self,
        simd: S,
        row: usize,
        column: usize,
        to: &mut [V],
    ) {
        let mut sums = [[simd.splat_f64s(0.0); TALL]; WIDE];
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
        take_products(simd, self.given, self.height, places, &mut sums);
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
fn take_products<S: Simd, const TALL: usize, const WIDE: usize>(
    simd: S,
    columns: &[S::f64s],
    height: usize,
    (row, other): (usize, usize),
    sums: &mut [[S::f64s; TALL]; WIDE],
) {
    let mut held = *sums;
    let mut rest = columns;
    while rest.len() >= height && height > 0 {
        let (line, further) = rest.split_at(height);
        let (own, factors) = (&line[row..row + TALL], &line[other..other + WIDE]);
        for (sums, factor) in held.iter_mut().zip(factors) {
            for (sum, value) in sums.iter_mut().zip(own) {
                *sum = simd.negate_mul_add_f64s(*value, *factor, *sum);
            }
        }
        rest = further;
    }
    *sums = held;
}

/// A tile from `row` on of the first columns.
#[inline(always)]
fn load<S: Simd, const TALL: usize, const WIDE: usize>(
    simd: S,
    columns: &[S::f64s],
    height: usize,
    row: usize,
) -> [[S::f64s; TALL]; WIDE] {
    let mut tile = [[simd.splat_f64s(0.0); TALL]; WIDE];
    for (at, line) in tile.iter_mut().enumerate() {
        let given = &columns[at * height + row..][..TALL];
        for (place, value) in line.iter_mut().zip(given) {
            *place = *value;
        }
    }
    tile
}

#[inline(always)]
fn store<S: Simd, const TALL: usize, const WIDE: usize>(
    _: S,
    columns: &mut [S::f64s],
    height: usize,
    row: usize,
    tile: &[[S::f64s; TALL]; WIDE],
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
fn columns<S: Simd, const WIDE: usize>(
    values: &[S::f64s],
    height: usize,
    column: usize,
) -> [&[S::f64s]; WIDE] {
    let mut lines = [&values[..0]; WIDE];
    for (at, line) in lines.iter_mut().enumerate() {
        *line = &values[(column + at) * height..][..height];
    }
    lines
}
