//! What users give is checked in full before any step uses it.
//!
//! `arrays` checks single arrays; `structure`, `loads` and `outputs` check what they say together.

pub(crate) mod arrays;
pub(crate) mod loads;
pub(crate) mod outputs;
pub(crate) mod structure;
