//! One linear static analysis: structure and loads in, outputs out.

use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::equilibrium::Equilibrium;
use crate::fe::load::PatternLoads;
use crate::fe::model::Model;
use crate::fe::outputs::{Observer, State, read_outputs};
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Loads, Outputs, Structure};
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
    let analysis = Analysis::new(structure, loads)?;
    let wanted = read_outputs(outputs);
    let observer = Observer::new(&analysis.model, &analysis.constraints, &wanted);
    let patterns: Vec<usize> = (0..loads.pattern_count()).collect();
    let mut results = Vec::with_capacity(patterns.len() * wanted.len());
    for block in patterns.chunks(BLOCK) {
        for state in analysis.solve(block)? {
            observer.read(&state, &mut results);
        }
    }
    match results.iter().position(|value| !value.is_finite()) {
        None => Ok(results),
        Some(at) => Err(Error::invalid(format!(
            "output {} of pattern {} overflows; check the sizes of loads and stiffnesses",
            at % wanted.len(),
            at / wanted.len()
        ))),
    }
}

struct Analysis<'a> {
    loads: &'a Loads<'a>,
    model: Model,
    constraints: Constraints,
    reduction: Reduction,
    solver: Solver,
    member_loads: Vec<PatternLoads>,
}

impl<'a> Analysis<'a> {
    fn new(structure: &Structure, loads: &'a Loads<'a>) -> Result<Self> {
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let solver = Solver::new(&model, &reduction)?;
        let member_loads = PatternLoads::group(loads, model.members.len());
        Ok(Self {
            loads,
            model,
            constraints,
            reduction,
            solver,
            member_loads,
        })
    }

    fn solve(&self, patterns: &[usize]) -> Result<Vec<State<'_>>> {
        let equilibrium = Equilibrium {
            model: &self.model,
            reduction: &self.reduction,
            solver: &self.solver,
        };
        let size = self.reduction.unknowns.len();
        let mut unknowns = vec![0.0; size * patterns.len()];
        let mut states = Vec::with_capacity(patterns.len());
        for (at, &pattern) in patterns.iter().enumerate() {
            let values = self.constraints.values(self.loads, pattern)?;
            let state = equilibrium.start(
                &self.member_loads[pattern],
                self.loads.strain.row(pattern),
                self.loads.forces.row(pattern),
                self.constraints.base_displacements(&values),
            )?;
            equilibrium.check_loose(&state, format_args!("pattern {pattern}"))?;
            let column = &mut unknowns[at * size..(at + 1) * size];
            self.reduction.collect(&state.unbalanced, column);
            self.solver
                .check_free_rotations(column, format_args!("pattern {pattern}"))?;
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
