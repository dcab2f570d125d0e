//! Structures that swing, by `ModalBatch`, and the same by dense matrices.

use nalgebra::{DMatrix, DVector};
use rga_core::{Array, ModalBatch, Result, modal_energies};

use super::masses::{mass, with_masses};
use super::samples::{Random, bridge};
use super::{AREA, Case, E};

const LINE: f64 = 60.0;

pub struct Swinging {
    pub case: Case,
    pub line: f64,
    /// Masses on nodes.
    pub nodal: Vec<(usize, [f64; 6])>,
}

impl Swinging {
    /// A bridge of crooked members with masses on some nodes.
    pub fn bridge(bays: i64, frame: bool) -> Self {
        let (case, mut random) = (bridge(bays, frame), Random(9));
        let nodal = (0..case.nodes.len()).step_by(3);
        Self {
            nodal: nodal
                .map(|node| (node, mass(random.between(100.0, 900.0))))
                .collect(),
            line: LINE,
            case,
        }
    }

    /// Masses on bars of their own, of unit mass, with stiffnesses of `squares`.
    pub fn oscillators(squares: &[f64]) -> Self {
        let apart = |at: usize| 10.0 * at as f64;
        let length = |square: f64| E * AREA / square;
        let held: Vec<[f64; 3]> = (0..squares.len()).map(|at| [0.0, apart(at), 0.0]).collect();
        let free = squares.iter().enumerate();
        let free = free.map(|(at, square)| [length(*square), apart(at), 0.0]);
        let nodes: Vec<[f64; 3]> = held.iter().copied().chain(free).collect();
        let count = squares.len() as i64;
        let bars: Vec<([i64; 2], bool)> = (0..count).map(|at| ([at, at + count], false)).collect();
        let mut case = Case::new(&nodes, &bars);
        for at in 0..squares.len() {
            case = case.fix(at, &[0, 1, 2]).fix(at + squares.len(), &[1, 2]);
        }
        let masses = (0..squares.len()).map(|at| (at + squares.len(), mass(1.0)));
        Self {
            nodal: masses.collect(),
            line: 0.0,
            case,
        }
    }

    /// Members, and springs behind them.
    pub fn elements(&self) -> usize {
        self.case.ends.len() + self.case.springs.len()
    }

    pub fn batch(&self, count: usize, dofs: &[usize], set: Option<&str>) -> Result<ModalBatch> {
        let all: Vec<usize> = (0..self.elements()).collect();
        self.batch_of(&all, count, dofs, set)
    }

    pub fn batch_of(
        &self,
        varied: &[usize],
        count: usize,
        dofs: &[usize],
        set: Option<&str>,
    ) -> Result<ModalBatch> {
        with_masses(&self.case, self.line, &self.nodal, |structure, masses| {
            ModalBatch::new(structure, masses, varied, count, dofs, set)
        })
    }

    /// Factors on all elements, of factors on those that vary.
    pub fn on_all(&self, varied: &[usize], factors: &[f64]) -> Vec<f64> {
        let mut all = vec![1.0; self.elements()];
        for (&element, factor) in varied.iter().zip(factors) {
            all[element] = *factor;
        }
        all
    }

    /// Holds the modes of samples against dense matrices.
    pub fn check(&self, varied: &[usize], count: usize, factors: &[f64]) -> Result<()> {
        let matrices = Matrices::of(self);
        let dofs: Vec<usize> = (0..matrices.dofs).collect();
        let batch = self.batch_of(varied, count, &dofs, None)?;
        let rows = factors.len() / varied.len();
        let found = batch.modes(Array::new(factors, &[rows, varied.len()]), 1)?;
        let of_rows = found.chunks_exact(batch.width());
        for (factors, found) in factors.chunks_exact(varied.len()).zip(of_rows) {
            matrices.check(&self.on_all(varied, factors), found);
        }
        Ok(())
    }
}

/// Of the dofs that move: which, the stiffness of each element, and the mass.
struct Matrices {
    dofs: usize,
    moving: Vec<usize>,
    stiffness: Vec<DMatrix<f64>>,
    mass: DMatrix<f64>,
}

