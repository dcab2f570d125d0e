//! As many condensed samples as there are lanes, solved together.

use rga_simd::f64::{Lanes, Packs};

use super::Condensed;

/// A pivot below this part of its diagonal has no digits left.
const SINGULAR: f64 = 1e-12;

/// Lanes of two vectors: their sums do not wait for each other.
pub(super) type Together<S> = Packs<S, 2>;

pub(super) struct Samples<'a, L: Lanes> {
    lanes: L,
    condensed: &'a Condensed,
    /// `[p]` q
    pub coefficients: Vec<L::Numbers>,
    /// `[e]` k + d
    stiffness: Vec<L::Numbers>,
    /// `[r]` d
    pub changes: Vec<L::Numbers>,
    /// Lower triangle of H + diag(d) column by column; then L of L D L', with 1 / D on its
    /// diagonal.
    factor: Vec<L::Numbers>,
    /// `[r]` v
    pub elongations: Vec<L::Numbers>,
    /// `[r]` minus w
    pub pseudo: Vec<L::Numbers>,
}

impl<'a, L: Lanes> Samples<'a, L> {
    #[inline(always)]
    pub(super) fn new(lanes: L, condensed: &'a Condensed) -> Self {
        let zero = lanes.splat(0.0);
        let Condensed {
            patterns,
            elements,
            terms,
            ..
        } = *condensed;
        Self {
            lanes,
            condensed,
            coefficients: vec![zero; patterns],
            stiffness: vec![zero; elements],
            changes: vec![zero; terms],
            factor: vec![zero; terms * (terms + 1) / 2],
            elongations: vec![zero; terms],
            pseudo: vec![zero; terms],
        }
    }

    /// Lanes behind the last row hold the last row again.
    #[inline(always)]
    pub(super) fn load(
        &mut self,
        coefficients: &[f64],
        stiffness: &[f64],
        from: usize,
        count: usize,
    ) {
        self.lanes
            .gather(&mut self.coefficients, coefficients, from, count);
        self.lanes
            .gather(&mut self.stiffness, stiffness, from, count);
        let Condensed { element, first, .. } = self.condensed;
        for ((change, element), first) in self.changes.iter_mut().zip(element).zip(first) {
            let before = self.lanes.splat(*first);
            *change = self.lanes.sub(self.stiffness[*element], before);
        }
    }

    /// Factorises H + diag(d) and finds v and w; gives the first lane that is not stable.
    #[inline(always)]
    pub(super) fn solve(&mut self, count: usize) -> Option<usize> {
        let lanes = self.lanes;
        if let Some(lane) = self.factorise(count) {
            return Some(lane);
        }
        let mut elongations = std::mem::take(&mut self.elongations);
        elongations.fill(lanes.splat(0.0));
        add_product(
            lanes,
            &self.coefficients,
            &self.condensed.driven,
            &mut elongations,
        );
        self.substitute(&mut elongations);
        for ((w, v), d) in self.pseudo.iter_mut().zip(&elongations).zip(&self.changes) {
            *w = lanes.take_product(*d, *v, lanes.splat(0.0));
        }
        self.elongations = elongations;
        None
    }

    /// Right-looking: the updates of a column do not wait for each other.
    #[inline(always)]
    fn factorise(&mut self, count: usize) -> Option<usize> {
        let lanes = self.lanes;
        let (terms, stiffness) = (self.condensed.terms, &self.condensed.stiffness);
        let mut rest = &mut self.factor[..];
        for column in 0..terms {
            let (own, behind) = rest.split_at_mut(terms - column);
            let given = &stiffness[column * terms + column..(column + 1) * terms];
            for (entry, value) in own.iter_mut().zip(given) {
                *entry = lanes.splat(*value);
            }
            own[0] = lanes.add(own[0], self.changes[column]);
            rest = behind;
        }
        let mut rest = &mut self.factor[..];
        for column in 0..terms {
            let (own, mut behind) = rest.split_at_mut(terms - column);
            let least = SINGULAR * stiffness[column * terms + column];
            let strong = lanes.above(own[0], lanes.splat(least));
            if !lanes.all(strong) {
                // Lanes behind the last row repeat it.
                let pivots = L::flat(&own[..1]).iter();
                let lane = pivots.take_while(|pivot| **pivot > least).count();
                return Some(lane.min(count - 1));
            }
            let inverse = lanes.div(lanes.splat(1.0), own[0]);
            own[0] = inverse;
            for row in 1..own.len() {
                let scaled = lanes.mul(own[row], inverse);
                let (other, further) = behind.split_at_mut(terms - column - row);
                for (entry, before) in other.iter_mut().zip(&own[row..]) {
                    *entry = lanes.take_product(scaled, *before, *entry);
                }
                behind = further;
            }
            for entry in &mut own[1..] {
                *entry = lanes.mul(*entry, inverse);
            }
            rest = &mut rest[terms - column..];
        }
        None
    }

    /// Solves (H + diag(d)) x = right in place.
    #[inline(always)]
    pub(super) fn substitute(&self, right: &mut [L::Numbers]) {
        let lanes = self.lanes;
        let terms = right.len();
        let mut rest = &self.factor[..];
        for column in 0..terms {
            let (own, behind) = rest.split_at(terms - column);
            let (known, below) = right[column..].split_at_mut(1);
            for (value, factor) in below.iter_mut().zip(&own[1..]) {
                *value = lanes.take_product(*factor, known[0], *value);
            }
            known[0] = lanes.mul(known[0], own[0]);
            rest = behind;
        }
        let mut end = self.factor.len();
        for column in (0..terms).rev() {
            let own = &self.factor[end - (terms - column)..end];
            let (known, below) = right[column..].split_at_mut(1);
            for (value, factor) in below.iter().zip(&own[1..]) {
                known[0] = lanes.take_product(*factor, *value, known[0]);
            }
            end -= terms - column;
        }
    }
}

/// `sums` `[n]` += `factors` `[k]` times `matrix` `[k, n]`, for each lane.
#[inline(always)]
pub(super) fn add_product<L: Lanes>(
    lanes: L,
    factors: &[L::Numbers],
    matrix: &[f64],
    sums: &mut [L::Numbers],
) {
    const BAND: usize = 4;
    let width = sums.len();
    let mut bands = sums.chunks_exact_mut(BAND);
    let mut first = 0;
    for band in &mut bands {
        let mut own = [band[0], band[1], band[2], band[3]];
        for (factor, row) in factors.iter().zip(matrix.chunks_exact(width)) {
            let row = &row[first..first + BAND];
            for (sum, value) in own.iter_mut().zip(row) {
                *sum = lanes.mul_add(*factor, lanes.splat(*value), *sum);
            }
        }
        band.copy_from_slice(&own);
        first += BAND;
    }
    for (place, sum) in bands.into_remainder().iter_mut().enumerate() {
        for (factor, row) in factors.iter().zip(matrix.chunks_exact(width)) {
            let value = lanes.splat(row[first + place]);
            *sum = lanes.mul_add(*factor, value, *sum);
        }
    }
}
