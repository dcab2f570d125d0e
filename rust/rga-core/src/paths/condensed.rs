//! Samples of a condensed structure (`condensation`).
//!
//! A term of stiffness k + d and elongation v adds the pseudo-force w = d v to the structure as it
//! is. With G the elongations under unit pseudo-forces and H = 1 / G, the elongations follow from
//! the condensed stiffness,
//!
//!   (H + diag(d)) v = H V q,    y = Y q - C w,
//!
//! with load coefficients q, outputs y, and the responses Y, V, C of the structure as it is to
//! unit loads and unit pseudo-forces (Woodbury's identity, written as a condensation). The cost
//! does not depend on the size of the structure.

mod adjoint;
mod kernel;
mod samples;
mod sensitivity;

use std::ops::Range;

use nalgebra::DMatrix;
use pulp::Arch;

use crate::error::{Error, Result};
use crate::paths::condensation::UnitResponses;
use crate::paths::directions::Directions;
use crate::paths::parallel::in_chunks;
use adjoint::AdjointKernel;
use kernel::Kernel;
use sensitivity::SensitivityKernel;

/// Rows that one thread takes at a time.
const CHUNK: usize = 2048;

/// p load patterns, e members and springs that vary, r terms that these are, o outputs.
#[derive(Debug, Clone)]
pub struct Condensed {
    pub patterns: usize,
    pub elements: usize,
    pub terms: usize,
    pub outputs: usize,
    /// `[r]` which element a term belongs to, and k
    element: Vec<usize>,
    first: Vec<f64>,
    /// `[p, o]` outputs under unit loads, Y transposed.
    loaded: Vec<f64>,
    /// `[p, r]` H V transposed.
    driven: Vec<f64>,
    /// `[r, r]` H, symmetric.
    stiffness: Vec<f64>,
    /// `[r, o]` outputs under unit pseudo-forces, C transposed.
    influence: Vec<f64>,
}

impl Condensed {
    /// `DependentTerms` where elongations depend on each other.
    pub(super) fn new(responses: &UnitResponses) -> Result<Self> {
        let UnitResponses {
            patterns, outputs, ..
        } = *responses;
        let terms = responses.element.len();
        let inverse = responses.inverse()?;
        let stretched = DMatrix::from_row_slice(patterns, terms, &responses.stretched);
        let by_rows = |matrix: DMatrix<f64>| matrix.transpose().as_slice().to_vec();
        let found = Self {
            patterns,
            elements: responses.elements,
            terms,
            outputs,
            element: responses.element.clone(),
            first: responses.stiffness.clone(),
            loaded: responses.loaded.clone(),
            driven: by_rows(stretched * &inverse),
            stiffness: by_rows(inverse),
            influence: responses.influence.clone(),
        };
        for (name, values) in [
            ("outputs", &found.loaded),
            ("elongations", &found.driven),
            ("outputs of the terms", &found.influence),
        ] {
            finite(name, values, 1, 0..values.len())?;
        }
        Ok(found)
    }

    /// Outputs of n samples, written to `results` `[n, o]`.
    ///
    /// `coefficients` is q `[n, p]`, `stiffness` that of the elements `[n, e]`, k + d.
    pub fn respond(
        &self,
        coefficients: &[f64],
        stiffness: &[f64],
        results: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        let given = [
            ("coefficients", coefficients, self.patterns),
            ("stiffness", stiffness, self.elements),
        ];
        let arch = Arch::new();
        in_parts(given, results, self.outputs, threads, |[q, k], results| {
            arch.dispatch(Kernel {
                condensed: self,
                coefficients: q,
                stiffness: k,
                results,
            })
        })
    }

