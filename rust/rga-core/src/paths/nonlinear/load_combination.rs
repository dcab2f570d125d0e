//! One load as the sum of patterns times coefficients.

use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::load::PatternLoads;
use crate::input::Loads;

#[derive(Debug)]
pub(super) struct Combination {
    forces: Sparse,
    strain: Sparse,
    /// With all unknowns at zero.
    displacements: Sparse,
    members: PatternLoads,
    member_patterns: Vec<usize>,
}

/// A load of one sample.
#[derive(Debug, Clone)]
pub(super) struct Combined {
    pub forces: Vec<f64>,
    pub strain: Vec<f64>,
    pub displacements: Vec<f64>,
    pub members: PatternLoads,
}

/// What is not zero of `[patterns, width]`: (pattern, index, value).
#[derive(Debug)]
struct Sparse {
    width: usize,
    entries: Vec<(usize, usize, f64)>,
}

impl Combination {
    pub(super) fn new(loads: &Loads, constraints: &Constraints, members: usize) -> Result<Self> {
        let dofs = constraints.rows.len();
        let patterns = 0..loads.pattern_count();
        let moved = patterns.clone().map(|pattern| {
            let values = constraints.values(loads, pattern)?;
            Ok(constraints.base_displacements(&values))
        });
        let moved: Vec<Vec<f64>> = moved.collect::<Result<_>>()?;
        let (merged, member_patterns) = PatternLoads::merge(loads, members);
        Ok(Self {
            forces: Sparse::new(dofs, patterns.clone().map(|at| loads.forces.row(at))),
            strain: Sparse::new(3 * members, patterns.map(|at| loads.strain.row(at))),
            displacements: Sparse::new(dofs, moved.iter().map(Vec::as_slice)),
            members: merged,
            member_patterns,
        })
    }

    /// Room for a sample.
    pub(super) fn room(&self) -> Combined {
        Combined {
            forces: vec![0.0; self.forces.width],
            strain: vec![0.0; self.strain.width],
            displacements: vec![0.0; self.displacements.width],
            members: self.members.clone(),
        }
    }

    /// With coefficients for forces, and others for initial strains and prescribed displacements.
    pub(super) fn combine(
        &self,
        of_forces: &[f64],
        of_strains: &[f64],
        into: &mut Combined,
    ) -> Result<()> {
        self.forces.combine(of_forces, &mut into.forces);
        self.strain.combine(of_strains, &mut into.strain);
        self.displacements
            .combine(of_strains, &mut into.displacements);
        into.members
            .combine(&self.members, &self.member_patterns, of_forces);
        let sums = [&into.forces, &into.strain, &into.displacements];
        if into.members.is_finite() && sums.into_iter().flatten().all(|sum| sum.is_finite()) {
            Ok(())
        } else {
            Err(Error::invalid("the load overflows; lower the coefficients"))
        }
    }
}

impl Sparse {
    fn new<'a>(width: usize, rows: impl Iterator<Item = &'a [f64]>) -> Self {
        let entries = rows.enumerate().flat_map(|(pattern, row)| {
            let filled = row.iter().enumerate().filter(|&(_, &value)| value != 0.0);
            filled.map(move |(index, &value)| (pattern, index, value))
        });
        Self {
            width,
            entries: entries.collect(),
        }
    }

    fn combine(&self, coefficients: &[f64], into: &mut [f64]) {
        into.fill(0.0);
        for &(pattern, index, value) in &self.entries {
            into[index] += coefficients[pattern] * value;
        }
    }
}
