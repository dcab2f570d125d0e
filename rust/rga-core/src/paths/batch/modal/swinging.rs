//! What all samples of a structure that swings share: places of the numbers of K - s M, what is
//! summed there, and the vectors with which each begins.
//!
//! M is one more weight in that sum, -s, and so is what stands for motions that are left out.
//! Unknowns are in the order of elimination.

use super::block::BESIDE;
use crate::paths::batch::bilinear::{Bilinear, Entry, merged};
use crate::paths::batch::elimination::Elimination;
use crate::paths::batch::panels::Panels;
use crate::paths::batch::probe::stiffness;
use crate::paths::batch::system::{MOST, Weights};
use crate::paths::modes::motion::Motion;
use crate::sparse::lanczos::RitzPairs;
use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::ordering::inverse;

/// Modes beyond those that are wanted among which the widest gap is looked for: there modes are
/// counted.
const GAPS: usize = 3;
/// Vectors beyond the last mode that is counted: the more, the fewer steps are taken.
const BEYOND: usize = 4;

/// K and M of unknowns, and vectors near the lowest modes.
pub(super) struct Pencil {
    pub weights: Weights,
    /// K, at least its lower triangle.
    pub stiffness: Vec<Entry>,
    /// Entries of K are those of elements, so that energies are summed element by element.
    pub by_elements: bool,
    pub mass: LowerTriangle,
    /// Eigenvalues of K^-1 M, the largest first, and vectors, where no weight differs from one.
    pub values: Vec<f64>,
    pub starts: Vec<Vec<f64>>,
    /// Nothing where there are no other motions.
    pub outside: Option<Outside>,
}

/// What couples the unknowns with all other motions (`reduced`).
pub(super) struct Outside {
    /// S
    pub matrix: LowerTriangle,
    /// No eigenvalue of the other motions is below it.
    pub first: f64,
}

pub(super) struct Swinging {
    pub weights: Weights,
    pub panels: Panels,
    /// K, both triangles, without M; nothing where that is no sum over elements.
    pub stiffness: Option<Bilinear>,
    pub mass: SymmetricRows,
    /// S, and the least eigenvalue of the other motions.
    pub outside: Option<(SymmetricRows, f64)>,
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
    width(count + GAPS) + 1
}

/// Vectors with which samples begin that ask for so many modes; nothing where too few are known.
pub(super) fn start_width(known: &RitzPairs, count: usize) -> Option<usize> {
    widest_gap(&known.values[..known.converged], count).map(width)
}

/// In whole groups.
fn width(kept: usize) -> usize {
    (kept + BEYOND).next_multiple_of(BESIDE)
}

/// The pencil of a whole structure; nothing where something turns freely in it.
pub(super) fn whole(motion: &Motion, known: &RitzPairs) -> Option<Pencil> {
    let (model, reduction) = (&motion.model, &motion.reduction);
    let weights = Weights {
        members: model.members.len(),
        elements: model.members.len() + model.springs.len(),
        inverses: false,
    };
    motion.turns_nowhere_freely().then(|| Pencil {
        stiffness: merged(stiffness(model, reduction, &weights)),
        by_elements: true,
        mass: motion.mass().clone(),
        values: known.values[..known.converged].to_vec(),
        starts: known.vectors.clone(),
        outside: None,
        weights,
    })
}

impl Swinging {
    /// Nothing where there are too many unknowns, or too few.
    pub(super) fn new(pencil: Pencil, count: usize) -> Option<Self> {
        let Pencil {
            weights,
            stiffness,
            by_elements,
            mass,
            values,
            starts,
            outside,
        } = pencil;
        let (kept, size) = (widest_gap(&values, count)?, mass.size());
        let width = width(kept);
        if width > values.len() || width >= size {
            return None;
        }
        let others = [Some(&mass), outside.as_ref().map(|outside| &outside.matrix)];
        let others = others.into_iter().flatten();
        let matrix = LowerTriangle::sum(size, |add| {
            let lower = stiffness.iter().filter(|entry| entry.row >= entry.column);
            lower.for_each(|entry| add(entry.row, entry.column, entry.value));
            for other in others.clone() {
                for_each(other, |row, column, _| add(row, column, 0.0));
            }
        });
        let elimination = Elimination::new(&matrix, MOST)?;
        let place = inverse(&elimination.order);
        let moved = |entry: &Entry| Entry {
            row: place[entry.row],
            column: place[entry.column],
            ..*entry
        };
        let own: Vec<Entry> = stiffness.iter().map(moved).collect();
        let lower = stiffness.iter().filter(|entry| entry.row >= entry.column);
        let mut all: Vec<Entry> = lower.map(moved).collect();
        for (other, weight) in others.zip(shifted(&weights)..) {
            for_each(other, |row, column, value| {
                all.push(Entry {
                    weight,
                    row: place[row],
                    column: place[column],
                    value,
                });
            });
        }
        for entry in &mut all {
            let places = [entry.row, entry.column];
            (entry.row, entry.column) = (places[0].max(places[1]), places[0].min(places[1]));
        }
        let mut start = vec![0.0; width * size];
        for (vector, motion) in starts[..width].iter().enumerate() {
            let (group, beside) = (vector / BESIDE, vector % BESIDE);
            for (unknown, force) in mass.product(motion).into_iter().enumerate() {
                start[(group * size + place[unknown]) * BESIDE + beside] = force;
            }
        }
        Some(Self {
            panels: Panels::new(&elimination, &all),
            stiffness: by_elements.then(|| Bilinear::new(own, weights.elements + 1)),
            mass: SymmetricRows::new(&mass, &place),
            outside: outside.map(|outside| {
                let rows = SymmetricRows::new(&outside.matrix, &place);
                (rows, outside.first)
            }),
            weights,
            place,
            start,
            width,
            kept,
        })
    }

    /// Number of weights.
    pub(super) fn weight_count(&self) -> usize {
        self.shifted() + 2
    }

    /// The weight of M; that of S is behind it.
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
fn widest_gap(values: &[f64], count: usize) -> Option<usize> {
    let last = (values.len().checked_sub(1)?).min(count + GAPS);
    let ratio = |at: usize| values[at - 1] / values[at];
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
