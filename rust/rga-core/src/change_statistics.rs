//! Statistics that grow when a stream of readings changes.
//!
//! Readings become scores (`reference`): standard normal, and independent in time and between
//! sensors, for as long as nothing changes. Banks of statistics (`banks`) weigh every kind and
//! scale of change against that. One that reaches its threshold raises an alarm, which stands
//! until the statistics begin again.

mod banks;
mod bytes;

mod powers;
mod recent;
mod reference;
mod sixteen;

use pulp::Arch;

use crate::gaussian_window::Refusal;
use crate::input::Array;
use banks::Banks;
pub use banks::STATISTICS;
use recent::Recent;
use reference::Work;
pub use reference::{Reference, ReferenceArrays};
use sixteen::{Lanes, OnSixteen, on_sixteen};

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
    /// One a statistic; infinite: it raises no alarm.
    thresholds: [f32; STATISTICS],
    banks: Banks,
    recent: Recent,
    rows: u64,
    alarm: Option<Alarm>,
    /// Largest values since they were last taken.
    peaks: [f32; STATISTICS],
}

impl ChangeStatistics {
    pub fn new(reference: Reference, thresholds: [f32; STATISTICS], rows_kept: usize) -> Self {
        Self {
            banks: Banks::new(reference.sensors()),
            recent: Recent::new(reference.sensors(), rows_kept),
            reference,
            thresholds,
            rows: 0,
            alarm: None,
            peaks: [0.0; STATISTICS],
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

    /// Scores `[rows, sensors]` of the latest rows since the statistics began; NaN where missing.
    pub fn recent(&self) -> Vec<f32> {
        self.recent.in_order()
    }

    /// Largest value of each statistic since this was last asked.
    pub fn take_peaks(&mut self) -> [f32; STATISTICS] {
        std::mem::replace(&mut self.peaks, [0.0; STATISTICS])
    }

    /// Forgets the alarm and all evidence; what the next readings are expected to be stays.
    pub fn begin_again(&mut self) {
        self.banks = Banks::new(self.reference.sensors());
        self.recent.clear();
        self.alarm = None;
        self.peaks = [0.0; STATISTICS];
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
        // Before anything changes; NaN is not above.
        if let Some(at) = rows.values.iter().position(|value| value.abs() > LARGEST) {
            let row = self.rows + (at / sensors) as u64;
            return Err(Refusal::new(
                format!("the value is {:?}", rows.values[at]),
                &format!("row {row} of the stream, sensor {}", at % sensors),
                &format!("give numbers within {LARGEST:e} in size, and NaN for a missing value"),
            ));
        }
        let mut alarms = vec![false; rows.len()];
        on_sixteen(
            arch,
            Advance {
                statistics: self,
                rows: rows.values,
                alarms: &mut alarms,
            },
        );
        Ok(alarms)
    }
}

struct Advance<'a> {
    statistics: &'a mut ChangeStatistics,
    rows: &'a [f64],
    alarms: &'a mut [bool],
}

impl OnSixteen for Advance<'_> {
    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let own = self.statistics;
        let sensors = own.reference.sensors();
        let mut work = Work::new(sensors);
        for (readings, alarm) in self.rows.chunks_exact(sensors).zip(self.alarms) {
            let gaps = own.reference.scores(lanes, readings, &mut work);
            own.recent.push(&work.scores[..sensors]);
            let signature = own.reference.signature();
            let found = own.banks.advance(lanes, &work.scores, signature, gaps);
            let (mut highest, mut statistic) = (0.0, None);
            let limits = own.peaks.iter_mut().zip(&own.thresholds);
            for (number, (value, (peak, threshold))) in found.iter().zip(limits).enumerate() {
                *peak = peak.max(*value);
                if *value >= *threshold && *value / threshold > highest {
                    (highest, statistic) = (*value / threshold, Some(number));
                }
            }
            let row = own.rows;
            let raised = statistic.map(|statistic| Alarm { row, statistic });
            own.alarm = own.alarm.or(raised);
            *alarm = own.alarm.is_some();
            own.rows += 1;
        }
    }
}
