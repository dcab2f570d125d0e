//! Statistics that grow when a stream of readings changes.
//!
//! Readings become scores (`reference`): standard normal, and independent in time and between
//! sensors, for as long as nothing changes. Banks of statistics (`statistics`) weigh every kind and
//! scale of change against that. One that reaches its threshold raises an alarm, which stands
//! until the statistics begin again.

mod bytes;
mod exponentials;
mod recent_scores;
mod reference;
mod statistics;

use pulp::Arch;
use rga_simd::Array;
use rga_simd::f32::{Lanes, OnSixteen, SIXTEEN, on_sixteen};

use crate::refusal::Refusal;
use recent_scores::Recent;
use reference::Work;
use statistics::{Banks, Found};

pub use reference::{Reference, ReferenceArrays, innovations};
pub use statistics::STATISTICS;

/// Rows of a block.
const BLOCK_ROWS: usize = 4;

/// Sixteen sensors in the rows of a block.
type Block = [[f32; SIXTEEN]; BLOCK_ROWS];

/// Beyond this a reading is taken for a fault of its source.
const LARGEST: f64 = 1e60;

/// What raised an alarm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alarm {
    /// Of the stream, from 0 on.
    pub row: u64,
    /// The statistic that was farthest above its threshold.
    pub statistic: usize,
}

#[derive(Debug, Clone, PartialEq)]
pub struct ChangeStatistics {
    reference: Reference,
    /// Infinite: it raises no alarm.
    thresholds: Found,
    banks: Banks,
    recent: Recent,
    rows: u64,
    alarm: Option<Alarm>,
    /// Largest values since they were last taken.
    peaks: Found,
}

impl ChangeStatistics {
    pub fn new(reference: Reference, thresholds: [f32; STATISTICS], rows_kept: usize) -> Self {
        let mut placed = [f32::INFINITY; _];
        placed[..STATISTICS].copy_from_slice(&thresholds);
        Self {
            banks: Banks::new(reference.sensors()),
            recent: Recent::new(reference.sensors(), rows_kept),
            reference,
            thresholds: placed,
            rows: 0,
            alarm: None,
            peaks: [0.0; _],
        }
    }

    pub fn sensors(&self) -> usize {
        self.reference.sensors()
    }

    /// Rows seen.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    pub fn alarm(&self) -> Option<Alarm> {
        self.alarm
    }

    /// Scores `[rows, sensors]` of the latest rows since the statistics began, or of the rows around
    /// the alarm; NaN where missing.
    pub fn recent(&self) -> Vec<f32> {
        self.recent.in_order()
    }

    /// Row of the stream that the first row of `recent` is.
    pub fn recent_first(&self) -> u64 {
        self.rows.min(self.end_of_evidence()) - self.recent.filled() as u64
    }

    /// Rows of the stream until which scores are kept: as many before an alarm as behind it.
    fn end_of_evidence(&self) -> u64 {
        let behind = self.recent.rows() as u64 / 2;
        self.alarm.map_or(u64::MAX, |alarm| alarm.row + 1 + behind)
    }

    /// Largest value of each statistic since this was last asked.
    pub fn take_peaks(&mut self) -> [f32; STATISTICS] {
        let peaks = std::mem::replace(&mut self.peaks, [0.0; _]);
        let mut found = [0.0; STATISTICS];
        found.copy_from_slice(&peaks[..STATISTICS]);
        found
    }

    /// Forgets the alarm and all evidence; what the next readings are expected to be stays.
    pub fn begin_again(&mut self) {
        self.banks = Banks::new(self.reference.sensors());
        self.recent.clear();
        self.alarm = None;
        self.peaks = [0.0; _];
    }

    /// Whether an alarm stands after each of the rows `[n, sensors]`; NaN is missing.
    pub fn update_many(&mut self, rows: Array<f64>) -> Result<Vec<bool>, Refusal> {
        self.update_with(rows, Arch::new())
    }

    /// The same, on given instructions.
    pub fn update_with(&mut self, rows: Array<f64>, arch: Arch) -> Result<Vec<bool>, Refusal> {
        let sensors = self.reference.sensors();
        if rows.shape != [rows.len(), sensors] {
            return Err(Refusal::new(
                format!("the array has shape {:?}", rows.shape),
                "rows",
                &format!("its shape must be [n, {sensors}]"),
            ));
        }
        let mut alarms = vec![false; rows.len()];
        let mut refused = false;
        let advance = Advance {
            statistics: self,
            rows: rows.values,
            alarms: &mut alarms,
            refused: &mut refused,
        };
        on_sixteen(arch, advance);
        if refused {
            return Err(self.beyond(rows.values));
        }
        Ok(alarms)
    }

    fn beyond(&self, values: &[f64]) -> Refusal {
        let sensors = self.reference.sensors();
        let beyond = values.iter().position(|value| value.abs() > LARGEST);
        let at = beyond.unwrap_or_default();
        let row = self.rows + (at / sensors) as u64;
        Refusal::new(
            format!("the value is {:?}", values[at]),
            &format!("row {row} of the stream, sensor {}", at % sensors),
            &format!("give numbers within {LARGEST:e} in size, and NaN for a missing value"),
        )
    }
}

