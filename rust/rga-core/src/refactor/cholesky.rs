//! The stiffness of many samples, one a lane: filled in, factorised and solved panel by panel.
//!
//! Every sum is a chain of fused multiply-adds in a fixed order, so that a sample has the same bits
//! in any lane of any instruction set.

use pulp::Simd;

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

    /// Fills K in and factorises it; solves L x = `right` on the way, while a panel is at hand.
    ///
    /// `share` is that of `sound`.
    #[inline(always)]
    pub fn factorise(&mut self, simd: S, weights: &[S::f64s], share: f64, right: &mut [S::f64s]) {
        let panels = self.panels;
        self.sound = simd.less_than_or_equal_f64s(simd.splat_f64s(0.0), simd.splat_f64s(0.0));
        for panel in &panels.panels {
            for &other in &panel.fills {
                self.fill(simd, &panels.panels[other], weights);
            }
            self.factorise_panel(simd, panel, share);
            for update in &panel.updates {
                self.hand_on(simd, panel, update);
            }
            self.forward::<1>(simd, panel, right);
        }
    }

    /// Solves L' x = `right` in place, `N` right-hand sides beside each other.
    #[inline(always)]
    pub fn backward<const N: usize>(&self, simd: S, right: &mut [S::f64s]) {
        for panel in self.panels.panels.iter().rev() {
            self.backward_panel::<N>(simd, panel, right);
        }
    }

    /// Solves K x = `right` in place, `N` right-hand sides beside each other.
    #[inline(always)]
    pub fn solve<const N: usize>(&self, simd: S, right: &mut [S::f64s]) {
        for panel in &self.panels.panels {
            self.forward::<N>(simd, panel, right);
        }
        self.backward::<N>(simd, right);
    }

    #[inline(always)]
    fn fill(&mut self, simd: S, panel: &Panel, weights: &[S::f64s]) {
        let values = &mut self.values[panel.numbers()];
        values.fill(simd.splat_f64s(0.0));
        for place in self.panels.places(panel) {
            let mut sum = simd.splat_f64s(0.0);
            for &(weight, value) in self.panels.terms(place) {
                sum = simd.mul_add_f64s(weights[weight], simd.splat_f64s(value), sum);
            }
            values[place.at] = sum;
        }
        let own = &mut self.diagonal[panel.first..panel.first + panel.width];
        for (at, value) in own.iter_mut().enumerate() {
            *value = values[at * (panel.width + 1)];
        }
    }

    /// Columns of one panel, some at a time: what those before take, then themselves.
    #[inline(always)]
    fn factorise_panel(&mut self, simd: S, panel: &Panel, share: f64) {
        if S::F64_LANES == 8 {
            self.factorise_tiles::<6, 4>(simd, panel, share);
        } else {
            self.factorise_tiles::<4, 3>(simd, panel, share);
        }
    }

    #[inline(always)]
    fn factorise_tiles<const TALL: usize, const WIDE: usize>(
        &mut self,
        simd: S,
        panel: &Panel,
        share: f64,
    ) {
        let width = panel.width;
        let rows = width + panel.below.len();
        let mut column = 0;
        while column < width {
            if width - column >= WIDE {
                self.factorise_columns::<TALL, WIDE>(simd, panel, column, rows, share);
                column += WIDE;
            } else if width - column >= 2 {
                self.factorise_columns::<TALL, 2>(simd, panel, column, rows, share);
                column += 2;
            } else {
                self.factorise_columns::<TALL, 1>(simd, panel, column, rows, share);
                column += 1;
            }
        }
    }

    #[inline(always)]
    fn factorise_columns<const TALL: usize, const WIDE: usize>(
        &mut self,
        simd: S,
        panel: &Panel,
        column: usize,
        rows: usize,
        share: f64,
    ) {
        let width = panel.width;
        let values = &mut self.values[panel.numbers()];
        // The triangle on the diagonal.
        let mut own: [[S::f64s; WIDE]; WIDE] = taken(simd, values, width, column, column, column);
        let mut inverse = [simd.splat_f64s(0.0); WIDE];
        for at in 0..WIDE {
            let unknown = panel.first + column + at;
            let least = simd.mul_f64s(simd.splat_f64s(share), self.diagonal[unknown]);
            let strong = simd.less_than_or_equal_f64s(least, own[at][at]);
            self.sound = simd.and_m64s(self.sound, strong);
            inverse[at] = simd.div_f64s(simd.splat_f64s(1.0), simd.sqrt_f64s(own[at][at]));
            self.inverse[unknown] = inverse[at];
            for row in at + 1..WIDE {
                own[row][at] = simd.mul_f64s(own[row][at], inverse[at]);
            }
            for row in at + 1..WIDE {
                for other in at + 1..=row {
                    own[row][other] =
                        simd.negate_mul_add_f64s(own[row][at], own[other][at], own[row][other]);
                }
            }
        }
        for (at, line) in own.iter().enumerate() {
            values[(column + at) * width + column..][..at].copy_from_slice(&line[..at]);
        }
        // The rows below it.
        let mut row = column + WIDE;
        while row + TALL <= rows {
            rest::<S, TALL, WIDE>(simd, values, width, row, column, &own, &inverse);
            row += TALL;
        }
        while row + 2 <= rows {
            rest::<S, 2, WIDE>(simd, values, width, row, column, &own, &inverse);
            row += 2;
        }
        if row < rows {
            rest::<S, 1, WIDE>(simd, values, width, row, column, &own, &inverse);
        }
    }

    #[inline(always)]
    fn hand_on(&mut self, simd: S, panel: &Panel, update: &Update) {
        if S::F64_LANES == 8 {
            self.hand_on_tiles::<6, 4>(simd, panel, update);
        } else {
            self.hand_on_tiles::<4, 3>(simd, panel, update);
        }
    }

    #[inline(always)]
    fn hand_on_tiles<const TALL: usize, const WIDE: usize>(
        &mut self,
        simd: S,
        panel: &Panel,
        update: &Update,
    ) {
        let other = &self.panels.panels[update.to];
        let (before, behind) = self.values.split_at_mut(other.start);
        let given = &before[panel.numbers()][panel.width * panel.width..];
        let hand = Hand {
            given: &given[update.from * panel.width..],
            depth: panel.width,
            rows: &update.rows,
            width: other.width,
        };
        let columns = update.end - update.from;
        let mut column = 0;
        while column < columns {
            if columns - column >= WIDE {
                hand.column::<S, TALL, WIDE>(simd, column, behind);
                column += WIDE;
            } else if columns - column >= 2 {
                hand.column::<S, TALL, 2>(simd, column, behind);
                column += 2;
            } else {
                hand.column::<S, TALL, 1>(simd, column, behind);
                column += 1;
            }
        }
    }

    #[inline(always)]
    fn forward<const N: usize>(&self, simd: S, panel: &Panel, right: &mut [S::f64s]) {
        const TOGETHER: usize = 4;
        let width = panel.width;
        let values = &self.values[panel.numbers()];
        let (_, right) = right.split_at_mut(panel.first * N);
        let (own, behind) = right.split_at_mut(width * N);
        for row in 0..width {
            let (known, rest) = own.split_at_mut(row * N);
            let mut sum: [S::f64s; N] = load::<S, N>(rest);
            for (factor, known) in values[row * width..][..row].iter().zip(known.chunks_exact(N)) {
                take::<S, N>(simd, *factor, known, &mut sum);
            }
            let inverse = self.inverse[panel.first + row];
            for (value, sum) in rest[..N].iter_mut().zip(sum) {
                *value = simd.mul_f64s(sum, inverse);
            }
        }
        let skipped = panel.first + width;
        let lines = values[width * width..].chunks(TOGETHER * width);
        for (lines, unknowns) in lines.zip(panel.below.chunks(TOGETHER)) {
            if unknowns.len() == TOGETHER {
                let mut sums = [[simd.splat_f64s(0.0); N]; TOGETHER];
                for (sum, unknown) in sums.iter_mut().zip(unknowns) {
                    *sum = load::<S, N>(&behind[(unknown - skipped) * N..]);
                }
                let lines: [&[S::f64s]; TOGETHER] =
                    std::array::from_fn(|at| &lines[at * width..][..width]);
                for (at, known) in own.chunks_exact(N).enumerate() {
                    for (sum, line) in sums.iter_mut().zip(&lines) {
                        take::<S, N>(simd, line[at], known, sum);
                    }
                }
                for (sum, unknown) in sums.iter().zip(unknowns) {
                    behind[(unknown - skipped) * N..][..N].copy_from_slice(sum);
                }
            } else {
                for (line, unknown) in lines.chunks_exact(width).zip(unknowns) {
                    let place = &mut behind[(unknown - skipped) * N..][..N];
                    let mut sum = load::<S, N>(place);
                    for (factor, known) in line.iter().zip(own.chunks_exact(N)) {
                        take::<S, N>(simd, *factor, known, &mut sum);
                    }
                    place.copy_from_slice(&sum);
                }
            }
        }
    }

    #[inline(always)]
    fn backward_panel<const N: usize>(&self, simd: S, panel: &Panel, right: &mut [S::f64s]) {
        const TOGETHER: usize = 4;
        let width = panel.width;
        let values = &self.values[panel.numbers()];
        let (_, right) = right.split_at_mut(panel.first * N);
        let (own, behind) = right.split_at_mut(width * N);
        let skipped = panel.first + width;
        let below = &values[width * width..];
        let mut column = 0;
        while column < width {
            let together = TOGETHER.min(width - column);
            if together == TOGETHER {
                let mut sums: [[S::f64s; N]; TOGETHER] =
                    std::array::from_fn(|at| load::<S, N>(&own[(column + at) * N..]));
                for (line, unknown) in below.chunks_exact(width).zip(&panel.below) {
                    let line = &line[column..][..TOGETHER];
                    let known = &behind[(unknown - skipped) * N..][..N];
                    for (sum, factor) in sums.iter_mut().zip(line) {
                        take::<S, N>(simd, *factor, known, sum);
                    }
                }
                own[column * N..][..TOGETHER * N].copy_from_slice(sums.as_flattened());
            } else {
                for at in column..width {
                    let mut sum = load::<S, N>(&own[at * N..]);
                    for (line, unknown) in below.chunks_exact(width).zip(&panel.below) {
                        let known = &behind[(unknown - skipped) * N..][..N];
                        take::<S, N>(simd, line[at], known, &mut sum);
                    }
                    own[at * N..][..N].copy_from_slice(&sum);
                }
            }
            column += together;
        }
        for row in (0..width).rev() {
            let (rest, found) = own.split_at_mut(row * N);
            let inverse = self.inverse[panel.first + row];
            for value in &mut found[..N] {
                *value = simd.mul_f64s(*value, inverse);
            }
            let line = &values[row * width..][..row];
            for (factor, value) in line.iter().zip(rest.chunks_exact_mut(N)) {
                let mut sum = load::<S, N>(value);
                take::<S, N>(simd, *factor, &found[..N], &mut sum);
                value.copy_from_slice(&sum);
            }
        }
    }
}

