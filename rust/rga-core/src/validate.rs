//! What users give is checked in full before any step uses it.
//!
//! `arrays` checks single arrays; `structure`, `loads` and `outputs` check what they say together.

pub mod arrays;
pub mod loads;
pub mod outputs;
pub mod structure;
