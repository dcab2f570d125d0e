//! Modes of samples of a structure of which every stiffness may vary.
//!
//! Samples begin with the modes of the structure (`swinging`) and are solved together, one a lane
//! of a SIMD vector (`iteration`, on blocks of vectors, `block`, and on what these span,
//! `projected`). One that is not proved there, or counted otherwise, is solved by itself, as is
//! every sample of a structure that is too large or too small for that.

mod block;
mod iteration;
mod projected;
mod swinging;

use std::ops::Range;

use pulp::{Arch, NullaryFnOnce, Simd, WithSimd};
use rga_simd::f64::{Lanes, Packs};
use rga_simd::{Array, instructions_named};

use crate::error::{Error, Result};
use crate::input::{Masses, Structure};
use crate::paths::modes::motion::{Motion, sign};
use crate::paths::modes::{Modes, lowest, modes_of_another};
use crate::paths::parallel::in_chunks;
use crate::sparse::lanczos::{Lanczos, RitzPairs};
use crate::validate::arrays::{CheckNumbers, CheckShape};
use crate::validate::masses::check_masses;
use crate::validate::structure::check_structure;
use block::BESIDE;
use iteration::Iteration;
use swinging::{Swinging, known_modes};

/// Rows that a thread takes at a time.
const CHUNK: usize = 32;

/// A structure that swings, of which every stiffness may vary from sample to sample; masses stay.
pub struct ModalBatch {
    motion: Motion,
    known: RitzPairs,
    /// Nothing where samples are solved one by one.
    swinging: Option<Swinging>,
    count: usize,
    dofs: Vec<usize>,
    arch: Arch,
}

impl ModalBatch {
    /// The `count` lowest modes are found, and of their shapes what moves along `dofs`: six times
    /// the node and the direction.
    ///
    /// `instructions` names one of `instructions()`; nothing names the best. Results do not depend
    /// on it.
    pub fn new(
        structure: &Structure,
        masses: &Masses,
        count: usize,
        dofs: &[usize],
        instructions: Option<&str>,
    ) -> Result<Self> {
        check_structure(structure)?;
        check_masses(structure, masses)?;
        let arch = instructions_named(instructions)?;
        let motion = Motion::new(structure, masses)?;
        if let Some(dof) = dofs.iter().find(|dof| **dof >= motion.model.dofs) {
            return Err(Error::invalid(format!("there is no dof {dof}")));
        }
        let known = lowest(&motion, known_modes(count), 0, Lanczos::new(&motion))?;
        if known.converged < count {
            return Err(Error::invalid(format!(
                "there are {} modes, and {count} are wanted",
                known.converged
            )));
        }
        let Motion {
            model, reduction, ..
        } = &motion;
        let swinging = Swinging::new(model, reduction, motion.mass(), &known, count);
        Ok(Self {
            motion,
            known,
            swinging,
            count,
            dofs: dofs.to_vec(),
            arch,
        })
    }

    /// Number of members and springs.
    pub fn elements(&self) -> usize {
        self.motion.model.members.len() + self.motion.model.springs.len()
    }

    /// Numbers of a sample: of each mode the eigenvalue, then its shape along the dofs.
    pub fn width(&self) -> usize {
        self.count * (1 + self.dofs.len())
    }

    /// Modes of samples, `[rows, modes, 1 + dofs]` in C order: the eigenvalue of each, then its
    /// shape, with a modal mass of one; the largest motion of all dofs is positive.
    ///
    /// Factors `[rows, members + springs]` multiply the whole stiffness of a member or of a spring.
    pub fn modes(&self, factors: Array<f64>, threads: usize) -> Result<Vec<f64>> {
        let rows = factors.len();
        factors.check_shape("factors", &[rows, self.elements()])?;
        for row in 0..rows {
            let stiff = |factor: f64| factor.is_finite() && factor > 0.0;
            factors.check_row("factors", row, "finite and above zero", stiff)?;
        }
        self.check_yielding(factors)?;
        let mut results = vec![0.0; rows * self.width().max(1)];
        let batch = self;
        self.arch.dispatch(Sweep {
            batch,
            factors,
            results: &mut results,
            threads,
        })?;
        results.truncate(rows * self.width());
        Ok(results)
    }

    fn check_yielding(&self, factors: Array<f64>) -> Result<()> {
        let members = self.motion.model.members.iter().enumerate();
        for (index, _) in members.filter(|(_, member)| !member.is_proportional()) {
            if let Some(row) = (0..factors.len()).find(|&row| factors.row(row)[index] != 1.0) {
                return Err(Error::invalid(format!(
                    "factors[{row}, {index}] is {}, but the ends of member {index} yield and do \
                     not scale with it; it must be 1",
                    factors.row(row)[index]
                )));
            }
        }
        Ok(())
    }

