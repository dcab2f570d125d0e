//! From readings to scores: what a stream is like while nothing changes.
//!
//! A reading less its level is predicted from the ones before it (autoregression). What it
//! differs by is bent to a normal score, by a function that is linear between knots, and the
//! scores of a row are mixed so that sensors go together no more.

use super::sixteen::{Lanes, SIXTEEN, sixteens};
use crate::gaussian_window::Refusal;
use crate::input::Array;

/// Scores are never beyond this: one reading alone says no more.
pub const LARGEST_SCORE: f32 = 6.0;

/// Readings further from their level, in units, are taken for this.
const FARTHEST: f32 = 1e3;

/// Sweeps that fill missing scores with what the others of the row let expect.
const SWEEPS: usize = 8;

/// p sensors
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// `[p]`
    pub(super) level: Vec<f64>,
    /// `[order, p]` weights of earlier deviations from the level, the latest first
    pub(super) weights: Vec<f64>,
    /// `[p]` units per reading
    pub(super) units: Vec<f64>,
    /// `[p]` score of a deviation of 0, but for the knots
    pub(super) offset: Vec<f64>,
    /// `[p]` scores per unit, below all knots
    pub(super) slope: Vec<f64>,
    /// `[knots, p]` in units
    pub(super) knots: Vec<f64>,
    /// `[knots, p]` scores per unit that a knot adds to the slope
    pub(super) bends: Vec<f64>,
    /// `[p, p]` symmetric W: independent scores are W times scores
    pub(super) mixing: Vec<f64>,
    /// `[p]` how independent scores change, with norm 1, when all readings rise alike
    pub(super) signature: Vec<f64>,
    /// `[order, p]` deviations from the level, the latest first
    pub(super) past: Vec<f64>,
    /// `[p]` rows until the deviations that predict a reading are known
    pub(super) unsettled: Vec<u64>,
    /// `[1]` scores beyond this are cut
    pub(super) largest: Vec<f64>,
    derived: Derived,
}

/// What follows from the arrays; whole sixteens.
#[derive(Debug, Clone, PartialEq, Default)]
struct Derived {
    /// `[p]` how far back deviations have a weight
    reach: Vec<u64>,
    /// `[1 + 1 + 2 knots, 16]` for each sixteen: offset, slope, and knots with their bends
    bending: Vec<f32>,
    /// `[sixteens, p, 16]` columns of W; empty: W is the identity.
    columns: Vec<f32>,
    signature: Vec<f32>,
}

/// The arrays of a reference, as they are given.
#[derive(Debug, Clone, Copy)]
pub struct ReferenceArrays<'a> {
    pub level: Array<'a, f64>,
    pub weights: Array<'a, f64>,
    pub units: Array<'a, f64>,
    pub offset: Array<'a, f64>,
    pub slope: Array<'a, f64>,
    pub knots: Array<'a, f64>,
    pub bends: Array<'a, f64>,
    pub mixing: Array<'a, f64>,
    pub signature: Array<'a, f64>,
    pub largest: f64,
}

