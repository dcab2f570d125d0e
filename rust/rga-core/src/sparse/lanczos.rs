//! Largest eigenvalues of K^-1 M by a block Lanczos method, orthogonal in the product of K.
//!
//! M may be singular: K^-1 M is self-adjoint in the product of K all the same, and what has no mass
//! stays out of the space (Ericsson and Ruhe, The spectral transformation Lanczos method, Math.
//! Comp. 35, 1980; Nour-Omid, Parlett, Ericsson and Jensen, How to implement the spectral
//! transformation, Math. Comp. 48, 1987). All vectors are kept orthogonal (Parlett, The Symmetric
//! Eigenvalue Problem, 1980, section 6.9).

use faer::{Mat, Side};
use pulp::{Arch, NullaryFnOnce};

use crate::error::{Error, Result};

/// Vectors that a step adds: eigenvalues of that multiplicity are found at once.
const BLOCK: usize = 4;
/// A vector that orthogonalisation leaves less of was in the space already.
const DEPENDENT: f64 = 1e-10;
/// Part of a vector by which it may be off what K^-1 makes of its image. Rounding grows from step to
/// step, by what orthogonalisation leaves.
const OFF: f64 = 1e-10;
/// Of such a vector of length one, what is left when all of it was rounding.
const ALL_ROUNDING: f64 = 0.1;
/// Vectors of the last three steps. Of a vector that keeps this part of its length as the space is
/// taken off it, what lies in the space is rounding; others have it taken off again, so often at
/// most.
const NEWEST: usize = 3 * BLOCK;
const KEPT: f64 = 0.5;
const PASSES: usize = 3;
/// Residual of an eigenvector, in the norm of K, over its eigenvalue, which errs by the square of
/// that: of a space that starts with nothing, and of one that starts with vectors near by.
const CONVERGED: f64 = 1e-11;
const CONVERGED_NEAR: f64 = 1e-6;
/// Steps between two looks at what has converged, of a space that starts with few vectors.
const LOOK: usize = 3;
/// Sums that a product is parted into, side by side in registers. Bits depend on it.
const BESIDE: usize = 8;

/// K and M as what is asked of them.
pub(crate) trait Pencil {
    fn size(&self) -> usize;
    /// Solves K x = f in place, for columns one behind the other.
    fn solve(&self, right: &mut [f64]) -> Result<()>;
    /// M x
    fn mass_times(&self, x: &[f64]) -> Vec<f64>;
}

/// A space of vectors that K makes orthogonal and long as one, with what K and M make of them.
pub(crate) struct Lanczos<'a, P: Pencil> {
    pencil: &'a P,
    arch: Arch,
    vectors: Vec<Vec<f64>>,
    stiff: Vec<Vec<f64>>,
    /// By what part vectors may be off what K^-1 makes of `stiff`.
    off: Vec<f64>,
    heavy: Vec<Vec<f64>>,
    /// V' M V, its lower triangle by rows.
    projected: Vec<Vec<f64>>,
    /// Vectors, from the first on, whose image under K^-1 M lies in the space.
    extended: usize,
    /// What the next irregular number follows from.
    drawn: u64,
    /// Nothing is left outside of the space.
    exhausted: bool,
    /// Steps until what has converged is looked at again.
    look: usize,
    converged: f64,
}

/// Eigenvalues of K^-1 M, the largest first, with vectors of length 1 in the norm of K.
pub(crate) struct RitzPairs {
    pub values: Vec<f64>,
    pub vectors: Vec<Vec<f64>>,
    /// How many, from the first on, have converged.
    pub converged: usize,
}

impl<'a, P: Pencil> Lanczos<'a, P> {
    pub(crate) fn new(pencil: &'a P) -> Self {
        Self {
            pencil,
            arch: Arch::new(),
            vectors: Vec::new(),
            stiff: Vec::new(),
            off: Vec::new(),
            heavy: Vec::new(),
            projected: Vec::new(),
            extended: 0,
            drawn: 0,
            exhausted: false,
            look: LOOK,
            converged: CONVERGED,
        }
    }

