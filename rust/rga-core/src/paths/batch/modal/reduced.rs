//! Samples of which few stiffnesses vary, in a space of few vectors.
//!
//! The space V holds the lowest modes of the structure as it is, and (K0^-1 M)^j K0^-1 B for j of 0,
//! 1 and 2, with the forces B by which the elements that vary resist: K = K0 + B d B'. Its vectors
//! are K0-orthogonal, and M is a diagonal between them.
//!
//! What lies outside is W, K0-orthogonal to V. As K0^-1 B lies in V, B' W = 0: no stiffness that
//! varies acts there or between the two, and of M no eigenvalue there is below that of the first
//! mode left out, n. So a sample is that of the space but for E = M between V and W, with
//! S = E' (W' K0 W)^-1 E: what the residual of a mode of the space lacks outside is l^2 y' S y,
//! exactly, and the whole has no more modes below s than K - s M - s^2 / (1 - s / n) S has in the
//! space (Haynsworth, Determination of the inertia of a partitioned Hermitian matrix, Linear Algebra
//! and its Applications 1, 1968), and no fewer than K - s M has there.

use nalgebra::{DMatrix, DVector};

use super::swinging::{Outside, Pencil};
use crate::error::Result;
use crate::fe::model::Model;
use crate::paths::batch::bilinear::{Entry, merged};
use crate::paths::batch::probe::stiffness;
use crate::paths::batch::system::Weights;
use crate::paths::modes::motion::Motion;
use crate::sparse::lanczos::{Pencil as _, RitzPairs};
use crate::sparse::lower_triangle::LowerTriangle;

/// Powers of K0^-1 M that are taken. With one more mode errors fall less than with one more power.
const POWERS: usize = 3;
/// Terms of rank one beyond which the space is no cheaper than the whole.
const TERMS: usize = 32;
/// Part of a stiffness that is rounding.
const ROUNDING: f64 = 1e-12;
/// A vector that orthogonalisation leaves less of lies in the space.
const DEPENDENT: f64 = 1e-9;

/// The pencil of the space, and its vectors; nothing where it would not be small. The space holds
/// so many of the modes that are known, and there is one behind them.
pub(super) fn reduced(
    motion: &Motion,
    known: &RitzPairs,
    modes: usize,
    varied: &[usize],
) -> Result<Option<(Pencil, Vec<Vec<f64>>)>> {
    let own = forces(motion, varied);
    let size = motion.size();
    if known.converged <= modes || own.len() > TERMS || 2 * (modes + POWERS * own.len()) > size {
        return Ok(None);
    }
    let mut space = Space::new(&known.vectors[..modes], motion);
    let mut block = own;
    for _ in 0..POWERS {
        let mut solved = block.concat();
        motion.solve(&mut solved)?;
        let vectors = solved.chunks_exact(size).map(<[f64]>::to_vec);
        block = vectors
            .map(|vector| {
                let heavy = motion.mass_times(&vector);
                space.add(vector, motion);
                heavy
            })
            .collect();
    }
    let heavy: Vec<Vec<f64>> = (space.vectors.iter())
        .map(|vector| motion.mass_times(vector))
        .collect();
    let (vectors, heavy) = (columns(&space.vectors), columns(&heavy));
    let eigen = (vectors.transpose() * &heavy).symmetric_eigen();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&one, &other| eigen.eigenvalues[other].total_cmp(&eigen.eigenvalues[one]));
    let turn = DMatrix::from_fn(order.len(), order.len(), |row, column| {
        eigen.eigenvectors[(row, order[column])]
    });
    let (vectors, heavy) = (vectors * &turn, heavy * &turn);
    let stiff = columns(&space.stiff) * &turn;
    let masses = DVector::from_fn(order.len(), |at, _| eigen.eigenvalues[order[at]]);
    // What K0^-1 M makes of the vectors, without what lies in the space.
    let mut solved = heavy.as_slice().to_vec();
    motion.solve(&mut solved)?;
    let mut left = DMatrix::from_vec(size, order.len(), solved);
    for _ in 0..2 {
        let shares = stiff.transpose() * &left;
        left -= &vectors * &shares;
    }
    let resisted = (left.column_iter()).map(|one| motion.stiffness_times(one.as_slice()));
    let outside = left.transpose() * columns(&resisted.collect::<Vec<_>>());
    let pencil = Pencil {
        stiffness: stiffness_within(motion, varied, &vectors),
        by_elements: false,
        values: masses.as_slice().to_vec(),
        mass: LowerTriangle::sum(order.len(), |add| {
            (0..order.len()).for_each(|at| add(at, at, masses[at]));
        }),
        weights: weights(varied.len()),
        starts: (0..order.len())
            .map(|at| (0..order.len()).map(|row| f64::from(row == at)).collect())
            .collect(),
        outside: Some(Outside {
            matrix: LowerTriangle::sum(order.len(), |add| {
                for column in 0..order.len() {
                    (column..order.len()).for_each(|row| add(row, column, outside[(row, column)]));
                }
            }),
            first: 1.0 / known.values[modes],
        }),
    };
    let vectors = vectors.column_iter().map(|one| one.as_slice().to_vec());
    Ok(Some((pencil, vectors.collect())))
}

