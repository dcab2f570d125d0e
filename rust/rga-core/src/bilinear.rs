//! Sparse forms that are linear in weights and in a vector: y = sum over k of w[k] A[k] x.

/// `value` in row and column of the matrix of one weight.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    pub weight: usize,
    pub row: usize,
    pub column: usize,
    pub value: f64,
}

#[derive(Debug)]
pub struct Bilinear {
    /// Of each weight, one behind the other.
    entries: Vec<Entry>,
    first: Vec<usize>,
    /// Weights that have entries.
    filled: Vec<usize>,
}

impl Bilinear {
    /// Entries of one place are summed, in their order.
    pub fn new(mut entries: Vec<Entry>, weights: usize) -> Self {
        let place = |entry: &Entry| (entry.weight, entry.row, entry.column);
        entries.sort_by_key(place);
        entries.dedup_by(|next, sum| {
            let same = place(next) == place(sum);
            if same {
                sum.value += next.value;
            }
            same
        });
        entries.retain(|entry| entry.value != 0.0);
        let starts = 0..=weights;
        let first: Vec<usize> = starts
            .map(|weight| entries.partition_point(|entry| entry.weight < weight))
            .collect();
        let filled = (0..weights).filter(|&at| first[at] < first[at + 1]);
        Self {
            filled: filled.collect(),
            entries,
            first,
        }
    }

    /// `out` += w A x
    pub fn add(&self, weights: &[f64], x: &[f64], out: &mut [f64]) {
        for &at in &self.filled {
            self.add_one(at, weights[at], x, out);
        }
    }

    /// The part of one weight.
    pub fn add_one(&self, at: usize, weight: f64, x: &[f64], out: &mut [f64]) {
        for entry in self.of(at) {
            out[entry.row] += weight * entry.value * x[entry.column];
        }
    }

    /// `out` += (w A)' y
    pub fn add_transposed(&self, weights: &[f64], y: &[f64], out: &mut [f64]) {
        for &at in &self.filled {
            for entry in self.of(at) {
                out[entry.column] += weights[at] * entry.value * y[entry.row];
            }
        }
    }

    /// `out[k]` += y' A[k] x
    pub fn add_to_weights(&self, y: &[f64], x: &[f64], out: &mut [f64]) {
        for &at in &self.filled {
            let products = self.of(at).iter();
            out[at] += products
                .map(|entry| y[entry.row] * entry.value * x[entry.column])
                .sum::<f64>();
        }
    }

    fn of(&self, weight: usize) -> &[Entry] {
        &self.entries[self.first[weight]..self.first[weight + 1]]
    }
}
