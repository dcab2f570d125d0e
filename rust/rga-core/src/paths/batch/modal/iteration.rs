//! The lowest modes of many samples, one a lane, from vectors near them: block inverse iteration
//! with a filter.
//!
//! A = K^-1 M is self-adjoint in the product of K, and the modes wanted are those of its largest
//! eigenvalues m. Vectors that span nearly their space are filtered by a Chebyshev polynomial in A
//! that stays small where the other modes are, and rotated within what they span (Rutishauser,
//! Simultaneous iteration method for symmetric matrices, Numer. Math. 16, 1970).
//!
//! Of x of length one, r = (A x - m x) / m in the norm of K. Where all other eigenvalues are below
//! s, the relative error of each of the k found is at most the sum of r^2 m / (m_k - s): A between
//! the found and all others is eliminated from the latter, and what that adds scales each
//! eigenvalue by that part at most (Ostrowski's theorem, Horn and Johnson, Matrix Analysis, 2013,
//! theorem 4.5.9). That no other is above s, is counted. What is given are Rayleigh quotients of
//! A x, which are nearer still: element by element, where K is a sum over these.

use rga_simd::f64::Lanes;

use super::block::{BESIDE, MassTimes, Products, Sums, product_each};
use super::projected::Projected;
use super::swinging::Swinging;
use crate::fe::stability::{DELICATE_PIVOT, SOFTEST};
use crate::paths::batch::cholesky::Cholesky;

/// Of an eigenvalue, relative: what its error is proved to be below.
const PROVED: f64 = 1e-9;
/// Gap behind the modes that are counted, relative, below which a sample is solved by itself.
const GAP: f64 = 1e-3;
/// Degree of the filter, and how often it is applied at most. A lower one is applied twice as often;
/// a higher one lets the lowest modes grow so far beyond the others that vectors become alike.
const DEGREE: usize = 4;
const ROUNDS: usize = 4;
/// Least pivot of K - s M, over the diagonal of K, whose sign is that of an exact one.
const COUNTED_PIVOT: f64 = 1e-6;

pub(super) struct Iteration<'a, L: Lanes> {
    swinging: &'a Swinging,
    cholesky: Cholesky<'a, L>,
    /// Factors of elements, one, and that of M.
    pub weights: Vec<L::Numbers>,
    /// Those found, and others beside; blocks of all vectors.
    vectors: Vec<L::Numbers>,
    forces: Vec<L::Numbers>,
    images: Vec<L::Numbers>,
    filtered: Vec<L::Numbers>,
    projected: Projected<L>,
    /// A x of those that are counted, their modal masses and eigenvalues.
    pub shapes: Vec<L::Numbers>,
    pub modal_masses: Vec<L::Numbers>,
    /// Twice their strain energies.
    energies: Vec<L::Numbers>,
    pub eigenvalues: Vec<L::Numbers>,
    /// Between the modes that are counted and the others.
    shift: L::Numbers,
    column: Vec<L::Numbers>,
    beside: Vec<L::Numbers>,
}

impl<'a, L: Lanes> Iteration<'a, L> {
    pub(super) fn new(lanes: L, swinging: &'a Swinging) -> Self {
        let zero = lanes.splat(0.0);
        let (size, width) = (swinging.size(), swinging.width);
        let groups = swinging.kept.next_multiple_of(BESIDE);
        let block = vec![zero; width * size];
        let line = vec![zero; size];
        Self {
            cholesky: Cholesky::new(lanes, &swinging.panels),
            weights: vec![zero; swinging.weight_count()],
            vectors: block.clone(),
            forces: block.clone(),
            images: block.clone(),
            filtered: block,
            projected: Projected::new(lanes, width),
            shapes: vec![zero; groups * size],
            modal_masses: vec![zero; groups],
            energies: vec![zero; groups],
            eigenvalues: vec![zero; groups],
            shift: zero,
            column: line.clone(),
            beside: line,
            swinging,
        }
    }

