//! Which unknowns a matrix couples.

use crate::sparse::lower_triangle::LowerTriangle;

/// Every coupling stands at both of its ends.
pub(crate) struct Graph {
    first: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Graph {
    pub(crate) fn new(matrix: &LowerTriangle) -> Self {
        let size = matrix.size();
        let below =
            |column: usize| &matrix.rows[matrix.first[column] + 1..matrix.first[column + 1]];
        let mut first = vec![0; size + 1];
        for column in 0..size {
            first[column + 1] += below(column).len();
            for &row in below(column) {
                first[row + 1] += 1;
            }
        }
        for at in 0..size {
            first[at + 1] += first[at];
        }
        let mut next = first.clone();
        let mut neighbours = vec![0; first[size]];
        let mut add = |at: usize, neighbour: usize| {
            neighbours[next[at]] = neighbour as u32;
            next[at] += 1;
        };
        for column in 0..size {
            for &row in below(column) {
                add(column, row);
                add(row, column);
            }
        }
        Self { first, neighbours }
    }

    pub(crate) fn size(&self) -> usize {
        self.first.len() - 1
    }

    pub(crate) fn neighbours(&self, at: usize) -> impl Iterator<Item = usize> {
        let own = &self.neighbours[self.first[at]..self.first[at + 1]];
        own.iter().map(|&neighbour| neighbour as usize)
    }
}
