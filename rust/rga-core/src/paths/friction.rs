//! Coulomb friction at bearings, step by step through time.
//!
//! The structure is condensed to the b bearings: displacements are
//! u = free + flexibility r and normal forces N = max(0, free + influence r),
//! with r the friction forces on the structure. Each step sticks to the place
//! of the step before, or slips with |r| = mu N against the motion.

use rga_simd::Array;

use crate::error::{Error, Result};
use crate::validate::arrays::{CheckNumbers, CheckShape};

#[derive(Debug, Clone, Copy)]
pub struct Bearings<'a> {
    /// `[n_t, b]` displacements without friction
    pub free_displacement: Array<'a, f64>,
    /// `[b, b]`
    pub flexibility: Array<'a, f64>,
    /// `[n_t, b]` normal forces without friction, pressure positive
    pub normal_free: Array<'a, f64>,
    /// `[b, b]`
    pub normal_influence: Array<'a, f64>,
    /// `[b]`
    pub mu: Array<'a, f64>,
    /// `[2, b]` displacements without friction, then friction forces, in the row before the first
    pub before: Array<'a, f64>,
}

/// A sweep that changes forces by less than this part has converged.
const CONVERGED: f64 = 1e-12;

const SWEEPS: usize = 100_000;

/// Friction forces `[n_t, b]`, from where the row before the first came to rest.
pub fn slide(bearings: &Bearings) -> Result<Vec<f64>> {
    check(bearings)?;
    let mut friction = bearings.before.row(1).to_vec();
    let mut rested = bearings.before.row(0).to_vec();
    for (bearing, rested) in rested.iter_mut().enumerate() {
        *rested += dot(bearings.flexibility.row(bearing), &friction);
    }
    let mut history = Vec::with_capacity(bearings.free_displacement.values.len());
    for row in 0..bearings.free_displacement.len() {
        settle(bearings, row, &rested, &mut friction)?;
        for (bearing, rested) in rested.iter_mut().enumerate() {
            *rested = displacement(bearings, row, bearing, &friction);
        }
        history.extend_from_slice(&friction);
    }
    Ok(history)
}

/// Projected Gauss-Seidel over the bearings.
fn settle(bearings: &Bearings, row: usize, rested: &[f64], friction: &mut [f64]) -> Result<()> {
    for _ in 0..SWEEPS {
        let mut change = 0.0_f64;
        let mut largest = 0.0_f64;
        for bearing in 0..friction.len() {
            let slip = displacement(bearings, row, bearing, friction) - rested[bearing];
            let stick = friction[bearing] - slip / bearings.flexibility.row(bearing)[bearing];
            let limit = bearings.mu[bearing] * normal(bearings, row, bearing, friction);
            let next = stick.clamp(-limit, limit);
            change = change.max((next - friction[bearing]).abs());
            largest = largest.max(next.abs());
            friction[bearing] = next;
        }
        if change <= CONVERGED * largest {
            return Ok(());
        }
    }
    Err(Error::NotConverged { row })
}

fn displacement(bearings: &Bearings, row: usize, bearing: usize, friction: &[f64]) -> f64 {
    bearings.free_displacement.row(row)[bearing] + dot(bearings.flexibility.row(bearing), friction)
}

fn normal(bearings: &Bearings, row: usize, bearing: usize, friction: &[f64]) -> f64 {
    let influence = dot(bearings.normal_influence.row(bearing), friction);
    (bearings.normal_free.row(row)[bearing] + influence).max(0.0)
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}

fn check(bearings: &Bearings) -> Result<()> {
    let (rows, count) = (bearings.free_displacement.len(), bearings.mu.len());
    for (name, array, shape) in [
        ("mu", &bearings.mu, &[count][..]),
        (
            "free_displacement",
            &bearings.free_displacement,
            &[rows, count],
        ),
        ("flexibility", &bearings.flexibility, &[count, count]),
        ("normal_free", &bearings.normal_free, &[rows, count]),
        (
            "normal_influence",
            &bearings.normal_influence,
            &[count, count],
        ),
        ("before", &bearings.before, &[2, count]),
    ] {
        array.check_shape(name, shape)?;
        array.check_finite(name)?;
    }
    for bearing in 0..count {
        let mu = bearings.mu[bearing];
        if mu < 0.0 {
            return Err(Error::invalid(format!(
                "mu[{bearing}] is {mu}; it must not be negative"
            )));
        }
        let own = bearings.flexibility.row(bearing)[bearing];
        if own <= 0.0 {
            return Err(Error::invalid(format!(
                "flexibility[{bearing}, {bearing}] is {own}; it must be positive"
            )));
        }
    }
    Ok(())
}
