//! Terms whose force is no multiple of their elongation: slack, play and stops.
//!
//! A law N(v) of a term is written as that of the linear term of the structure and a pseudo-force
//! w = N(v) - k v beside it. Condensed onto these terms, v + G w(v) = v0 is a small system with
//! corners at the ends of the play; Newton's method meets few of them (Qi and Sun, A nonsmooth
//! version of Newton's method, Math. Programming 58, 1993).
//!
//! A trace of stiffness in idle terms keeps in the middle of the play what only the play lets move
//! and no load pushes. It finds the side on which each term is; its force is then taken off again.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::error::{Error, Result};
use crate::paths::condensation::UnitResponses;

/// Newton steps before a row is given up.
const STEPS: usize = 60;
/// An elongation is found when it changes by less than this part of the largest.
const CONVERGED: f64 = 1e-12;
/// Share of its stiffness that an idle term keeps.
const TRACE: f64 = 1e-8;
/// Shares that lead to the trace where it cannot be reached at once.
const TRACES: [f64; 13] = [
    0.9, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02, 1e-2, 3e-3, 1e-3, 1e-4, 1e-6, TRACE,
];
/// How often a step is halved on the way.
const HALVED: i32 = 16;
/// Steps that take the force of the trace off again, and by how much of the largest elongation the
/// last may move.
const REFINED: usize = 2;
const HELD: f64 = 1e-3;
/// Factors that are kept: rows under much the same loads have the same terms idle.
const KEPT: usize = 64;

/// What terms carry, row by row: `[rows, terms]` each.
#[derive(Debug, Clone, Copy)]
pub struct Laws<'a> {
    /// A term carries nothing up to this elongation [m], and a play down to its negative; infinite
    /// for a term that never carries.
    pub size: &'a [f64],
    /// Beyond, not below that of the term in the structure.
    pub stiffness: &'a [f64],
    /// Of the terms alone: it carries tension alone.
    pub rod: &'a [bool],
}

/// What a term carries.
#[derive(Debug, Clone, Copy)]
struct Law {
    size: f64,
    stiffness: f64,
    rod: bool,
}

/// Where the elongation of a term is: at an end of its play, where it bears, or between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Side {
    Lower,
    Idle,
    Upper,
}

/// Pseudo-forces `[rows, terms]` beside the linear terms of a structure.
///
/// `coefficients` are those of the load patterns, `[rows, patterns]`; every term has a law.
/// `UnstableSample` where play or slack leaves a row nothing that holds it.
pub fn pseudo_forces(linear: &UnitResponses, coefficients: &[f64], laws: Laws) -> Result<Vec<f64>> {
    let (terms, patterns) = (linear.stiffness.len(), linear.patterns);
    let rows = coefficients.len() / patterns.max(1);
    let of_rows = [laws.size.len(), laws.stiffness.len()] == [rows * terms; 2];
    if !of_rows || laws.rod.len() != terms || coefficients.len() != rows * patterns {
        return Err(Error::invalid(
            "every term needs a law in every row, and every row the coefficients of all load \
             patterns",
        ));
    }
    let stretched = DMatrix::from_row_slice(patterns, terms, &linear.stretched);
    let apart = DMatrix::from_row_slice(rows, patterns, coefficients) * stretched;
    let unit = DMatrix::from_row_slice(terms, terms, &linear.unit);
    let mut found = Vec::with_capacity(rows * terms);
    let factors = Factors::default();
    let mut solved: Vec<(DVector<f64>, Place)> = Vec::with_capacity(rows);
    for (row, apart) in apart.row_iter().enumerate() {
        let beyond = &laws.stiffness[row * terms..][..terms];
        if row > 0 && *beyond != laws.stiffness[(row - 1) * terms..][..terms] {
            factors.borrow_mut().clear();
        }
        let own = |term: usize| Law {
            size: laws.size[row * terms + term],
            stiffness: beyond[term],
            rod: laws.rod[term],
        };
        let system = System {
            unit: &unit,
            stiffness: &linear.stiffness,
            laws: (0..terms).map(own).collect(),
            factors: &factors,
        };
        let apart = apart.transpose();
        let place = system
            .settled(&apart, &solved)
            .ok_or(Error::UnstableSample { row })?;
        found.extend(system.pseudo(&place.elongation, &place.sides, 0.0).iter());
        solved.push((apart, place));
    }
    Ok(found)
}

