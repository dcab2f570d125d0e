//! Derivatives of condensed samples along directions, one sample a SIMD lane.
//!
//!   (H + diag(d)) dv = H V dq - diag(dd) v,    dy = Y dq - C (d dv + dd v)

use pulp::{Simd, WithSimd};
use rga_simd::f64::{Lanes, Packs};

use super::Condensed;
use super::samples::{Samples, Together, add_product};
use crate::paths::directions::Directions;

/// Derivatives `[n, c, o]` of rows; gives the first row whose structure is not stable.
pub(super) struct SensitivityKernel<'a> {
    pub condensed: &'a Condensed,
    pub directions: &'a Directions,
    pub coefficients: &'a [f64],
    pub stiffness: &'a [f64],
    pub coefficient_rates: &'a [f64],
    pub stiffness_rates: &'a [f64],
    pub results: &'a mut [f64],
}

/// What one direction changes, as places among all rates, and the rows of Y and H V for it.
struct Direction {
    loads: Vec<usize>,
    /// (place among the rates, term)
    changes: Vec<(usize, usize)>,
    driven: Vec<f64>,
    /// Of the loads, then C of all terms.
    shown: Vec<f64>,
}

impl Direction {
    fn new(number: usize, directions: &Directions, condensed: &Condensed) -> Self {
        let Condensed { terms, outputs, .. } = *condensed;
        let own = |entries: &[(usize, usize)]| -> Vec<(usize, usize)> {
            let places = entries
                .iter()
                .enumerate()
                .filter(|(_, entry)| entry.0 == number);
            places.map(|(place, entry)| (place, entry.1)).collect()
        };
        let loads = own(&directions.loads);
        let rows = |matrix: &[f64], width: usize| -> Vec<f64> {
            let rows = loads
                .iter()
                .map(|(_, pattern)| &matrix[pattern * width..][..width]);
            rows.flatten().copied().collect()
        };
        let mut shown = rows(&condensed.loaded, outputs);
        shown.extend_from_slice(&condensed.influence);
        Self {
            driven: rows(&condensed.driven, terms),
            shown,
            loads: loads.iter().map(|(place, _)| *place).collect(),
            changes: own(&directions.changes)
                .into_iter()
                .flat_map(|(place, element)| {
                    let terms = condensed.element.iter().enumerate();
                    let own = terms.filter(move |(_, of)| **of == element);
                    own.map(move |(term, _)| (place, term))
                })
                .collect(),
        }
    }
}

impl WithSimd for SensitivityKernel<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Option<usize> {
        let Condensed { terms, outputs, .. } = *self.condensed;
        let directions: Vec<Direction> = (0..self.directions.count)
            .map(|number| Direction::new(number, self.directions, self.condensed))
            .collect();
        let width = outputs * directions.len();
        let many = Together::<S>::COUNT;
        let rows = self.results.len() / width;
        let lanes: Together<S> = Packs(simd);
        let zero = lanes.splat(0.0);
        let mut samples = Samples::new(lanes, self.condensed);
        let mut load_rates = vec![zero; self.directions.loads.len()];
        let mut change_rates = vec![zero; self.directions.changes.len()];
        let mut factors = Vec::new();
        let mut shown = vec![zero; outputs];
        for from in (0..rows).step_by(many) {
            let present = many.min(rows - from);
            samples.load(self.coefficients, self.stiffness, from, present);
            if let Some(lane) = samples.solve(present) {
                return Some(from + lane);
            }
            lanes.gather(&mut load_rates, self.coefficient_rates, from, present);
            lanes.gather(&mut change_rates, self.stiffness_rates, from, present);
            for (number, direction) in directions.iter().enumerate() {
                factors.clear();
                factors.extend(direction.loads.iter().map(|place| load_rates[*place]));
                let loads = factors.len();
                factors.resize(loads + terms, zero);
                let (of_loads, pseudo) = factors.split_at_mut(loads);
                add_product(lanes, of_loads, &direction.driven, pseudo);
                let of_changes = |pseudo: &mut [_]| {
                    for &(place, term) in &direction.changes {
                        let v = samples.elongations[term];
                        pseudo[term] = lanes.take_product(change_rates[place], v, pseudo[term]);
                    }
                };
                of_changes(pseudo);
                samples.substitute(pseudo);
                // Minus d dv, minus dd v.
                for (w, d) in pseudo.iter_mut().zip(&samples.changes) {
                    *w = lanes.take_product(*d, *w, zero);
                }
                of_changes(pseudo);
                shown.fill(zero);
                add_product(lanes, &factors, &direction.shown, &mut shown);
                let results = &mut self.results[from * width + number * outputs..];
                lanes.scatter(&shown, results, width, present);
            }
        }
        None
    }
}
