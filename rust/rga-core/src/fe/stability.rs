//! Refuses structures that can move freely, and says what moves.

use crate::error::{Error, Result};
use crate::fe::assembly::assemble;
use crate::fe::equilibrium::{REFINE, REFUSE};
use crate::fe::free_rotations::FreeRotation;
use crate::fe::mechanism::mechanism;
use crate::fe::model::Model;
use crate::fe::reduction::{NO_STIFFNESS, Reduction, stiffest};
use crate::sparse::factor::Factor;
use crate::sparse::inverse_iteration::InverseIteration;
use crate::sparse::lower_triangle::LowerTriangle;

/// Smallest pivot of the scaled matrix, whose diagonal is 1.
const SMALLEST_PIVOT: f64 = 1e-11;

/// Below this, a pivot may be the rounding of one that vanishes.
const SUSPICIOUS_PIVOT: f64 = 1e-6;

/// Below this, the assembled matrix may have lost digits of soft motions.
pub(crate) const DELICATE_PIVOT: f64 = 1e-3;

/// Refinements there: each gains about as many digits as the factor still has.
const DELICATE_STEPS: usize = 2;

/// Energy of a motion that nothing holds, over that with which each dof moves on its own.
const FREE_ENERGY: f64 = 1e-12;

/// Scaling never takes a direction that is this much softer than the
/// stiffest of its node for a stiff one. With `SMALLEST_PIVOT` it refuses
/// what `NO_STIFFNESS` calls rounding.
pub(crate) const SOFTEST: f64 = 1e-10;

/// Makes the scaled matrix definite; far below every stiffness that counts.
const SHIFT: f64 = 1e-10;

/// Of inverse iteration.
const STEPS: usize = 20;

/// Changes of a motion below this are rounding.
const SETTLED: f64 = 1e-13;

/// K of the unknowns, scaled to unit diagonal and factorised. Scaling makes
/// the pivots dimensionless: translations and rotations compare.
pub(crate) struct Solver {
    matrix: LowerTriangle,
    scale: Vec<f64>,
    factor: Factor,
    /// Held in `matrix`.
    free_rotations: Vec<FreeRotation>,
}

impl Solver {
    pub(crate) fn new(model: &Model, reduction: &Reduction) -> Result<Self> {
        let (matrix, free_rotations) = held(assemble(model, reduction), reduction);
        let places = reduction.places(&model.nodes);
        Self::analyse(matrix, free_rotations, &places, 1.0)?.standing(model, reduction)
    }

    /// The solver of another structure with the analysis of this one, where what it couples
    /// is coupled in this one.
    pub(crate) fn of_another(&self, model: &Model, reduction: &Reduction) -> Result<Option<Self>> {
        let Some(matrix) = assemble(model, reduction).in_places_of(&self.matrix) else {
            return Ok(None);
        };
        let (matrix, free_rotations) = held(matrix, reduction);
        let solver = Self {
            scale: Vec::new(),
            factor: self.factor.another()?,
            free_rotations,
            matrix,
        };
        solver.standing(model, reduction).map(Some)
    }

    /// Factorised, or refused.
    fn standing(mut self, model: &Model, reduction: &Reduction) -> Result<Self> {
        let solver = &mut self;
        let stands = solver.factorise(model, reduction);
        if stands && !solver.moves_freely(model, reduction, |_| 1.0)? {
            Ok(self)
        } else {
            Err(solver.unstable(model, reduction))
        }
    }

    /// The symbolic analysis alone; `factorise` must follow, about `repeats` times.
    /// `free_rotations` are held in new values of K by `hold_free_rotations`; `places` are those
    /// of the unknowns.
    pub(crate) fn analyse(
        matrix: LowerTriangle,
        free_rotations: Vec<FreeRotation>,
        places: &[[f64; 3]],
        repeats: f64,
    ) -> Result<Self> {
        Ok(Self {
            scale: vec![1.0; matrix.size()],
            factor: Factor::analyse(&matrix, places, repeats)?,
            free_rotations,
            matrix,
        })
    }

    /// Another solver that shares the symbolic analysis; values and
    /// `factorise` must follow.
    pub(crate) fn another(&self) -> Result<Self> {
        Ok(Self {
            matrix: self.matrix.clone(),
            scale: self.scale.clone(),
            factor: self.factor.another()?,
            free_rotations: self.free_rotations.clone(),
        })
    }

