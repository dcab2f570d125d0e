//! Sparse symmetric matrices: their Cholesky factors, and nothing about structures.
//!
//! A matrix (`lower_triangle`) is eliminated in an order that keeps its factor small (`ordering`,
//! of `minimum_degree` and of nested `dissection` of its `graph`). A small one is factorised
//! column by column, a large one dense front by dense front (`supernodes`, `multifrontal`);
//! `factor` chooses, and solves. `inverse_iteration` finds the motion that a matrix resists
//! least, `lanczos` those that a second matrix sets against it, and `inertia` counts them.

pub(crate) mod dissection;
pub(crate) mod factor;
pub(crate) mod graph;
pub(crate) mod inertia;
pub(crate) mod inverse_iteration;
pub(crate) mod lanczos;
pub(crate) mod lower_triangle;
pub(crate) mod minimum_degree;
pub(crate) mod multifrontal;
pub(crate) mod ordering;
pub(crate) mod supernodes;
