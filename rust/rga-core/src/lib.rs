//! Static and modal analysis of three-dimensional truss and frame structures.
//!
//! Every node has six degrees of freedom (dofs) in the order
//! ux uy uz rx ry rz. The tree, from the ground up:
//!
//! - `input`: the arrays that describe a structure, its loads and the wanted outputs; `error`:
//!   what can go wrong with them.
//! - `sparse`: symmetric matrices and their factors; knows nothing of structures.
//! - `fe`: finite elements, from the arrays to a balanced state and its outputs.
//! - `validate`: checks of the arrays, before any step uses them.
//! - `paths`: the analyses: linear, modes, condensed, batch, nonlinear, unilateral, and friction.
//!
//! SIMD lanes and the view of arrays are those of `rga_simd`.

#![warn(unreachable_pub)]

mod error;
mod fe;
mod input;
mod paths;
mod sparse;
mod validate;

pub use rga_simd::{Array, instructions};

pub use error::{Error, Result};
pub use input::{Loads, Masses, OutputKind, Outputs, Structure};
pub use paths::batch::modal::ModalBatch;
pub use paths::batch::{BatchSolver, Samples};
pub use paths::condensation::{Condensation, UnitResponses};
pub use paths::condensed::Condensed;
pub use paths::directions::Directions;
pub use paths::friction::{Bearings, slide};
pub use paths::linear::respond;
pub use paths::modes::{ModalEnergies, ModalReanalysis, Modes, modal_energies, modes};
pub use paths::nonlinear::respond_nonlinear;
pub use paths::rank_one_terms::{Varied, count_terms};
pub use paths::reanalysis::{Loaded, Reanalysis, StiffnessDifference};
pub use paths::unilateral::{Laws, pseudo_forces};
pub use sparse::lower_triangle::LowerTriangle;
pub use sparse::ordering::fill_reducing;
