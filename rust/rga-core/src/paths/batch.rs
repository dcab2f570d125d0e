//! Samples of a structure of which every stiffness may vary (C3).
//!
//! What does not depend on the stiffness is done once: checks, supports and ties, the structure as
//! sums over the factors of its elements (`system`, read off by `probe`), in which order unknowns
//! are eliminated (`elimination`), and where the numbers of the factor stand (`panels`). Samples
//! are then filled in, factorised (`cholesky`) and solved for their one load together, one a lane
//! of a SIMD vector (`simd_solver`). A sample that may be unstable or lose digits is solved again
//! by itself (`scalar_fallback`), as is every sample of a structure that is too large for caches to
//! hold it many times. Outputs and derivatives are read off the solved samples (`readings`).
//! Factors enter all of these sparsely (`bilinear`); sums of the factorisation stay in registers
//! (`tiles`). Modes of samples are found with the same factors (`modal`).

mod bilinear;
mod cholesky;
mod elimination;
pub(crate) mod modal;
mod panels;
mod probe;
mod readings;
mod scalar_fallback;
mod simd_solver;
mod system;
mod tiles;

use std::ops::Range;

use pulp::{Arch, NullaryFnOnce, Simd, WithSimd};
use rga_simd::Array;
use rga_simd::f64::{Lanes, MOST, ONE, One, Packs};
use rga_simd::instructions_named;

use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::model::Model;
use crate::fe::outputs::read_outputs;
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Loads, Outputs, Structure};
use crate::paths::directions::Directions;
use crate::paths::parallel::in_chunks;
use crate::sparse::ordering::OFTEN;
use crate::validate::arrays::{CheckNumbers, CheckShape, not_negative};
use crate::validate::loads::check_loads;
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;
use readings::{Adjoint, Forward, Reading, Rows};
use scalar_fallback::ScalarFallback;
use simd_solver::{Batch, SimdSolver};
use system::System;

/// Rows that a thread takes at a time.
const CHUNK: usize = 64;

pub struct BatchSolver {
    model: Model,
    reduction: Reduction,
    system: System,
    /// Analysed, not factorised.
    solver: Solver,
    patterns: usize,
    outputs: usize,
    arch: Arch,
}

/// Samples: factors `[rows, members + springs]` multiply the whole stiffness of a member or of a
/// spring; 0 removes it. The load of a sample is the sum of all patterns times its coefficients
/// `[rows, patterns]`.
#[derive(Debug, Clone, Copy)]
pub struct Samples<'a> {
    pub factors: Array<'a, f64>,
    pub coefficients: Array<'a, f64>,
}

impl BatchSolver {
    /// `instructions` names one of `instructions()`; nothing names the best. Results do not depend
    /// on it.
    pub fn new(
        structure: &Structure,
        loads: &Loads,
        outputs: &Outputs,
        instructions: Option<&str>,
    ) -> Result<Self> {
        check_structure(structure)?;
        check_loads(structure, loads)?;
        check_outputs(structure, outputs)?;
        let arch = instructions_named(instructions)?;
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let wanted = read_outputs(outputs);
        let (system, matrix) = System::new(&model, &constraints, &reduction, loads, &wanted)?;
        let places = reduction.places(&model.nodes);
        Ok(Self {
            solver: Solver::analyse(matrix, system.free_rotations.clone(), &places, OFTEN)?,
            patterns: loads.pattern_count(),
            outputs: wanted.len(),
            model,
            reduction,
            system,
            arch,
        })
    }

    /// Number of outputs.
    pub fn width(&self) -> usize {
        self.outputs
    }

    /// Number of members and springs.
    pub fn elements(&self) -> usize {
        self.system.weights.elements
    }

    /// Number of load patterns.
    pub fn patterns(&self) -> usize {
        self.patterns
    }

    /// The outputs of all samples, `[rows, outputs]` in C order.
    pub fn respond(&self, samples: Samples, threads: usize) -> Result<Vec<f64>> {
        let outputs = self.outputs;
        self.each(samples, &readings::Outputs { outputs }, threads)
    }

