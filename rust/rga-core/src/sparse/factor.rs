//! Sparse Cholesky factor of a scaled stiffness.

use std::mem;
use std::sync::{Arc, Mutex};

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::simplicial::SimplicialLltRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Conj, MatMut, Par, Side};

use crate::error::{Error, Result};
use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::multifrontal::{Fronts, Stack};
use crate::sparse::ordering::{fill_reducing, inverse};

pub(crate) struct Factor {
    analysis: Arc<Analysis>,
    values: Vec<f64>,
    memory: MemBuffer,
    stacks: [Stack; 2],
    /// 0 where the matrix is not positive definite.
    smallest_pivot: f64,
}

/// What holds for all matrices of one pattern.
struct Analysis {
    symbolic: SymbolicCholesky<usize>,
    /// Where the factor has dense parts; a small one has none.
    fronts: Option<Fronts>,
    /// Values of a factor that is done with: large memory is slow to get from the system.
    spare: Mutex<Vec<f64>>,
}

impl Factor {
    /// The symbolic analysis alone, which holds for all matrices of one
    /// pattern; `factorise` must follow, about `repeats` times. `places` are
    /// those of the unknowns.
    pub(crate) fn analyse(
        matrix: &LowerTriangle,
        places: &[[f64; 3]],
        repeats: f64,
    ) -> Result<Self> {
        let (symbolic, inverse) = symbolic(matrix, places, repeats)?;
        let fronts = match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(_) => None,
            SymbolicCholeskyRaw::Supernodal(raw) => Some(Fronts::new(raw, matrix, &inverse)),
        };
        Self::over(Arc::new(Analysis {
            symbolic,
            fronts,
            spare: Mutex::default(),
        }))
    }

    /// Another factor that shares the symbolic analysis; `factorise` must
    /// follow.
    pub(crate) fn another(&self) -> Result<Self> {
        Self::over(Arc::clone(&self.analysis))
    }

    fn over(analysis: Arc<Analysis>) -> Result<Self> {
        let symbolic = &analysis.symbolic;
        let scratch = match &analysis.fronts {
            None => symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            Some(fronts) => fronts.scratch(),
        };
        let memory = MemBuffer::try_new(scratch).map_err(|_| too_large(symbolic.nrows()))?;
        Ok(Self {
            values: analysis.room(),
            stacks: analysis
                .fronts
                .as_ref()
                .map(Fronts::stacks)
                .unwrap_or_default(),
            analysis,
            memory,
            smallest_pivot: f64::NAN,
        })
    }

    /// False where the matrix is not positive definite.
    pub(crate) fn factorise(&mut self, matrix: &LowerTriangle) -> bool {
        let memory = MemStack::new(&mut self.memory);
        let done = match &self.analysis.fronts {
            Some(fronts) => {
                fronts.factorise(&matrix.values, &mut self.values, &mut self.stacks, memory)
            }
            None => {
                let done = self.analysis.symbolic.factorize_numeric_llt(
                    &mut self.values,
                    SparseColMatRef::new(matrix.pattern(), &matrix.values),
                    Side::Lower,
                    LltRegularization::default(),
                    Par::Seq,
                    memory,
                    Default::default(),
                );
                done.is_ok()
            }
        };
        self.smallest_pivot = if done { self.least_pivot() } else { 0.0 };
        done
    }

    pub(crate) fn smallest_pivot(&self) -> f64 {
        self.smallest_pivot
    }

    fn least_pivot(&self) -> f64 {
        let smaller = |least: f64, value: f64| least.min(value * value);
        match self.analysis.symbolic.raw() {
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
    pub(crate) fn solve(&self, right: &mut [f64], columns: usize) -> Result<()> {
        let symbolic = &self.analysis.symbolic;
        let size = symbolic.nrows();
        let scratch = symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| too_large(size))?;
        LltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, size, columns),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }
}

impl Analysis {
    fn room(&self) -> Vec<f64> {
        match self.spare.lock().map(|mut spare| mem::take(&mut *spare)) {
            Ok(spare) if !spare.is_empty() => spare,
            _ => vec![0.0; self.symbolic.len_val()],
        }
    }
}

impl Drop for Factor {
    fn drop(&mut self) {
        if let Ok(mut spare) = self.analysis.spare.lock() {
            *spare = mem::take(&mut self.values);
        }
    }
}

/// The analysis of a pattern, and where each unknown stands in its factor.
pub(super) fn symbolic(
    matrix: &LowerTriangle,
    places: &[[f64; 3]],
    repeats: f64,
) -> Result<(SymbolicCholesky<usize>, Vec<usize>)> {
    let size = matrix.size();
    let order = fill_reducing(matrix, places, repeats).ok_or_else(|| too_large(size))?;
    let inverse = inverse(&order);
    let symbolic = factorize_symbolic_cholesky(
        matrix.pattern(),
        Side::Lower,
        SymmetricOrdering::Custom(PermRef::new_checked(&order, &inverse, size)),
        CholeskySymbolicParams::default(),
    )
    .map_err(|_| too_large(size))?;
    Ok((symbolic, inverse))
}

fn too_large(size: usize) -> Error {
    Error::invalid(format!("not enough memory to solve for {size} unknowns"))
}
