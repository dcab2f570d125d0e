//! Supports, inclined supports and ties, by elimination.
//!
//! Each constraint removes one dof: after elimination every removed dof is a
//! sum over remaining dofs and over prescribed values,
//! u = sum m z + sum v g. All mixes (a tie to an inclined support, say) are
//! one case, and the same numbers v give the constraint forces.

use crate::error::{Error, Result};
use crate::input::{Loads, Structure};

#[derive(Debug, Clone, Copy)]
enum Value {
    Dof(usize),
    Inclined(usize),
    Zero,
}

#[derive(Debug, Clone)]
struct Constraint {
    /// (dof, factor)
    terms: Vec<(usize, f64)>,
    value: Value,
}

/// (index, factor) lists over remaining dofs and over constraints.
#[derive(Debug, Clone, Default)]
pub(crate) struct Row {
    pub dofs: Vec<(usize, f64)>,
    values: Vec<(usize, f64)>,
}

#[derive(Debug, Clone, Default)]
pub(crate) struct Constraints {
    list: Vec<Constraint>,
    /// Of each dof: how it follows, if a constraint removed it.
    pub rows: Vec<Option<Row>>,
    /// Constraints that others imply, as 0 = sum v g.
    redundant: Vec<Row>,
}

/// What is left of a constraint that others imply.
const NEGLIGIBLE: f64 = 1e-9;

impl Constraints {
    pub(crate) fn new(structure: &Structure) -> Self {
        let mut constraints = Self {
            list: Vec::new(),
            rows: vec![None; 6 * structure.node_count()],
            redundant: Vec::new(),
        };
        let mut linked = Vec::new();
        for constraint in read(structure) {
            constraints.eliminate(constraint, &mut linked);
        }
        constraints
    }

    /// `linked` are the removed dofs that follow others.
    fn eliminate(&mut self, constraint: Constraint, linked: &mut Vec<usize>) {
        let index = self.list.len();
        let mut row = Row::default();
        row.values.push((index, -1.0));
        for &(dof, factor) in &constraint.terms {
            self.substitute(&mut row, dof, factor);
        }
        self.list.push(constraint);
        let pivot = row
            .dofs
            .iter()
            .copied()
            .filter(|(_, factor)| factor.abs() > NEGLIGIBLE)
            .reduce(|best, next| {
                if next.1.abs() > best.1.abs() {
                    next
                } else {
                    best
                }
            });
        let Some((removed, factor)) = pivot else {
            self.redundant.push(row);
            return;
        };
        row.dofs.retain(|&(dof, _)| dof != removed);
        for (_, term) in row.dofs.iter_mut().chain(&mut row.values) {
            *term /= -factor;
        }
        for &dof in linked.iter() {
            if let Some(mut follower) = self.rows[dof].take() {
                if let Some(at) = follower.dofs.iter().position(|term| term.0 == removed) {
                    let (_, factor) = follower.dofs.swap_remove(at);
                    follower.add(&row, factor);
                }
                self.rows[dof] = Some(follower);
            }
        }
        if !row.dofs.is_empty() {
            linked.push(removed);
        }
        self.rows[removed] = Some(row);
    }

    fn substitute(&self, row: &mut Row, dof: usize, factor: f64) {
        match &self.rows[dof] {
            None => add_term(&mut row.dofs, dof, factor),
            Some(known) => row.add(known, factor),
        }
    }

    /// The prescribed values of one pattern, by constraint.
    pub(crate) fn values(&self, loads: &Loads, pattern: usize) -> Result<Vec<f64>> {
        let value = |constraint: &Constraint| match constraint.value {
            Value::Dof(dof) => loads.prescribed.row(pattern)[dof],
            Value::Inclined(index) => loads.prescribed_inclined.row(pattern)[index],
            Value::Zero => 0.0,
        };
        let values: Vec<f64> = self.list.iter().map(value).collect();
        let largest = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        for row in &self.redundant {
            if row.sum(&values).abs() > NEGLIGIBLE * largest {
                let named = row
                    .values
                    .first()
                    .map(|&(index, _)| self.list[index].name());
                return Err(Error::invalid(format!(
                    "prescribed values of pattern {pattern} contradict each other at {}; supports \
                     and ties that hold the same motion must prescribe the same value",
                    named.unwrap_or_default()
                )));
            }
        }
        Ok(values)
    }

