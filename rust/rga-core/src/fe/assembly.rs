//! The stiffness of the unknowns, assembled from that of members and springs.

use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::sparse::lower_triangle::LowerTriangle;

/// T' K T
pub(crate) fn assemble(model: &Model, reduction: &Reduction) -> LowerTriangle {
    LowerTriangle::sum(reduction.unknowns.len(), |add| {
        model.for_each_stiffness(|row, column, value| {
            if value == 0.0 {
                return;
            }
            for &(i, left) in reduction.entries(row) {
                for &(j, right) in reduction.entries(column) {
                    if i >= j {
                        add(i, j, left * value * right);
                    }
                }
            }
        });
    })
}