/// The factored system of the `Steep` terms for each set of idle terms and each trace; it holds as
/// long as rows have terms of the same stiffness.
type Factors = RefCell<HashMap<(Vec<bool>, u64), Rc<Steep>>>;

/// Terms whose pseudo-force grows with their elongation: they are a system of their own.
struct Steep {
    terms: Vec<usize>,
    /// By how much it grows.
    slopes: Vec<f64>,
    factor: LU<f64, Dyn, Dyn>,
}

/// The compatibility of one row's elongations.
struct System<'a> {
    unit: &'a DMatrix<f64>,
    /// Of the terms in the structure.
    stiffness: &'a [f64],
    laws: Vec<Law>,
    factors: &'a Factors,
}

/// Elongations with the side that each is on.
#[derive(Clone)]
struct Place {
    elongation: DVector<f64>,
    sides: Vec<Side>,
}

/// The elongations of the row that is nearest by what they would be without laws.
fn nearest<'a>(apart: &DVector<f64>, solved: &'a [(DVector<f64>, Place)]) -> Option<&'a Place> {
    let distance = |(other, _): &&(DVector<f64>, Place)| (apart - other).norm_squared();
    let by_distance = |one: &&(DVector<f64>, Place), other: &&(DVector<f64>, Place)| {
        distance(one).total_cmp(&distance(other))
    };
    solved.iter().min_by(by_distance).map(|(_, place)| place)
}

