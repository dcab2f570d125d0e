//! Numbers side by side in the vectors of a processor: what `rga-core` and `rga-detect` share.
//!
//! `f64` has lanes of double precision, one for each sample or sensor; `f32` has sixteen numbers
//! of single precision. `instructions` names the instruction sets that a processor has, and
//! `array` is a view of rows of numbers. On all instruction sets results have the same bits.

#![warn(unreachable_pub)]

mod array;
pub mod f32;
pub mod f64;
mod instructions;

pub use array::Array;
pub use instructions::{UnknownInstructions, instructions, instructions_named};
