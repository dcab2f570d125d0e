//! Linear static analysis of three-dimensional truss and frame structures.
//!
//! Every node has six degrees of freedom (dofs) in the order
//! ux uy uz rx ry rz. The flow is one file a step: arrays are checked
//! (`input`, `check*`), members get their stiffness (`axes`, `element`,
//! `connection`, `member`) and their fixed-end forces (`load`), supports and
//! ties reduce the dofs (`constraint`), the reduced matrix is assembled
//! (`model`, `reduction`, `assembly`, `turning`) and factorised (`solve`, `stability`, `softening`), and the outputs are
//! read off the balanced solution (`equilibrium`, `observe`). `respond` runs
//! the steps; `friction` follows bearings through time.
//!
//! Large matrices are eliminated in an order that keeps their factor small (`ordering`, `graph`,
//! `dissection`), dense front by dense front (`supernodes`, `multifrontal`).
//!
//! `refactor` repeats an analysis for samples of which every stiffness may
//! vary: the structure is read off its elements as sums over their factors
//! (`system`, `bilinear`), samples are factorised side by side in the lanes
//! of SIMD vectors (`rga_simd`), and rows are shared among threads (`parallel`).
//!
//! `condensed` repeats an analysis for many samples of which few
//! stiffnesses, or none, vary.
//!
//! `nonlinear` finds the equilibrium of the deformed structure, sample by sample, from members
//! that are `deformed`: loads are combined (`combination`), and tangents go where they belong in
//! the matrix (`scatter`).

mod assembly;
mod axes;
mod bilinear;
mod check;
mod check_loads;
mod check_structure;
mod combination;
mod condensed;
mod connection;
mod constraint;
mod deformed;
mod directions;
mod dissection;
mod element;
mod equilibrium;
mod error;
mod friction;
mod graph;
mod input;
mod load;
mod member;
mod model;
mod multifrontal;
mod nonlinear;
mod observe;
mod ordering;
mod parallel;
mod reduction;
mod refactor;
mod respond;
mod scatter;
mod softening;
mod solve;
mod stability;
mod supernodes;
mod system;
mod turning;

pub use rga_simd::{Array, instructions};

pub use assembly::LowerTriangle;
pub use condensed::Condensed;
pub use directions::Directions;
pub use error::{Error, Result};
pub use friction::{Bearings, slide};
pub use input::{Loads, Outputs, Structure};
pub use nonlinear::respond_nonlinear;
pub use ordering::fill_reducing;
pub use refactor::{Refactored, Samples};
pub use respond::respond;
