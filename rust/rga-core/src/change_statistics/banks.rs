//! Banks of statistics over the scores of a stream: one for every kind and scale of change.
//!
//! Let L be the likelihood ratio of a score under a change against none. The statistic of Shiryaev
//! and Roberts, R' = (1 + R) L, is the sum over all onsets of the likelihood ratio since then. A
//! mean of such statistics over sensors and signs, less the number of rows, is a martingale while
//! nothing changes, whatever goes together with what (Pollak, 1985).
//!
//! - A step in the mean of one sensor by d: L = exp(d z - d^2 / 2), up and down.
//! - The same of two sums: of all sensors that rise alike, and of the squares of all.
//! - A change of the standard deviation of one sensor to s: L = exp(z^2 (1 - s^-2) / 2) / s.
//! - A step in several sensors, which ones unknown: averages of recent scores that forget
//!   exponentially, each in standard deviations u, enter a mixture over subsets of sensors (Xie
//!   and Siegmund, 2013), the product of 1 - q + q f(u). For f, the likelihood ratio of a shift by
//!   3.2, e^(3.2 |u| - 5.12) / 2, a power stands that follows it where it decides.
//!
//! What is slow is looked at in beats of a few rows.

mod beat;
mod likelihood;
mod row;
mod sums;

use super::sixteen::{Lanes, SIXTEEN, sixteens};

/// Rows of a beat, and beats of a bar.
const BEAT: u64 = 4;
const BAR: u64 = 2;

/// Steps d in the scores of rows, of beats and of bars.
const ROW_STEPS: [f32; 3] = [1.0, 2.0, 4.0];
const BEAT_STEP: f32 = 0.5;
const BAR_STEP: f32 = 0.25;
/// Steps in sums.
const SUM_STEPS: [f32; 4] = [0.5, 1.0, 2.0, 4.0];
/// Sums that are watched: of all that rise alike, and of the squares of all.
const SUMS: usize = 2;
/// Factors on the standard deviation: sqrt(2), 2, 1/2.
const SPREADS: usize = 3;

/// What an average of rows, or of beats, forgets with each, and after how many it is looked at.
const ROW_AVERAGES: [(f32, u64); 3] = [(1.0 / 2.0, 1), (1.0 / 4.0, 1), (1.0 / 8.0, 2)];
const BEAT_AVERAGES: [(f32, u64); 5] = [
    (1.0 / 4.0, 1),
    (1.0 / 8.0, 1),
    (1.0 / 16.0, 2),
    (1.0 / 32.0, 4),
    (1.0 / 64.0, 8),
];

/// In this order: a step in one sensor, small to large; a spread; a step in several, slow to forget
/// last; a step in all alike; one in the squares of all.
pub const STATISTICS: usize = SIXTEEN + SUMS * SUM_STEPS.len();
const STEPS: usize = 2 + ROW_STEPS.len();
const AVERAGES: usize = ROW_AVERAGES.len() + BEAT_AVERAGES.len();
const _: () = assert!(STEPS + SPREADS + AVERAGES == SIXTEEN);
const _: () = assert!(2 * SUMS * SUM_STEPS.len() == SIXTEEN);

/// Two sixteens; what is behind the last statistic means nothing.
pub type Found = [f32; 2 * SIXTEEN];

/// Vectors of sixteen sensors: what every row changes, and what beats change.
const QUICK: usize = 3 + ROW_AVERAGES.len() + 2 * ROW_STEPS.len();
const SLOW: usize = 1 + 2 + 2 + SPREADS + BEAT_AVERAGES.len();

#[derive(Debug, Clone, PartialEq)]
pub struct Banks {
    sensors: usize,
    /// `[sixteens, QUICK, 16]`
    pub(super) quick: Vec<f32>,
    /// `[sixteens, SLOW, 16]`
    pub(super) slow: Vec<f32>,
    /// `[2, SUMS, SUM_STEPS]`: steps that rise, then steps that fall
    pub(super) sums: Vec<f32>,
    pub(super) rows: u64,
}

impl Banks {
    pub fn new(sensors: usize) -> Self {
        let width = sixteens(sensors) * SIXTEEN;
        Self {
            sensors,
            quick: vec![0.0; width * QUICK],
            slow: vec![0.0; width * SLOW],
            sums: vec![0.0; SIXTEEN],
            rows: 0,
        }
    }

    /// Takes the scores of a row, whole sixteens with NaN where they are missing, and gives the
    /// statistics; one that is not looked at in this row is 0.
    #[inline(always)]
    pub fn advance<L: Lanes>(
        &mut self,
        lanes: L,
        scores: &[f32],
        signature: &[f32],
        gaps: bool,
    ) -> Found {
        self.rows += 1;
        let mut found = [0.0; 2 * SIXTEEN];
        let (of_sensors, of_sums) = found.split_at_mut(SIXTEEN);
        let (steps, rest) = of_sensors.split_at_mut(STEPS);
        let (spreads, averages) = rest.split_at_mut(SPREADS);
        let (quick_averages, slow_averages) = averages.split_at_mut(ROW_AVERAGES.len());
        let rows = &mut steps[2..];
        let totals = self.each_row(lanes, scores, signature, gaps, rows, quick_averages);
        L::vectors_mut(of_sums)[0] = self.watch_sums(lanes, totals);
        if self.rows.is_multiple_of(BEAT) {
            self.each_beat(lanes, &mut steps[..2], spreads, slow_averages);
        }
        found
    }
}