impl Reference {
    pub fn new(arrays: ReferenceArrays) -> Result<Self, Refusal> {
        let p = arrays.level.len();
        let (order, knots) = (arrays.weights.len(), arrays.knots.len());
        let wanted = [
            ("level", arrays.level, vec![p.max(1)]),
            ("weights", arrays.weights, vec![order, p]),
            ("units", arrays.units, vec![p]),
            ("offset", arrays.offset, vec![p]),
            ("slope", arrays.slope, vec![p]),
            ("knots", arrays.knots, vec![knots, p]),
            ("bends", arrays.bends, vec![knots, p]),
            ("mixing", arrays.mixing, vec![p, p]),
            ("signature", arrays.signature, vec![p]),
        ];
        if !(0.0..=f64::from(LARGEST_SCORE)).contains(&arrays.largest) {
            let what = format!("the largest score is {}", arrays.largest);
            let remedy = format!("give a number from 0 to {LARGEST_SCORE}");
            return Err(Refusal::new(what, "largest", &remedy));
        }
        for (name, array, shape) in &wanted {
            if array.shape != shape || !array.values.iter().all(|value| value.is_finite()) {
                let what = format!("shape {:?}, or a number that is none", array.shape);
                let remedy = format!("give finite numbers of shape {shape:?}");
                return Err(Refusal::new(what, name, &remedy));
            }
        }
        let [
            level,
            weights,
            units,
            offset,
            slope,
            knots,
            bends,
            mixing,
            signature,
        ] = wanted.map(|(_, array, _)| array.values.to_vec());
        let mut reference = Self {
            past: vec![0.0; weights.len()],
            level,
            weights,
            units,
            offset,
            slope,
            knots,
            bends,
            mixing,
            signature,
            largest: vec![arrays.largest],
            unsettled: Vec::new(),
            derived: Derived::default(),
        };
        reference.derive();
        reference.unsettled.clone_from(&reference.derived.reach);
        Ok(reference)
    }

    pub(super) fn derive(&mut self) {
        let sensors = self.sensors();
        let reach = |sensor: usize| {
            let weight = |lag: &usize| self.weights[lag * sensors + sensor] != 0.0;
            let last = (0..self.order()).rev().find(weight);
            last.map_or(0, |lag| lag as u64 + 1)
        };
        let reach = (0..sensors).map(reach).collect();
        let mut bending = Vec::new();
        let mut signature = Vec::new();
        for first in (0..sensors).step_by(SIXTEEN) {
            let own = first..sensors.min(first + SIXTEEN);
            let knots = self.knots.chunks_exact(sensors);
            let bends = self.bends.chunks_exact(sensors);
            let bent = knots.zip(bends).flat_map(|(knot, bend)| [knot, bend]);
            for row in [&self.offset[..], &self.slope].into_iter().chain(bent) {
                bending.extend(whole(&row[own.clone()]));
            }
            signature.extend(whole(&self.signature[own]));
        }
        let identity = |at: usize| f64::from(u8::from(at / sensors == at % sensors));
        let mut columns = Vec::new();
        if (0..sensors * sensors).any(|at| self.mixing[at] != identity(at)) {
            for first in (0..sensors).step_by(SIXTEEN) {
                // W is symmetric: its rows are its columns.
                for row in self.mixing.chunks_exact(sensors) {
                    columns.extend(whole(&row[first..sensors.min(first + SIXTEEN)]));
                }
            }
        }
        self.derived = Derived {
            reach,
            bending,
            columns,
            signature,
        };
    }

    /// In the order of their names in `ReferenceArrays`.
    pub(super) fn arrays(&self) -> [&Vec<f64>; 10] {
        [
            &self.level,
            &self.weights,
            &self.units,
            &self.offset,
            &self.slope,
            &self.knots,
            &self.bends,
            &self.mixing,
            &self.signature,
            &self.largest,
        ]
    }

    pub fn sensors(&self) -> usize {
        self.level.len()
    }

    /// Whole sixteens.
    pub fn signature(&self) -> &[f32] {
        &self.derived.signature
    }

    fn order(&self) -> usize {
        self.weights.len() / self.sensors()
    }

    /// Independent scores of a row, NaN where they are missing; and whether any is.
    #[inline(always)]
    pub fn scores<L: Lanes>(&mut self, lanes: L, readings: &[f64], work: &mut Work) -> bool {
        let sensors = self.sensors();
        self.innovations(readings, &mut work.innovations);
        let scores = &mut work.scores;
        let innovations = work.innovations.iter().zip(&self.units);
        for (score, (innovation, units)) in scores.iter_mut().zip(innovations) {
            *score = (innovation * units) as f32;
        }
        let gaps = any_missing(&work.innovations);
        self.bend(lanes, scores);
        if !self.derived.columns.is_empty() {
            if gaps {
                self.mix_with_gaps(lanes, scores, &mut work.mixed);
                self.cut(lanes, scores);
            } else {
                self.mix(lanes, &scores[..sensors], &mut work.mixed);
                scores[..sensors].copy_from_slice(&work.mixed[..sensors]);
                self.cut(lanes, scores);
            }
        }
        gaps
    }

