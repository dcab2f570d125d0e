//! Numeric Cholesky factorisation of large matrices, front by front.
//!
//! Columns of one pattern, with the rows below them, make a dense front: the matrix there, and
//! what earlier fronts leave to it. Its columns are eliminated; what this leaves of the rows below
//! goes to its parent (Duff and Reid, The multifrontal solution of indefinite sparse symmetric
//! linear equations, ACM Trans. Math. Softw. 9, 1983).

use std::ops::Range;

use faer::dyn_stack::{MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::*;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::{Accum, MatMut, Par};

use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::supernodes::Supernodes;

/// What all factorisations of one pattern share.
pub(crate) struct Fronts {
    /// In postorder: each right behind its subtrees.
    fronts: Vec<Front>,
    /// Of each front: its rows below, as rows of its parent.
    in_parent: Vec<u32>,
    /// Of each front: values of the matrix by number, and their places in it.
    entries: Vec<(usize, usize)>,
    /// Most numbers on each stack.
    room: [usize; 2],
}

struct Front {
    columns: usize,
    below: usize,
    /// Where its part of the factor and of `in_parent` begins.
    values: usize,
    rows: usize,
    entries: Range<usize>,
    /// How many; what they left is the last on the other stack.
    children: usize,
    /// What it leaves goes there.
    stack: usize,
}

/// What fronts left, until their parents take it. Parents take from one stack and leave on another.
#[derive(Default)]
pub(crate) struct Stack {
    numbers: Vec<f64>,
    used: usize,
    fronts: Vec<usize>,
}

impl Fronts {
    /// `inverse` is where each unknown of the matrix stands in the factor.
    pub(crate) fn new(
        symbolic: &SymbolicSupernodalCholesky<usize>,
        matrix: &LowerTriangle,
        inverse: &[usize],
    ) -> Self {
        let supernodes = Supernodes::new(symbolic);
        let count = supernodes.count();
        let mut stack = vec![0; count];
        for at in (0..count).rev() {
            stack[at] = supernodes.parent(at).map_or(0, |parent| 1 - stack[parent]);
        }
        let (first, entries) = supernodes.entries(matrix, inverse);
        let mut all = Self {
            fronts: Vec::with_capacity(count),
            in_parent: Vec::with_capacity(symbolic.row_idx().len()),
            entries,
            room: [0; 2],
        };
        let mut used = [0; 2];
        let mut children = vec![0; count];
        let mut left_to = vec![0; count];
        for at in supernodes.postorder() {
            let front = Front {
                columns: supernodes.columns(at).len(),
                below: supernodes.below(at).len(),
                values: symbolic.col_ptr_for_val()[at],
                rows: all.in_parent.len(),
                entries: first[at]..first[at + 1],
                children: children[at],
                stack: stack[at],
            };
            let rows = supernodes.in_parent(at);
            all.in_parent.extend(rows.map(|row| row as u32));
            used[front.stack] += front.left();
            all.room[front.stack] = all.room[front.stack].max(used[front.stack]);
            used[1 - front.stack] -= left_to[at];
            if let Some(parent) = supernodes.parent(at) {
                children[parent] += 1;
                left_to[parent] += front.left();
            }
            all.fronts.push(front);
        }
        all
    }

    /// For one factorisation at a time.
    pub(crate) fn stacks(&self) -> [Stack; 2] {
        self.room.map(|room| Stack {
            numbers: vec![0.0; room],
            ..Stack::default()
        })
    }

    pub(crate) fn scratch(&self) -> StackReq {
        let widest = self.fronts.iter().map(|front| front.columns).max();
        cholesky_in_place_scratch::<f64>(widest.unwrap_or(0), Par::Seq, Default::default())
    }

    /// Fills in the factor; false where the matrix is not positive definite.
    pub(crate) fn factorise(
        &self,
        matrix: &[f64],
        factor: &mut [f64],
        stacks: &mut [Stack; 2],
        scratch: &mut MemStack,
    ) -> bool {
        stacks.iter_mut().for_each(Stack::clear);
        let [even, odd] = stacks;
        for (at, front) in self.fronts.iter().enumerate() {
            let (own, other) = match front.stack {
                0 => (&mut *even, &mut *odd),
                _ => (&mut *odd, &mut *even),
            };
            let values = &mut factor[front.values..][..front.columns * front.height()];
            values.fill(0.0);
            for &(entry, place) in &self.entries[front.entries.clone()] {
                values[place] = matrix[entry];
            }
            self.take(front, other, |rows, left| {
                let column = rows[0] as usize;
                if column < front.columns {
                    let column = &mut values[column * front.height()..][..front.height()];
                    add(rows, left, column, 0);
                }
            });
            let left = own.push(at, front);
            if !front.eliminate(values, left, scratch) {
                return false;
            }
            self.take(front, other, |rows, numbers| {
                let column = rows[0] as usize;
                if column >= front.columns {
                    let column = (column - front.columns) * front.below;
                    add(
                        rows,
                        numbers,
                        &mut left[column..][..front.below],
                        front.columns,
                    );
                }
            });
            other.pop(front.children, &self.fronts);
        }
        true
    }

    /// Passes on the columns that the children of a front left: rows of the front, and numbers.
    fn take(&self, front: &Front, stack: &Stack, mut pass: impl FnMut(&[u32], &[f64])) {
        let mut end = stack.used;
        for &at in stack.fronts.iter().rev().take(front.children) {
            let child = &self.fronts[at];
            let left = &stack.numbers[end - child.left()..end];
            end -= child.left();
            let rows = &self.in_parent[child.rows..][..child.below];
            for (column, numbers) in left.chunks_exact(child.below).enumerate() {
                pass(&rows[column..], &numbers[column..]);
            }
        }
    }
}

/// Adds numbers to rows, less `skipped`, of a column.
fn add(rows: &[u32], numbers: &[f64], column: &mut [f64], skipped: usize) {
    for (&row, number) in rows.iter().zip(numbers) {
        column[row as usize - skipped] += number;
    }
}

impl Front {
    fn height(&self) -> usize {
        self.columns + self.below
    }

    /// How many numbers it leaves: a square, of which the lower triangle counts.
    fn left(&self) -> usize {
        self.below * self.below
    }

    /// Factorises the columns in place; false where they are not positive definite.
    fn eliminate(&self, values: &mut [f64], left: &mut [f64], scratch: &mut MemStack) -> bool {
        let values = MatMut::from_column_major_slice_mut(values, self.height(), self.columns);
        let (mut pivots, mut below) = values.split_at_row_mut(self.columns);
        let (regularization, params) = Default::default();
        if cholesky_in_place(pivots.rb_mut(), regularization, Par::Seq, scratch, params).is_err() {
            return false;
        }
        if self.below > 0 {
            solve_lower_triangular_in_place(pivots.rb(), below.rb_mut().transpose_mut(), Par::Seq);
            matmul(
                MatMut::from_column_major_slice_mut(left, self.below, self.below),
                BlockStructure::TriangularLower,
                Accum::Replace,
                below.rb(),
                BlockStructure::Rectangular,
                below.rb().transpose(),
                BlockStructure::Rectangular,
                -1.0,
                Par::Seq,
            );
        }
        true
    }
}

impl Stack {
    fn clear(&mut self) {
        self.used = 0;
        self.fronts.clear();
    }

    /// Room for what a front leaves.
    fn push(&mut self, at: usize, front: &Front) -> &mut [f64] {
        let start = self.used;
        self.used += front.left();
        self.fronts.push(at);
        &mut self.numbers[start..self.used]
    }

    fn pop(&mut self, count: usize, fronts: &[Front]) {
        let left = self.fronts.len() - count;
        let taken: usize = self.fronts.drain(left..).map(|at| fronts[at].left()).sum();
        self.used -= taken;
    }
}
