//! Detectors that watch a stream of readings, row by row, whatever the readings are of.
//!
//! `window` is the paper's rule: a Gaussian bound on each sensor's next value. `change` weighs
//! every kind and scale of change. `refusal` says what is wrong with input that cannot be used.

#![warn(unreachable_pub)]

mod change;
mod refusal;
mod window;

pub use rga_simd::{Array, UnknownInstructions, instructions};

pub use change::{Alarm, ChangeStatistics, Reference, ReferenceArrays, STATISTICS, innovations};
pub use refusal::Refusal;
pub use window::{GaussianWindow, WindowRule};
