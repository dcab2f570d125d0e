//! Loads are checked in full against a checked structure.

use crate::error::{DOFS, Error, Result};
use crate::fe::axes::local_axes;
use crate::input::{Loads, Structure};
use crate::validate::arrays::{CheckIndices, CheckNumbers, CheckShape};

pub(crate) fn check_loads(structure: &Structure, loads: &Loads) -> Result<()> {
    let (n, m, k) = (
        structure.node_count(),
        structure.member_count(),
        structure.inclined_node.len(),
    );
    let (p, q) = (loads.pattern_count(), loads.member_pattern.len());
    loads.forces.check_shape("forces", &[p, n, 6])?;
    loads.strain.check_shape("strain", &[p, m, 3])?;
    loads.prescribed.check_shape("prescribed", &[p, n, 6])?;
    loads
        .prescribed_inclined
        .check_shape("prescribed_inclined", &[p, k])?;
    loads.member_pattern.check_shape("member_pattern", &[q])?;
    loads.member_index.check_shape("member_index", &[q])?;
    loads.member_axis.check_shape("member_axis", &[q])?;
    for (name, array) in [
        ("member_from", &loads.member_from),
        ("member_to", &loads.member_to),
        ("member_start", &loads.member_start),
        ("member_end", &loads.member_end),
    ] {
        array.check_shape(name, &[q])?;
        array.check_finite(name)?;
    }
    loads.forces.check_finite("forces")?;
    loads.strain.check_finite("strain")?;
    loads.prescribed.check_finite("prescribed")?;
    loads
        .prescribed_inclined
        .check_finite("prescribed_inclined")?;
    loads.member_pattern.check_range("member_pattern", 0, p)?;
    loads.member_index.check_range("member_index", 0, m)?;
    loads.member_axis.check_range("member_axis", 0, 6)?;
    for pattern in 0..p {
        let free = |&(_, (&value, &fixed)): &(usize, (&f64, &bool))| value != 0.0 && !fixed;
        let values = loads.prescribed.row(pattern).iter();
        if let Some((at, _)) = values.zip(structure.fixed.values).enumerate().find(free) {
            let (node, dof) = (at / 6, at % 6);
            return Err(Error::invalid(format!(
                "prescribed[{pattern}, {node}, {dof}] moves {}, which fixed[{node}, {dof}] leaves free; \
                 only fixed dofs can be moved",
                DOFS[dof]
            )));
        }
    }
    (0..q).try_for_each(|index| check_member_load(structure, loads, index))
}

fn check_member_load(structure: &Structure, loads: &Loads, index: usize) -> Result<()> {
    let member = loads.member_index.at(index);
    let (from, to) = (loads.member_from[index], loads.member_to[index]);
    let length = local_axes(structure, member).map_or(0.0, |(length, _)| length);
    // A load to the very end may overshoot by the rounding of the caller's length.
    if from < 0.0 || to < from || to > length * (1.0 + 1e-9) {
        return Err(Error::invalid(format!(
            "member load {index} runs from {from} to {to}; it must stay in 0..{length} on member {member}"
        )));
    }
    let axis = loads.member_axis[index];
    if axis >= 3 && from != to {
        return Err(Error::invalid(format!(
            "member_axis[{index}] is {axis}, a moment, and spread from {from} to {to}; \
             moments must be point loads (from == to)"
        )));
    }
    if axis == 3 && !structure.frame[member] {
        return Err(Error::invalid(format!(
            "member_axis[{index}] is 3, a torque on truss member {member}; only frame members resist it"
        )));
    }
    Ok(())
}
