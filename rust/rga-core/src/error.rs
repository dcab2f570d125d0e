//! What can go wrong, in words a user can act on.

use rga_simd::UnknownInstructions;
use thiserror::Error;

pub type Result<T> = std::result::Result<T, Error>;

/// Names of the dofs of a node, in their order.
pub(crate) const DOFS: [&str; 6] = ["ux", "uy", "uz", "rx", "ry", "rz"];

#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    #[error("{0}")]
    InvalidInput(String),

    /// `direction` is the motion of `node` in the null vector, normalised.
    #[error(
        "the structure is unstable: nothing holds node {node} in {name}; \
         add a support, a member or a spring there",
        name = DOFS[*dof]
    )]
    UnstableStructure {
        node: usize,
        dof: usize,
        direction: [f64; 6],
    },

    /// `share` of the load is carried; `direction` as above.
    #[error(
        "the structure buckles or snaps through: beyond {share:.4} of the load no stable \
         equilibrium is reached, node {node} gives way in {name}; lower the load or stiffen the \
         structure there",
        name = DOFS[*dof]
    )]
    Buckled {
        share: f64,
        node: usize,
        dof: usize,
        direction: [f64; 6],
    },

    #[error("the stiffnesses of row {row} leave no stable structure; keep them above zero")]
    UnstableSample { row: usize },

    #[error(
        "the elongations of the members and springs that vary depend on each other, or are \
         prescribed; solve the structure anew"
    )]
    DependentTerms,

    #[error("row {row}: {error}")]
    Row { row: usize, error: Box<Error> },

    #[error(
        "friction at row {row} does not settle: reduce mu or the influence of friction on the \
         normal forces (normal_influence)"
    )]
    NotConverged { row: usize },
}

impl Error {
    pub(crate) fn invalid(message: impl Into<String>) -> Self {
        Self::InvalidInput(message.into())
    }

    pub(crate) fn of_row(self, row: usize) -> Self {
        Self::Row {
            row,
            error: Box::new(self),
        }
    }
}

impl From<UnknownInstructions> for Error {
    fn from(error: UnknownInstructions) -> Self {
        Self::invalid(error.to_string())
    }
}