    /// What readings differ by from what the ones before them let expect.
    #[inline(always)]
    fn innovations(&mut self, readings: &[f64], found: &mut [f64]) {
        let (sensors, order) = (self.sensors(), self.order());
        for ((found, reading), level) in found.iter_mut().zip(readings).zip(&self.level) {
            *found = reading - level;
        }
        if order == 0 {
            return;
        }
        let unsettled = self.unsettled.iter().fold(0, |any, rows| any | rows);
        if unsettled > 0 || any_missing(found) {
            self.innovations_with_gaps(found);
            return;
        }
        for lag in 1..order {
            let (weights, past) = (&self.weights[lag * sensors..], &self.past[lag * sensors..]);
            for ((found, weight), past) in found.iter_mut().zip(weights).zip(past) {
                *found -= weight * past;
            }
        }
        self.past.copy_within(..(order - 1) * sensors, sensors);
        let deviations = readings.iter().zip(&self.level);
        let latest = self.past[..sensors].iter_mut().zip(&self.weights);
        for ((found, (latest, weight)), (reading, level)) in
            found.iter_mut().zip(latest).zip(deviations)
        {
            *found -= weight * *latest;
            *latest = reading - level;
        }
    }

    /// A missing reading is taken for the expected one; those that it would have helped to
    /// predict are not judged.
    #[inline(never)]
    fn innovations_with_gaps(&mut self, found: &mut [f64]) {
        let (sensors, order) = (self.sensors(), self.order());
        for (sensor, found) in found.iter_mut().enumerate() {
            let deviation = *found;
            let mut expected = 0.0;
            for lag in (0..order).rev() {
                let at = lag * sensors + sensor;
                expected += self.weights[at] * self.past[at];
                if lag > 0 {
                    self.past[at] = self.past[at - sensors];
                }
            }
            let unsettled = &mut self.unsettled[sensor];
            if deviation.is_nan() {
                self.past[sensor] = expected;
                *unsettled = self.derived.reach[sensor];
            } else {
                self.past[sensor] = deviation;
                *found = deviation - expected;
                if *unsettled > 0 {
                    *unsettled -= 1;
                    *found = f64::NAN;
                }
            }
        }
    }

    /// From units to scores.
    #[inline(always)]
    fn bend<L: Lanes>(&self, lanes: L, scores: &mut [f32]) {
        let width = self.derived.bending.len() / scores.len() * SIXTEEN;
        let bending = self.derived.bending.chunks_exact(width).map(L::vectors);
        for (score, bending) in L::vectors_mut(scores).iter_mut().zip(bending) {
            let units = lanes.max(*score, lanes.splat(-FARTHEST));
            let units = lanes.min(units, lanes.splat(FARTHEST));
            let mut bent = lanes.add(bending[0], lanes.mul(bending[1], units));
            for knot in bending[2..].chunks_exact(2) {
                let beyond = lanes.max(units, knot[0]);
                bent = lanes.add(bent, lanes.mul(knot[1], beyond));
            }
            *score = lanes.select(lanes.equal(*score, *score), bent, *score);
        }
        self.cut(lanes, scores);
    }

    /// To what a baseline can tell of; what is no number stays none.
    #[inline(always)]
    fn cut<L: Lanes>(&self, lanes: L, scores: &mut [f32]) {
        let largest = self.largest[0] as f32;
        for score in L::vectors_mut(scores) {
            let cut = lanes.max(*score, lanes.splat(-largest));
            let cut = lanes.min(cut, lanes.splat(largest));
            *score = lanes.select(lanes.equal(*score, *score), cut, *score);
        }
    }

