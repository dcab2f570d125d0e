//! Terms whose force is no multiple of their elongation: slack, play and stops.
//!
//! A law N(v) of a term is written as that of the linear term of the structure and a pseudo-force
//! w = N(v) - k v beside it. Condensed onto these terms, v + G w(v) = v0 is a small system with
//! corners at the ends of the play; Newton's method meets few of them (Qi and Sun, A nonsmooth
//! version of Newton's method, Math. Programming 58, 1993).
//!
//! A trace of stiffness in idle terms keeps in the middle of the play what only the play lets move
//! and no load pushes. It finds the side on which each term is; its force is then taken off again.

use nalgebra::{DMatrix, DVector};

use crate::error::{Error, Result};
use crate::paths::condensation::UnitResponses;

/// Newton steps before a row is given up.
const STEPS: usize = 60;
/// An elongation is found when it changes by less than this part of the largest.
const CONVERGED: f64 = 1e-12;
/// Share of its stiffness that an idle term keeps, and how much of the loads it may carry by that.
const TRACE: f64 = 1e-8;
const CARRIED: f64 = 1e-3;
/// Shares that lead to the trace where it cannot be reached at once.
const TRACES: [f64; 13] = [
    0.9, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02, 1e-2, 3e-3, 1e-3, 1e-4, 1e-6, TRACE,
];
/// How often a step is halved on the way.
const HALVED: i32 = 16;
/// Steps that take the force of the trace off again.
const REFINED: usize = 2;
/// Elongations below this are none [m].
const NONE: f64 = 1e-12;

/// What terms carry, row by row: `[rows, terms]` each.
#[derive(Debug, Clone, Copy)]
pub struct Laws<'a> {
    /// A term carries nothing up to this elongation [m], and a play down to its negative; infinite
    /// for a play that never carries.
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
#[derive(Debug, Clone, Copy, PartialEq)]
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
    let sizes = laws.size.iter().filter(|size| size.is_finite());
    let largest = sizes.fold(0.0, |most: f64, size| most.max(size.abs()));
    let unit = DMatrix::from_row_slice(terms, terms, &linear.unit);
    let carried = CARRIED * (apart.amax() + largest + NONE);
    let mut found = Vec::with_capacity(rows * terms);
    for (row, apart) in apart.row_iter().enumerate() {
        let own = |term: usize| Law {
            size: laws.size[row * terms + term],
            stiffness: laws.stiffness[row * terms + term],
            rod: laws.rod[term],
        };
        let system = System {
            unit: &unit,
            stiffness: &linear.stiffness,
            laws: (0..terms).map(own).collect(),
            carried,
        };
        let forces = system
            .settled(&apart.transpose())
            .ok_or(Error::UnstableSample { row })?;
        found.extend(forces.iter());
    }
    Ok(found)
}

/// The compatibility of one row's elongations.
struct System<'a> {
    unit: &'a DMatrix<f64>,
    /// Of the terms in the structure.
    stiffness: &'a [f64],
    laws: Vec<Law>,
    /// Elongation that the trace may take for itself [m].
    carried: f64,
}

/// Elongations with the side that each is on.
#[derive(Clone)]
struct Place {
    elongation: DVector<f64>,
    sides: Vec<Side>,
}

impl System<'_> {
    /// Pseudo-forces of a row, whose elongations would be `apart` were all terms linear.
    fn settled(&self, apart: &DVector<f64>) -> Option<DVector<f64>> {
        // All terms bear at first, each on the side that it would take without its law.
        let bearing = DVector::from_fn(apart.len(), |term, _| {
            let sign = f64::from(apart[term] > 0.0) - f64::from(apart[term] < 0.0);
            match self.laws[term].size {
                size if size.is_finite() => sign * size * self.stiffness[term],
                _ => 0.0,
            }
        });
        let mut place = self.at(apart + self.unit.tr_mul(&bearing), TRACE);
        if !self.newton(&mut place, apart, TRACE, false)? {
            // Many idle terms and little load: Newton's method goes round in circles, and is led
            // from terms that keep much of their stiffness to those that keep a trace.
            let mut met = false;
            for trace in TRACES {
                met = self.newton(&mut place, apart, trace, true)?;
            }
            if !met {
                return None;
            }
        }
        if TRACE * place.elongation.amax() >= self.carried {
            return None;
        }
        for _ in 0..REFINED {
            place.elongation = self.moved(&place, apart, 0.0)?;
        }
        Some(self.pseudo(&place.elongation, &place.sides, 0.0))
    }

    /// Newton steps, in place; whether they come to an end. None where nothing holds the terms.
    fn newton(
        &self,
        place: &mut Place,
        apart: &DVector<f64>,
        trace: f64,
        damped: bool,
    ) -> Option<bool> {
        for _ in 0..STEPS {
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
        // By how much a pseudo-force grows with the elongation.
        let slope = |term: usize| match place.sides[term] {
            Side::Idle => (trace.max(TRACE) - 1.0) * self.stiffness[term],
            _ => self.laws[term].stiffness - self.stiffness[term],
        };
        let steep: Vec<usize> = (0..place.sides.len())
            .filter(|&term| slope(term) != 0.0)
            .collect();
        let mut next = &place.elongation - &missed;
        if steep.is_empty() {
            return Some(next);
        }
        // The other terms follow these: they alone are a system, as large as they are many.
        let matrix = DMatrix::from_fn(steep.len(), steep.len(), |row, column| {
            let own = self.unit[(steep[row], steep[column])] * slope(steep[column]);
            f64::from(row == column) + own
        });
        let own = DVector::from_fn(steep.len(), |row, _| missed[steep[row]]);
        let own = matrix.lu().solve(&own)?;
        for (&term, own) in steep.iter().zip(&own) {
            next.axpy(slope(term) * own, &self.unit.column(term), 1.0);
        }
        for (&term, own) in steep.iter().zip(&own) {
            next[term] = place.elongation[term] - own;
        }
        Some(next)
    }

    /// By how much compatibility is missed.
    fn missed(&self, place: &Place, apart: &DVector<f64>, trace: f64) -> DVector<f64> {
        let pseudo = self.pseudo(&place.elongation, &place.sides, trace);
        &place.elongation + self.unit.tr_mul(&pseudo) - apart
    }

    fn pseudo(&self, elongation: &DVector<f64>, sides: &[Side], trace: f64) -> DVector<f64> {
        DVector::from_fn(elongation.len(), |term, _| {
            let (law, own) = (self.laws[term], self.stiffness[term]);
            let slack = if law.rod { trace * law.size } else { 0.0 };
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
