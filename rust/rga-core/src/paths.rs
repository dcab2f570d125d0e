//! Paths from a structure and its loads to outputs: which one is quickest depends on what varies.
//!
//! - `linear`: one structure, many load patterns.
//! - `modes`: natural frequencies and mode shapes of one structure.
//! - `condensation`: a structure condensed onto few stiffnesses that vary, or none; `condensed` are
//!   its samples.
//! - `reanalysis`: structures near one that is solved.
//! - `batch`: many samples of which every stiffness may vary.
//! - `nonlinear`: many samples, each in the equilibrium of the deformed structure.
//! - `unilateral`: members and springs with slack, play or a stop.
//! - `friction`: bearings that stick and slide, through time.
//!
//! Stiffnesses that vary are terms of rank one (`rank_one_terms`). Samples are differentiated along `directions`, and rows are shared among threads (`parallel`).

pub(crate) mod batch;
pub(crate) mod condensation;
pub(crate) mod condensed;
pub(crate) mod directions;
pub(crate) mod friction;
pub(crate) mod linear;
pub(crate) mod modes;
pub(crate) mod nonlinear;
mod parallel;
pub(crate) mod rank_one_terms;
pub(crate) mod reanalysis;
pub(crate) mod unilateral;