    /// W times scores.
    #[inline(always)]
    fn mix<L: Lanes>(&self, lanes: L, scores: &[f32], mixed: &mut [f32]) {
        let sensors = scores.len();
        // Sums that do not wait for each other.
        for (columns, mixed) in self
            .derived
            .columns
            .chunks(TOGETHER * SIXTEEN * sensors)
            .zip(mixed.chunks_mut(TOGETHER * SIXTEEN))
        {
            let (columns, mixed) = (L::vectors(columns), L::vectors_mut(mixed));
            if mixed.len() == TOGETHER {
                let sums = product::<L, TOGETHER>(lanes, columns, scores);
                mixed.copy_from_slice(&sums);
            } else {
                for (columns, mixed) in columns.chunks_exact(sensors).zip(mixed) {
                    [*mixed] = product(lanes, columns, scores);
                }
            }
        }
    }

    /// Missing scores take the values that are likeliest beside the others: those that make the
    /// sum of squares of the independent scores least, found one after the other.
    #[inline(always)]
    fn mix_with_gaps<L: Lanes>(&self, lanes: L, scores: &mut [f32], mixed: &mut [f32]) {
        let sensors = self.sensors();
        let missing: Vec<usize> = (0..sensors).filter(|at| scores[*at].is_nan()).collect();
        for sensor in &missing {
            scores[*sensor] = 0.0;
        }
        self.mix(lanes, &scores[..sensors], mixed);
        for _ in 0..SWEEPS {
            for sensor in &missing {
                let own = &self.mixing[sensor * sensors..][..sensors];
                let along = own
                    .iter()
                    .zip(&*mixed)
                    .map(|(w, score)| w * f64::from(*score));
                let length: f64 = own.iter().map(|w| w * w).sum();
                let step = -along.sum::<f64>() / length;
                for (score, w) in mixed.iter_mut().zip(own) {
                    *score += (step * w) as f32;
                }
            }
        }
        scores[..sensors].copy_from_slice(&mixed[..sensors]);
        for sensor in missing {
            scores[sensor] = f32::NAN;
        }
    }
}

/// Sixteens whose sums are formed together.
const TOGETHER: usize = 6;

/// N sixteens of W times scores.
#[inline(always)]
fn product<L: Lanes, const N: usize>(
    lanes: L,
    columns: &[L::Numbers],
    scores: &[f32],
) -> [L::Numbers; N] {
    let mut sums = [lanes.splat(0.0); N];
    for (column, score) in scores.iter().enumerate() {
        let score = lanes.splat(*score);
        for (band, sum) in sums.iter_mut().enumerate() {
            let weighted = lanes.mul(columns[band * scores.len() + column], score);
            *sum = lanes.add(*sum, weighted);
        }
    }
    sums
}

/// What one row is worked out in.
#[derive(Debug, Clone)]
pub struct Work {
    innovations: Vec<f64>,
    /// Whole sixteens; NaN behind the last sensor.
    pub scores: Vec<f32>,
    mixed: Vec<f32>,
}

impl Work {
    pub fn new(sensors: usize) -> Self {
        let padded = sixteens(sensors) * SIXTEEN;
        Self {
            innovations: vec![0.0; sensors],
            scores: vec![f32::NAN; padded],
            mixed: vec![0.0; padded],
        }
    }
}

/// A number times 0 is 0, and what is none stays none: eight sums of that, side by side.
#[inline(always)]
fn any_missing(values: &[f64]) -> bool {
    let (eights, rest) = values.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for eight in eights {
        for (sum, value) in sums.iter_mut().zip(eight) {
            *sum += value * 0.0;
        }
    }
    sums.iter().chain(rest).any(|value| value.is_nan())
}

/// Single precision, filled up to sixteen with zeros.
fn whole(values: &[f64]) -> impl Iterator<Item = f32> {
    let fill = std::iter::repeat_n(0.0, SIXTEEN - values.len());
    values.iter().map(|value| *value as f32).chain(fill)
}
