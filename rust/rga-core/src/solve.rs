//! Sparse Cholesky factor of a scaled stiffness.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::simplicial::SimplicialLltRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use crate::assembly::LowerTriangle;
use crate::error::{Error, Result};

pub struct Factor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl Factor {
    /// Nothing where the matrix is not positive definite.
    pub fn new(matrix: &LowerTriangle) -> Result<Option<Self>> {
        let mut factor = Self::analyse(matrix)?;
        Ok(factor.refactor(matrix).then_some(factor))
    }

    /// The symbolic analysis alone, which holds for all matrices of one
    /// pattern; `refactor` must follow.
    pub fn analyse(matrix: &LowerTriangle) -> Result<Self> {
        let size = matrix.size();
        let symbolic = factorize_symbolic_cholesky(
            pattern(matrix),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| too_large(size))?;
        Self::over(Arc::new(symbolic))
    }

    /// Another factor that shares the symbolic analysis; `refactor` must
    /// follow.
    pub fn another(&self) -> Result<Self> {
        Self::over(Arc::clone(&self.symbolic))
    }

    fn over(symbolic: Arc<SymbolicCholesky<usize>>) -> Result<Self> {
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let memory = MemBuffer::try_new(scratch).map_err(|_| too_large(symbolic.nrows()))?;
        Ok(Self {
            values: vec![0.0; symbolic.len_val()],
            symbolic,
            memory,
        })
    }

    /// False where the matrix is not positive definite.
    pub fn refactor(&mut self, matrix: &LowerTriangle) -> bool {
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.values,
            SparseColMatRef::new(pattern(matrix), &matrix.values),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        done.is_ok()
    }

    pub fn smallest_pivot(&self) -> f64 {
        let smaller = |least: f64, value: f64| least.min(value * value);
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(symbolic) => {
                let values = SimplicialLltRef::new(symbolic, &self.values).values();
                let starts = &symbolic.col_ptr()[..symbolic.ncols()];
                starts
                    .iter()
                    .map(|&start| values[start])
                    .fold(f64::INFINITY, smaller)
            }
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                let factor = SupernodalLltRef::new(symbolic, &self.values);
                (0..symbolic.n_supernodes())
                    .flat_map(|index| {
                        let block = factor.supernode(index).val();
                        (0..block.ncols()).map(move |at| block[(at, at)])
                    })
                    .fold(f64::INFINITY, smaller)
            }
        }
    }

    /// Solves in place; `columns` right-hand sides one behind the other.
    pub fn solve(&self, right: &mut [f64], columns: usize) -> Result<()> {
        let size = self.symbolic.nrows();
        let scratch = self
            .symbolic
            .solve_in_place_scratch::<f64>(columns, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large(size))?;
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, size, columns),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }
}

fn pattern(matrix: &LowerTriangle) -> SymbolicSparseColMatRef<'_, usize> {
    let size = matrix.size();
    SymbolicSparseColMatRef::new_checked(size, size, &matrix.first, None, &matrix.rows)
}

fn too_large(size: usize) -> Error {
    Error::invalid(format!("not enough memory to solve for {size} unknowns"))
}
