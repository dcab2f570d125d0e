//! From all dofs to the unknowns and back: u = T z + prescribed part.

use crate::fe::constraint::Constraints;

/// Relative to the stiffest direction of the node, a diagonal below this is
/// the rounding of direction cosines (squared), not stiffness.
pub(crate) const NO_STIFFNESS: f64 = 1e-21;

#[derive(Debug, Clone)]
pub(crate) struct Reduction {
    /// Rows of T in compressed form: (unknown, factor).
    first: Vec<usize>,
    entries: Vec<(usize, f64)>,
    /// The dof of each unknown.
    pub unknowns: Vec<usize>,
    /// Rotations that nothing stiffens: they are held at zero.
    pub held: Vec<usize>,
}

impl Reduction {
    /// `diagonal` is that of the unreduced stiffness.
    pub(crate) fn new(constraints: &Constraints, diagonal: &[f64]) -> Self {
        let mut reduced = diagonal.to_vec();
        for (dof, row) in constraints.rows.iter().enumerate() {
            for &(to, factor) in row.iter().flat_map(|row| &row.dofs) {
                reduced[to] += factor * factor * diagonal[dof];
            }
        }
        let mut reduction = Self {
            first: vec![0],
            entries: Vec::with_capacity(diagonal.len()),
            unknowns: Vec::new(),
            held: Vec::new(),
        };
        let mut number = vec![None; diagonal.len()];
        for dof in (0..diagonal.len()).filter(|&dof| constraints.rows[dof].is_none()) {
            if dof % 6 >= 3 && reduced[dof] <= NO_STIFFNESS * stiffest(&reduced, dof) {
                reduction.held.push(dof);
            } else {
                number[dof] = Some(reduction.unknowns.len());
                reduction.unknowns.push(dof);
            }
        }
        for (dof, row) in constraints.rows.iter().enumerate() {
            match row {
                None => reduction.entries.extend(number[dof].map(|to| (to, 1.0))),
                Some(row) => {
                    let kept = row
                        .dofs
                        .iter()
                        .filter_map(|&(to, f)| Some((number[to]?, f)));
                    let before = reduction.entries.len();
                    reduction.entries.extend(kept);
                    if reduction.entries.len() - before < row.dofs.len() {
                        reduction.held.push(dof);
                    }
                }
            }
            reduction.first.push(reduction.entries.len());
        }
        reduction
    }

    /// Of the unknowns, from those of the nodes.
    pub(crate) fn places(&self, nodes: &[[f64; 3]]) -> Vec<[f64; 3]> {
        self.unknowns.iter().map(|dof| nodes[dof / 6]).collect()
    }

    /// The unknowns that move `dof`, with their factors.
    pub(crate) fn entries(&self, dof: usize) -> &[(usize, f64)] {
        &self.entries[self.first[dof]..self.first[dof + 1]]
    }

    /// What an entry of a matrix of all dofs adds to the lower triangle of that of the unknowns.
    pub(crate) fn pass_on(
        &self,
        (row, column, value): (usize, usize, f64),
        mut add: impl FnMut(usize, usize, f64),
    ) {
        if value == 0.0 {
            return;
        }
        for &(i, left) in self.entries(row) {
            for &(j, right) in self.entries(column) {
                if i >= j {
                    add(i, j, left * value * right);
                }
            }
        }
    }

    /// `displacements` += T `unknowns`.
    pub(crate) fn expand(&self, unknowns: &[f64], displacements: &mut [f64]) {
        for (dof, displacement) in displacements.iter_mut().enumerate() {
            for &(from, factor) in self.entries(dof) {
                *displacement += factor * unknowns[from];
            }
        }
    }

    /// `reduced` = T' `forces`.
    pub(crate) fn collect(&self, forces: &[f64], reduced: &mut [f64]) {
        reduced.fill(0.0);
        for (dof, force) in forces.iter().enumerate() {
            for &(to, factor) in self.entries(dof) {
                reduced[to] += factor * force;
            }
        }
    }
}

/// The largest diagonal among the three translations, or rotations, that
/// `dof` belongs to.
pub(crate) fn stiffest(diagonal: &[f64], dof: usize) -> f64 {
    let first = dof - dof % 3;
    diagonal[first..first + 3]
        .iter()
        .fold(0.0, |most, &value| most.max(value))
}
