//! Linear static analysis of three-dimensional truss and frame structures.
//!
//! Every node has six degrees of freedom (dofs) in the order
//! ux uy uz rx ry rz. The flow is one file a step: arrays are checked
//! (`input`, `check*`), members get their stiffness (`axes`, `element`,
//! `connection`, `member`) and their fixed-end forces (`load`), supports and
//! ties reduce the dofs (`constraint`), the reduced matrix is assembled
//! (`model`, `reduction`, `assembly`) and factorised (`solve`, `stability`), and the outputs are
//! read off the solution (`observe`). `respond` runs the steps;
//! `friction` follows bearings through time.
//!
//! `gaussian_window` stands on its own: it watches what sensors send.

mod assembly;
mod axes;
mod check;
mod check_loads;
mod check_structure;
mod connection;
mod constraint;
mod element;
mod error;
mod friction;
mod gaussian_window;
mod input;
mod load;
mod member;
mod model;
mod observe;
mod reduction;
mod respond;
mod solve;
mod stability;

pub use error::{Error, Result};
pub use friction::{Bearings, slide};
pub use gaussian_window::{GaussianWindow, Refusal, WindowRule};
pub use input::{Array, Loads, Outputs, Structure};
pub use respond::respond;
