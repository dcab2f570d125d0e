//! Rotations about skew axes that nothing stiffens: they are held, as those about the axes are.
//!
//! Where the rotations of a node have no stiffness about some direction, a member with a release
//! askew to the axes say, the whole stiffness has none there. A stiffness about that direction
//! alone changes no other motion.

use nalgebra::DMatrix;

use crate::error::Result;
use crate::fe::equilibrium::{LOOSE_MOMENT, loose_moment};
use crate::fe::reduction::Reduction;
use crate::sparse::lower_triangle::{Entry as Place, LowerTriangle};

/// Beside the stiffest direction of the node, what is below this is rounding.
const NO_STIFFNESS: f64 = 1e-12;

/// A direction about which one node turns freely.
#[derive(Debug, Clone)]
pub(crate) struct FreeRotation {
    /// (unknown, component)
    pub terms: Vec<(usize, f64)>,
    /// That it is given.
    stiffness: f64,
    /// The dof that turns most.
    dof: usize,
}

impl FreeRotation {
    pub(crate) fn find(matrix: &LowerTriangle, reduction: &Reduction) -> Vec<Self> {
        let unknowns = &reduction.unknowns;
        let mut found = Vec::new();
        let mut first = 0;
        while first < unknowns.len() {
            let node = unknowns[first] / 6;
            let turns = |at: &usize| unknowns[*at] / 6 == node && unknowns[*at] % 6 >= 3;
            let own: Vec<usize> = (first..unknowns.len().min(first + 6))
                .filter(turns)
                .collect();
            let same = |at: &&usize| *at / 6 == node;
            first += unknowns[first..].iter().take_while(same).count();
            if own.len() < 2 {
                continue;
            }
            let block = DMatrix::from_fn(own.len(), own.len(), |i, j| {
                let (row, column) = (own[i.max(j)], own[i.min(j)]);
                matrix.find(row, column).map_or(0.0, |at| matrix.values[at])
            });
            let eigen = block.symmetric_eigen();
            let stiffest = eigen.eigenvalues.max();
            for (value, direction) in eigen
                .eigenvalues
                .iter()
                .zip(eigen.eigenvectors.column_iter())
            {
                if *value <= NO_STIFFNESS * stiffest {
                    found.push(Self {
                        terms: own.iter().copied().zip(direction.iter().copied()).collect(),
                        stiffness: stiffest,
                        dof: unknowns[own[direction.iamax()]],
                    });
                }
            }
        }
        found
    }

    /// Stiffens it.
    pub(crate) fn hold(&self, matrix: &mut LowerTriangle) {
        for (row, column, value) in self.stiffness_on(matrix) {
            let at = matrix.place(row, column);
            matrix.values[at] += value;
        }
    }

    /// The stiffness that it is given, in the lower triangle.
    pub(crate) fn stiffness_on(&self, matrix: &LowerTriangle) -> Vec<Place> {
        let pairs = self
            .terms
            .iter()
            .flat_map(|&one| self.terms.iter().map(move |&other| (one, other)));
        let below = pairs.filter(|((row, _), (column, _))| row >= column);
        below
            .filter(|((row, _), (column, _))| matrix.find(*row, *column).is_some())
            .map(|((row, left), (column, right))| (row, column, self.stiffness * left * right))
            .collect()
    }

    /// A moment about it must not vanish silently. `forces` are those on the unknowns.
    pub(crate) fn check(&self, forces: &[f64], load: impl std::fmt::Display) -> Result<()> {
        let largest = forces
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()));
        let about = self.terms.iter().map(|&(at, part)| forces[at] * part);
        if about.sum::<f64>().abs() > LOOSE_MOMENT * largest {
            return Err(loose_moment(load, self.dof));
        }
        Ok(())
    }
}
