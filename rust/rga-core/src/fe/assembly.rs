//! Stiffness and mass of the unknowns, assembled from those of members, springs and nodes.

use crate::fe::mass::ElementMasses;
use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::sparse::lower_triangle::LowerTriangle;

/// T' M T
pub(crate) fn assemble_mass(reduction: &Reduction, masses: &ElementMasses) -> LowerTriangle {
    LowerTriangle::sum(reduction.unknowns.len(), |add| {
        masses.for_each(|row, column, value| {
            reduction.pass_on((row, column, value), &mut *add);
        });
    })
}

/// T' K T
pub(crate) fn assemble(model: &Model, reduction: &Reduction) -> LowerTriangle {
    LowerTriangle::sum(reduction.unknowns.len(), |add| {
        model.for_each_stiffness(|row, column, value| {
            reduction.pass_on((row, column, value), &mut *add);
        });
    })
}
