//! Input that is refused, and why.

use thiserror::Error;

/// Input that cannot be used: what is wrong, where, and how to mend it.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{what} ({place}): {remedy}")]
pub struct Refusal {
    pub what: String,
    pub place: String,
    pub remedy: String,
}

impl Refusal {
    pub(crate) fn new(what: String, place: &str, remedy: &str) -> Self {
        Self {
            what,
            place: place.into(),
            remedy: remedy.into(),
        }
    }
}