impl System<'_> {
    /// Elongations of a row, which would be `apart` were all terms linear.
    ///
    /// `solved` are other rows, by what their elongations would be.
    fn settled(&self, apart: &DVector<f64>, solved: &[(DVector<f64>, Place)]) -> Option<Place> {
        // All terms bear at first, each on the side that it would take without its law.
        let bearing = DVector::from_fn(apart.len(), |term, _| {
            let sign = f64::from(apart[term] > 0.0) - f64::from(apart[term] < 0.0);
            match self.laws[term].size {
                size if size.is_finite() => sign * size * self.stiffness[term],
                _ => 0.0,
            }
        });
        let start = self.at(apart + self.unit.tr_mul(&bearing), TRACE);
        let mut place = start.clone();
        let mut met = self.newton(&mut place, apart, TRACE, false)?;
        if !met && let Some(near) = nearest(apart, solved) {
            // Many idle terms and little load: Newton's method goes round in circles. It seldom
            // does from the sides of a row whose loads are much the same.
            place = self.at(near.elongation.clone(), TRACE);
            met = self.newton(&mut place, apart, TRACE, false) == Some(true);
        }
        if !met {
            // It is led from terms that keep much of their stiffness to those that keep a trace.
            place = start;
            for trace in TRACES {
                met = self.newton(&mut place, apart, trace, true)?;
            }
            // Rounding keeps what only the trace holds from standing still; its sides stay.
            met = met || self.newton(&mut place, apart, TRACE, false)?;
        }
        if !met {
            return None;
        }
        // From the sides alone: on whatever way they were found, the bits are the same.
        place.elongation = apart.clone();
        place.elongation = self.moved(&place, apart, TRACE)?;
        let mut moved = 0.0;
        for _ in 0..REFINED {
            let next = self.moved(&place, apart, 0.0)?;
            moved = (&next - &place.elongation).amax();
            place.elongation = next;
        }
        // What only the trace holds moves on as far with every step. Under next to no load that is
        // within the play, where all places are as good.
        let sizes = self.laws.iter().map(|law| law.size.abs());
        let play = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        (moved <= (HELD * place.elongation.amax()).max(play)).then_some(place)
    }

    /// Newton steps, in place; whether they come to an end. None where nothing holds the terms.
    fn newton(
        &self,
        place: &mut Place,
        apart: &DVector<f64>,
        trace: f64,
        damped: bool,
    ) -> Option<bool> {
        let mut seen = HashSet::new();
        for _ in 0..STEPS {
            // A step depends on the sides alone: from sides that were left before it goes round.
            if !damped && !seen.insert(place.sides.clone()) {
                return Some(false);
            }
            let mut next = self.at(self.moved(place, apart, trace)?, trace);
            if damped {
                next = self.shortened(place, &next, apart, trace);
            }
            // Between corners all is straight, and a step that meets none is exact.
            let straight = !damped && next.sides == place.sides;
            let moved = (&next.elongation - &place.elongation).amax();
            let still = moved <= CONVERGED * next.elongation.amax();
            *place = next;
            if straight || still {
                return Some(true);
            }
        }
        Some(false)
    }

    /// One Newton step, the terms staying on their sides.
    fn moved(&self, place: &Place, apart: &DVector<f64>, trace: f64) -> Option<DVector<f64>> {
        let missed = self.missed(place, apart, trace);
        let steep = self.steep(place, trace.max(TRACE));
        let mut next = &place.elongation - &missed;
        if steep.terms.is_empty() {
            return Some(next);
        }
        let own = DVector::from_fn(steep.terms.len(), |row, _| missed[steep.terms[row]]);
        let own = steep.factor.solve(&own)?;
        for ((&term, slope), own) in steep.terms.iter().zip(&steep.slopes).zip(&own) {
            next.axpy(slope * own, &self.unit.column(term), 1.0);
        }
        for (&term, own) in steep.terms.iter().zip(&own) {
            next[term] = place.elongation[term] - own;
        }
        Some(next)
    }

    /// The terms that the others follow, the idle ones with a trace of stiffness.
    fn steep(&self, place: &Place, trace: f64) -> Rc<Steep> {
        let idle: Vec<bool> = place.sides.iter().map(|side| *side == Side::Idle).collect();
        let key = (idle, trace.to_bits());
        if let Some(known) = self.factors.borrow().get(&key) {
            return Rc::clone(known);
        }
        let slope = |term: usize| match key.0[term] {
            true => (trace - 1.0) * self.stiffness[term],
            false => self.laws[term].stiffness - self.stiffness[term],
        };
        let terms: Vec<usize> = (0..key.0.len())
            .filter(|&term| slope(term) != 0.0)
            .collect();
        let slopes: Vec<f64> = terms.iter().map(|&term| slope(term)).collect();
        let factor = DMatrix::from_fn(terms.len(), terms.len(), |row, column| {
            let own = self.unit[(terms[row], terms[column])] * slopes[column];
            f64::from(row == column) + own
        })
        .lu();
        let found = Rc::new(Steep {
            terms,
            slopes,
            factor,
        });
        let mut factors = self.factors.borrow_mut();
        if factors.len() >= KEPT {
            factors.clear();
        }
        factors.insert(key, Rc::clone(&found));
        found
    }

    /// By how much compatibility is missed.
    fn missed(&self, place: &Place, apart: &DVector<f64>, trace: f64) -> DVector<f64> {
        let pseudo = self.pseudo(&place.elongation, &place.sides, trace);
        &place.elongation + self.unit.tr_mul(&pseudo) - apart
    }

    fn pseudo(&self, elongation: &DVector<f64>, sides: &[Side], trace: f64) -> DVector<f64> {
        DVector::from_fn(elongation.len(), |term, _| {
            let (law, own) = (self.laws[term], self.stiffness[term]);
            let slack = if law.rod && law.size.is_finite() {
                trace * law.size
            } else {
                0.0
            };
            let beyond = |end: f64| (law.stiffness - own) * elongation[term] - law.stiffness * end;
            match sides[term] {
                Side::Idle => -own * ((1.0 - trace) * elongation[term] + slack),
                Side::Upper => beyond(law.size),
                Side::Lower => beyond(-law.size),
            }
        })
    }

    /// The point between two that misses compatibility least.
    fn shortened(&self, from: &Place, to: &Place, apart: &DVector<f64>, trace: f64) -> Place {
        let step = &to.elongation - &from.elongation;
        let mut best = (f64::INFINITY, to.clone());
        for halved in 0..HALVED {
            let tried = self.at(&from.elongation + 0.5_f64.powi(halved) * &step, trace);
            let missed = self.missed(&tried, apart, trace).norm_squared();
            if missed < best.0 {
                best = (missed, tried);
            }
        }
        best.1
    }

    /// Elongations, each on its side.
    fn at(&self, elongation: DVector<f64>, trace: f64) -> Place {
        let terms = elongation.iter().zip(&self.laws).zip(self.stiffness);
        let sides = terms.map(|((&own, law), stiffness)| {
            // With the trace a rod's force is zero at its slack, that of a play in its middle.
            let highest = if law.rod {
                law.size
            } else {
                law.size / (1.0 - trace * stiffness / law.stiffness)
            };
            if own >= highest {
                Side::Upper
            } else if !law.rod && own <= -highest {
                Side::Lower
            } else {
                Side::Idle
            }
        });
        let sides = sides.collect();
        Place { elongation, sides }
    }
}
