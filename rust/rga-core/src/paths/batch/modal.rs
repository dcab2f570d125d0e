//! Modes of samples of a structure of which every stiffness may vary.
//!
//! Samples begin with the modes of the structure (`swinging`) and are solved together, one a lane
//! of a SIMD vector (`iteration`, on blocks of vectors, `block`, and on what these span,
//! `projected`). Where few stiffnesses vary, that is done in a space of few vectors (`reduced`); a
//! sample that is not proved there, or counted otherwise, is solved in the whole, and by itself if
//! it is not proved there either, as is every sample of a structure that is too large or too small.

mod block;
mod iteration;
mod projected;
mod reduced;
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
use reduced::reduced;
use swinging::{Swinging, known_modes, start_width, whole};

/// Rows that a thread takes at a time.
const CHUNK: usize = 32;

/// A structure that swings, of which stiffnesses vary from sample to sample; masses stay.
pub struct ModalBatch {
    motion: Motion,
    known: RitzPairs,
    /// Ways to solve samples together, the quickest first.
    ways: Vec<Way>,
    /// Numbers of the elements that vary: members, then springs behind them.
    varied: Vec<usize>,
    count: usize,
    dofs: Vec<usize>,
    arch: Arch,
}

struct Way {
    swinging: Swinging,
    /// Weights of the elements that vary.
    weights: Vec<usize>,
    /// Vectors of which the unknowns are shares; nothing where they are those of the structure.
    vectors: Option<Vec<Vec<f64>>>,
}