/// x' A x of matrices A, for motions x along one dof, or along two.
struct Forms<'a> {
    swinging: &'a Swinging,
    dofs: usize,
}

impl Forms<'_> {
    /// Of the stiffness of each element, then of the mass.
    fn along(&self, pairs: &[[usize; 2]]) -> Vec<Vec<f64>> {
        let Swinging { case, line, nodal } = self.swinging;
        let mut motions = vec![0.0; pairs.len() * self.dofs];
        for (motion, pair) in motions.chunks_exact_mut(self.dofs).zip(pairs) {
            pair.iter().for_each(|&dof| motion[dof] = 1.0);
        }
        let found = with_masses(case, *line, nodal, |structure, masses| {
            modal_energies(structure, masses, &motions).unwrap()
        });
        let strain = found.strain.chunks_exact(self.swinging.elements());
        let kinetic = (found.kinetic).chunks_exact(found.kinetic.len() / pairs.len());
        let each = strain.zip(kinetic);
        each.map(|(strain, kinetic)| [strain, &[kinetic.iter().sum()]].concat())
            .collect()
    }
}

impl Matrices {
    fn of(swinging: &Swinging) -> Self {
        let dofs = 6 * swinging.case.nodes.len();
        let forms = Forms { swinging, dofs };
        let diagonal = forms.along(&(0..dofs).map(|dof| [dof, dof]).collect::<Vec<_>>());
        let fixed = swinging.case.fixed.as_flattened();
        let elements = swinging.elements();
        let stiff = |dof: usize| diagonal[dof][..elements].iter().sum::<f64>() > 0.0;
        let moving: Vec<usize> = (0..dofs).filter(|&dof| !fixed[dof] && stiff(dof)).collect();
        let size = moving.len();
        let mut all = vec![DMatrix::zeros(size, size); elements + 1];
        for (column, &other) in moving.iter().enumerate() {
            let pairs: Vec<[usize; 2]> = moving[column..].iter().map(|&one| [one, other]).collect();
            for ([one, _], (row, both)) in pairs.iter().zip((column..).zip(forms.along(&pairs))) {
                for (at, matrix) in all.iter_mut().enumerate() {
                    let (first, last) = (diagonal[*one][at], diagonal[other][at]);
                    let off = 0.5 * (both[at] - first - last);
                    let value = if row == column { first } else { off };
                    (matrix[(row, column)], matrix[(column, row)]) = (value, value);
                }
            }
        }
        let mass = all.pop().unwrap();
        Self {
            dofs,
            moving,
            stiffness: all,
            mass,
        }
    }

    /// Holds the lowest modes of factors, each an eigenvalue and motions along all dofs, against
    /// those of the matrices.
    fn check(&self, factors: &[f64], found: &[f64]) {
        let size = self.moving.len();
        let mut stiffness = DMatrix::zeros(size, size);
        for (own, factor) in self.stiffness.iter().zip(factors) {
            stiffness += own * *factor;
        }
        let lower = stiffness.clone().cholesky().unwrap().l();
        let half = lower.solve_lower_triangular(&self.mass).unwrap();
        let whole = lower.solve_lower_triangular(&half.transpose()).unwrap();
        let mut exact: Vec<f64> = whole.symmetric_eigenvalues().iter().copied().collect();
        exact.sort_by(|one, other| other.total_cmp(one));
        for (mode, exact) in found.chunks_exact(1 + self.dofs).zip(exact) {
            let (value, motion) = (mode[0], &mode[1..]);
            let error = value * exact - 1.0;
            assert!(error.abs() < 1e-9, "{value} instead of {}", 1.0 / exact);
            let shape = DVector::from_iterator(size, self.moving.iter().map(|&at| motion[at]));
            let force = &stiffness * &shape;
            let left = &force - &self.mass * &shape * value;
            // In the norm of K^-1.
            let solved = |force: &DVector<f64>| lower.solve_lower_triangular(force).unwrap();
            assert!(solved(&left).norm() < 1e-5 * solved(&force).norm());
            assert!((shape.dot(&(&self.mass * &shape)) - 1.0).abs() < 1e-9);
        }
    }
}
