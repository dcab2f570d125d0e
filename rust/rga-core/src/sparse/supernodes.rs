//! Columns of a factor that share a pattern, as a tree: a parent holds the first row below them.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

use crate::sparse::lower_triangle::LowerTriangle;

pub(crate) struct Supernodes<'a> {
    symbolic: &'a SymbolicSupernodalCholesky<usize>,
    of_column: Vec<usize>,
}

impl<'a> Supernodes<'a> {
    pub(crate) fn new(symbolic: &'a SymbolicSupernodalCholesky<usize>) -> Self {
        let mut supernodes = Self {
            symbolic,
            of_column: vec![0; symbolic.ncols()],
        };
        for at in 0..supernodes.count() {
            let columns = supernodes.columns(at);
            supernodes.of_column[columns].fill(at);
        }
        supernodes
    }

    pub(crate) fn count(&self) -> usize {
        self.symbolic.n_supernodes()
    }

    pub(crate) fn columns(&self, at: usize) -> Range<usize> {
        self.symbolic.supernode_begin()[at]..self.symbolic.supernode_end()[at]
    }

    /// The rows below the columns; they ascend.
    pub(crate) fn below(&self, at: usize) -> &'a [usize] {
        let first = self.symbolic.col_ptr_for_row_idx();
        &self.symbolic.row_idx()[first[at]..first[at + 1]]
    }

    /// It comes later.
    pub(crate) fn parent(&self, at: usize) -> Option<usize> {
        self.below(at).first().map(|&row| self.of_column[row])
    }

    /// Each right behind its subtrees.
    pub(crate) fn postorder(&self) -> Vec<usize> {
        let count = self.count();
        let mut sizes = vec![1; count];
        for at in 0..count {
            if let Some(parent) = self.parent(at) {
                sizes[parent] += sizes[at];
            }
        }
        let mut order = vec![0; count];
        // Subtrees are laid down from the end: that of a parent ends with the parent.
        let mut ends = vec![0; count];
        let mut end = count;
        for at in (0..count).rev() {
            let end = match self.parent(at) {
                Some(parent) => &mut ends[parent],
                None => &mut end,
            };
            let place = *end - 1;
            *end -= sizes[at];
            order[place] = at;
            ends[at] = place;
        }
        order
    }

    /// The rows below, counted from the first column of the parent over its columns and the rows
    /// below these.
    pub(crate) fn in_parent(&self, at: usize) -> impl Iterator<Item = usize> {
        let parent = self.parent(at);
        let columns = parent.map_or(0..0, |parent| self.columns(parent));
        let mut later = parent.map_or(&[][..], |parent| self.below(parent)).iter();
        let mut place = columns.len();
        self.below(at).iter().map(move |&row| {
            if row < columns.end {
                return row - columns.start;
            }
            // Both ascend, and the parent has all rows of its child.
            place += 1 + later.by_ref().take_while(|&&other| other < row).count();
            place - 1
        })
    }

    /// Numbers of the values of a matrix, and their places among the values of their supernode,
    /// column by column: those of supernode k stand from the k-th of the first numbers on.
    /// `inverse` is where each unknown of the matrix stands in the factor.
    pub(crate) fn entries(
        &self,
        matrix: &LowerTriangle,
        inverse: &[usize],
    ) -> (Vec<usize>, Vec<(usize, usize)>) {
        let each = |pass: &mut dyn FnMut(usize, usize, usize)| {
            for (column, &one) in inverse.iter().enumerate() {
                for at in matrix.first[column]..matrix.first[column + 1] {
                    let other = inverse[matrix.rows[at]];
                    pass(at, one.max(other), one.min(other));
                }
            }
        };
        let mut first = vec![0; self.count() + 1];
        each(&mut |_, _, column| first[self.of_column[column] + 1] += 1);
        for at in 0..self.count() {
            first[at + 1] += first[at];
        }
        let mut next = first.clone();
        let mut entries = vec![(0, 0); matrix.values.len()];
        each(&mut |at, row, column| {
            let own = self.of_column[column];
            let (columns, below) = (self.columns(own), self.below(own));
            let height = columns.len() + below.len();
            let row = if row < columns.end {
                row - columns.start
            } else {
                columns.len() + below.partition_point(|&other| other < row)
            };
            entries[next[own]] = (at, (column - columns.start) * height + row);
            next[own] += 1;
        });
        (first, entries)
    }
}
