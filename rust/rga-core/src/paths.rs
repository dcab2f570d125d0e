//! Paths from a structure and its loads to outputs: which one is quickest depends on what varies.
//!
//! - `linear`: one structure, many load patterns.
//! - `condensed`: many samples of which few stiffnesses vary, or none.
//! - `batch`: many samples of which every stiffness may vary.
//! - `nonlinear`: many samples, each in the equilibrium of the deformed structure.
//! - `friction`: bearings that stick and slide, through time.
//!
//! Samples are differentiated along `directions`, and rows are shared among threads (`parallel`).

pub(crate) mod batch;
pub(crate) mod condensed;
pub(crate) mod directions;
pub(crate) mod friction;
pub(crate) mod linear;
pub(crate) mod nonlinear;
mod parallel;