struct Advance<'a> {
    statistics: &'a mut ChangeStatistics,
    rows: &'a [f64],
    alarms: &'a mut [bool],
    /// Nothing has changed: a value is too large.
    refused: &'a mut bool,
}

impl OnSixteen for Advance<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let (mut rows, mut alarms) = (self.rows, self.alarms);
        let (beyond, missing) = oddities(rows);
        *self.refused = beyond;
        if beyond {
            return;
        }
        let own = self.statistics;
        let sensors = own.reference.sensors();
        let mut work = Work::new(&own.reference);
        let mut found = [[0.0; _]; BLOCK_ROWS];
        while !alarms.is_empty() {
            let count = own.banks.rows_to_beat().min(alarms.len());
            let (readings, alarm);
            (readings, rows) = rows.split_at(count * sensors);
            (alarm, alarms) = alarms.split_at_mut(count);
            own.take(
                lanes,
                readings,
                missing,
                alarm,
                &mut work,
                &mut found[..count],
            );
        }
    }
}

impl ChangeStatistics {
    /// Takes rows of one block.
    #[inline(always)]
    fn take<L: Lanes>(
        &mut self,
        lanes: L,
        readings: &[f64],
        missing: bool,
        alarms: &mut [bool],
        work: &mut Work,
        found: &mut [Found],
    ) {
        let gaps = self.reference.scores(lanes, readings, missing, work);
        let signature = self.reference.signature();
        self.banks
            .advance(lanes, &work.scores, signature, gaps, found);
        for (row, (alarm, found)) in alarms.iter_mut().zip(found).enumerate() {
            if self.rows < self.end_of_evidence() {
                self.recent.push(&work.scores, row);
            }
            let peaks = L::vectors_mut(&mut self.peaks).iter_mut();
            let limits = L::vectors(&self.thresholds);
            let mut raised = false;
            for ((peak, value), limit) in peaks.zip(L::vectors(found)).zip(limits) {
                *peak = lanes.max(*peak, *value);
                raised |= lanes.any_reaches(*value, *limit);
            }
            if raised && self.alarm.is_none() {
                self.alarm = Some(Alarm {
                    row: self.rows,
                    statistic: farthest(found, &self.thresholds),
                });
            }
            *alarm = self.alarm.is_some();
            self.rows += 1;
        }
    }
}

/// Whether some value is too large, and whether some is missing.
#[inline(always)]
fn oddities(values: &[f64]) -> (bool, bool) {
    let mut usual = true;
    for value in values {
        usual &= value.abs() <= LARGEST;
    }
    if usual {
        return (false, false);
    }
    let beyond = values.iter().any(|value| value.abs() > LARGEST);
    (beyond, values.iter().any(|value| value.is_nan()))
}

/// The statistic that is farthest above its threshold.
fn farthest(found: &Found, thresholds: &Found) -> usize {
    let limits = found.iter().zip(thresholds).take(STATISTICS);
    let heights = limits.map(|(value, threshold)| value / threshold);
    let by_height = heights.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    by_height.map_or(0, |(statistic, _)| statistic)
}
