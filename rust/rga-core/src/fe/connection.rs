//! Connections in series with the end dofs of a member.
//!
//! Each connected dof is eliminated in turn: an internal dof inside the
//! connection takes over, and the node keeps what the spring passes on. The
//! formulas hold for every stiffness from 0 (released) to inf (rigid).

use crate::fe::element::{Matrix12, Vector12};

/// The elimination of one internal dof.
#[derive(Debug, Clone)]
struct Step {
    dof: usize,
    /// Part of a force on the internal dof that the other end dofs take.
    carry: Vector12,
    /// Part of it that the node behind the connection takes.
    share: f64,
    /// Neither the member nor the connection holds the internal dof.
    loose: bool,
}

#[derive(Debug, Clone, Default)]
pub(crate) struct Connection {
    steps: Vec<Step>,
}

/// A diagonal below this part of its former value is rounding, not stiffness.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A loose dof may carry this part of the largest force: it is rounding.
const LOOSE_FORCE: f64 = 1e-9;

impl Connection {
    /// Turns `k` of the bare member into that of the member with its ends.
    pub(crate) fn condense(k: &mut Matrix12, stiffness: &[f64]) -> Self {
        let finite = |&(_, value): &(usize, &f64)| value.is_finite();
        let steps = stiffness.iter().enumerate().filter(finite);
        Self {
            steps: steps
                .map(|(dof, &spring)| eliminate(k, dof, spring))
                .collect(),
        }
    }

    /// Whether the member moves as its nodes do.
    pub(crate) fn is_rigid(&self) -> bool {
        self.steps.is_empty()
    }

    /// The same for fixed-end forces; the error is a local dof that is loaded
    /// although nothing holds it.
    pub(crate) fn pass_on(&self, forces: &mut Vector12) -> Result<(), usize> {
        let largest = forces.amax();
        for step in &self.steps {
            let force = forces[step.dof];
            if step.loose && force.abs() > LOOSE_FORCE * largest {
                return Err(step.dof);
            }
            *forces -= step.carry * force;
            forces[step.dof] = step.share * force;
        }
        Ok(())
    }

    /// Motions of the bare member behind its connections, from those of the nodes.
    pub(crate) fn inner(&self, ends: &Vector12) -> Vector12 {
        let mut inner = *ends;
        for step in self.steps.iter().rev() {
            inner[step.dof] = step.share * inner[step.dof] - step.carry.dot(&inner);
        }
        inner
    }
}

fn eliminate(k: &mut Matrix12, dof: usize, spring: f64) -> Step {
    let own = k[(dof, dof)];
    let pivot = spring + own;
    if pivot == 0.0 {
        return Step {
            dof,
            carry: Vector12::zeros(),
            share: 0.0,
            loose: true,
        };
    }
    let share = spring / pivot;
    let column: Vector12 = k.column(dof).into();
    let mut carry = column / pivot;
    carry[dof] = 0.0;
    let before = k.diagonal();
    for a in (0..12).filter(|&a| a != dof) {
        for b in (0..12).filter(|&b| b != dof) {
            k[(a, b)] -= column[a] * column[b] / pivot;
        }
    }
    let mut passed_on = column * share;
    passed_on[dof] = share * own;
    k.set_column(dof, &passed_on);
    k.set_row(dof, &passed_on.transpose());
    for a in (0..12).filter(|&a| a != dof) {
        if k[(a, a)] <= ROUNDING * before[a] {
            k.row_mut(a).fill(0.0);
            k.column_mut(a).fill(0.0);
        }
    }
    Step {
        dof,
        carry,
        share,
        loose: false,
    }
}