/// Rows of a panel against columns of another.
struct Hand<'a, V> {
    /// Rows of the panel that hands on, from the first that is a column of the other.
    given: &'a [V],
    depth: usize,
    /// The row of each in the other panel.
    rows: &'a [usize],
    /// Of the other panel.
    width: usize,
}

impl<V> Hand<'_, V> {
    /// `WIDE` columns, and all rows from the first of them on. What falls above the diagonal of
    /// the other panel counts for nothing.
    #[inline(always)]
    fn column<S: Simd<f64s = V>, const TALL: usize, const WIDE: usize>(
        &self,
        simd: S,
        column: usize,
        to: &mut [V],
    ) where
        V: Copy,
    {
        let mut row = column;
        while row + TALL <= self.rows.len() {
            self.tile::<S, TALL, WIDE>(simd, row, column, to);
            row += TALL;
        }
        while row + 2 <= self.rows.len() {
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
    ) where
        V: Copy,
    {
        let lines: [&[V]; TALL] =
            std::array::from_fn(|at| &self.given[(row + at) * self.depth..][..self.depth]);
        let others: [&[V]; WIDE] =
            std::array::from_fn(|at| &self.given[(column + at) * self.depth..][..self.depth]);
        let rows: [usize; TALL] = std::array::from_fn(|at| self.rows[row + at] * self.width);
        let columns: [usize; WIDE] = std::array::from_fn(|at| self.rows[column + at]);
        let mut sums = [[simd.splat_f64s(0.0); WIDE]; TALL];
        for (sums, row) in sums.iter_mut().zip(rows) {
            for (sum, column) in sums.iter_mut().zip(columns) {
                *sum = to[row + column];
            }
        }
        for at in 0..self.depth {
            for (sums, line) in sums.iter_mut().zip(&lines) {
                let factor = line[at];
                for (sum, other) in sums.iter_mut().zip(&others) {
                    *sum = simd.negate_mul_add_f64s(factor, other[at], *sum);
                }
            }
        }
        for (sums, row) in sums.iter().zip(rows) {
            for (sum, column) in sums.iter().zip(columns) {
                to[row + column] = *sum;
            }
        }
    }
}

