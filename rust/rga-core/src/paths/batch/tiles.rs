//! Tiles of sums that stay in registers: loops over them have fixed lengths, and are unrolled.

#![allow(clippy::needless_range_loop)]

use rga_simd::f64::Lanes;

/// Rows of a panel below columns of which the triangle is factorised.
pub(super) struct Below<'a, V, const WIDE: usize, const SIGNED: bool> {
    /// The columns before, and the signs of their pivots.
    pub before: &'a [V],
    pub signs: &'a [V],
    pub rows: usize,
    pub column: usize,
    /// Its columns, each times the sign of its pivot.
    pub triangle: &'a [[V; WIDE]; WIDE],
    pub inverse: &'a [V; WIDE],
}

impl<V: Copy, const WIDE: usize, const SIGNED: bool> Below<'_, V, WIDE, SIGNED> {
    #[inline(always)]
    pub(super) fn factorise<const TALL: usize>(
        &self,
        lanes: impl Lanes<Numbers = V>,
        row: usize,
        own: &mut [V],
    ) {
        let mut sums = load::<_, TALL, WIDE>(lanes, own, self.rows, row);
        let places = (row, self.column);
        take_products::<_, TALL, WIDE, SIGNED>(
            lanes,
            (self.before, self.signs),
            self.rows,
            places,
            &mut sums,
        );
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
pub(super) struct Hand<'a, V, const SIGNED: bool> {
    /// The panel that hands on, of columns as high as this, and the signs of their pivots.
    pub given: &'a [V],
    pub signs: &'a [V],
    pub height: usize,
    /// Rows before the first that is a column of the other panel.
    pub skipped: usize,
    /// Rows in the other panel.
    pub rows: &'a [usize],
    /// From a column of the other panel to the next.
    pub offset: usize,
}

impl<V: Copy, const SIGNED: bool> Hand<'_, V, SIGNED> {
    /// `WIDE` columns, and all rows from the first of them on. What falls above the diagonal of
    /// the other panel counts for nothing.
    #[inline(always)]
    pub(super) fn columns<L: Lanes<Numbers = V>, const TALL: usize, const WIDE: usize>(
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
        take_products::<_, TALL, WIDE, SIGNED>(
            lanes,
            (self.given, self.signs),
            self.height,
            places,
            &mut sums,
        );
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

/// `sums` -= the products of rows from each of two places on, over all columns: times the signs of
/// these, or where `SIGNED` is false, there are none.
#[inline(always)]
pub(super) fn take_products<L: Lanes, const TALL: usize, const WIDE: usize, const SIGNED: bool>(
    lanes: L,
    (columns, signs): (&[L::Numbers], &[L::Numbers]),
    height: usize,
    (row, other): (usize, usize),
    sums: &mut [[L::Numbers; TALL]; WIDE],
) {
    let mut held = *sums;
    let (mut rest, mut column) = (columns, 0);
    while rest.len() >= height && height > 0 {
        let (line, further) = rest.split_at(height);
        let (own, factors) = (&line[row..row + TALL], &line[other..other + WIDE]);
        for (sums, factor) in held.iter_mut().zip(factors) {
            let factor = if SIGNED {
                lanes.mul(*factor, signs[column])
            } else {
                *factor
            };
            for (sum, value) in sums.iter_mut().zip(own) {
                *sum = lanes.take_product(*value, factor, *sum);
            }
        }
        (rest, column) = (further, column + 1);
    }
    *sums = held;
}

/// A tile from `row` on of the first columns.
#[inline(always)]
pub(super) fn load<L: Lanes, const TALL: usize, const WIDE: usize>(
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
pub(super) fn store<L: Lanes, const TALL: usize, const WIDE: usize>(
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
pub(super) fn columns<L: Lanes, const WIDE: usize>(
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
