//! Gradients of condensed samples by all that they depend on, one sample a SIMD lane.
//!
//! Of g' y, with a = C' g and (H + diag(d)) l = diag(d) a:
//!
//!   by q: Y' g - (H V)' l,    by d: (l - a) v, term by term; an element's is the sum of its terms.

use pulp::{Simd, WithSimd};
use rga_simd::f64::{Lanes, Packs};

use super::Condensed;
use super::samples::{Samples, Together, add_product};

/// Gradients `[n, p + e]` of rows; gives the first row whose structure is not stable.
pub(super) struct AdjointKernel<'a> {
    pub condensed: &'a Condensed,
    pub coefficients: &'a [f64],
    pub stiffness: &'a [f64],
    /// `[n, o]`
    pub gradients: &'a [f64],
    pub results: &'a mut [f64],
}

impl WithSimd for AdjointKernel<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<usize> {
        let Condensed {
            patterns,
            elements,
            terms,
            outputs,
            ..
        } = *self.condensed;
        let width = patterns + elements;
        let both = [&self.condensed.loaded[..], &self.condensed.influence[..]].concat();
        let both = transposed(&both, outputs);
        let driven = transposed(&self.condensed.driven, terms);
        let lanes: Together<S> = Packs(simd);
        let zero = lanes.splat(0.0);
        let mut samples = Samples::new(lanes, self.condensed);
        let mut gradients = vec![zero; outputs];
        let mut found = vec![zero; patterns + terms];
        let mut of_elements = vec![zero; width];
        let mut adjoint = vec![zero; terms];
        let many = Together::<S>::COUNT;
        let rows = self.results.len() / width;
        for from in (0..rows).step_by(many) {
            let present = many.min(rows - from);
            samples.load(self.coefficients, self.stiffness, from, present);
            if let Some(lane) = samples.solve(present) {
                return Some(from + lane);
            }
            lanes.gather(&mut gradients, self.gradients, from, present);
            found.fill(zero);
            add_product(lanes, &gradients, &both, &mut found);
            let (by_loads, a) = found.split_at_mut(patterns);
            // Minus l, from minus the right-hand side.
            adjoint.fill(zero);
            for ((own, d), a) in adjoint.iter_mut().zip(&samples.changes).zip(&*a) {
                *own = lanes.take_product(*d, *a, *own);
            }
            samples.substitute(&mut adjoint);
            add_product(lanes, &adjoint, &driven, by_loads);
            of_elements.fill(zero);
            let parts = a.iter().zip(&adjoint).zip(&samples.elongations);
            for (((a, own), v), element) in parts.zip(&self.condensed.element) {
                let sum = &mut of_elements[patterns + element];
                *sum = lanes.take_product(lanes.add(*own, *a), *v, *sum);
            }
            of_elements[..patterns].copy_from_slice(by_loads);
            lanes.scatter(
                &of_elements,
                &mut self.results[from * width..],
                width,
                present,
            );
        }
        None
    }
}

fn transposed(matrix: &[f64], width: usize) -> Vec<f64> {
    let rows = matrix.len().checked_div(width).unwrap_or(0);
    let places = (0..width).flat_map(|column| (0..rows).map(move |row| row * width + column));
    places.map(|place| matrix[place]).collect()
}