    /// Derivatives of the outputs along directions, `[rows, directions, outputs]` in C order.
    ///
    /// `rates` hold, row by row, the derivatives of the coefficients and of the factors that the
    /// directions name.
    pub fn differentiate(
        &self,
        samples: Samples,
        directions: &Directions,
        rates: (Array<f64>, Array<f64>),
        threads: usize,
    ) -> Result<Vec<f64>> {
        directions.check(self.patterns, self.elements())?;
        let rows = samples.factors.len();
        for (name, rates, entries) in [
            ("coefficient_rates", rates.0, &directions.loads),
            ("factor_rates", rates.1, &directions.changes),
        ] {
            rates.check_shape(name, &[rows, entries.len()])?;
            rates.check_finite(name)?;
        }
        let forward = Forward {
            outputs: self.outputs,
            directions,
            coefficients: rates.0,
            factors: rates.1,
        };
        self.each(samples, &forward, threads)
    }

    /// Derivatives of the sum of the outputs times `gradients` `[rows, outputs]`, by the
    /// coefficients and then by the factors: `[rows, patterns + elements]` in C order. One solve a
    /// row, however many there are.
    pub fn pull_back(
        &self,
        samples: Samples,
        gradients: Array<f64>,
        threads: usize,
    ) -> Result<Vec<f64>> {
        gradients.check_shape("gradients", &[samples.factors.len(), self.outputs])?;
        gradients.check_finite("gradients")?;
        let adjoint = Adjoint {
            patterns: self.patterns,
            elements: self.elements(),
            gradients,
        };
        self.each(samples, &adjoint, threads)
    }

    /// Solves every sample and reads its numbers.
    fn each(&self, samples: Samples, reading: &impl Reading, threads: usize) -> Result<Vec<f64>> {
        let Samples {
            factors,
            coefficients,
        } = samples;
        let rows = factors.len();
        factors.check_shape("factors", &[rows, self.elements()])?;
        coefficients.check_shape("coefficients", &[rows, self.patterns])?;
        self.check_yielding(factors)?;
        // Without outputs the samples are still checked: one place a row, left empty.
        let width = reading.width();
        let mut results = vec![0.0; rows * width.max(1)];
        self.arch.dispatch(Sweep {
            solver: self,
            samples,
            reading,
            results: &mut results,
            threads,
        })?;
        results.truncate(rows * width);
        Ok(results)
    }

    fn fallback(&self) -> Result<ScalarFallback<'_>> {
        Ok(ScalarFallback {
            model: &self.model,
            reduction: &self.reduction,
            system: &self.system,
            solver: self.solver.another()?,
        })
    }

    fn check_yielding(&self, factors: Array<f64>) -> Result<()> {
        let members = self.model.members.iter().enumerate();
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
}

/// All samples, shared among threads.
struct Sweep<'a, R> {
    solver: &'a BatchSolver,
    samples: Samples<'a>,
    reading: &'a R,
    results: &'a mut [f64],
    threads: usize,
}

impl<R: Reading> WithSimd for Sweep<'_, R> {
    type Output = Result<()>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<()> {
        let lanes = Packs::<S, 1>(simd);
        let Self {
            solver,
            samples,
            reading,
            results,
            threads,
        } = self;
        let BatchSolver {
            system, patterns, ..
        } = solver;
        let prepare = || {
            Ok(Scratch {
                batch: Batch::new(lanes, system, *patterns),
                simd: (system.panels.as_ref()).map(|panels| SimdSolver::new(lanes, system, panels)),
                shown: vec![lanes.splat(0.0); reading.width()],
                alone: Alone {
                    solver,
                    samples,
                    reading,
                    fallback: None,
                },
            })
        };
        let work =
            |scratch: &mut Scratch<Packs<S, 1>, R>, rows: Range<usize>, results: &mut [f64]| {
                lanes.vectorize(Chunk {
                    lanes,
                    scratch,
                    rows,
                    results,
                })
            };
        in_chunks(
            results,
            reading.width().max(1),
            CHUNK,
            threads,
            prepare,
            work,
        )
    }
}