    /// Derivatives of the outputs of n samples along c directions, written to `results`
    /// `[n, c, o]`.
    ///
    /// `rates` hold, row by row, the derivatives of the coefficients and of the stiffnesses that
    /// the directions name.
    pub fn differentiate(
        &self,
        coefficients: &[f64],
        stiffness: &[f64],
        directions: &Directions,
        rates: (&[f64], &[f64]),
        results: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        directions.check(self.patterns, self.elements)?;
        let given = [
            ("coefficients", coefficients, self.patterns),
            ("stiffness", stiffness, self.elements),
            ("coefficient_rates", rates.0, directions.loads.len()),
            ("stiffness_rates", rates.1, directions.changes.len()),
        ];
        let width = self.outputs * directions.count;
        let arch = Arch::new();
        in_parts(
            given,
            results,
            width,
            threads,
            |[q, k, of_q, of_k], results| {
                arch.dispatch(SensitivityKernel {
                    condensed: self,
                    directions,
                    coefficients: q,
                    stiffness: k,
                    coefficient_rates: of_q,
                    stiffness_rates: of_k,
                    results,
                })
            },
        )
    }

    /// Derivatives of the sum of the outputs times `gradients` `[n, o]`, by the coefficients and
    /// then by the stiffnesses, written to `results` `[n, p + e]`: the adjoint of `respond`.
    pub fn pull_back(
        &self,
        coefficients: &[f64],
        stiffness: &[f64],
        gradients: &[f64],
        results: &mut [f64],
        threads: usize,
    ) -> Result<()> {
        let given = [
            ("coefficients", coefficients, self.patterns),
            ("stiffness", stiffness, self.elements),
            ("gradients", gradients, self.outputs),
        ];
        let width = self.patterns + self.elements;
        let arch = Arch::new();
        in_parts(given, results, width, threads, |[q, k, g], results| {
            arch.dispatch(AdjointKernel {
                condensed: self,
                coefficients: q,
                stiffness: k,
                gradients: g,
                results,
            })
        })
    }
}

/// Checks `given` arrays, (name, values, width) each, and has `work` fill `width` numbers a row;
/// it gives the first of its rows that is not stable.
fn in_parts<const N: usize>(
    given: [(&str, &[f64], usize); N],
    results: &mut [f64],
    width: usize,
    threads: usize,
    work: impl Fn([&[f64]; N], &mut [f64]) -> Option<usize> + Sync,
) -> Result<()> {
    let rows = results.len() / width.max(1);
    for (name, values, own) in given {
        check(name, values, rows * own)?;
    }
    let nothing = || Ok(());
    let part = |(): &mut (), rows: Range<usize>, results: &mut [f64]| {
        for (name, values, own) in given {
            finite(name, values, own, rows.clone())?;
        }
        let own = given.map(|(_, values, own)| &values[rows.start * own..rows.end * own]);
        let unstable = work(own, results);
        unstable.map_or(Ok(()), |row| {
            Err(Error::UnstableSample {
                row: rows.start + row,
            })
        })
    };
    in_chunks(results, width, CHUNK, threads, nothing, part)
}

fn check(name: &str, values: &[f64], length: usize) -> Result<()> {
    if values.len() != length {
        return Err(Error::invalid(format!(
            "{name} holds {} numbers where {length} are needed",
            values.len()
        )));
    }
    Ok(())
}

/// Refuses rows with a number that is not finite. A product with zero shows one, many at a time.
fn finite(name: &str, values: &[f64], width: usize, rows: Range<usize>) -> Result<()> {
    const MANY: usize = 16;
    let part = &values[rows.start * width..rows.end * width];
    let mut sums = [0.0; MANY];
    let blocks = part.chunks_exact(MANY);
    let rest = blocks.remainder();
    for block in blocks {
        for (sum, value) in sums.iter_mut().zip(block) {
            *sum += value * 0.0;
        }
    }
    if sums.iter().sum::<f64>() == 0.0 && rest.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    let at = part
        .iter()
        .position(|value| !value.is_finite())
        .unwrap_or_default();
    Err(Error::invalid(format!(
        "{name} holds {} at row {}, column {}",
        part[at],
        rows.start + at / width,
        at % width
    )))
}
