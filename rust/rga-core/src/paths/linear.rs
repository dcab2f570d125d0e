//! Linear static analysis: a structure is factorised once, and solved under any loads.

use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::equilibrium::Equilibrium;
use crate::fe::load::PatternLoads;
use crate::fe::model::Model;
use crate::fe::outputs::{Observer, Output, State, read_outputs};
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Loads, Outputs, Structure};
use crate::paths::rank_one_terms::{Term, TermKind};
use crate::validate::loads::check_loads;
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;

/// Patterns solved at a time: enough to share the factor, few enough to stay
/// in cache.
const BLOCK: usize = 32;

/// The outputs of all patterns, `[patterns, outputs]` in C order.
pub fn respond(structure: &Structure, loads: &Loads, outputs: &Outputs) -> Result<Vec<f64>> {
    check_structure(structure)?;
    check_loads(structure, loads)?;
    check_outputs(structure, outputs)?;
    let analysis = Analysis::new(structure)?;
    let wanted = read_outputs(outputs);
    let mut results = Vec::with_capacity(loads.pattern_count() * wanted.len());
    analysis.under_loads(loads, |_, state| {
        analysis.read(&wanted, state, &mut results);
        Ok(())
    })?;
    check_read(&results, wanted.len(), 0)?;
    Ok(results)
}

/// Refuses outputs `[patterns, outputs]` that overflow, the first being of the pattern `first`.
pub(super) fn check_read(results: &[f64], outputs: usize, first: usize) -> Result<()> {
    match results.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(Error::invalid(format!(
            "output {} of pattern {} overflows; check the sizes of loads and stiffnesses",
            at % outputs,
            first + at / outputs
        ))),
    }
}

/// One structure, factorised.
pub(super) struct Analysis {
    pub model: Model,
    constraints: Constraints,
    reduction: Reduction,
    solver: Solver,
}

/// What acts at once, and its name in messages.
struct Case<'a> {
    name: String,
    members: &'a PatternLoads,
    strain: &'a [f64],
    forces: &'a [f64],
    /// By supports that move, all unknowns at zero.
    displacements: Vec<f64>,
}

impl Analysis {
    /// Of a checked structure.
    pub(super) fn new(structure: &Structure) -> Result<Self> {
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let solver = Solver::new(&model, &reduction)?;
        Ok(Self {
            model,
            constraints,
            reduction,
            solver,
        })
    }

    /// Calls `read(pattern, state)` for each of checked load patterns, in their order.
    pub(super) fn under_loads(
        &self,
        loads: &Loads,
        mut read: impl FnMut(usize, &State) -> Result<()>,
    ) -> Result<()> {
        let members = PatternLoads::group(loads, self.model.members.len());
        let patterns: Vec<usize> = (0..loads.pattern_count()).collect();
        for block in patterns.chunks(BLOCK) {
            let cases = block.iter().map(|&pattern| {
                let values = self.constraints.values(loads, pattern)?;
                Ok(Case {
                    name: format!("pattern {pattern}"),
                    members: &members[pattern],
                    strain: loads.strain.row(pattern),
                    forces: loads.forces.row(pattern),
                    displacements: self.constraints.base_displacements(&values),
                })
            });
            let states = self.solve(cases.collect::<Result<_>>()?)?;
            for (&pattern, state) in block.iter().zip(&states) {
                read(pattern, state)?;
            }
        }
        Ok(())
    }

    /// Calls `read(number, state)` for each of `count` sets of nodal forces, in their order;
    /// `push(number, forces)` adds them to zeros, `[n, 6]`.
    pub(super) fn under_forces(
        &self,
        count: usize,
        push: impl Fn(usize, &mut [f64]),
        mut read: impl FnMut(usize, &State) -> Result<()>,
    ) -> Result<()> {
        let members = PatternLoads::none(self.model.members.len());
        let strain = vec![0.0; 3 * self.model.members.len()];
        let numbers: Vec<usize> = (0..count).collect();
        for block in numbers.chunks(BLOCK) {
            let forces: Vec<Vec<f64>> = block
                .iter()
                .map(|&number| {
                    let mut own = vec![0.0; self.model.dofs];
                    push(number, &mut own);
                    own
                })
                .collect();
            let cases = block.iter().zip(&forces).map(|(number, forces)| Case {
                name: format!("unit force {number}"),
                members: &members,
                strain: &strain,
                forces,
                displacements: vec![0.0; self.model.dofs],
            });
            let states = self.solve(cases.collect())?;
            for (&number, state) in block.iter().zip(&states) {
                read(number, state)?;
            }
        }
        Ok(())
    }