fn weights(varied: usize) -> Weights {
    Weights {
        members: varied,
        elements: varied,
        inverses: false,
    }
}

fn columns(vectors: &[Vec<f64>]) -> DMatrix<f64> {
    let size = vectors.first().map_or(0, Vec::len);
    DMatrix::from_fn(size, vectors.len(), |row, column| vectors[column][row])
}

/// Of elements by themselves, in the order of `varied`: entries of their stiffness.
fn elements(motion: &Motion, varied: &[usize]) -> Vec<Vec<Entry>> {
    let Model {
        members, springs, ..
    } = &motion.model;
    let all = Weights {
        members: members.len(),
        elements: members.len() + springs.len(),
        inverses: false,
    };
    let mut own = vec![Vec::new(); all.elements + 1];
    for entry in merged(stiffness(&motion.model, &motion.reduction, &all)) {
        own[entry.weight].push(entry);
    }
    varied
        .iter()
        .map(|&at| std::mem::take(&mut own[at]))
        .collect()
}

/// Forces with which each element that varies resists its deformations.
fn forces(motion: &Motion, varied: &[usize]) -> Vec<Vec<f64>> {
    let mut forces = Vec::new();
    for entries in elements(motion, varied) {
        let mut places: Vec<usize> = entries.iter().map(|entry| entry.row).collect();
        places.sort_unstable();
        places.dedup();
        let place = |unknown: usize| places.partition_point(|&other| other < unknown);
        let mut dense = DMatrix::zeros(places.len(), places.len());
        for entry in &entries {
            dense[(place(entry.row), place(entry.column))] = entry.value;
        }
        if places.is_empty() {
            continue;
        }
        let eigen = dense.symmetric_eigen();
        let least = ROUNDING * eigen.eigenvalues.max();
        let pairs = eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter());
        for (_, direction) in pairs.filter(|(value, _)| **value > least) {
            let mut force = vec![0.0; motion.size()];
            for (&unknown, part) in places.iter().zip(&direction) {
                force[unknown] = *part;
            }
            forces.push(force);
        }
    }
    forces
}

/// K within the space: what does not vary has the weight one.
fn stiffness_within(motion: &Motion, varied: &[usize], vectors: &DMatrix<f64>) -> Vec<Entry> {
    let size = vectors.ncols();
    let mut rest = DMatrix::<f64>::identity(size, size);
    let mut entries = Vec::new();
    let mut add = |weight: usize, matrix: &DMatrix<f64>| {
        for column in 0..size {
            for row in column..size {
                entries.push(Entry {
                    weight,
                    row,
                    column,
                    value: matrix[(row, column)],
                });
            }
        }
    };
    for (weight, own) in elements(motion, varied).into_iter().enumerate() {
        let mut within = DMatrix::zeros(size, size);
        let rows = own.chunk_by(|one, other| one.row == other.row);
        for row in rows {
            let mut sums = DMatrix::zeros(1, size);
            for entry in row {
                sums += vectors.row(entry.column) * entry.value;
            }
            within += vectors.row(row[0].row).transpose() * sums;
        }
        rest -= &within;
        add(weight, &within);
    }
    add(weights(varied.len()).one(), &rest);
    entries
}

/// Vectors that K0 makes orthogonal and long as one.
struct Space {
    vectors: Vec<Vec<f64>>,
    stiff: Vec<Vec<f64>>,
}

impl Space {
    /// Of modes, which are so.
    fn new(modes: &[Vec<f64>], motion: &Motion) -> Self {
        Self {
            vectors: modes.to_vec(),
            stiff: modes
                .iter()
                .map(|mode| motion.stiffness_times(mode))
                .collect(),
        }
    }

    fn add(&mut self, mut vector: Vec<f64>, motion: &Motion) {
        let square = |vector: &[f64], stiff: &[f64]| -> f64 {
            vector
                .iter()
                .zip(stiff)
                .map(|(one, other)| one * other)
                .sum()
        };
        let mut stiff = motion.stiffness_times(&vector);
        let before = square(&vector, &stiff).sqrt();
        for _ in 0..2 {
            for (other, other_stiff) in self.vectors.iter().zip(&self.stiff) {
                let share = square(other_stiff, &vector);
                let pairs = vector.iter_mut().zip(other);
                pairs.for_each(|(value, part)| *value -= share * part);
            }
        }
        // Anew: what is left of both would have lost digits, each its own.
        stiff.copy_from_slice(&motion.stiffness_times(&vector));
        let length = square(&vector, &stiff).max(0.0).sqrt();
        if length > DEPENDENT * before {
            vector.iter_mut().for_each(|value| *value /= length);
            stiff.iter_mut().for_each(|value| *value /= length);
            self.vectors.push(vector);
            self.stiff.push(stiff);
        }
    }
}
