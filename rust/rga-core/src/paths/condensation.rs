//! A structure condensed onto its loads, its outputs and the few terms of rank one that vary (C2),
//! or none (C1).
//!
//! A term of stiffness k + d and elongation v acts on the structure as it is like one of
//! stiffness k with the pseudo-force w = d v beside it. Elongations under unit pseudo-forces are a
//! matrix G; its inverse H is the stiffness that these terms see, and a sample costs a
//! factorisation of that size alone (Woodbury's identity; Akgun et al., Fast exact linear and
//! non-linear structural reanalysis, IJNME 50, 2001). Forces of temperature and of lack of fit
//! scale with the stiffness of their member; those of loads between its ends do not.

use std::sync::OnceLock;

use nalgebra::DMatrix;

use crate::error::{Error, Result};
use crate::fe::outputs::read_outputs;
use crate::input::{Loads, Outputs, Structure};
use crate::paths::condensed::Condensed;
use crate::paths::linear::{Analysis, check_read};
use crate::paths::rank_one_terms::{Term, TermKind, Varied, find_terms};
use crate::validate::loads::check_loads;
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;

/// The elongations under unit pseudo-forces must be independent to at least this share.
const INDEPENDENT: f64 = 1e-7;

/// What unit loads and unit pseudo-forces do to a structure: p load patterns, r terms, o outputs.
#[derive(Debug, Clone)]
pub struct UnitResponses {
    pub patterns: usize,
    pub outputs: usize,
    /// Members and springs that vary.
    pub elements: usize,
    /// `[r]` which of them a term belongs to
    pub element: Vec<usize>,
    /// `[r]` in the structure as it is
    pub stiffness: Vec<f64>,
    /// `[p, o]` outputs under unit loads
    pub loaded: Vec<f64>,
    /// `[p, r]` elongations under unit loads
    pub stretched: Vec<f64>,
    /// `[r, o]` outputs under unit pseudo-forces
    pub influence: Vec<f64>,
    /// `[r, r]` elongations under unit pseudo-forces, G
    pub unit: Vec<f64>,
}

/// A structure for which only stiffnesses of some members and springs vary.
#[derive(Debug)]
pub struct Condensation {
    pub responses: UnitResponses,
    samples: OnceLock<Result<Condensed>>,
}

impl Condensation {
    pub fn new(responses: UnitResponses) -> Self {
        Self {
            responses,
            samples: OnceLock::new(),
        }
    }

    /// Of a structure under loads.
    pub fn of(
        structure: &Structure,
        loads: &Loads,
        outputs: &Outputs,
        varied: Varied,
    ) -> Result<Self> {
        check_structure(structure)?;
        check_loads(structure, loads)?;
        check_outputs(structure, outputs)?;
        varied.check(structure)?;
        let analysis = Analysis::new(structure)?;
        let wanted = read_outputs(outputs);
        let (terms, held) = find_terms(structure, &analysis.model, &wanted, varied);
        let patterns = loads.pattern_count();
        if (0..patterns).any(|pattern| stretches(&held, loads, pattern)) {
            return Err(Error::DependentTerms);
        }
        let count = terms.len();
        let mut loaded = Vec::with_capacity(patterns * wanted.len());
        let mut stretched = Vec::with_capacity(patterns * count);
        let zeros = vec![0.0; analysis.model.dofs.max(3 * analysis.model.members.len())];
        let gauged = |term: &Term| matches!(term.kind, TermKind::Gauge(_));
        let gauges = terms.iter().any(gauged);
        analysis.under_loads(loads, |_, state| {
            analysis.read(&wanted, state, &mut loaded);
            let own = terms
                .iter()
                .map(|term| term.elongation(&state.displacements) - term.at_rest(state.strain));
            stretched.extend(own);
            if gauges {
                let still = analysis.held(state.loads, &zeros)?;
                let first = stretched.len() - count;
                for (term, own) in terms.iter().zip(&mut stretched[first..]) {
                    if let TermKind::Gauge(output) = term.kind {
                        *own = analysis.read_one(&wanted[output], &still);
                    }
                }
            }
            Ok(())
        })?;
        check_read(&loaded, wanted.len(), 0)?;
        let (influence, unit) = analysis.under_terms(&terms, &wanted)?;
        Ok(Self::new(UnitResponses {
            patterns,
            outputs: wanted.len(),
            elements: varied.members.len() + varied.springs.len(),
            element: terms.iter().map(|term| term.element).collect(),
            stiffness: terms.iter().map(|term| term.stiffness).collect(),
            loaded,
            stretched,
            influence,
            unit,
        }))
    }

    /// What samples are solved with; `DependentTerms` where elongations depend on each other.
    pub fn samples(&self) -> Result<&Condensed> {
        let made = self.samples.get_or_init(|| Condensed::new(&self.responses));
        made.as_ref().map_err(Clone::clone)
    }
}

impl UnitResponses {
    /// H, `[r, r]`.
    pub(super) fn inverse(&self) -> Result<DMatrix<f64>> {
        let count = self.stiffness.len();
        let unit = DMatrix::from_row_slice(count, count, &self.unit);
        let finite = unit.iter().all(|value| value.is_finite());
        if !finite || unit.diagonal().iter().any(|&own| own <= 0.0) {
            return Err(Error::DependentTerms);
        }
        if count == 0 {
            return Ok(unit);
        }
        let size = unit.diagonal().map(f64::sqrt);
        let sizes = &size * size.transpose();
        let eigen = unit.component_div(&sizes).symmetric_eigen();
        if eigen.eigenvalues.min() < INDEPENDENT {
            return Err(Error::DependentTerms);
        }
        let mut scaled = eigen.eigenvectors.clone();
        for (mut column, value) in scaled.column_iter_mut().zip(&eigen.eigenvalues) {
            column /= *value;
        }
        Ok((scaled * eigen.eigenvectors.transpose()).component_div(&sizes))
    }
}

/// Whether supports that move, or initial strains, stretch terms that supports hold still.
fn stretches(held: &[Term], loads: &Loads, pattern: usize) -> bool {
    let (moved, strain) = (loads.prescribed.row(pattern), loads.strain.row(pattern));
    let stretch = |term: &Term| term.elongation(moved) != term.at_rest(strain);
    held.iter().any(stretch)
}
