//! How many eigenvalues of a symmetric matrix are negative: Sylvester's law of inertia.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::simplicial::SimplicialLdltRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLdltRef;
use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};
use faer::{Par, Side};

use crate::error::{Error, Result};
use crate::sparse::factor::symbolic;
use crate::sparse::lower_triangle::LowerTriangle;

/// The symbolic analysis of L D L', which holds for all matrices of one pattern.
pub(crate) struct Inertia {
    symbolic: SymbolicCholesky<usize>,
}

impl Inertia {
    /// For about as many matrices as `repeats` says; `places` are those of the unknowns.
    pub(crate) fn analyse(
        matrix: &LowerTriangle,
        places: &[[f64; 3]],
        repeats: f64,
    ) -> Result<Self> {
        let (symbolic, _) = symbolic(matrix, places, repeats)?;
        Ok(Self { symbolic })
    }

    /// How many there are of a matrix of the pattern, from the pivots.
    pub(crate) fn negative_eigenvalues(&self, matrix: &LowerTriangle) -> Result<usize> {
        let symbolic = &self.symbolic;
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        let memory = MemBuffer::try_new(scratch);
        let mut memory = memory.map_err(|_| Error::invalid("not enough memory to count modes"))?;
        let mut values = vec![0.0; symbolic.len_val()];
        symbolic
            .factorize_numeric_ldlt(
                &mut values,
                SparseColMatRef::new(matrix.pattern(), &matrix.values),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|_| Error::invalid("modes cannot be counted: a pivot is zero"))?;
        let pivots: Vec<f64> = match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(raw) => {
                let values = SimplicialLdltRef::new(raw, &values).values();
                let starts = &raw.col_ptr()[..raw.ncols()];
                starts.iter().map(|&start| values[start]).collect()
            }
            SymbolicCholeskyRaw::Supernodal(raw) => {
                let factor = SupernodalLdltRef::new(raw, &values);
                (0..raw.n_supernodes())
                    .flat_map(|index| {
                        let block = factor.supernode(index).val();
                        (0..block.ncols()).map(move |at| block[(at, at)])
                    })
                    .collect()
            }
        };
        Ok(pivots.iter().filter(|pivot| **pivot < 0.0).count())
    }
}
