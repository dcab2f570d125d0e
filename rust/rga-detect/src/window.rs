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
//!
//! Sensors go in blocks of eight, one a lane of SIMD vectors (`block`): a few rows at a time
//! (`tile`) pass through one block after the other (`pass`). Where some values of a block are
//! missing, fill a window or stay outside, its lanes part ways (`masked`). Products are added
//! without rounding in between, so that decisions do not depend on the processor.

mod block;
mod bytes;
mod masked;
mod moments;
mod pass;
mod rule;
mod tile;

use pulp::Arch;
use rga_simd::Array;
use rga_simd::{UnknownInstructions, instructions_named};

use crate::refusal::Refusal;
use block::Block;
use pass::Pass;
use tile::{Eight, WIDTH};

pub use rule::WindowRule;

/// Part of the largest M Q below which M Q - S^2 has lost too many digits.
const DIGITS_LEFT: f64 = 1e-6;

/// Windows after which rounding in S and Q is cleared.
const LAPS: u64 = 64;

/// Beyond this, squares of squares overflow.
const LARGEST: f64 = 1e60;

#[derive(Debug, Clone)]
pub struct GaussianWindow {
    rule: WindowRule,
    arch: Arch,
    rows: u64,
    /// Where the next row goes, 0..M.
    slot: usize,
    /// The last one overlaps the one before, so that it is full.
    blocks: Vec<Block>,
    /// `[M, blocks]`
    ring: Vec<Eight>,
}

impl GaussianWindow {
    pub fn new(rule: WindowRule) -> Result<Self, Refusal> {
        rule.check()?;
        let blocks = rule.sensors().div_ceil(WIDTH);
        let mut ring = Vec::new();
        let cells = blocks.saturating_mul(rule.earlier());
        ring.try_reserve_exact(cells).map_err(|_| {
            let what = format!(
                "{} sensors times {} values do not fit in memory",
                rule.sensors,
                rule.earlier()
            );
            Refusal::new(what, "n_sensors and window", "make one of them smaller")
        })?;
        ring.resize(cells, Eight::ZERO);
        Ok(Self {
            rule,
            arch: Arch::new(),
            rows: 0,
            slot: 0,
            blocks: vec![Block::new(rule.earlier()); blocks],
            ring,
        })
    }

    /// The same on one of `instructions()`; nothing names the best. Results do not depend on it.
    pub fn with_instructions(self, name: Option<&str>) -> Result<Self, UnknownInstructions> {
        let arch = instructions_named(name)?;
        Ok(Self { arch, ..self })
    }

    /// Rows seen.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Writes the alarms `[sensors]` of one row `[sensors]`; NaN is missing.
    pub fn update(&mut self, row: Array<f64>, alarms: &mut [bool]) -> Result<(), Refusal> {
        let sensors = self.rule.sensors();
        if row.shape != [sensors] {
            return Err(misshapen("row", row.shape, &format!("[{sensors}]")));
        }
        self.advance(row.values, alarms)
    }

    /// Writes the alarms `[n, sensors]` of rows `[n, sensors]`; NaN is missing.
    pub fn update_many(&mut self, rows: Array<f64>, alarms: &mut [bool]) -> Result<(), Refusal> {
        let sensors = self.rule.sensors();
        if rows.shape != [rows.len(), sensors] {
            return Err(misshapen("rows", rows.shape, &format!("[n, {sensors}]")));
        }
        self.advance(rows.values, alarms)
    }

    /// `[sensors]` what the next value must exceed; NaN while the window fills.
    pub fn bound(&self) -> Vec<f64> {
        let (own, others) = self.rule.weights();
        (0..self.rule.sensors())
            .map(|sensor| {
                let at = sensor / WIDTH;
                let (block, lane) = (&self.blocks[at], sensor - self.rule.first(at));
                let moments = &block.moments;
                if block.lacking[lane] > 0 {
                    f64::NAN
                } else if own <= 0.0 {
                    f64::INFINITY
                } else {
                    let reach = (others / own * moments.spread.0[lane]).sqrt();
                    let sum = moments.sum.0[lane] + reach;
                    moments.shift.0[lane] + sum / self.rule.earlier() as f64
                }
            })
            .collect()
    }

    fn advance(&mut self, values: &[f64], alarms: &mut [bool]) -> Result<(), Refusal> {
        if alarms.len() != values.len() {
            let right = format!("[{}], as many as there are values", values.len());
            return Err(misshapen("alarms", &[alarms.len()], &right));
        }
        // A call of more rows than a window has is read only once, beside a copy of the windows.
        let kept = (values.len() > WIDTH * self.ring.len()).then(|| self.clone());
        let pass = Pass {
            checked: kept.is_none(),
            values,
            alarms,
            window: self,
        };
        if pass.window.arch.dispatch(pass) {
            return Ok(());
        }
        if let Some(kept) = kept {
            *self = kept;
        }
        Err(self.infinite(values))
    }

    fn infinite(&self, values: &[f64]) -> Refusal {
        let mut numbered = values.iter().enumerate();
        let beyond = numbered.find(|(_, value)| value.abs() > LARGEST);
        let (at, value) = beyond.unwrap_or((0, &f64::INFINITY));
        let sensors = self.rule.sensors();
        let row = self.rows + (at / sensors) as u64;
        Refusal::new(
            format!("the value is {value:?}"),
            &format!("row {row} of the stream, sensor {}", at % sensors),
            &format!("give numbers within {LARGEST:e} in size, and NaN for a missing value"),
        )
    }
}

fn misshapen(place: &str, shape: &[usize], right: &str) -> Refusal {
    let what = format!("the array has shape {shape:?}");
    Refusal::new(what, place, &format!("its shape must be {right}"))
}