/// What a thread needs for its samples.
struct Scratch<'a, L: Lanes, R> {
    batch: Batch<L>,
    /// Nothing where the structure is too large.
    simd: Option<SimdSolver<'a, L>>,
    shown: Vec<L::Numbers>,
    alone: Alone<'a, R>,
}

/// Samples that a thread takes at a time.
struct Chunk<'a, 'b, L: Lanes, R> {
    lanes: L,
    scratch: &'a mut Scratch<'b, L, R>,
    rows: Range<usize>,
    results: &'a mut [f64],
}

impl<L: Lanes, R: Reading> NullaryFnOnce for Chunk<'_, '_, L, R> {
    type Output = Result<()>;

    #[inline(always)]
    fn call(self) -> Result<()> {
        let Self {
            lanes,
            scratch,
            rows,
            results,
        } = self;
        let Scratch {
            batch,
            simd,
            shown,
            alone,
        } = scratch;
        let width = alone.reading.width();
        let place = width.max(1);
        let Samples {
            factors,
            coefficients,
        } = alone.samples;
        let system = &alone.solver.system;
        let at_once = if simd.is_some() { L::COUNT } else { 1 };
        for from in rows.clone().step_by(at_once) {
            let count = at_once.min(rows.end - from);
            let results = &mut results[(from - rows.start) * place..][..count * place];
            let mut sound = [false; MOST];
            if let Some(simd) = simd {
                batch.take(
                    lanes,
                    system,
                    (factors.values, coefficients.values),
                    from,
                    count,
                );
                simd.factorise(lanes, batch);
                shown.fill(lanes.splat(0.0));
                let rows = Rows { from, count };
                alone
                    .reading
                    .read(lanes, system, rows, batch, simd, shown)?;
                lanes.scatter(shown, results, place, count);
                for (lane, found) in results.chunks_exact(place).enumerate() {
                    let finite = found.iter().all(|value| value.is_finite());
                    sound[lane] = finite && simd.sound(lanes, lane);
                }
            }
            for lane in (0..count).filter(|&lane| !sound[lane]) {
                let found = &mut results[lane * place..][..width];
                alone.read(from + lane, found)?;
            }
        }
        Ok(())
    }
}

/// Samples one by one.
struct Alone<'a, R> {
    solver: &'a BatchSolver,
    samples: Samples<'a>,
    reading: &'a R,
    /// Made when the first sample needs it.
    fallback: Option<(ScalarFallback<'a>, Batch<One>)>,
}

impl<R: Reading> Alone<'_, R> {
    #[inline(never)]
    fn read(&mut self, row: usize, found: &mut [f64]) -> Result<()> {
        let Samples {
            factors,
            coefficients,
        } = self.samples;
        let BatchSolver {
            system, patterns, ..
        } = self.solver;
        factors.check_row("factors", row, "finite and not negative", not_negative)?;
        coefficients.check_row("coefficients", row, "a finite number", f64::is_finite)?;
        let (fallback, batch) = match &mut self.fallback {
            Some(pair) => pair,
            none => none.insert((self.solver.fallback()?, Batch::new(ONE, system, *patterns))),
        };
        batch.take(ONE, system, (factors.values, coefficients.values), row, 1);
        found.fill(0.0);
        let rows = Rows {
            from: row,
            count: 1,
        };
        let (shown, _) = found.as_chunks_mut();
        (fallback.factorise(batch))
            .and_then(|()| self.reading.read(ONE, system, rows, batch, fallback, shown))
            .and_then(|()| finite(found))
            .map_err(|error| error.of_row(row))
    }
}

fn finite(found: &[f64]) -> Result<()> {
    match found.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => Err(Error::invalid(format!(
            "number {at} of the result overflows; check the sizes of loads and stiffnesses"
        ))),
    }
}
