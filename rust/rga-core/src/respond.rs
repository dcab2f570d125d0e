//! One linear static analysis: structure and loads in, outputs out.

use crate::check_loads::{check_loads, check_outputs};
use crate::check_structure::check_structure;
use crate::constraint::Constraints;
use crate::element::Vector12;
use crate::error::{DOFS, Error, Result};
use crate::input::{Loads, Outputs, Structure};
use crate::load::{PatternLoads, fixed_end_forces};
use crate::model::Model;
use crate::observe::{Observer, State};
use crate::reduction::Reduction;
use crate::stability::Solver;

/// Patterns solved at a time: enough to share the factor, few enough to stay
/// in cache.
const BLOCK: usize = 32;

/// A residual above this part of the load asks for one refinement step.
const REFINE: f64 = 1e-12;

/// A residual above this part of load and internal forces is refused.
const REFUSE: f64 = 1e-9;

/// A moment on a held rotation below this part of the largest load is rounding.
const LOOSE_MOMENT: f64 = 1e-9;

/// The outputs of all patterns, `[patterns, outputs]` in C order.
pub fn respond(structure: &Structure, loads: &Loads, outputs: &Outputs) -> Result<Vec<f64>> {
    check_structure(structure)?;
    check_loads(structure, loads)?;
    check_outputs(structure, outputs)?;
    let analysis = Analysis::new(structure, loads)?;
    let observer = Observer::new(&analysis.model, &analysis.constraints, outputs);
    let patterns: Vec<usize> = (0..loads.pattern_count()).collect();
    let mut results = Vec::with_capacity(patterns.len() * outputs.kind.len());
    for block in patterns.chunks(BLOCK) {
        for state in analysis.solve(block)? {
            observer.read(&state, &mut results);
        }
    }
    let width = outputs.kind.len();
    match results.iter().position(|value| !value.is_finite()) {
        None => Ok(results),
        Some(at) => Err(Error::invalid(format!(
            "output {} of pattern {} overflows; check the sizes of loads and stiffnesses",
            at % width,
            at / width
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
        let size = self.reduction.unknowns.len();
        let mut unknowns = vec![0.0; size * patterns.len()];
        let mut states = Vec::with_capacity(patterns.len());
        for (at, &pattern) in patterns.iter().enumerate() {
            let state = self.start(pattern)?;
            self.check_loose(pattern, &state.unbalanced)?;
            let column = &mut unknowns[at * size..(at + 1) * size];
            self.reduction.collect(&state.unbalanced, column);
            states.push(state);
        }
        let applied = unknowns.clone();
        self.solver.solve(&mut unknowns)?;
        for (at, state) in states.iter_mut().enumerate() {
            let column = at * size..(at + 1) * size;
            let load = self.solver.force_norm(&applied[column.clone()]);
            self.finish(state, load, &unknowns[column])?;
        }
        Ok(states)
    }

    /// Unknowns at zero. `unbalanced` is what is applied minus what the
    /// structure takes.
    fn start(&self, pattern: usize) -> Result<State<'_>> {
        let loads = &self.member_loads[pattern];
        let strain = self.loads.strain.row(pattern);
        let fixed_end: Vec<Vector12> = (self.model.members.iter().zip(strain.chunks_exact(3)))
            .enumerate()
            .map(|(index, (member, strain))| {
                fixed_end_forces(member, index, strain, loads.of(index))
            })
            .collect::<Result<_>>()?;
        let values = self.constraints.values(self.loads, pattern)?;
        let displacements = self.constraints.base_displacements(&values);
        let mut state = State {
            loads,
            strain,
            forces: self.loads.forces.row(pattern),
            fixed_end,
            displacements,
            unbalanced: Vec::new(),
        };
        self.balance(&mut state);
        Ok(state)
    }

    /// Adds the solution, refines it once if needed, and checks the residual.
    fn finish(&self, state: &mut State, load: f64, unknowns: &[f64]) -> Result<()> {
        self.reduction.expand(unknowns, &mut state.displacements);
        let mut residual = self.residual(state);
        if self.solver.force_norm(&residual) > REFINE * load {
            self.solver.solve(&mut residual)?;
            self.reduction.expand(&residual, &mut state.displacements);
            residual = self.residual(state);
        }
        let internal = self.solver.motion_norm(unknowns);
        // Written so that NaN is refused as well.
        if self.solver.force_norm(&residual) <= REFUSE * (load + internal) {
            Ok(())
        } else {
            Err(self.solver.unstable(&self.model, &self.reduction))
        }
    }

    fn residual(&self, state: &mut State) -> Vec<f64> {
        self.balance(state);
        let mut residual = vec![0.0; self.reduction.unknowns.len()];
        self.reduction.collect(&state.unbalanced, &mut residual);
        residual
    }

    fn balance(&self, state: &mut State) {
        let internal = self
            .model
            .internal_forces(&state.displacements, &state.fixed_end);
        let applied = state.forces.iter().zip(internal);
        state.unbalanced = applied
            .map(|(applied, internal)| applied - internal)
            .collect();
    }

    /// A moment on a rotation that nothing stiffens must not vanish silently.
    fn check_loose(&self, pattern: usize, unbalanced: &[f64]) -> Result<()> {
        let largest = unbalanced
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()));
        let loaded = |&&dof: &&usize| unbalanced[dof].abs() > LOOSE_MOMENT * largest;
        match self.reduction.held.iter().find(loaded) {
            None => Ok(()),
            Some(dof) => Err(Error::invalid(format!(
                "pattern {pattern} puts a moment on {} of node {}, which no member, spring or \
                 support resists; remove the moment or stiffen the rotation",
                DOFS[dof % 6],
                dof / 6
            ))),
        }
    }
}
