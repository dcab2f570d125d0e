//! Newton's method from level to level of the load.

use super::Analysis;
use super::state::Scratch;
use crate::error::{Error, Result};

/// A correction below this part of motions and forces is the last: Newton's method squares it.
const TIGHT: f64 = 1e-10;

/// Corrections that no longer shrink are rounding below this part.
const ROUNDING: f64 = 1e-6;

/// Largest correction of a level, beside its step.
const LARGEST: f64 = 0.25;

/// Corrections that shrink less than this have come to rounding, or do not converge.
const SHRINKING: f64 = 0.5;

/// Largest ratio of the flexibilities before and after a step.
const CHANGE: f64 = 2.0;

const CORRECTIONS: usize = 12;

/// Smallest step of the load, as a part of it: what is soft until it is tight begins with such.
const SMALLEST_STEP: f64 = 1e-12;

const LEVELS: usize = 1000;

impl Analysis {
    /// The unknowns under the whole load, reached from none.
    pub(super) fn follow(&self, scratch: &mut Scratch, coefficients: &[f64]) -> Result<Vec<f64>> {
        let mut unknowns = vec![0.0; self.reduction.unknowns.len()];
        let (mut level, mut step) = (0.0, 1.0);
        for _ in 0..LEVELS {
            if step < SMALLEST_STEP {
                break;
            }
            let next = f64::min(level + step, 1.0);
            match self.advance(scratch, coefficients, (level, next), &unknowns)? {
                Some(found) if next == 1.0 => return Ok(found),
                Some(found) => {
                    unknowns = found;
                    level = next;
                    step *= 2.0;
                }
                None => step = 0.5 * (next - level),
            }
        }
        Err(self.gives_way(scratch, coefficients, level, &unknowns)?)
    }

    /// From the equilibrium at one level of the load to that at the next, or nothing where that
    /// is too far.
    fn advance(
        &self,
        scratch: &mut Scratch,
        coefficients: &[f64],
        (level, next): (f64, f64),
        from: &[f64],
    ) -> Result<Option<Vec<f64>>> {
        let at_rest = level == 0.0;
        if !at_rest {
            self.load_part(scratch, coefficients, level)?;
            if !self.balance(scratch, from) {
                return Ok(None);
            }
            scratch.take_tensions();
            if !self.factorise(scratch) {
                return Ok(None);
            }
        }
        self.load_part(scratch, coefficients, next)?;
        if !self.balance(scratch, from) {
            return Ok(None);
        }
        scratch.take_tensions();
        let mut step = scratch.residual.clone();
        match &self.rest {
            Some(rest) if at_rest => rest.solve(&mut step)?,
            // What only its tension holds is held by that of this level.
            None if at_rest && !self.factorise(scratch) => return Ok(None),
            _ => scratch.solver.solve(&mut step)?,
        }
        let increment = scratch.residual.clone();
        let flexibility = dot(&step, &increment);
        let mut unknowns = from.to_vec();
        let mut correction = step.clone();
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.expect(scratch, &correction);
            unknowns = sum(&unknowns, &correction);
            if !self.balance(scratch, &unknowns) || !self.factorise(scratch) {
                return Ok(None);
            }
            correction.copy_from_slice(&scratch.residual);
            scratch.solver.solve(&mut correction)?;
            let (change, size) = (
                scratch.solver.motion_norm(&correction),
                scratch.size(&unknowns),
            );
            let settled = change > SHRINKING * before && change <= ROUNDING * size;
            if change <= TIGHT * size || settled {
                let mut after = increment.clone();
                scratch.solver.solve(&mut after)?;
                let after = dot(&after, &increment);
                let steady = after <= CHANGE * flexibility && flexibility <= CHANGE * after;
                return Ok(steady.then(|| sum(&unknowns, &correction)));
            }
            if self.reach(&correction) > LARGEST * self.reach(&step) {
                return Ok(None);
            }
            before = change;
        }
        Ok(None)
    }

    /// The error for a load that is carried up to a level only.
    fn gives_way(
        &self,
        scratch: &mut Scratch,
        coefficients: &[f64],
        level: f64,
        unknowns: &[f64],
    ) -> Result<Error> {
        self.load_part(scratch, coefficients, level)?;
        self.balance(scratch, unknowns);
        scratch.take_tensions();
        self.factorise(scratch);
        let named = scratch.solver.unstable(&self.model, &self.reduction);
        Ok(match named {
            Error::UnstableStructure {
                node,
                dof,
                direction,
            } if self.rest.is_some() || level > 0.0 => Error::Buckled {
                share: self.shares(level)[0],
                node,
                dof,
                direction,
            },
            other => other,
        })
    }

    fn load_part(&self, scratch: &mut Scratch, coefficients: &[f64], level: f64) -> Result<()> {
        let part =
            |share: f64| -> Vec<f64> { coefficients.iter().map(|value| share * value).collect() };
        let [forces, strains] = self.shares(level).map(part);
        self.load(scratch, &forces, &strains)
    }

    /// Of forces, and of initial strains and prescribed displacements: together, but the latter
    /// before where only tension holds the structure.
    fn shares(&self, level: f64) -> [f64; 2] {
        match &self.rest {
            Some(_) => [level, level],
            None => [(2.0 * level - 1.0).max(0.0), (2.0 * level).min(1.0)],
        }
    }
}

fn sum(left: &[f64], right: &[f64]) -> Vec<f64> {
    left.iter().zip(right).map(|(a, b)| a + b).collect()
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}