    /// One sample by itself.
    #[inline(never)]
    fn alone(&self, factors: &[f64], found: &mut [f64]) -> Result<()> {
        let motion = self.motion.with_factors(factors)?;
        let modes = modes_of_another(&motion, &self.known, self.count)?;
        let Modes {
            eigenvalues,
            shapes,
            ..
        } = &modes;
        if eigenvalues.len() < self.count {
            return Err(Error::invalid("a sample has fewer modes"));
        }
        let shapes = shapes.chunks_exact(self.motion.model.dofs);
        let places = found.chunks_exact_mut(1 + self.dofs.len());
        for ((eigenvalue, shape), place) in eigenvalues.iter().zip(shapes).zip(places) {
            place[0] = *eigenvalue;
            for (value, &dof) in place[1..].iter_mut().zip(&self.dofs) {
                *value = shape[dof];
            }
        }
        Ok(())
    }

    /// What a lane has come to.
    #[inline(never)]
    fn read<L: Lanes>(
        &self,
        swinging: &Swinging,
        iteration: &Iteration<L>,
        lane: usize,
        found: &mut [f64],
    ) {
        let Motion {
            model, reduction, ..
        } = &self.motion;
        let size = swinging.size();
        let numbers = L::flat(&iteration.shapes);
        let of_lane = |values: &[L::Numbers], at: usize| L::flat(values)[at * L::COUNT + lane];
        let mut motion = vec![0.0; size];
        let mut shape = vec![0.0; model.dofs];
        let places = found.chunks_exact_mut(1 + self.dofs.len());
        for (vector, place) in places.enumerate() {
            let (group, beside) = (vector / BESIDE, vector % BESIDE);
            for (value, at) in motion.iter_mut().zip(&swinging.place) {
                *value = numbers[((group * size + at) * BESIDE + beside) * L::COUNT + lane];
            }
            shape.fill(0.0);
            reduction.expand(&motion, &mut shape);
            let modal_mass = of_lane(&iteration.modal_masses, vector);
            let scale = sign(&shape, model.arm()) / modal_mass.sqrt();
            place[0] = of_lane(&iteration.eigenvalues, vector);
            for (value, &dof) in place[1..].iter_mut().zip(&self.dofs) {
                *value = scale * shape[dof];
            }
        }
    }
}

/// All samples, shared among threads.
struct Sweep<'a> {
    batch: &'a ModalBatch,
    factors: Array<'a, f64>,
    results: &'a mut [f64],
    threads: usize,
}

impl WithSimd for Sweep<'_> {
    type Output = Result<()>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<()> {
        let lanes = Packs::<S, 1>(simd);
        let Self {
            batch,
            factors,
            results,
            threads,
        } = self;
        let prepare = || {
            let swinging = batch.swinging.as_ref();
            Ok(swinging.map(|swinging| Iteration::new(lanes, swinging)))
        };
        let work = |iteration: &mut Option<Iteration<Packs<S, 1>>>,
                    rows: Range<usize>,
                    results: &mut [f64]| {
            lanes.vectorize(Chunk {
                lanes,
                batch,
                factors,
                iteration: iteration.as_mut(),
                rows,
                results,
            })
        };
        let width = batch.width().max(1);
        in_chunks(results, width, CHUNK, threads, prepare, work)
    }
}

/// Samples that a thread takes at a time.
struct Chunk<'a, 'b, L: Lanes> {
    lanes: L,
    batch: &'a ModalBatch,
    factors: Array<'a, f64>,
    iteration: Option<&'a mut Iteration<'b, L>>,
    rows: Range<usize>,
    results: &'a mut [f64],
}

impl<L: Lanes> NullaryFnOnce for Chunk<'_, '_, L> {
    type Output = Result<()>;

    #[inline(always)]
    fn call(self) -> Result<()> {
        let Self {
            lanes,
            batch,
            factors,
            mut iteration,
            rows,
            results,
        } = self;
        let (width, elements) = (batch.width().max(1), batch.elements());
        let at_once = if iteration.is_some() { L::COUNT } else { 1 };
        for from in rows.clone().step_by(at_once) {
            let count = at_once.min(rows.end - from);
            let results = &mut results[(from - rows.start) * width..][..count * width];
            let mut counted = 0;
            if let (Some(iteration), Some(swinging)) = (&mut iteration, &batch.swinging) {
                let weights = &mut iteration.weights[..elements];
                lanes.gather(weights, factors.values, from, count);
                counted = iteration.solve(lanes, |iteration, proved| {
                    for (lane, found) in results.chunks_exact_mut(width).enumerate() {
                        if proved >> lane & 1 == 1 {
                            batch.read(swinging, iteration, lane, found);
                        }
                    }
                });
            }
            for (lane, found) in results.chunks_exact_mut(width).enumerate() {
                if counted >> lane & 1 == 0 {
                    let row = from + lane;
                    let solved = batch.alone(factors.row(row), found);
                    solved.map_err(|error| error.of_row(row))?;
                }
            }
        }
        Ok(())
    }
}
