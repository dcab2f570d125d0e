//! Balances a state: solves for the unknowns, refines and checks the residual.

use std::fmt::Display;

use crate::error::{DOFS, Error, Result};
use crate::fe::element::Vector12;
use crate::fe::load::{PatternLoads, fixed_end_forces};
use crate::fe::model::Model;
use crate::fe::outputs::State;
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;

/// A residual above this part of the load asks for one refinement step.
pub(crate) const REFINE: f64 = 1e-12;

/// A residual above this part of load and internal forces is refused.
pub(crate) const REFUSE: f64 = 1e-9;

/// A moment on a held rotation below this part of the largest load is rounding.
pub(crate) const LOOSE_MOMENT: f64 = 1e-9;

pub(crate) struct Equilibrium<'a> {
    pub model: &'a Model,
    pub reduction: &'a Reduction,
    pub solver: &'a Solver,
}

impl Equilibrium<'_> {
    /// Unknowns at zero. `unbalanced` is what is applied minus what the
    /// structure takes.
    pub(crate) fn start<'b>(
        &self,
        loads: &'b PatternLoads,
        strain: &'b [f64],
        forces: &'b [f64],
        displacements: Vec<f64>,
    ) -> Result<State<'b>> {
        let fixed_end: Vec<Vector12> = (self.model.members.iter().zip(strain.chunks_exact(3)))
            .enumerate()
            .map(|(index, (member, strain))| {
                fixed_end_forces(member, index, strain, loads.of(index))
            })
            .collect::<Result<_>>()?;
        // Where nothing moves yet, members take their fixed-end forces alone.
        let still = displacements
            .iter()
            .all(|&displacement| displacement == 0.0);
        let mut state = State {
            loads,
            strain,
            forces,
            fixed_end,
            displacements,
            unbalanced: Vec::new(),
            deformed: None,
        };
        if still {
            let ends = state.fixed_end.iter().copied();
            let internal = self.model.sum_forces(&state.displacements, ends);
            state.unbalanced = left(forces, &internal);
        } else {
            self.balance(&mut state);
        }
        Ok(state)
    }

    /// A moment on a rotation that nothing stiffens must not vanish silently.
    pub(crate) fn check_loose(&self, state: &State, load: impl Display) -> Result<()> {
        let unbalanced = &state.unbalanced;
        let largest = unbalanced
            .iter()
            .fold(0.0_f64, |most, force| most.max(force.abs()));
        let loaded = |&&dof: &&usize| unbalanced[dof].abs() > LOOSE_MOMENT * largest;
        match self.reduction.held.iter().find(loaded) {
            None => Ok(()),
            Some(dof) => Err(loose_moment(load, *dof)),
        }
    }

    /// Adds the solution, refines it once if needed, and checks the residual.
    /// `load` is the norm of what was applied.
    pub(crate) fn finish(&self, state: &mut State, load: f64, unknowns: &[f64]) -> Result<()> {
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
            Err(self.solver.unstable(self.model, self.reduction))
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
        state.unbalanced = left(state.forces, &internal);
    }
}

fn left(applied: &[f64], internal: &[f64]) -> Vec<f64> {
    let pairs = applied.iter().zip(internal);
    pairs
        .map(|(applied, internal)| applied - internal)
        .collect()
}

pub(crate) fn loose_moment(load: impl Display, dof: usize) -> Error {
    Error::invalid(format!(
        "{load} puts a moment on {} of node {}, which no member, spring or support resists; remove \
         the moment or stiffen the rotation",
        DOFS[dof % 6],
        dof / 6
    ))
}