    /// Solves all lanes; calls `found` with itself and the bits of lanes that have come to be
    /// proved. The bits of those that are also counted.
    ///
    /// The factors of the elements stand in `weights`.
    #[inline(always)]
    pub(super) fn solve(&mut self, lanes: L, mut found: impl FnMut(&Self, u64)) -> u64 {
        let (one, mass) = (self.swinging.weights.one(), self.swinging.shifted());
        self.weights[one] = lanes.splat(1.0);
        (self.weights[mass], self.weights[mass + 1]) = (lanes.splat(0.0), lanes.splat(0.0));
        let sound = self.factorise(lanes);
        self.start(lanes);
        let all = (1 << L::COUNT) - 1;
        let mut proved = 0;
        let mut shift = lanes.splat(0.0);
        for _ in 0..ROUNDS {
            self.filter(lanes);
            self.rotate(lanes);
            let fresh = self.proved(lanes) & sound & !proved;
            found(self, fresh);
            for lane in (0..L::COUNT).filter(|lane| fresh >> lane & 1 == 1) {
                let own = L::flat(&[self.shift])[lane];
                L::flat_mut(std::slice::from_mut(&mut shift))[lane] = own;
            }
            proved |= fresh;
            if proved | (all & !sound) == all {
                break;
            }
        }
        self.weights[mass] = lanes.neg(shift);
        self.weights[mass + 1] = lanes.neg(self.outside(lanes, shift));
        let cholesky = &mut self.cholesky;
        let below = cholesky.negative_eigenvalues(lanes, &self.weights, COUNTED_PIVOT);
        let right = lanes.equal(below, lanes.splat(self.swinging.kept as f64));
        proved & lanes.bits(lanes.and(right, cholesky.sound))
    }

    /// The weight of S at a shift; no number where the other motions may have modes below it.
    #[inline(always)]
    fn outside(&self, lanes: L, shift: L::Numbers) -> L::Numbers {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let Some((_, first)) = &self.swinging.outside else {
            return zero;
        };
        let left = lanes.sub(one, lanes.div(shift, lanes.splat(*first)));
        let lowest = lanes.above(left, zero);
        let weight = lanes.div(lanes.mul(shift, shift), left);
        lanes.select(lowest, weight, lanes.splat(f64::NAN))
    }

    /// The bits of lanes whose factor may be relied on.
    #[inline(always)]
    fn factorise(&mut self, lanes: L) -> u64 {
        let zero = lanes.splat(0.0);
        self.column.fill(zero);
        let cholesky = &mut self.cholesky;
        cholesky.factorise(lanes, &self.weights, DELICATE_PIVOT, &mut self.column);
        let (mut least, mut most) = (lanes.splat(f64::INFINITY), zero);
        for stiffness in &cholesky.diagonal {
            least = lanes.min(least, *stiffness);
            most = lanes.max(most, *stiffness);
        }
        let softest = lanes.mul(lanes.splat(SOFTEST), most);
        let sound = lanes.and(cholesky.sound, lanes.at_most(softest, least));
        lanes.bits(sound)
    }

    /// What A makes of the modes that are known, rotated.
    #[inline(always)]
    fn start(&mut self, lanes: L) {
        for (place, force) in self.forces.iter_mut().zip(&self.swinging.start) {
            *place = lanes.splat(*force);
        }
        self.rotate(lanes);
    }

    /// A polynomial of A of the vectors, as forces of the last A of it.
    #[inline(always)]
    fn filter(&mut self, lanes: L) {
        let last = self.projected.values[self.swinging.width - 1];
        let two = lanes.splat(2.0);
        let scale = lanes.div(two, last);
        self.filtered.copy_from_slice(&self.vectors);
        for step in 2..=DEGREE {
            // T1 = s A x - x, and T(k + 1) = 2 (s A Tk - Tk) - T(k - 1).
            self.mass_times_filtered(lanes);
            self.images.copy_from_slice(&self.forces);
            Self::apply_inverse(
                lanes,
                &self.cholesky,
                &mut self.images,
                self.swinging.size(),
            );
            let numbers = (self.filtered.iter_mut()).zip(&mut self.vectors);
            for ((now, before), image) in numbers.zip(&self.images) {
                let next = lanes.sub(lanes.mul(scale, *image), *now);
                let next = if step == 2 {
                    next
                } else {
                    lanes.sub(lanes.mul(two, next), *before)
                };
                (*before, *now) = (*now, next);
            }
        }
        self.mass_times_filtered(lanes);
    }

    #[inline(always)]
    fn mass_times_filtered(&mut self, lanes: L) {
        lanes.vectorize(MassTimes {
            lanes,
            mass: &self.swinging.mass,
            x: &self.filtered,
            product: &mut self.forces,
        });
    }

    #[inline(always)]
    fn apply_inverse(lanes: L, cholesky: &Cholesky<L>, vectors: &mut [L::Numbers], size: usize) {
        for group in vectors.chunks_exact_mut(BESIDE * size) {
            cholesky.solve::<BESIDE>(lanes, group);
        }
    }

