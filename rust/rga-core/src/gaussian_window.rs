//! An upper Gaussian bound on each sensor's next value, from its last values.
//!
//! A value x exceeds when x > mean + z * standard deviation (population, 1/M)
//! of the M values before it. With S and Q the sums of those values less a
//! shift, and of their squares, and with r = M (x - shift) - S, that is
//! r > 0 and r^2 > z^2 (M Q - S^2): no root, no division, and exact for values
//! of few digits.
//!
//! If the window holds x itself and W - 1 = M values before it, the same
//! condition becomes r > 0 and (M - z^2) r^2 > z^2 (M + 1) (M Q - S^2).
//!
//! M Q - S^2 loses digits where the values have moved away from the shift or
//! have shrunk (an outlier has left). S and Q are summed anew from the window
//! before that can turn a decision, and every `LAPS` windows in any case.

mod bytes;
mod rule;

use crate::input::Array;
pub use rule::{Refusal, WindowRule};

/// Part of the largest M Q below which M Q - S^2 has lost too many digits.
const DIGITS_LEFT: f64 = 1e-6;

/// Windows after which rounding in S and Q is cleared.
const LAPS: u64 = 64;

/// Beyond this, squares of squares overflow.
const LARGEST: f64 = 1e60;

/// One column a sensor in every array.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussianWindow {
    rule: WindowRule,
    sensors: usize,
    /// M
    earlier: usize,
    rows: u64,
    /// Where the next value goes, 0..M.
    slot: Vec<u64>,
    /// How often the window has been filled.
    laps: Vec<u64>,
    /// Bits of the last tested values, newest lowest: it exceeded.
    recent: Vec<u64>,
    shift: Vec<f64>,
    /// S
    sum: Vec<f64>,
    /// Q
    square: Vec<f64>,
    /// Largest Q since S and Q were summed.
    peak: Vec<f64>,
    /// `[M, sensors]`
    ring: Vec<f64>,
}

impl GaussianWindow {
    pub fn new(rule: WindowRule) -> Result<Self, Refusal> {
        rule.check()?;
        let (sensors, earlier) = (rule.sensors as usize, rule.earlier());
        let mut ring = Vec::new();
        let cells = sensors.saturating_mul(earlier);
        ring.try_reserve_exact(cells).map_err(|_| {
            let what = format!("{sensors} sensors times {earlier} values do not fit in memory");
            Refusal::new(what, "n_sensors and window", "make one of them smaller")
        })?;
        ring.resize(cells, 0.0);
        Ok(Self {
            rule,
            sensors,
            earlier,
            rows: 0,
            slot: vec![0; sensors],
            laps: vec![0; sensors],
            recent: vec![0; sensors],
            shift: vec![0.0; sensors],
            sum: vec![0.0; sensors],
            square: vec![0.0; sensors],
            peak: vec![0.0; sensors],
            ring,
        })
    }

    /// Rows seen.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Alarms `[sensors]` of one row `[sensors]`; NaN is missing.
    pub fn update(&mut self, row: Array<f64>) -> Result<Vec<bool>, Refusal> {
        if row.shape != [self.sensors] {
            return Err(self.misshapen("row", row.shape, format!("[{}]", self.sensors)));
        }
        self.advance(row.values)
    }

    /// Alarms `[n, sensors]` of rows `[n, sensors]`; NaN is missing.
    pub fn update_many(&mut self, rows: Array<f64>) -> Result<Vec<bool>, Refusal> {
        if rows.shape != [rows.len(), self.sensors] {
            return Err(self.misshapen("rows", rows.shape, format!("[n, {}]", self.sensors)));
        }
        self.advance(rows.values)
    }

    /// `[sensors]` what the next value must exceed; NaN while the window fills.
    pub fn bound(&self) -> Vec<f64> {
        let (own, others) = self.rule.weights();
        (0..self.sensors)
            .map(|sensor| match self.laps[sensor] {
                0 => f64::NAN,
                _ if own <= 0.0 => f64::INFINITY,
                _ => {
                    let reach = (others / own * self.spread(sensor)).sqrt();
                    self.shift[sensor] + (self.sum[sensor] + reach) / self.earlier as f64
                }
            })
            .collect()
    }