impl ModalBatch {
    /// The `count` lowest modes are found, and of their shapes what moves along `dofs`: six times
    /// the node and the direction. `varied` are numbers of members, and of springs behind them.
    ///
    /// `instructions` names one of `instructions()`; nothing names the best. Results do not depend
    /// on it.
    pub fn new(
        structure: &Structure,
        masses: &Masses,
        varied: &[usize],
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
        let elements = motion.model.members.len() + motion.model.springs.len();
        if let Some(element) = varied.iter().find(|element| **element >= elements) {
            return Err(Error::invalid(format!("there is no element {element}")));
        }
        let mut once = varied.to_vec();
        once.sort_unstable();
        if once.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(Error::invalid("an element is named twice"));
        }
        let known = lowest(&motion, known_modes(count), 0, Lanczos::new(&motion))?;
        if known.converged < count {
            return Err(Error::invalid(format!(
                "there are {} modes, and {count} are wanted",
                known.converged
            )));
        }
        let mut ways = Vec::new();
        if let Some(modes) = start_width(&known, count)
            && let Some((pencil, vectors)) = reduced(&motion, &known, modes, varied)?
            && let Some(swinging) = Swinging::new(pencil, count)
        {
            ways.push(Way {
                swinging,
                weights: (0..varied.len()).collect(),
                vectors: Some(vectors),
            });
        }
        if let Some(swinging) = whole(&motion, &known).and_then(|all| Swinging::new(all, count)) {
            ways.push(Way {
                swinging,
                weights: varied.to_vec(),
                vectors: None,
            });
        }
        Ok(Self {
            motion,
            known,
            ways,
            varied: varied.to_vec(),
            count,
            dofs: dofs.to_vec(),
            arch,
        })
    }

    /// Numbers of a sample: of each mode the eigenvalue, then its shape along the dofs.
    pub fn width(&self) -> usize {
        self.count * (1 + self.dofs.len())
    }

    /// Modes of samples, `[rows, modes, 1 + dofs]` in C order: the eigenvalue of each, then its
    /// shape, with a modal mass of one; the largest motion of all dofs is positive.
    ///
    /// Factors `[rows, varied]` multiply the whole stiffness of a member or of a spring.
    pub fn modes(&self, factors: Array<f64>, threads: usize) -> Result<Vec<f64>> {
        let rows = factors.len();
        factors.check_shape("factors", &[rows, self.varied.len()])?;
        // A stiffness that is none is another structure.
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
        let yields = |element: usize| {
            let member = self.motion.model.members.get(element);
            member.is_some_and(|member| !member.is_proportional())
        };
        let own = self.varied.iter().enumerate();
        for (index, member) in own.filter(|(_, element)| yields(**element)) {
            if let Some(row) = (0..factors.len()).find(|&row| factors.row(row)[index] != 1.0) {
                return Err(Error::invalid(format!(
                    "factors[{row}, {index}] is {}, but the ends of member {member} yield and do \
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
        let model = &self.motion.model;
        let mut all = vec![1.0; model.members.len() + model.springs.len()];
        for (&element, factor) in self.varied.iter().zip(factors) {
            all[element] = *factor;
        }
        let motion = self.motion.with_factors(&all)?;
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
    fn read<L: Lanes>(&self, way: &Way, iteration: &Iteration<L>, lane: usize, found: &mut [f64]) {
        let Motion {
            model, reduction, ..
        } = &self.motion;
        let size = way.swinging.size();
        let numbers = L::flat(&iteration.shapes);
        let of_lane = |values: &[L::Numbers], at: usize| L::flat(values)[at * L::COUNT + lane];
        let mut own = vec![0.0; size];
        let mut shape = vec![0.0; model.dofs];
        let places = found.chunks_exact_mut(1 + self.dofs.len());
        for (vector, place) in places.enumerate() {
            let (group, beside) = (vector / BESIDE, vector % BESIDE);
            place[0] = of_lane(&iteration.eigenvalues, vector);
            if self.dofs.is_empty() {
                continue;
            }
            for (value, at) in own.iter_mut().zip(&way.swinging.place) {
                *value = numbers[((group * size + at) * BESIDE + beside) * L::COUNT + lane];
            }
            shape.fill(0.0);
            match &way.vectors {
                None => reduction.expand(&own, &mut shape),
                Some(vectors) => reduction.expand(&sum(&own, vectors), &mut shape),
            }
            let modal_mass = of_lane(&iteration.modal_masses, vector);
            let scale = sign(&shape, model.arm()) / modal_mass.sqrt();
            for (value, &dof) in place[1..].iter_mut().zip(&self.dofs) {
                *value = scale * shape[dof];
            }
        }
    }
}

fn sum(shares: &[f64], vectors: &[Vec<f64>]) -> Vec<f64> {
    let mut found = vec![0.0; vectors.first().map_or(0, Vec::len)];
    for (share, vector) in shares.iter().zip(vectors) {
        for (value, part) in found.iter_mut().zip(vector) {
            *value += share * part;
        }
    }
    found
}

/// All samples, shared among threads.
struct Sweep<'a> {
    batch: &'a ModalBatch,
    factors: Array<'a, f64>,
    results: &'a mut [f64],
    threads: usize,
}

impl<'a> WithSimd for Sweep<'a> {
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
            Ok(Scratch {
                iterations: batch.ways.iter().map(|_| None).collect(),
                given: vec![lanes.splat(0.0); batch.varied.len()],
            })
        };
        let work =
            |scratch: &mut Scratch<'a, Packs<S, 1>>, rows: Range<usize>, results: &mut [f64]| {
                lanes.vectorize(Chunk {
                    lanes,
                    batch,
                    factors,
                    scratch,
                    rows,
                    results,
                })
            };
        let width = batch.width().max(1);
        in_chunks(results, width, CHUNK, threads, prepare, work)
    }
}

/// What a thread needs for its samples.
struct Scratch<'a, L: Lanes> {
    /// Of each way, once a sample has asked for it.
    iterations: Vec<Option<Iteration<'a, L>>>,
    /// Factors of the samples at hand.
    given: Vec<L::Numbers>,
}

/// Samples that a thread takes at a time.
struct Chunk<'a, 'b, L: Lanes> {
    lanes: L,
    batch: &'b ModalBatch,
    factors: Array<'a, f64>,
    scratch: &'a mut Scratch<'b, L>,
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
            scratch,
            rows,
            results,
        } = self;
        let Scratch { iterations, given } = scratch;
        let width = batch.width().max(1);
        let at_once = if iterations.is_empty() { 1 } else { L::COUNT };
        for from in rows.clone().step_by(at_once) {
            let count = at_once.min(rows.end - from);
            let results = &mut results[(from - rows.start) * width..][..count * width];
            let (mut counted, all) = (0, (1 << count) - 1);
            lanes.gather(given, factors.values, from, count);
            for (iteration, way) in iterations.iter_mut().zip(&batch.ways) {
                if counted & all == all {
                    break;
                }
                let iteration =
                    iteration.get_or_insert_with(|| Iteration::new(lanes, &way.swinging));
                let elements = way.swinging.weights.elements;
                iteration.weights[..elements].fill(lanes.splat(1.0));
                for (&weight, factor) in way.weights.iter().zip(given.iter()) {
                    iteration.weights[weight] = *factor;
                }
                counted |= iteration.solve(lanes, |iteration, proved| {
                    for (lane, found) in results.chunks_exact_mut(width).enumerate() {
                        if proved & !counted & (1 << lane) != 0 {
                            batch.read(way, iteration, lane, found);
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
