//! Refuses structures that can move freely, and says what moves.

use crate::assembly::LowerTriangle;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::reduction::{Reduction, stiffest};
use crate::solve::Factor;

/// Smallest pivot of the scaled matrix, whose diagonal is 1.
const SMALLEST_PIVOT: f64 = 1e-11;

/// Scaling never takes a direction that is this much softer than the
/// stiffest of its node for a stiff one. With `SMALLEST_PIVOT` it refuses
/// what `NO_STIFFNESS` calls rounding.
const SOFTEST: f64 = 1e-10;

/// Makes the scaled matrix definite; far below every stiffness that counts.
const SHIFT: f64 = 1e-10;

const ITERATIONS: usize = 20;

/// Among motions within this part of the largest, the first dof is named.
const AS_LARGE: f64 = 1.0 - 1e-6;

/// K of the unknowns, scaled to unit diagonal and factorised. Scaling makes
/// the pivots dimensionless: translations and rotations compare.
pub struct Solver {
    matrix: LowerTriangle,
    scale: Vec<f64>,
    factor: Factor,
}

impl Solver {
    pub fn new(model: &Model, reduction: &Reduction) -> Result<Self> {
        let mut solver = Self::analyse(LowerTriangle::assemble(model, reduction))?;
        if solver.factorise(model, reduction) {
            Ok(solver)
        } else {
            Err(solver.unstable(model, reduction))
        }
    }

    /// The symbolic analysis alone; `factorise` must follow.
    pub fn analyse(matrix: LowerTriangle) -> Result<Self> {
        Ok(Self {
            scale: vec![1.0; matrix.size()],
            factor: Factor::analyse(&matrix)?,
            matrix,
        })
    }

    /// Another solver that shares the symbolic analysis; values and
    /// `factorise` must follow.
    pub fn another(&self) -> Result<Self> {
        Ok(Self {
            matrix: self.matrix.clone(),
            scale: self.scale.clone(),
            factor: self.factor.another()?,
        })
    }

    /// Those of K; `factorise` must follow.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.matrix.values
    }

    /// Scales K and factorises it; false where something moves freely.
    pub fn factorise(&mut self, model: &Model, reduction: &Reduction) -> bool {
        self.scale = scaling(&self.matrix, reduction, model.dofs);
        self.matrix.scale(&self.scale);
        self.factor.refactor(&self.matrix) && self.factor.smallest_pivot() >= SMALLEST_PIVOT
    }

    /// Solves in place for right-hand sides one behind the other.
    pub fn solve(&self, right: &mut [f64]) -> Result<()> {
        let size = self.scale.len();
        if size == 0 {
            return Ok(());
        }
        self.apply_scale(right);
        self.factor.solve(right, right.len() / size)?;
        self.apply_scale(right);
        Ok(())
    }

    fn apply_scale(&self, values: &mut [f64]) {
        for column in values.chunks_mut(self.scale.len()) {
            for (value, scale) in column.iter_mut().zip(&self.scale) {
                *value *= scale;
            }
        }
    }

    /// Dimensionless norm of forces on the unknowns.
    pub fn force_norm(&self, forces: &[f64]) -> f64 {
        let terms = forces.iter().zip(&self.scale);
        terms
            .map(|(force, scale)| (force * scale).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The norm of unknowns in the same scale: K has norm 1 or a little more.
    pub fn motion_norm(&self, unknowns: &[f64]) -> f64 {
        let terms = unknowns.iter().zip(&self.scale);
        terms
            .map(|(motion, scale)| (motion / scale).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The error for K that does not factorise, or leaves a large residual.
    pub fn unstable(&self, model: &Model, reduction: &Reduction) -> Error {
        name_mechanism(self.matrix.clone(), &self.scale, model, reduction)
    }
}

fn scaling(matrix: &LowerTriangle, reduction: &Reduction, dofs: usize) -> Vec<f64> {
    let mut all = vec![0.0; dofs];
    for (&dof, value) in reduction.unknowns.iter().zip(matrix.diagonal()) {
        all[dof] = value;
    }
    let own = |&dof: &usize| {
        let stiffness: f64 = all[dof].max(SOFTEST * stiffest(&all, dof));
        if stiffness > 0.0 {
            1.0 / stiffness.sqrt()
        } else {
            1.0
        }
    };
    reduction.unknowns.iter().map(own).collect()
}

fn name_mechanism(
    matrix: LowerTriangle,
    scale: &[f64],
    model: &Model,
    reduction: &Reduction,
) -> Error {
    let motion = match null_vector(matrix) {
        Ok(motion) => motion,
        Err(error) => return error,
    };
    let unscaled: Vec<f64> = motion.iter().zip(scale).map(|(m, s)| m * s).collect();
    let mut displacements = vec![0.0; model.dofs];
    reduction.expand(&unscaled, &mut displacements);
    let arm = model.arm();
    let size = |dof: usize| {
        let lever = if dof % 6 < 3 { 1.0 } else { arm };
        displacements[dof].abs() * lever
    };
    let most = (0..model.dofs).map(size).fold(0.0, f64::max);
    let worst = (0..model.dofs)
        .find(|&dof| size(dof) >= AS_LARGE * most)
        .unwrap_or(0);
    let node = worst / 6;
    let mut direction = [0.0; 6];
    direction.copy_from_slice(&displacements[6 * node..6 * node + 6]);
    let norm = direction
        .iter()
        .map(|value| value * value)
        .sum::<f64>()
        .sqrt();
    if norm > 0.0 {
        // The sign is free: the named dof moves forward.
        let norm = norm.copysign(direction[worst % 6]);
        direction.iter_mut().for_each(|value| *value /= norm);
    }
    Error::UnstableStructure {
        node,
        dof: worst % 6,
        direction,
    }
}

/// Inverse iteration on the shifted matrix, from a fixed irregular start.
fn null_vector(mut matrix: LowerTriangle) -> Result<Vec<f64>> {
    let mut shift = SHIFT;
    let factor = loop {
        matrix.shift(shift);
        match Factor::new(&matrix)? {
            Some(factor) => break factor,
            None if shift < 1.0 => shift *= 100.0,
            None => return Err(Error::invalid("the stiffness is not a finite number")),
        }
    };
    let golden = 0.618_033_988_749_895;
    let start = |at: usize| 0.5 + (golden * (at + 1) as f64).fract();
    let mut motion: Vec<f64> = (0..matrix.size()).map(start).collect();
    for _ in 0..ITERATIONS {
        factor.solve(&mut motion, 1)?;
        let largest = motion
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        motion.iter_mut().for_each(|value| *value /= largest);
    }
    Ok(motion)
}