    /// Displacements with all remaining dofs at zero.
    pub(crate) fn base_displacements(&self, values: &[f64]) -> Vec<f64> {
        let base = |row: &Option<Row>| row.as_ref().map_or(0.0, |row| row.sum(values));
        self.rows.iter().map(base).collect()
    }

    /// Forces of supports (not ties) on all dofs, from what is out of balance:
    /// internal minus applied forces.
    pub(crate) fn support_forces(&self, unbalanced: &[f64]) -> Vec<f64> {
        let mut multipliers = vec![0.0; self.list.len()];
        for (row, force) in self.rows.iter().zip(unbalanced) {
            for &(index, factor) in row.iter().flat_map(|row| &row.values) {
                multipliers[index] += factor * force;
            }
        }
        let mut forces = vec![0.0; self.rows.len()];
        for (constraint, multiplier) in self.list.iter().zip(multipliers) {
            if !matches!(constraint.value, Value::Zero) {
                for &(dof, factor) in &constraint.terms {
                    forces[dof] += factor * multiplier;
                }
            }
        }
        forces
    }

    /// Weights of what is out of balance, by dof, in the force of supports along a direction at
    /// three dofs.
    pub(crate) fn support_weights(&self, first: usize, direction: &[f64]) -> Vec<(usize, f64)> {
        let along = |constraint: &Constraint| -> f64 {
            if matches!(constraint.value, Value::Zero) {
                return 0.0;
            }
            let own = constraint.terms.iter().filter(|term| term.0 >= first);
            let own = own.filter_map(|term| Some(direction.get(term.0 - first)? * term.1));
            own.sum()
        };
        let multipliers: Vec<f64> = self.list.iter().map(along).collect();
        let removed = self.rows.iter().enumerate();
        let removed = removed.filter_map(|(dof, row)| Some((dof, row.as_ref()?.sum(&multipliers))));
        removed.filter(|(_, weight)| *weight != 0.0).collect()
    }
}

impl Row {
    fn add(&mut self, other: &Row, factor: f64) {
        for &(dof, term) in &other.dofs {
            add_term(&mut self.dofs, dof, factor * term);
        }
        for &(index, term) in &other.values {
            add_term(&mut self.values, index, factor * term);
        }
    }

    fn sum(&self, values: &[f64]) -> f64 {
        self.values
            .iter()
            .map(|&(index, factor)| factor * values[index])
            .sum()
    }
}

impl Constraint {
    fn name(&self) -> String {
        let node = self.terms.first().map_or(0, |term| term.0 / 6);
        match self.value {
            Value::Dof(dof) => format!("fixed[{}, {}]", dof / 6, dof % 6),
            Value::Inclined(index) => format!("inclined support {index} of node {node}"),
            Value::Zero => format!("a tie of node {node}"),
        }
    }
}

fn add_term(terms: &mut Vec<(usize, f64)>, index: usize, factor: f64) {
    match terms.iter_mut().find(|term| term.0 == index) {
        Some(term) => term.1 += factor,
        None => terms.push((index, factor)),
    }
}

fn read(structure: &Structure) -> impl Iterator<Item = Constraint> {
    let fixed = structure.fixed.values.iter().enumerate();
    let fixed = fixed.filter(|&(_, &held)| held).map(|(dof, _)| Constraint {
        terms: vec![(dof, 1.0)],
        value: Value::Dof(dof),
    });
    let ties = (0..structure.tie_node.len()).map(|index| {
        let nodes = structure.tie_node.row(index);
        let dof = |end: usize| 6 * nodes[end] as usize + structure.tie_dof.at(index);
        Constraint {
            terms: vec![(dof(1), 1.0), (dof(0), -1.0)],
            value: Value::Zero,
        }
    });
    let inclined = (0..structure.inclined_node.len()).map(|index| {
        let direction = structure.inclined_direction.row(index);
        // Scaled first, so that no square over- or underflows.
        let largest = direction
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        let norm = direction
            .iter()
            .map(|value| (value / largest).powi(2))
            .sum::<f64>()
            .sqrt();
        let first = 6 * structure.inclined_node.at(index);
        Constraint {
            terms: (0..3)
                .map(|axis| (first + axis, direction[axis] / largest / norm))
                .collect(),
            value: Value::Inclined(index),
        }
    });
    fixed.chain(ties).chain(inclined)
}
