//! The stiffness of the unknowns, as a sparse lower triangle.

use crate::model::Model;
use crate::reduction::Reduction;

/// Compressed columns; rows ascend within a column and the diagonal, which is
/// always there, comes first.
#[derive(Debug, Clone)]
pub struct LowerTriangle {
    pub first: Vec<usize>,
    pub rows: Vec<usize>,
    pub values: Vec<f64>,
}

/// (row, column, value)
pub type Entry = (usize, usize, f64);

impl LowerTriangle {
    /// T' K T
    pub fn assemble(model: &Model, reduction: &Reduction) -> Self {
        let size = reduction.unknowns.len();
        let mut entries: Vec<Entry> = (0..size).map(|at| (at, at, 0.0)).collect();
        model.for_each_stiffness(|row, column, value| {
            if value == 0.0 {
                return;
            }
            for &(i, left) in reduction.entries(row) {
                for &(j, right) in reduction.entries(column) {
                    if i >= j {
                        entries.push((i, j, left * value * right));
                    }
                }
            }
        });
        Self::from_entries(&entries, size)
    }

    /// Entries repeat; all diagonal ones are there.
    pub fn from_entries(entries: &[Entry], size: usize) -> Self {
        let entries = bucket(entries, size, |entry| entry.0);
        let entries = bucket(&entries, size, |entry| entry.1);
        let mut matrix = Self {
            first: Vec::with_capacity(size + 1),
            rows: Vec::with_capacity(entries.len()),
            values: Vec::with_capacity(entries.len()),
        };
        let mut last = None;
        for (row, column, value) in entries {
            if last == Some((row, column)) {
                if let Some(sum) = matrix.values.last_mut() {
                    *sum += value;
                }
                continue;
            }
            if row == column {
                matrix.first.push(matrix.rows.len());
            }
            matrix.rows.push(row);
            matrix.values.push(value);
            last = Some((row, column));
        }
        matrix.first.push(matrix.rows.len());
        matrix
    }

    pub fn size(&self) -> usize {
        self.first.len() - 1
    }

    /// Where the entry, which is there, stands in `values`.
    pub fn place(&self, row: usize, column: usize) -> usize {
        let (first, end) = (self.first[column], self.first[column + 1]);
        first + self.rows[first..end].partition_point(|&other| other < row)
    }

    /// The same of an entry that may not be there.
    pub fn find(&self, row: usize, column: usize) -> Option<usize> {
        let at = self.place(row, column);
        let there = at < self.first[column + 1] && self.rows[at] == row;
        there.then_some(at)
    }

    pub fn diagonal(&self) -> Vec<f64> {
        let starts = &self.first[..self.size()];
        starts.iter().map(|&start| self.values[start]).collect()
    }

    /// K x, both triangles taken.
    pub fn product(&self, x: &[f64]) -> Vec<f64> {
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
    pub fn scale(&mut self, scale: &[f64]) {
        for column in 0..self.size() {
            for at in self.first[column]..self.first[column + 1] {
                self.values[at] *= scale[column] * scale[self.rows[at]];
            }
        }
    }

    /// K + shift I
    pub fn shift(&mut self, shift: f64) {
        for column in 0..self.size() {
            self.values[self.first[column]] += shift;
        }
    }
}

/// Stable counting sort: linear, and the order of sums stays fixed.
fn bucket(entries: &[Entry], size: usize, key: impl Fn(&Entry) -> usize) -> Vec<Entry> {
    let mut next = vec![0; size + 1];
    for entry in entries {
        next[key(entry) + 1] += 1;
    }
    for at in 0..size {
        next[at + 1] += next[at];
    }
    let mut sorted = vec![(0, 0, 0.0); entries.len()];
    for entry in entries {
        let slot = &mut next[key(entry)];
        sorted[*slot] = *entry;
        *slot += 1;
    }
    sorted
}
