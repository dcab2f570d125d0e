//! What users give is checked in full before any step uses it.
//!
//! `arrays` checks single arrays; `structure`, `loads`, `masses` and `outputs` check what they say
//! together.

pub(crate) mod arrays;
pub(crate) mod loads;
pub(crate) mod masses;
pub(crate) mod outputs;
pub(crate) mod structure;
