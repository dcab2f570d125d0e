//! Masses are checked in full against a checked structure.

use crate::error::Result;
use crate::input::{Masses, Structure};
use crate::validate::arrays::{CheckNumbers, CheckShape};

pub(crate) fn check_masses(structure: &Structure, masses: &Masses) -> Result<()> {
    let (n, m) = (structure.node_count(), structure.member_count());
    masses.line.check_shape("line mass", &[m])?;
    masses.section.check_shape("section mass", &[m, 3])?;
    masses.nodal.check_shape("nodal mass", &[n, 6])?;
    for (name, array) in [
        ("line mass", &masses.line),
        ("section mass", &masses.section),
        ("nodal mass", &masses.nodal),
    ] {
        array.check_finite(name)?;
    }
    Ok(())
}