    /// S (K - shift M) S, S its scaling: as many eigenvalues are negative as without it.
    pub(crate) fn shifted(&self, mass: &LowerTriangle, shift: f64) -> LowerTriangle {
        let mut scaled = mass.clone();
        scaled.scale(&self.scale);
        self.matrix.less(shift, &scaled)
    }

    pub(crate) fn free_rotations(&self) -> &[FreeRotation] {
        &self.free_rotations
    }

    /// Holds them in new values of K.
    pub(crate) fn hold_free_rotations(&mut self) {
        for rotation in &self.free_rotations {
            rotation.hold(&mut self.matrix);
        }
    }

    /// A moment about one of them must not vanish silently. `forces` are those on the unknowns.
    pub(crate) fn check_free_rotations(
        &self,
        forces: &[f64],
        load: impl std::fmt::Display,
    ) -> Result<()> {
        self.free_rotations
            .iter()
            .try_for_each(|rotation| rotation.check(forces, &load))
    }

    /// Those of K; `factorise` must follow.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.matrix.values
    }

    /// Scales K and factorises it; false where something moves freely.
    pub(crate) fn factorise(&mut self, model: &Model, reduction: &Reduction) -> bool {
        self.scale = scaling(&self.matrix, reduction, model.dofs);
        self.matrix.scale(&self.scale);
        self.factor.factorise(&self.matrix) && self.factor.smallest_pivot() >= SMALLEST_PIVOT
    }

    /// Whether a motion strains no element: where members are much stiffer along than across, the
    /// pivot of a mechanism may be all rounding and yet not small. Rounding of the elements' own
    /// deformations is smaller by far. That of the scaled matrix, whose entries are 1 at most, is
    /// small beside `FREE_ENERGY`: where it leaves no motion so little energy, none is free.
    ///
    /// `factor` is that of a member, or spring behind them, on the stiffness of `model`.
    pub(crate) fn moves_freely(
        &self,
        model: &Model,
        reduction: &Reduction,
        factor: impl Fn(usize) -> f64,
    ) -> Result<bool> {
        if self.scale.is_empty() || self.factor.smallest_pivot() >= SUSPICIOUS_PIVOT {
            return Ok(false);
        }
        let mut iteration = InverseIteration::new(&self.factor, self.scale.len());
        for _ in 0..STEPS {
            iteration.step()?;
            let displacements = displacements(&iteration.motion, &self.scale, model, reduction);
            if model.energy(&displacements, &factor) < FREE_ENERGY {
                return Ok(true);
            }
            if iteration.least_energy() > FREE_ENERGY {
                return Ok(false);
            }
        }
        Ok(false)
    }

    /// Solves in place for right-hand sides one behind the other.
    pub(crate) fn solve(&self, right: &mut [f64]) -> Result<()> {
        let size = self.scale.len();
        if size == 0 {
            return Ok(());
        }
        self.apply_scale(right);
        self.factor.solve(right, right.len() / size)?;
        self.apply_scale(right);
        Ok(())
    }

    /// Solves in place, refines and checks the residual of each column; false where it stays
    /// large.
    ///
    /// `resisted` gives K z element by element, which is asked for where digits of the assembled
    /// matrix may be lost: where members are much stiffer along than across, say.
    pub(crate) fn solve_checked(
        &self,
        right: &mut [f64],
        resisted: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Result<bool> {
        let size = self.scale.len();
        if size == 0 {
            return Ok(true);
        }
        let delicate = self.factor.smallest_pivot() < DELICATE_PIVOT;
        let loads = right.to_vec();
        self.solve(right)?;
        for (load, unknowns) in loads.chunks_exact(size).zip(right.chunks_exact_mut(size)) {
            let residual = |unknowns: &[f64]| -> Vec<f64> {
                let taken = if delicate {
                    resisted(unknowns)
                } else {
                    self.resisted(unknowns)
                };
                load.iter()
                    .zip(taken)
                    .map(|(load, taken)| load - taken)
                    .collect()
            };
            let applied = self.force_norm(load);
            let mut left = residual(unknowns);
            let steps = if delicate { DELICATE_STEPS } else { 1 };
            for _ in 0..steps {
                if !delicate && self.force_norm(&left) <= REFINE * applied {
                    break;
                }
                self.solve(&mut left)?;
                for (unknown, correction) in unknowns.iter_mut().zip(&left) {
                    *unknown += correction;
                }
                left = residual(unknowns);
            }
            // Written so that NaN is refused as well.
            let small = REFUSE * (applied + self.motion_norm(unknowns));
            if self.force_norm(&left) <= small {
                continue;
            }
            return Ok(false);
        }
        Ok(true)
    }

    /// K `unknowns`, from the assembled matrix.
    pub(crate) fn resisted(&self, unknowns: &[f64]) -> Vec<f64> {
        let pairs = unknowns.iter().zip(&self.scale);
        let scaled: Vec<f64> = pairs.map(|(unknown, scale)| unknown / scale).collect();
        let mut forces = self.matrix.product(&scaled);
        for (force, scale) in forces.iter_mut().zip(&self.scale) {
            *force /= scale;
        }
        forces
    }

    /// Gives rotations that nothing stiffens a stiffness, so that they stay where they are;
    /// `factorise` must follow. The unknowns that it held.
    pub(crate) fn hold_loose(&mut self, reduction: &Reduction, dofs: usize) -> Vec<usize> {
        let mut all = vec![0.0; dofs];
        let diagonal = self.matrix.diagonal();
        for (&dof, value) in reduction.unknowns.iter().zip(&diagonal) {
            all[dof] = *value;
        }
        let rotations = reduction.unknowns.iter().enumerate();
        let rotations = rotations.filter(|(_, dof)| *dof % 6 >= 3);
        let loose: Vec<usize> = rotations
            .filter(|&(at, &dof)| diagonal[at] <= NO_STIFFNESS * stiffest(&all, dof))
            .map(|(at, _)| at)
            .collect();
        for &at in &loose {
            self.matrix.values[self.matrix.first[at]] = 1.0;
        }
        loose
    }

    fn apply_scale(&self, values: &mut [f64]) {
        for column in values.chunks_mut(self.scale.len()) {
            for (value, scale) in column.iter_mut().zip(&self.scale) {
                *value *= scale;
            }
        }
    }

    /// Dimensionless norm of forces on the unknowns.
    pub(crate) fn force_norm(&self, forces: &[f64]) -> f64 {
        let terms = forces.iter().zip(&self.scale);
        terms
            .map(|(force, scale)| (force * scale).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The norm of unknowns in the same scale: K has norm 1 or a little more.
    pub(crate) fn motion_norm(&self, unknowns: &[f64]) -> f64 {
        let terms = unknowns.iter().zip(&self.scale);
        terms
            .map(|(motion, scale)| (motion / scale).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The error for K that does not factorise, or leaves a large residual.
    pub(crate) fn unstable(&self, model: &Model, reduction: &Reduction) -> Error {
        match self.null_vector() {
            Ok(motion) => mechanism(
                &displacements(&motion, &self.scale, model, reduction),
                model.arm(),
            ),
            Err(error) => error,
        }
    }

    /// The motion that the matrix, shifted until it is definite, resists least.
    fn null_vector(&self) -> Result<Vec<f64>> {
        let mut matrix = self.matrix.clone();
        let mut factor = self.factor.another()?;
        let mut shift = SHIFT;
        matrix.shift(shift);
        while !factor.factorise(&matrix) {
            if shift >= 1.0 {
                return Err(Error::invalid("the stiffness is not a finite number"));
            }
            shift *= 100.0;
            matrix.shift(shift);
        }
        let mut iteration = InverseIteration::new(&factor, matrix.size());
        for _ in 0..STEPS {
            if iteration.step()? < SETTLED {
                break;
            }
        }
        Ok(iteration.motion)
    }
}

/// A stiffness with its free rotations, which are held in it.
fn held(mut matrix: LowerTriangle, reduction: &Reduction) -> (LowerTriangle, Vec<FreeRotation>) {
    let found = FreeRotation::find(&matrix, reduction);
    found.iter().for_each(|rotation| rotation.hold(&mut matrix));
    (matrix, found)
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

/// Of all dofs, from a motion of the scaled unknowns.
fn displacements(motion: &[f64], scale: &[f64], model: &Model, reduction: &Reduction) -> Vec<f64> {
    let unscaled: Vec<f64> = motion.iter().zip(scale).map(|(m, s)| m * s).collect();
    let mut displacements = vec![0.0; model.dofs];
    reduction.expand(&unscaled, &mut displacements);
    displacements
}