/// A tile of a panel less what the first `depth` of its columns take.
#[inline(always)]
fn taken<S: Simd, const TALL: usize, const WIDE: usize>(
    simd: S,
    values: &[S::f64s],
    width: usize,
    row: usize,
    column: usize,
    depth: usize,
) -> [[S::f64s; WIDE]; TALL] {
    let lines: [&[S::f64s]; TALL] = std::array::from_fn(|at| &values[(row + at) * width..][..depth]);
    let others: [&[S::f64s]; WIDE] =
        std::array::from_fn(|at| &values[(column + at) * width..][..depth]);
    let mut sums: [[S::f64s; WIDE]; TALL] = std::array::from_fn(|row_at| {
        std::array::from_fn(|at| values[(row + row_at) * width + column + at])
    });
    for at in 0..depth {
        for (sums, line) in sums.iter_mut().zip(&lines) {
            let factor = line[at];
            for (sum, other) in sums.iter_mut().zip(&others) {
                *sum = simd.negate_mul_add_f64s(factor, other[at], *sum);
            }
        }
    }
    sums
}

/// Rows below a triangle that is factorised.
#[inline(always)]
fn rest<S: Simd, const TALL: usize, const WIDE: usize>(
    simd: S,
    values: &mut [S::f64s],
    width: usize,
    row: usize,
    column: usize,
    triangle: &[[S::f64s; WIDE]; WIDE],
    inverse: &[S::f64s; WIDE],
) {
    let mut sums: [[S::f64s; WIDE]; TALL] = taken(simd, values, width, row, column, column);
    for at in 0..WIDE {
        for line in &mut sums {
            for before in 0..at {
                line[at] = simd.negate_mul_add_f64s(line[before], triangle[at][before], line[at]);
            }
            line[at] = simd.mul_f64s(line[at], inverse[at]);
        }
    }
    for (at, line) in sums.iter().enumerate() {
        values[(row + at) * width + column..][..WIDE].copy_from_slice(line);
    }
}

#[inline(always)]
fn load<S: Simd, const N: usize>(values: &[S::f64s]) -> [S::f64s; N] {
    let values = &values[..N];
    std::array::from_fn(|at| values[at])
}

/// `sums` -= `factor` times `known`
#[inline(always)]
fn take<S: Simd, const N: usize>(
    simd: S,
    factor: S::f64s,
    known: &[S::f64s],
    sums: &mut [S::f64s; N],
) {
    for (sum, known) in sums.iter_mut().zip(known) {
        *sum = simd.negate_mul_add_f64s(factor, *known, *sum);
    }
}