    fn misshapen(&self, place: &str, shape: &[usize], right: String) -> Refusal {
        let what = format!("the array has shape {shape:?}");
        Refusal::new(what, place, &format!("its shape must be {right}"))
    }

    fn advance(&mut self, values: &[f64]) -> Result<Vec<bool>, Refusal> {
        // Before anything changes; NaN is not above.
        if let Some(at) = values.iter().position(|value| value.abs() > LARGEST) {
            let row = self.rows + (at / self.sensors) as u64;
            return Err(Refusal::new(
                format!("the value is {:?}", values[at]),
                &format!("row {row} of the stream, sensor {}", at % self.sensors),
                &format!("give numbers within {LARGEST:e} in size, and NaN for a missing value"),
            ));
        }
        let mut alarms = vec![false; values.len()];
        let rows = values.chunks_exact(self.sensors);
        for (row, alarms) in rows.zip(alarms.chunks_exact_mut(self.sensors)) {
            for (sensor, (&value, alarm)) in row.iter().zip(alarms).enumerate() {
                *alarm = !value.is_nan() && self.take(sensor, value);
            }
            self.rows += 1;
        }
        Ok(alarms)
    }

    /// Tests a value, lets it into the window, and tells whether the sensor alarms.
    fn take(&mut self, sensor: usize, value: f64) -> bool {
        if self.laps[sensor] == 0 {
            self.enter(sensor, value);
            return false;
        }
        let exceeds = self.exceeds(sensor, value);
        if !(exceeds && self.rule.frozen) {
            self.enter(sensor, value);
        }
        let (k, n) = self.rule.persistence;
        let tested = (self.recent[sensor] << 1 | u64::from(exceeds)) & (u64::MAX >> (64 - n));
        self.recent[sensor] = tested;
        i64::from(tested.count_ones()) >= k
    }

    fn exceeds(&self, sensor: usize, value: f64) -> bool {
        let (own, others) = self.rule.weights();
        let reach = self.earlier as f64 * (value - self.shift[sensor]) - self.sum[sensor];
        reach > 0.0 && own * (reach * reach) > others * self.spread(sensor)
    }

    /// M Q - S^2
    fn spread(&self, sensor: usize) -> f64 {
        let sum = self.sum[sensor];
        (self.earlier as f64 * self.square[sensor] - sum * sum).max(0.0)
    }

    fn enter(&mut self, sensor: usize, value: f64) {
        let cell = self.slot[sensor] as usize * self.sensors + sensor;
        let oldest = std::mem::replace(&mut self.ring[cell], value);
        self.slot[sensor] += 1;
        let filled = self.slot[sensor] == self.earlier as u64;
        if filled {
            self.slot[sensor] = 0;
            self.laps[sensor] += 1;
        }
        if self.laps[sensor] == 0 {
            return;
        }
        let (gained, lost) = (value - self.shift[sensor], oldest - self.shift[sensor]);
        self.sum[sensor] += gained - lost;
        self.square[sensor] += gained * gained - lost * lost;
        self.peak[sensor] = self.peak[sensor].max(self.square[sensor]);
        let most = self.earlier as f64 * self.peak[sensor];
        let due = filled && self.laps[sensor] % LAPS == 1;
        if due || self.spread(sensor) < DIGITS_LEFT * most {
            self.sum_anew(sensor);
        }
    }

    /// The shift is the value nearest to the mean: values that are alike leave
    /// no rounding, and M Q - S^2 is then at least half of M Q.
    fn sum_anew(&mut self, sensor: usize) {
        let values = || self.ring[sensor..].iter().step_by(self.sensors).copied();
        let first = self.ring[sensor];
        let mean = first + values().map(|value| value - first).sum::<f64>() / self.earlier as f64;
        let shift = values().fold(first, |nearest, value| {
            if (value - mean).abs() < (nearest - mean).abs() {
                value
            } else {
                nearest
            }
        });
        let sum = values().map(|value| value - shift).sum();
        let square = values().map(|value| (value - shift).powi(2)).sum();
        self.shift[sensor] = shift;
        self.sum[sensor] = sum;
        self.square[sensor] = square;
        self.peak[sensor] = square;
    }
}
