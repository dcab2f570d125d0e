//! Energies of elements in modes: the derivatives of the eigenvalues.
//!
//! With a modal mass of one, the derivative of an eigenvalue is that of stiffness and mass between
//! its own shape: phi' (dK - l dM) phi (Fox and Kapoor, Rates of change of eigenvalues and
//! eigenvectors, AIAA Journal 6, 1968). No solve is needed.

use crate::error::{Error, Result};
use crate::fe::mass::ElementMasses;
use crate::fe::model::Model;
use crate::input::{Masses, Structure};
use crate::validate::masses::check_masses;
use crate::validate::structure::check_structure;

/// Of every mode, what each element has a part in.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalEnergies {
    /// `[modes, m + s]` phi' K phi of members, then springs: derivatives of an eigenvalue by the
    /// logarithm of their stiffness.
    pub strain: Vec<f64>,
    /// `[modes, m + n]` phi' M phi of members, then of masses on nodes: an eigenvalue times these
    /// is what it loses by the logarithm of their mass.
    pub kinetic: Vec<f64>,
}

/// Those of shapes `[modes, n, 6]`.
pub fn modal_energies(
    structure: &Structure,
    masses: &Masses,
    shapes: &[f64],
) -> Result<ModalEnergies> {
    check_structure(structure)?;
    check_masses(structure, masses)?;
    let model = Model::new(structure)?;
    if model.dofs == 0 || !shapes.len().is_multiple_of(model.dofs) {
        return Err(Error::invalid("shapes must have 6 numbers for each node"));
    }
    if !shapes.iter().all(|motion| motion.is_finite()) {
        return Err(Error::invalid("shapes must be finite"));
    }
    let own = ElementMasses::new(&model, masses);
    let each = shapes.chunks_exact(model.dofs);
    Ok(ModalEnergies {
        strain: each
            .clone()
            .flat_map(|shape| model.energies(shape))
            .collect(),
        kinetic: each.flat_map(|shape| own.kinetic_energies(shape)).collect(),
    })
}
