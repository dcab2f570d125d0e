//! How a window judges.

use super::LARGEST;
use super::tile::{Part, WIDTH};
use crate::refusal::Refusal;

/// Counts are signed, so that a negative one is refused in words.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowRule {
    pub sensors: i64,
    /// W
    pub window: i64,
    pub z: f64,
    /// The window of W values holds the value under test.
    pub inclusive: bool,
    /// (k, n): an alarm is k of the last n tested values.
    pub persistence: (i64, i64),
    /// A value that exceeds does not enter the window.
    pub frozen: bool,
}

impl WindowRule {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let (k, n) = self.persistence;
        if self.sensors < 1 {
            let what = format!("{} sensors", self.sensors);
            return Err(Refusal::new(what, "n_sensors", "give 1 or more"));
        }
        if self.window < 2 {
            let what = format!("a window of {} values", self.window);
            return Err(Refusal::new(what, "window", "give 2 or more"));
        }
        if !(0.0..=LARGEST.sqrt()).contains(&self.z) {
            let what = format!("z is {}", self.z);
            let remedy = "give a number from 0 on, such as 3";
            return Err(Refusal::new(what, "z", remedy));
        }
        if !(1 <= k && k <= n && n <= 64) {
            let what = format!("persistence is ({k}, {n})");
            let remedy = "give (k, n) with 1 <= k <= n <= 64: k of the last n values";
            return Err(Refusal::new(what, "persistence", remedy));
        }
        Ok(())
    }

    pub(super) fn sensors(&self) -> usize {
        self.sensors as usize
    }

    /// The first sensor of a block: the last block overlaps another, so that its lanes are full.
    pub(super) fn first(&self, block: usize) -> usize {
        (block * WIDTH).min(self.sensors().saturating_sub(WIDTH))
    }

    pub(super) fn part(&self, block: usize) -> Part {
        Part {
            block,
            first: self.first(block),
        }
    }

    /// M, the number of values before the one under test.
    pub(super) fn earlier(&self) -> usize {
        (self.window - i64::from(self.inclusive)) as usize
    }

    /// Weights of r^2 and of M Q - S^2 in the comparison.
    pub(super) fn weights(&self) -> (f64, f64) {
        let variance = self.z * self.z;
        if self.inclusive {
            let earlier = self.earlier() as f64;
            (earlier - variance, variance * (earlier + 1.0))
        } else {
            (1.0, variance)
        }
    }
}