    /// A space that starts with what K^-1 M makes of vectors near the eigenvectors.
    pub(crate) fn near(pencil: &'a P, vectors: &[Vec<f64>]) -> Result<Self> {
        let mut space = Self::new(pencil);
        (space.look, space.converged) = (1, CONVERGED_NEAR);
        space.add(vectors.iter().map(|one| pencil.mass_times(one)).collect())?;
        Ok(space)
    }

    /// Grows the space until so many pairs have converged, or all that there are.
    pub(crate) fn grow(&mut self, count: usize) -> Result<RitzPairs> {
        loop {
            for _ in 0..self.look {
                if !self.exhausted {
                    self.step()?;
                }
            }
            if self.extended >= count || self.exhausted {
                let found = self.within(count)?;
                if found.converged >= count || self.exhausted {
                    return Ok(self.pairs(found));
                }
            }
        }
    }

    /// Adds irregular vectors to the space: copies of eigenvalues that it lacks come with them.
    pub(crate) fn start_anew(&mut self) -> Result<()> {
        self.look = LOOK;
        let size = self.pencil.size();
        let mut forces = Vec::with_capacity(BLOCK);
        for _ in 0..BLOCK.min(size) {
            let irregular: Vec<f64> = (0..size).map(|_| self.irregular()).collect();
            forces.push(self.pencil.mass_times(&irregular));
        }
        self.add(forces)
    }

    /// Numbers between -0.5 and 0.5, the same in every run (Steele, Lea and Flood, Fast splittable
    /// pseudorandom number generators, OOPSLA 2014).
    fn irregular(&mut self) -> f64 {
        self.drawn = self.drawn.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.drawn;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        (bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }

    /// Takes in what K^-1 M makes of the newest vectors.
    fn step(&mut self) -> Result<()> {
        let before = self.vectors.len();
        if self.extended == before {
            self.start_anew()?;
            self.exhausted = self.vectors.len() == before;
            return Ok(());
        }
        let forces = self.heavy[self.extended..].to_vec();
        self.add(forces)?;
        self.extended = before;
        Ok(())
    }

    /// Adds K^-1 of forces.
    fn add(&mut self, forces: Vec<Vec<f64>>) -> Result<()> {
        let mut solved = forces.concat();
        self.pencil.solve(&mut solved)?;
        let columns = solved.chunks_exact(self.pencil.size());
        for (vector, force) in columns.zip(forces) {
            self.add_one(vector.to_vec(), force)?;
        }
        Ok(())
    }

    fn add_one(&mut self, mut vector: Vec<f64>, mut stiff: Vec<f64>) -> Result<()> {
        let before = norm(&vector, &stiff);
        let (mut left, mut off) = self.orthogonalise(&mut vector, &mut stiff);
        if left <= DEPENDENT * before || left == 0.0 {
            return Ok(());
        }
        if off > OFF {
            // What is left of both has lost digits, each its own: they belong together again.
            stiff.iter_mut().for_each(|value| *value /= left);
            vector.copy_from_slice(&stiff);
            self.pencil.solve(&mut vector)?;
            (left, off) = self.orthogonalise(&mut vector, &mut stiff);
            if left < ALL_ROUNDING {
                return Ok(());
            }
        }
        self.off.push(off);
        vector.iter_mut().for_each(|value| *value /= left);
        stiff.iter_mut().for_each(|value| *value /= left);
        let heavy = self.pencil.mass_times(&vector);
        let mut row = self.arch.dispatch(Products {
            vectors: &self.vectors,
            with: &heavy,
        });
        row.push(dot(&vector, &heavy));
        self.projected.push(row);
        self.vectors.push(vector);
        self.stiff.push(stiff);
        self.heavy.push(heavy);
        Ok(())
    }

    /// Takes what lies in the space off a vector and its image under K, until that is no more than
    /// rounding; the norm of what is left, and by what part of it the two are off each other.
    fn orthogonalise(&self, vector: &mut [f64], stiff: &mut [f64]) -> (f64, f64) {
        let mut off = f64::EPSILON * norm(vector, stiff);
        // All that is more in what K^-1 M makes of the newest vectors is a part of these.
        let newest = self.vectors.len().saturating_sub(NEWEST);
        off += self.take_off(newest, vector, stiff);
        let mut left = norm(vector, stiff);
        for _ in 0..PASSES {
            let before = left;
            off += self.take_off(0, vector, stiff);
            left = norm(vector, stiff);
            if left > KEPT * before {
                break;
            }
        }
        (left, off / left)
    }

    /// Takes what lies in the vectors from one on off; by how much the vector and its image are off
    /// each other then.
    fn take_off(&self, from: usize, vector: &mut [f64], stiff: &mut [f64]) -> f64 {
        self.arch.dispatch(TakeOff {
            vectors: &self.vectors[from..],
            images: &self.stiff[from..],
            off: &self.off[from..],
            vector,
            stiff,
        })
    }

    /// The largest of those whose vectors K^-1 M has been applied to.
    fn within(&self, count: usize) -> Result<Within> {
        let size = self.extended;
        let projected = Mat::from_fn(size, size, |row, column| {
            self.projected[row.max(column)][row.min(column)]
        });
        let eigen = projected
            .self_adjoint_eigen(Side::Lower)
            .map_err(|_| Error::invalid("the modes do not converge; check the masses"))?;
        let mut found = Within::default();
        let mut all_so_far = true;
        for at in (0..size).rev().take(count) {
            let (value, shares) = (eigen.S()[at], eigen.U().col(at));
            let outside = self.projected[size..].iter().map(|row| {
                let products = row[..size].iter().zip(shares.iter());
                products.map(|(one, other)| one * other).sum::<f64>()
            });
            let residual = outside.map(|part| part * part).sum::<f64>().sqrt();
            all_so_far &= residual <= self.converged * value;
            found.converged += usize::from(all_so_far);
            found.values.push(value);
            found.shares.push(shares.iter().copied().collect());
        }
        Ok(found)
    }

    fn pairs(&self, found: Within) -> RitzPairs {
        let vectors = found.shares.iter().map(|shares| {
            let mut vector = vec![0.0; self.pencil.size()];
            for (share, one) in shares.iter().zip(&self.vectors) {
                subtract(&mut vector, -share, one);
            }
            vector
        });
        RitzPairs {
            vectors: vectors.collect(),
            values: found.values,
            converged: found.converged,
        }
    }
}

/// Takes vectors off one, and their images off its image, one after the other.
///
/// It runs on the best instructions of the processor; bits do not depend on them.
struct TakeOff<'a> {
    vectors: &'a [Vec<f64>],
    images: &'a [Vec<f64>],
    off: &'a [f64],
    vector: &'a mut [f64],
    stiff: &'a mut [f64],
}

