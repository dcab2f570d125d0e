//! From readings to scores: what a stream is like while nothing changes.
//!
//! A reading less its level is predicted from the ones before it (autoregression). What it
//! differs by is bent to a normal score, by a function that is linear between knots, and the
//! scores of a row are mixed so that sensors go together no more.

mod autoregression;
mod decorrelation;
mod gaps;
mod memory;
mod normal_scores;

use rga_simd::Array;
use rga_simd::f32::{Lanes, SIXTEEN, sixteens};

use crate::change::{BLOCK_ROWS, Block};
use crate::refusal::Refusal;
use autoregression::any_missing;
use gaps::Gaps;
use memory::{reach, unknown};

pub use memory::innovations;

/// Scores are never beyond this: one reading alone says no more.
pub(super) const LARGEST_SCORE: f32 = 6.0;

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
    /// `[p, order, order]` covariance of what is not known of these, as `Memory` has it; the first
    /// entries of a sensor whose order is less
    pub(super) doubt: Vec<f64>,
    /// `[1]` scores beyond this are cut
    pub(super) largest: Vec<f64>,
    derived: Derived,
}

/// What follows from the arrays; whole sixteens.
#[derive(Debug, Clone, PartialEq, Default)]
struct Derived {
    /// `[p]` how far back deviations have a weight
    reach: Vec<usize>,
    units: Vec<f64>,
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
            doubt: Vec::new(),
            derived: Derived::default(),
        };
        reference.derive();
        reference.doubt = vec![0.0; order * order * p];
        for sensor in 0..p {
            let reach = reference.derived.reach[sensor];
            let own: Vec<f64> = (0..reach)
                .map(|lag| reference.weights[lag * p + sensor])
                .collect();
            reference.doubt[sensor * order * order..][..reach * reach]
                .copy_from_slice(&unknown(&own));
        }
        Ok(reference)
    }

    pub(super) fn derive(&mut self) {
        let sensors = self.sensors();
        let reach = (0..sensors).map(|sensor| reach(&self.weights, sensors, sensor));
        let reach = reach.collect();
        let mut units = self.units.clone();
        units.resize(sixteens(sensors) * SIXTEEN, 0.0);
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
            units,
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

    pub(crate) fn sensors(&self) -> usize {
        self.level.len()
    }

    /// Whole sixteens.
    pub(crate) fn signature(&self) -> &[f32] {
        &self.derived.signature
    }

    fn order(&self) -> usize {
        self.weights.len() / self.sensors()
    }

    /// Independent scores of rows, those of a block at most, NaN where they are missing; and whether
    /// any is. `missing`: readings may be.
    #[inline(always)]
    pub(crate) fn scores<L: Lanes>(
        &mut self,
        lanes: L,
        readings: &[f64],
        missing: bool,
        work: &mut Work,
    ) -> bool {
        let sensors = self.sensors();
        let mut gaps = false;
        let rows = readings.chunks_exact(sensors).len();
        for row in 0..rows {
            let readings = &readings[row * sensors..][..sensors];
            self.scale(readings, row, work);
            let gap = !work.settled || missing && any_missing(readings);
            gaps |= gap;
            if self.past.is_empty() {
                continue;
            }
            if gap {
                let shrink = |sensor: usize, share: f64| {
                    work.scores[sensor / SIXTEEN][row][sensor % SIXTEEN] *= share as f32;
                };
                self.remember_with_gaps(readings, shrink);
                work.settled = self.settled();
                self.expect(&mut work.expected[..sensors]);
            } else {
                self.remember(readings, &mut work.expected);
            }
        }
        if rows == BLOCK_ROWS && !gaps {
            self.finish::<L, BLOCK_ROWS, false>(lanes, work, 0);
            return false;
        }
        for row in 0..rows {
            if gaps {
                self.finish::<L, 1, true>(lanes, work, row);
            } else {
                self.finish::<L, 1, false>(lanes, work, row);
            }
        }
        gaps
    }

    /// Readings less the expected ones, in units.
    #[inline(always)]
    fn scale(&self, readings: &[f64], row: usize, work: &mut Work) {
        let (sixteens, rest) = readings.as_chunks();
        let mut last = [0.0; SIXTEEN];
        last[..rest.len()].copy_from_slice(rest);
        let readings = sixteens.iter().chain([&last]);
        let (expected, _) = work.expected.as_chunks::<SIXTEEN>();
        let (units, _) = self.derived.units.as_chunks::<SIXTEEN>();
        let by_sixteen = readings.zip(expected).zip(units).zip(&mut work.scores);
        for (((readings, expected), units), block) in by_sixteen {
            block[row] = scaled(readings, expected, units);
        }
    }

    /// N rows of units, from one on, become independent scores.
    #[inline(always)]
    fn finish<L: Lanes, const N: usize, const GAPS: bool>(
        &self,
        lanes: L,
        work: &mut Work,
        first: usize,
    ) {
        self.bend::<L, N, GAPS>(lanes, &mut work.scores, first);
        if !self.derived.columns.is_empty() {
            self.mix::<L, N, GAPS>(
                lanes,
                &mut work.scores,
                &mut work.mixed,
                first,
                &mut work.gaps,
            );
        }
    }
}

#[inline(always)]
fn scaled(
    readings: &[f64; SIXTEEN],
    expected: &[f64; SIXTEEN],
    units: &[f64; SIXTEEN],
) -> [f32; SIXTEEN] {
    let mut scores = [0.0; SIXTEEN];
    for lane in 0..SIXTEEN {
        scores[lane] = ((readings[lane] - expected[lane]) * units[lane]) as f32;
    }
    scores
}

/// What the rows of a block are worked out in.
#[derive(Debug, Clone)]
pub(crate) struct Work {
    /// Readings that predict the next ones are known.
    settled: bool,
    /// Whole sixteens, NaN behind the last sensor.
    expected: Vec<f64>,
    /// NaN behind the last sensor.
    pub scores: Vec<Block>,
    mixed: Vec<Block>,
    gaps: Gaps,
}

impl Work {
    pub(crate) fn new(reference: &Reference) -> Self {
        let sensors = reference.sensors();
        let mut expected = reference.level.clone();
        reference.expect(&mut expected);
        expected.resize(sixteens(sensors) * SIXTEEN, f64::NAN);
        Self {
            settled: reference.settled(),
            expected,
            scores: vec![[[f32::NAN; _]; _]; sixteens(sensors)],
            mixed: vec![[[0.0; _]; _]; sixteens(sensors)],
            gaps: Gaps::default(),
        }
    }
}

/// Single precision, filled up to sixteen with zeros.
fn whole(values: &[f64]) -> impl Iterator<Item = f32> {
    let fill = std::iter::repeat_n(0.0, SIXTEEN - values.len());
    values.iter().map(|value| *value as f32).chain(fill)
}
