//! Stiffness and mass of the unknowns, assembled from those of members, springs and nodes.

use crate::fe::mass::for_each_mass;
use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::input::Masses;
use crate::sparse::lower_triangle::LowerTriangle;

/// T' (K - shift M) T
pub(crate) fn assemble_shifted(
    model: &Model,
    reduction: &Reduction,
    masses: &Masses,
    shift: f64,
) -> LowerTriangle {
    LowerTriangle::sum(reduction.unknowns.len(), |add| {
        model.for_each_stiffness(|row, column, value| {
            reduction.pass_on((row, column, value), &mut *add);
        });
        for_each_mass(model, masses, |row, column, value| {
            reduction.pass_on((row, column, -shift * value), &mut *add);
        });
    })
}

/// T' M T
pub(crate) fn assemble_mass(
    model: &Model,
    reduction: &Reduction,
    masses: &Masses,
) -> LowerTriangle {
    LowerTriangle::sum(reduction.unknowns.len(), |add| {
        for_each_mass(model, masses, |row, column, value| {
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
