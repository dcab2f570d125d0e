//! Finite elements: from the arrays of a structure to outputs.
//!
//! Members get their stiffness (`axes`, `element`, `connection`, `member`) and their fixed-end
//! forces (`load`), and make the `model` with springs. Supports and ties leave the unknowns
//! (`constraint`, `reduction`), whose stiffness is assembled (`assembly`). Rotations that nothing
//! stiffens are held (`free_rotations`), and structures that move freely are refused with the
//! motion's node (`stability`): `sparse` knows matrices alone. A state is balanced
//! (`equilibrium`), and outputs are read off it (`outputs`). `deformed_member` is a member under
//! large displacements.

pub mod assembly;
pub mod axes;
pub mod connection;
pub mod constraint;
pub mod deformed_member;
pub mod element;
pub mod equilibrium;
pub mod free_rotations;
pub mod load;
pub mod member;
pub mod model;
pub mod outputs;
pub mod reduction;
pub mod stability;
