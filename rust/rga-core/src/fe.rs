//! Finite elements: from the arrays of a structure to outputs.
//!
//! Members get their stiffness (`axes`, `element`, `connection`, `member`) and their fixed-end
//! forces (`load`), and make the `model` with springs. Supports and ties leave the unknowns
//! (`constraint`, `reduction`), whose stiffness is assembled (`assembly`). Rotations that nothing
//! stiffens are held (`free_rotations`), and structures that move freely are refused with the
//! motion's node (`stability`, `mechanism`): `sparse` knows matrices alone. A state is balanced
//! (`equilibrium`), and outputs are read off it (`outputs`). `deformed_member` is a member under
//! large displacements, and `mass` what members and nodes weigh in motion.

pub(crate) mod assembly;
pub(crate) mod axes;
pub(crate) mod connection;
pub(crate) mod constraint;
pub(crate) mod deformed_member;
pub(crate) mod element;
pub(crate) mod equilibrium;
pub(crate) mod free_rotations;
pub(crate) mod load;
pub(crate) mod mass;
pub(crate) mod mechanism;
pub(crate) mod member;
pub(crate) mod model;
pub(crate) mod outputs;
pub(crate) mod reduction;
pub(crate) mod stability;