impl NullaryFnOnce for TakeOff<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let mut off = 0.0;
        let others = self.vectors.iter().zip(self.images).zip(self.off);
        for ((other, image), other_off) in others {
            let share = dot(image, self.vector);
            subtract(self.vector, share, other);
            subtract(self.stiff, share, image);
            off += share.abs() * other_off;
        }
        off
    }
}

/// Products of vectors with one, on the best instructions of the processor, with the same bits.
struct Products<'a> {
    vectors: &'a [Vec<f64>],
    with: &'a [f64],
}

impl NullaryFnOnce for Products<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn call(self) -> Vec<f64> {
        let mut products = Vec::with_capacity(self.vectors.len() + 1);
        for one in self.vectors {
            products.push(dot(one, self.with));
        }
        products
    }
}

/// The same within the space, as shares of its vectors.
#[derive(Default)]
struct Within {
    values: Vec<f64>,
    shares: Vec<Vec<f64>>,
    converged: usize,
}

/// In the norm of K, of a vector and its image.
fn norm(vector: &[f64], stiff: &[f64]) -> f64 {
    dot(vector, stiff).max(0.0).sqrt()
}

#[inline(always)]
pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    let (ones, rest) = one.as_chunks::<BESIDE>();
    let (others, further) = other.as_chunks::<BESIDE>();
    let mut sums = [0.0; BESIDE];
    for (one, other) in ones.iter().zip(others) {
        for ((sum, one), other) in sums.iter_mut().zip(one).zip(other) {
            *sum += one * other;
        }
    }
    let rest: f64 = rest
        .iter()
        .zip(further)
        .map(|(one, other)| one * other)
        .sum();
    sums.iter().sum::<f64>() + rest
}

#[inline(always)]
fn subtract(from: &mut [f64], share: f64, other: &[f64]) {
    for (value, part) in from.iter_mut().zip(other) {
        *value -= share * part;
    }
}
