//! A symmetric matrix, as a sparse lower triangle.

use faer::sparse::SymbolicSparseColMatRef;

/// Compressed columns; rows ascend within a column and the diagonal, which is
/// always there, comes first.
#[derive(Debug, Clone)]
pub struct LowerTriangle {
    pub first: Vec<usize>,
    pub rows: Vec<usize>,
    pub values: Vec<f64>,
}

/// Of entries, beside those of the diagonal in their row and column.
const ROUNDING: f64 = 1e-14;

/// (row, column, value)
pub(crate) type Entry = (usize, usize, f64);

impl LowerTriangle {
    /// `each` calls `add(row, column, value)` for all entries; entries repeat, and are summed in
    /// their order.
    pub fn sum(size: usize, each: impl Fn(&mut dyn FnMut(usize, usize, f64))) -> Self {
        let mut starts = vec![0; size + 1];
        each(&mut |_, column, _| starts[column + 1] += 1);
        for at in 0..size {
            starts[at + 1] += starts[at];
        }
        let mut next = starts.clone();
        let mut sorted = vec![(0, 0.0); starts[size]];
        each(&mut |row, column, value| {
            sorted[next[column]] = (row, value);
            next[column] += 1;
        });
        let mut matrix = Self {
            first: Vec::with_capacity(size + 1),
            rows: Vec::new(),
            values: Vec::new(),
        };
        let mut sums = Vec::new();
        // Of each row, where its sum may stand.
        let mut place = vec![0; size];
        for column in 0..size {
            sums.clear();
            sums.push((column, 0.0));
            place[column] = 0;
            for &(row, value) in &sorted[starts[column]..starts[column + 1]] {
                match sums.get_mut(place[row]) {
                    Some((same, sum)) if *same == row => *sum += value,
                    _ => {
                        place[row] = sums.len();
                        sums.push((row, value));
                    }
                }
            }
            sums.sort_unstable_by_key(|&(row, _)| row);
            matrix.first.push(matrix.rows.len());
            matrix.rows.extend(sums.iter().map(|&(row, _)| row));
            matrix.values.extend(sums.iter().map(|&(_, sum)| sum));
        }
        matrix.first.push(matrix.rows.len());
        matrix
    }

    pub(crate) fn size(&self) -> usize {
        self.first.len() - 1
    }

    pub(crate) fn pattern(&self) -> SymbolicSparseColMatRef<'_, usize> {
        let size = self.size();
        SymbolicSparseColMatRef::new_checked(size, size, &self.first, None, &self.rows)
    }

    /// Where the entry, which is there, stands in `values`.
    pub(crate) fn place(&self, row: usize, column: usize) -> usize {
        let (first, end) = (self.first[column], self.first[column + 1]);
        first + self.rows[first..end].partition_point(|&other| other < row)
    }

    /// The same of an entry that may not be there.
    pub(crate) fn find(&self, row: usize, column: usize) -> Option<usize> {
        let at = self.place(row, column);
        let there = at < self.first[column + 1] && self.rows[at] == row;
        there.then_some(at)
    }

    /// The same with the places of another, those of it that are empty here as zeros; nothing
    /// where there is more than rounding in places that the other lacks.
    pub(crate) fn in_places_of(&self, other: &Self) -> Option<Self> {
        if self.size() != other.size() {
            return None;
        }
        let diagonal = self.diagonal();
        let mut moved = Self {
            values: vec![0.0; other.values.len()],
            ..other.clone()
        };
        for column in 0..self.size() {
            for at in self.first[column]..self.first[column + 1] {
                let (row, value) = (self.rows[at], self.values[at]);
                match moved.find(row, column) {
                    Some(place) => moved.values[place] = value,
                    None if value * value
                        <= ROUNDING * ROUNDING * (diagonal[row] * diagonal[column]).abs() => {}
                    None => return None,
                }
            }
        }
        Some(moved)
    }

    /// K - times M
    pub(crate) fn less(&self, times: f64, other: &Self) -> Self {
        let mut found = Self {
            first: Vec::with_capacity(self.first.len()),
            rows: Vec::with_capacity(self.rows.len()),
            values: Vec::with_capacity(self.rows.len()),
        };
        found.first.push(0);
        for column in 0..self.size() {
            let (mut own, mut its) = (self.first[column], other.first[column]);
            loop {
                let row = if own < self.first[column + 1] {
                    self.rows[own]
                } else {
                    usize::MAX
                };
                let beside = if its < other.first[column + 1] {
                    other.rows[its]
                } else {
                    usize::MAX
                };
                let next = row.min(beside);
                if next == usize::MAX {
                    break;
                }
                let mut value = 0.0;
                if row == next {
                    value += self.values[own];
                    own += 1;
                }
                if beside == next {
                    value -= times * other.values[its];
                    its += 1;
                }
                found.rows.push(next);
                found.values.push(value);
            }
            found.first.push(found.rows.len());
        }
        found
    }

    pub(crate) fn diagonal(&self) -> Vec<f64> {
        let starts = &self.first[..self.size()];
        starts.iter().map(|&start| self.values[start]).collect()
    }

    /// K x, both triangles taken.
    pub(crate) fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        for column in 0..self.size() {
            let own = self.first[column]..self.first[column + 1];
            let mut sum = self.values[own.start] * x[column];
            for at in own.start + 1..own.end {
                product[self.rows[at]] += self.values[at] * x[column];
                sum += self.values[at] * x[self.rows[at]];
            }
            product[column] += sum;
        }
        product
    }

    /// S K S with diagonal S.
    pub(crate) fn scale(&mut self, scale: &[f64]) {
        for column in 0..self.size() {
            for at in self.first[column]..self.first[column + 1] {
                self.values[at] *= scale[column] * scale[self.rows[at]];
            }
        }
    }

    /// K + shift I
    pub(crate) fn shift(&mut self, shift: f64) {
        for column in 0..self.size() {
            self.values[self.first[column]] += shift;
        }
    }
}
