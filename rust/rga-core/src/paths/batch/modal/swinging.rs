//! What all samples of a structure that swings share: places of the numbers of K - s M, what is
//! summed there, and the vectors with which each begins.
//!
//! M is one more weight in that sum: -s. Unknowns are in the order of elimination.

use super::block::BESIDE;
use crate::fe::free_rotations::FreeRotation;
use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::paths::batch::bilinear::{Bilinear, Entry, merged};
use crate::paths::batch::elimination::Elimination;
use crate::paths::batch::panels::Panels;
use crate::paths::batch::probe::stiffness;
use crate::paths::batch::system::{MOST, Weights};
use crate::sparse::lanczos::RitzPairs;
use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::ordering::inverse;

/// Modes beyond those that are wanted among which the widest gap is looked for: there modes are
/// counted.
const GAPS: usize = 3;
/// Vectors beyond the last mode that is counted: the more, the fewer steps are taken.
const BEYOND: usize = 4;

pub(super) struct Swinging {
    pub weights: Weights,
    pub panels: Panels,
    /// K, both triangles, without M.
    pub stiffness: Bilinear,
    pub mass: SymmetricRows,
    /// The place of each unknown in the order of elimination.
    pub place: Vec<usize>,
    /// M times the vectors with which samples begin, as a block of `width` vectors.
    pub start: Vec<f64>,
    pub width: usize,
    /// Modes that are counted.
    pub kept: usize,
}

/// A symmetric matrix, both triangles, row by row.
pub(super) struct SymmetricRows {
    first: Vec<usize>,
    entries: Vec<(usize, f64)>,
}

/// Modes that must be known of a structure for samples of it.
pub(super) fn known_modes(count: usize) -> usize {
    width(count + GAPS)
}

/// In whole groups.
fn width(kept: usize) -> usize {
    (kept + BEYOND).next_multiple_of(BESIDE)
}

impl Swinging {
    /// Nothing where samples have to be solved one by one: they are too large or too small, or
    /// something turns freely.
    pub(super) fn new(
        model: &Model,
        reduction: &Reduction,
        mass: &LowerTriangle,
        known: &RitzPairs,
        count: usize,
    ) -> Option<Self> {
        let weights = Weights {
            members: model.members.len(),
            elements: model.members.len() + model.springs.len(),
            inverses: false,
        };
        let stiffness = merged(stiffness(model, reduction, &weights));
        let matrix = LowerTriangle::sum(mass.size(), |add| {
            let lower = stiffness.iter().filter(|entry| entry.row >= entry.column);
            lower.for_each(|entry| add(entry.row, entry.column, entry.value));
            for_each(mass, |row, column, _| add(row, column, 0.0));
        });
        if !FreeRotation::find(&matrix, reduction).is_empty() {
            return None;
        }
        let kept = widest_gap(known, count)?;
        let width = width(kept);
        if width > known.converged || 2 * width > mass.size() {
            return None;
        }
        let elimination = Elimination::new(&matrix, MOST)?;
        let place = inverse(&elimination.order);
        let moved = |entry: &Entry| Entry {
            row: place[entry.row],
            column: place[entry.column],
            ..*entry
        };
        let stiffness: Vec<Entry> = stiffness.iter().map(moved).collect();
        let mut all = stiffness.clone();
        for_each(mass, |row, column, value| {
            let (row, column) = (place[row], place[column]);
            all.push(Entry {
                weight: shifted(&weights),
                row: row.max(column),
                column: row.min(column),
                value,
            });
        });
        let size = mass.size();
        let mut start = vec![0.0; width * size];
        for (vector, motion) in known.vectors[..width].iter().enumerate() {
            let (group, beside) = (vector / BESIDE, vector % BESIDE);
            for (unknown, force) in mass.product(motion).into_iter().enumerate() {
                start[(group * size + place[unknown]) * BESIDE + beside] = force;
            }
        }
        Some(Self {
            panels: Panels::new(&elimination, &all),
            stiffness: Bilinear::new(stiffness, weights.elements + 1),
            mass: SymmetricRows::new(mass, &place),
            weights,
            place,
            start,
            width,
            kept,
        })
    }

    /// Number of weights.
    pub(super) fn weight_count(&self) -> usize {
        shifted(&self.weights) + 1
    }

    /// The weight of M.
    pub(super) fn shifted(&self) -> usize {
        shifted(&self.weights)
    }

    pub(super) fn size(&self) -> usize {
        self.place.len()
    }
}

fn shifted(weights: &Weights) -> usize {
    weights.one() + 1
}

fn for_each(matrix: &LowerTriangle, mut add: impl FnMut(usize, usize, f64)) {
    for column in 0..matrix.size() {
        for at in matrix.first[column]..matrix.first[column + 1] {
            if matrix.values[at] != 0.0 {
                add(matrix.rows[at], column, matrix.values[at]);
            }
        }
    }
}

/// How many modes to count, at least `count`: there is a gap behind them.
fn widest_gap(known: &RitzPairs, count: usize) -> Option<usize> {
    let last = (known.converged.checked_sub(1)?).min(count + GAPS);
    let ratio = |at: usize| known.values[at - 1] / known.values[at];
    (count.max(1)..=last).max_by(|&one, &other| ratio(one).total_cmp(&ratio(other)))
}

impl SymmetricRows {
    fn new(matrix: &LowerTriangle, place: &[usize]) -> Self {
        let mut rows = vec![Vec::new(); matrix.size()];
        for_each(matrix, |row, column, value| {
            let (row, column) = (place[row], place[column]);
            rows[row].push((column, value));
            if row != column {
                rows[column].push((row, value));
            }
        });
        let mut first = vec![0];
        let mut entries = Vec::new();
        for row in &mut rows {
            row.sort_by_key(|&(column, _)| column);
            entries.append(row);
            first.push(entries.len());
        }
        Self { first, entries }
    }

    pub(super) fn size(&self) -> usize {
        self.first.len() - 1
    }

    pub(super) fn row(&self, row: usize) -> &[(usize, f64)] {
        &self.entries[self.first[row]..self.first[row + 1]]
    }
}