    /// The modes of what K^-1 of the forces spans.
    #[inline(always)]
    fn rotate(&mut self, lanes: L) {
        let size = self.swinging.size();
        self.images.copy_from_slice(&self.forces);
        Self::apply_inverse(lanes, &self.cholesky, &mut self.images, size);
        lanes.vectorize(Products {
            lanes,
            size,
            ones: &self.images,
            others: &self.forces,
            products: &mut self.projected.stiff,
        });
        lanes.vectorize(MassTimes {
            lanes,
            mass: &self.swinging.mass,
            x: &self.images,
            product: &mut self.forces,
        });
        lanes.vectorize(Products {
            lanes,
            size,
            ones: &self.images,
            others: &self.forces,
            products: &mut self.projected.heavy,
        });
        self.projected.solve(lanes);
        lanes.vectorize(Sums {
            lanes,
            size,
            others: &self.images,
            shares: &self.projected.shares,
            vectors: &mut self.vectors,
        });
    }

    /// The bits of lanes in which the residuals bound the errors.
    #[inline(always)]
    fn proved(&mut self, lanes: L) -> u64 {
        let (size, kept) = (self.swinging.size(), self.swinging.kept);
        let numbers = self.shapes.len();
        lanes.vectorize(MassTimes {
            lanes,
            mass: &self.swinging.mass,
            x: &self.vectors[..numbers],
            product: &mut self.forces[..numbers],
        });
        self.shapes.copy_from_slice(&self.forces[..numbers]);
        Self::apply_inverse(lanes, &self.cholesky, &mut self.shapes, size);
        let (vectors, forces) = (&self.vectors[..numbers], &self.forces[..numbers]);
        // x' M x = m, and (A x)' M x = m^2 (1 + r^2).
        product_each(lanes, size, vectors, forces, &mut self.eigenvalues);
        product_each(lanes, size, &self.shapes, forces, &mut self.energies);
        let (zero, one, half) = (lanes.splat(0.0), lanes.splat(1.0), lanes.splat(0.5));
        let mut residuals = zero;
        for (value, product) in self.eigenvalues[..kept].iter().zip(&self.energies) {
            let square = lanes.sub(lanes.div(*product, lanes.mul(*value, *value)), one);
            residuals = lanes.mul_add(lanes.abs(square), *value, residuals);
        }
        if let Some((coupling, _)) = &self.swinging.outside {
            lanes.vectorize(MassTimes {
                lanes,
                mass: coupling,
                x: vectors,
                product: &mut self.images[..numbers],
            });
            let images = &self.images[..numbers];
            product_each(lanes, size, vectors, images, &mut self.modal_masses);
            for (value, product) in self.eigenvalues[..kept].iter().zip(&self.modal_masses) {
                residuals = lanes.add(lanes.div(*product, *value), residuals);
            }
        }
        let (inside, outside) = (self.projected.values[kept - 1], self.projected.values[kept]);
        let between = lanes.mul(half, lanes.add(inside, outside));
        self.shift = lanes.div(one, between);
        let most = lanes.mul(lanes.splat(PROVED), lanes.sub(inside, between));
        let small = lanes.at_most(residuals, most);
        let apart = lanes.at_most(lanes.mul(lanes.splat(1.0 + GAP), outside), inside);
        let proved = lanes.and(lanes.and(small, apart), self.projected.sound);
        self.quotients(lanes, numbers);
        lanes.bits(proved)
    }

    /// Rayleigh quotients of the shapes.
    #[inline(always)]
    fn quotients(&mut self, lanes: L, numbers: usize) {
        let (size, kept) = (self.swinging.size(), self.swinging.kept);
        lanes.vectorize(MassTimes {
            lanes,
            mass: &self.swinging.mass,
            x: &self.shapes,
            product: &mut self.forces[..numbers],
        });
        let forces = &self.forces[..numbers];
        product_each(lanes, size, &self.shapes, forces, &mut self.modal_masses);
        for vector in 0..kept {
            let Some(stiffness) = &self.swinging.stiffness else {
                let (energy, mass) = (self.energies[vector], self.modal_masses[vector]);
                self.eigenvalues[vector] = lanes.div(energy, mass);
                continue;
            };
            let (group, beside) = (vector / BESIDE, vector % BESIDE);
            let group = &self.shapes[group * BESIDE * size..][..BESIDE * size];
            for (place, own) in self.column.iter_mut().zip(group.chunks_exact(BESIDE)) {
                *place = own[beside];
            }
            self.beside.fill(lanes.splat(0.0));
            stiffness.add(lanes, &self.weights, &self.column, &mut self.beside);
            let mut energy = lanes.splat(0.0);
            for (motion, force) in self.column.iter().zip(&self.beside) {
                energy = lanes.mul_add(*motion, *force, energy);
            }
            self.eigenvalues[vector] = lanes.div(energy, self.modal_masses[vector]);
        }
    }
}
