//! A structure solved once: further loads, and a few stiffnesses that differ, cost little more.
//!
//! What unit pseudo-forces at every truss member and spring do is known from one factorisation,
//! and what they do along frame members with springs at their ends: trusses with stiff joints.
//! Structures that differ in few of these terms cost a system of as many equations
//! (`condensation` has the algebra and its source). Frame members that differ are the matter of
//! `frame_change`; where two structures differ is told by `difference`.

mod difference;
mod frame_change;

use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;

use crate::error::{Error, Result};
use crate::fe::load::PatternLoads;
use crate::fe::outputs::{Output, State, read_outputs};
use crate::input::{Loads, Outputs, Structure};
use crate::paths::condensation::UnitResponses;
use crate::paths::linear::{Analysis, check_read};
use crate::paths::rank_one_terms::{Term, Varied, find_terms};
use crate::validate::loads::check_loads;
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;
pub use difference::StiffnessDifference;
use frame_change::EndForces;

/// The response of one structure, and of those near it: r terms, o outputs.
pub struct Reanalysis {
    analysis: Analysis,
    wanted: Vec<Output>,
    /// Those that are terms, in their order; all springs are.
    members: Vec<usize>,
    terms: Vec<Term>,
    /// `[r, o]` and `[r, r]`, outputs and elongations under unit pseudo-forces
    influence: Vec<f64>,
    unit: Vec<f64>,
    /// Of frame members, in their order.
    nodes: Vec<usize>,
    /// What unit forces on these nodes do, once it is asked for.
    end_forces: OnceLock<Result<EndForces>>,
}

/// What load patterns with coefficient one do to a structure.
#[derive(Debug, Clone)]
pub struct Loaded {
    patterns: Vec<Arc<LoadedPattern>>,
}

#[derive(Debug)]
struct LoadedPattern {
    outputs: Vec<f64>,
    /// Of the terms.
    elongations: Vec<f64>,
    /// Of the nodes of frame members.
    displacements: Vec<f64>,
    /// The load itself, as far as members feel it.
    strain: Vec<f64>,
    members: PatternLoads,
}

