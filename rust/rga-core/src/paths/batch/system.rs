//! A structure as sums over the factors f of its members and springs:
//!
//!   K(f) z = B(f) q,    y = S(f) z + T(f) q,
//!
//! with load coefficients q, unknowns z and outputs y. The matrices are read off the elements once,
//! by probing them with unit motions and with each load pattern (`probe`).

use rga_simd::f64::Lanes;

use super::bilinear::{Bilinear, Entry, merged};
use super::elimination::Elimination;
use super::panels::Panels;
use super::probe::{Probe, stiffness};
use crate::error::Result;
use crate::fe::constraint::Constraints;
use crate::fe::free_rotations::FreeRotation;
use crate::fe::model::Model;
use crate::fe::outputs::Output;
use crate::fe::reduction::Reduction;
use crate::input::Loads;
use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::ordering::inverse;

/// Weights are the factors of members, then of springs; a one; and one over the factors of members.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weights {
    pub members: usize,
    pub elements: usize,
    /// Whether anything depends on one over a factor.
    pub inverses: bool,
}

impl Weights {
    pub(super) fn one(&self) -> usize {
        self.elements
    }

    pub(super) fn inverse(&self, member: usize) -> usize {
        self.elements + 1 + member
    }

    pub(super) fn count(&self) -> usize {
        self.elements + 1 + self.members
    }

    /// Fills in what follows from the factors.
    #[inline(always)]
    pub(super) fn complete<L: Lanes>(&self, lanes: L, weights: &mut [L::Numbers]) {
        let (factors, others) = weights.split_at_mut(self.elements);
        others[0] = lanes.splat(1.0);
        if !self.inverses {
            return;
        }
        for (inverse, factor) in others[1..].iter_mut().zip(factors) {
            *inverse = lanes.div(lanes.splat(1.0), *factor);
        }
    }
}

#[derive(Debug)]
pub(super) struct System {
    pub weights: Weights,
    /// The unknown of each place in z, in the order of elimination, and back.
    pub order: Vec<usize>,
    pub place: Vec<usize>,
    /// Where the factor of many samples together has its numbers, unless it is too large.
    pub panels: Option<Panels>,
    /// Rotations that nothing stiffens, held in K; of the unknowns in their own order.
    pub free_rotations: Vec<FreeRotation>,
    /// K, both triangles.
    pub stiffness: Bilinear,
    /// B
    pub load: Bilinear,
    /// What each pattern puts on rotations that are held because nothing stiffens them, and how
    /// many these are.
    pub on_held: Bilinear,
    pub held: usize,
    /// S
    pub shown: Bilinear,
    /// T
    pub direct: Bilinear,
    /// Of the lower triangle of K, unknowns in their own order: place among its values, weight,
    /// value.
    entries: Vec<(usize, usize, f64)>,
}

/// Numbers of a factor up to which samples are solved many at a time, one a lane. Beyond them
/// caches hold too few of the lanes.
pub(super) const MOST: usize = 1 << 17;

impl System {
    /// Together with K, of factors of one.
    pub(super) fn new(
        model: &Model,
        constraints: &Constraints,
        reduction: &Reduction,
        loads: &Loads,
        wanted: &[Output],
    ) -> Result<(Self, LowerTriangle)> {
        let mut weights = Weights {
            members: model.members.len(),
            elements: model.members.len() + model.springs.len(),
            inverses: false,
        };
        let stiffness = merged(stiffness(model, reduction, &weights));
        let size = reduction.unknowns.len();
        let lower = stiffness.iter().filter(|entry| entry.row >= entry.column);
        let matrix = LowerTriangle::sum(size, |add| {
            (lower.clone()).for_each(|entry| add(entry.row, entry.column, entry.value));
        });
        let entry = |entry: &Entry| {
            let place = matrix.place(entry.row, entry.column);
            (place, entry.weight, entry.value)
        };
        let entries = lower.map(entry).collect();
        let free_rotations = FreeRotation::find(&matrix, reduction);
        let elimination = Elimination::new(&matrix, MOST);
        let order = match &elimination {
            Some(elimination) => elimination.order.clone(),
            None => (0..size).collect(),
        };
        let place = inverse(&order);
        let rows = |entries: Vec<Entry>| with_rows(entries, &place);
        let columns = |entries: Vec<Entry>| with_columns(entries, &place);
        let stiffness = rows(columns(stiffness));
        let panels = elimination.map(|elimination| {
            let held = free_rotations
                .iter()
                .flat_map(|rotation| rotation.stiffness_on(&matrix));
            let held = held.map(|(row, column, value)| Entry {
                weight: weights.one(),
                row: place[row],
                column: place[column],
                value,
            });
            let entries: Vec<Entry> = stiffness.iter().copied().chain(held).collect();
            Panels::new(&elimination, &entries)
        });
        let probe = Probe::new(model, constraints, reduction, loads, weights)?;
        let (load, on_held) = probe.loads()?;
        let (shown, direct) = probe.outputs(wanted)?;
        weights.inverses = shown
            .iter()
            .chain(&direct)
            .any(|entry| entry.weight > weights.one());
        let form = |entries: Vec<Entry>| Bilinear::new(entries, weights.count());
        let system = Self {
            weights,
            stiffness: form(stiffness),
            load: form(rows(load)),
            on_held: form(on_held),
            held: reduction.held.len(),
            shown: form(columns(shown)),
            direct: form(direct),
            entries,
            panels,
            free_rotations,
            order,
            place,
        };
        Ok((system, matrix))
    }

    /// Values of the lower triangle of K.
    pub(super) fn fill(&self, weights: &[f64], values: &mut [f64]) {
        values.fill(0.0);
        for &(place, weight, value) in &self.entries {
            values[place] += weights[weight] * value;
        }
    }

    /// Numbers in the order of elimination, by unknown.
    pub(super) fn by_unknown(&self, values: &[f64]) -> Vec<f64> {
        self.place.iter().map(|&place| values[place]).collect()
    }
}

fn with_rows(mut entries: Vec<Entry>, place: &[usize]) -> Vec<Entry> {
    entries
        .iter_mut()
        .for_each(|entry| entry.row = place[entry.row]);
    entries
}

fn with_columns(mut entries: Vec<Entry>, place: &[usize]) -> Vec<Entry> {
    entries
        .iter_mut()
        .for_each(|entry| entry.column = place[entry.column]);
    entries
}