    /// Loads along members, all nodes held where they are; `zeros` are as many as there are dofs,
    /// and thrice as many as members, or more.
    pub(super) fn held<'a>(
        &self,
        members: &'a PatternLoads,
        zeros: &'a [f64],
    ) -> Result<State<'a>> {
        let (dofs, strains) = (self.model.dofs, 3 * self.model.members.len());
        let still = vec![0.0; dofs];
        let equilibrium = self.equilibrium();
        equilibrium.start(members, &zeros[..strains], &zeros[..dofs], still)
    }

    fn equilibrium(&self) -> Equilibrium<'_> {
        Equilibrium {
            model: &self.model,
            reduction: &self.reduction,
            solver: &self.solver,
        }
    }

    /// Appends what outputs read of a state.
    pub(super) fn read(&self, wanted: &[Output], state: &State, results: &mut Vec<f64>) {
        Observer::new(&self.model, &self.constraints, wanted).read(state, results);
    }

    /// What one output reads of a state.
    pub(super) fn read_one(&self, output: &Output, state: &State) -> f64 {
        let mut read = Vec::with_capacity(1);
        self.read(std::slice::from_ref(output), state, &mut read);
        read[0]
    }

    /// What unit pseudo-forces on terms do: to outputs `[r, o]`, their own readings included, and
    /// to the elongations of the terms `[r, r]`.
    pub(super) fn under_terms(
        &self,
        terms: &[Term],
        wanted: &[Output],
    ) -> Result<(Vec<f64>, Vec<f64>)> {
        let count = terms.len();
        let mut influence = Vec::with_capacity(count * wanted.len());
        let mut unit = Vec::with_capacity(count * count);
        let push = |number: usize, forces: &mut [f64]| terms[number].push(forces);
        self.under_forces(count, push, |number, state| {
            let first = influence.len();
            self.read(wanted, state, &mut influence);
            for (read, output) in influence[first..].iter_mut().zip(wanted) {
                *read += terms[number].own_reading(output);
            }
            unit.extend(
                terms
                    .iter()
                    .map(|term| term.elongation(&state.displacements)),
            );
            Ok(())
        })?;
        for (number, term) in terms.iter().enumerate() {
            if let TermKind::Gauge(output) = term.kind {
                let own = 1.0 / term.stiffness;
                (
                    unit[number * count + number],
                    influence[number * wanted.len() + output],
                ) = (own, own);
            }
        }
        for row in 0..count {
            for column in 0..row {
                let (here, there) = (row * count + column, column * count + row);
                let mean = 0.5 * (unit[here] + unit[there]);
                (unit[here], unit[there]) = (mean, mean);
            }
        }
        Ok((influence, unit))
    }

    fn solve<'a>(&self, cases: Vec<Case<'a>>) -> Result<Vec<State<'a>>> {
        let equilibrium = self.equilibrium();
        let size = self.reduction.unknowns.len();
        let mut unknowns = vec![0.0; size * cases.len()];
        let mut states = Vec::with_capacity(cases.len());
        for (at, case) in cases.into_iter().enumerate() {
            let state =
                equilibrium.start(case.members, case.strain, case.forces, case.displacements)?;
            equilibrium.check_loose(&state, &case.name)?;
            let column = &mut unknowns[at * size..(at + 1) * size];
            self.reduction.collect(&state.unbalanced, column);
            self.solver.check_free_rotations(column, &case.name)?;
            states.push(state);
        }
        let applied = unknowns.clone();
        self.solver.solve(&mut unknowns)?;
        for (at, state) in states.iter_mut().enumerate() {
            let column = at * size..(at + 1) * size;
            let load = self.solver.force_norm(&applied[column.clone()]);
            equilibrium.finish(state, load, &unknowns[column])?;
        }
        Ok(states)
    }
}