impl Reanalysis {
    pub fn new(structure: &Structure, outputs: &Outputs) -> Result<Self> {
        check_structure(structure)?;
        check_outputs(structure, outputs)?;
        let analysis = Analysis::new(structure)?;
        let wanted = read_outputs(outputs);
        let model = &analysis.model;
        let springy = |member: &usize| {
            let ends = structure.connection.row(*member);
            ends.iter().any(|&end| end.is_finite() && end > 0.0)
        };
        let members: Vec<usize> = (0..model.members.len())
            .filter(|member| !structure.frame[*member] || springy(member))
            .collect();
        let springs: Vec<usize> = (0..model.springs.len()).collect();
        let varied = Varied {
            members: &members,
            springs: &springs,
            axial: true,
        };
        let (terms, _) = find_terms(structure, model, &wanted, varied);
        let (influence, unit) = analysis.under_terms(&terms, &wanted)?;
        let frames = model.members.iter().filter(|member| member.frame.is_some());
        let mut nodes: Vec<usize> = frames.flat_map(|member| member.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Ok(Self {
            analysis,
            wanted,
            members,
            terms,
            influence,
            unit,
            nodes,
            end_forces: OnceLock::new(),
        })
    }

    /// Outputs of a pattern.
    pub fn outputs(&self) -> usize {
        self.wanted.len()
    }

    /// The structure, which is given again, under loads.
    pub fn under(&self, structure: &Structure, loads: &Loads) -> Result<Loaded> {
        check_loads(structure, loads)?;
        let mut patterns = Vec::with_capacity(loads.pattern_count());
        self.analysis.under_loads(loads, |pattern, state| {
            let mut outputs = Vec::with_capacity(self.wanted.len());
            self.analysis.read(&self.wanted, state, &mut outputs);
            check_read(&outputs, self.wanted.len(), pattern)?;
            let stretch =
                |term: &Term| term.elongation(&state.displacements) - term.at_rest(state.strain);
            patterns.push(Arc::new(LoadedPattern {
                outputs,
                elongations: self.terms.iter().map(stretch).collect(),
                displacements: self.end_displacements(state),
                strain: state.strain.to_vec(),
                members: state.loads.clone(),
            }));
            Ok(())
        })?;
        Ok(Loaded { patterns })
    }

    /// Outputs `[p, o]` of a structure near this one, which differs as told. `DependentTerms`
    /// where no force balances it.
    pub fn changed(
        &self,
        loaded: &Loaded,
        other: &Structure,
        difference: &StiffnessDifference,
    ) -> Result<Vec<f64>> {
        if !difference.frames.is_empty() {
            return self.with_frames(loaded, other, &difference.frames);
        }
        let mut found = loaded.outputs();
        let differing = difference.terms.iter();
        let (places, stiffer): (Vec<usize>, Vec<f64>) = differing
            .filter_map(|&(element, stiffer)| Some((self.term_of(element)?, stiffer)))
            .unzip();
        let (count, width) = (places.len(), self.wanted.len());
        if count == 0 || width == 0 {
            return Ok(found);
        }
        let matrix = DMatrix::from_fn(count, count, |row, column| {
            let unit = self.unit[places[row] * self.terms.len() + places[column]];
            f64::from(row == column) + unit * stiffer[column]
        });
        let mut elongations = DMatrix::from_fn(count, loaded.patterns.len(), |row, pattern| {
            loaded.patterns[pattern].elongations[places[row]]
        });
        if !matrix.lu().solve_mut(&mut elongations) {
            return Err(Error::DependentTerms);
        }
        for (own, elongations) in (found.chunks_exact_mut(width)).zip(elongations.column_iter()) {
            for ((place, stiffer), elongation) in places.iter().zip(&stiffer).zip(&elongations) {
                take(own, stiffer * elongation, &self.influence[place * width..]);
            }
        }
        Ok(found)
    }

    /// The structure under loads condensed along members and onto springs; None for frame members
    /// without springs at their ends.
    pub fn onto(
        &self,
        loaded: &Loaded,
        members: &[usize],
        springs: &[usize],
    ) -> Option<UnitResponses> {
        let first = self.analysis.model.members.len();
        let elements = (members.iter().copied()).chain(springs.iter().map(|spring| first + spring));
        let places: Vec<usize> = elements
            .map(|element| self.term_of(element))
            .collect::<Option<_>>()?;
        let (width, count) = (self.wanted.len(), self.terms.len());
        let rows = places.iter();
        Some(UnitResponses {
            patterns: loaded.patterns.len(),
            outputs: width,
            elements: places.len(),
            element: (0..places.len()).collect(),
            stiffness: rows.clone().map(|&at| self.terms[at].stiffness).collect(),
            loaded: loaded.outputs(),
            stretched: (loaded.patterns.iter())
                .flat_map(|pattern| places.iter().map(|&at| pattern.elongations[at]))
                .collect(),
            influence: rows
                .clone()
                .flat_map(|&at| &self.influence[at * width..(at + 1) * width])
                .copied()
                .collect(),
            unit: rows
                .flat_map(|&row| places.iter().map(move |&at| self.unit[row * count + at]))
                .collect(),
        })
    }

    /// Members that are terms, and derivatives of the outputs by the logarithm of their EA, `[p,
    /// o]` one behind the other.
    pub fn rates(&self, loaded: &Loaded) -> (&[usize], Vec<f64>) {
        let width = self.wanted.len();
        let rates = (0..self.members.len()).flat_map(|at| {
            let influence = &self.influence[at * width..(at + 1) * width];
            let stiffness = self.terms[at].stiffness;
            loaded.patterns.iter().flat_map(move |pattern| {
                let force = stiffness * pattern.elongations[at];
                influence.iter().map(move |read| -force * read)
            })
        });
        (&self.members, rates.collect())
    }

    /// The term that an element is: a member, or a spring behind all members.
    fn term_of(&self, element: usize) -> Option<usize> {
        match element.checked_sub(self.analysis.model.members.len()) {
            Some(spring) => Some(self.members.len() + spring).filter(|&at| at < self.terms.len()),
            None => self.members.binary_search(&element).ok(),
        }
    }

    /// Of the nodes of frame members.
    fn end_displacements(&self, state: &State) -> Vec<f64> {
        let nodes = self.nodes.iter();
        nodes
            .flat_map(|node| &state.displacements[6 * node..6 * node + 6])
            .copied()
            .collect()
    }
}

impl Loaded {
    /// Patterns of several, as (which of `parts`, pattern); None where one does not exist.
    pub fn choose(parts: &[&Self], places: &[(usize, usize)]) -> Option<Self> {
        let chosen = places.iter();
        let patterns = chosen.map(|&(part, at)| parts.get(part)?.patterns.get(at).cloned());
        let patterns = patterns.collect::<Option<_>>()?;
        Some(Self { patterns })
    }

    /// How many patterns there are.
    pub fn len(&self) -> usize {
        self.patterns.len()
    }

    pub fn is_empty(&self) -> bool {
        self.patterns.is_empty()
    }

    /// Outputs, `[p, o]`.
    pub fn outputs(&self) -> Vec<f64> {
        let patterns = self.patterns.iter();
        patterns
            .flat_map(|pattern| &pattern.outputs)
            .copied()
            .collect()
    }
}

/// `sums` -= `factor` times the beginning of `row`.
fn take(sums: &mut [f64], factor: f64, row: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(row) {
        *sum -= factor * value;
    }
}
