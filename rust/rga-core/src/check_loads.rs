//! Loads and outputs are checked in full against a checked structure.

use crate::axes::local_axes;
use crate::check::{CheckIndices, CheckNumbers, CheckShape, positive};
use crate::error::{DOFS, Error, Result};
use crate::input::{Loads, Outputs, Structure};

pub fn check_loads(structure: &Structure, loads: &Loads) -> Result<()> {
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

pub fn check_outputs(structure: &Structure, outputs: &Outputs) -> Result<()> {
    let (n, m, o) = (
        structure.node_count(),
        structure.member_count(),
        outputs.kind.len(),
    );
    outputs.kind.check_shape("kind", &[o])?;
    outputs.index.check_shape("index", &[o])?;
    outputs.other.check_shape("other", &[o])?;
    outputs.vector.check_shape("vector", &[o, 3])?;
    outputs.total.check_shape("total", &[o])?;
    outputs.kind.check_range("kind", 0, 7)?;
    outputs.vector.check_finite("vector")?;
    for at in 0..o {
        let kind = outputs.kind[at];
        let member = matches!(kind, 2 | 3 | 6);
        let end = if member { m } else { n };
        if !(0..end as i64).contains(&outputs.index[at]) {
            let what = if member { "member" } else { "node" };
            return Err(Error::invalid(format!(
                "index[{at}] is {}; it must be a {what}, at least 0 and below {end}",
                outputs.index[at]
            )));
        }
        let (low, end) = match kind {
            0 | 1 => (-1, n as i64),
            6 => (0, 12),
            _ => continue,
        };
        if !(low..end).contains(&outputs.other[at]) {
            return Err(Error::invalid(format!(
                "other[{at}] is {}; for kind {kind} it must be at least {low} and below {end}",
                outputs.other[at]
            )));
        }
    }
    for at in (0..o).filter(|&at| matches!(outputs.kind[at], 2 | 3)) {
        check_section(structure, outputs, at)?;
    }
    Ok(())
}

fn check_section(structure: &Structure, outputs: &Outputs, at: usize) -> Result<()> {
    let member = outputs.index.at(at);
    let vector = outputs.vector.row(at);
    if !(0.0..=1.0).contains(&vector[0]) {
        return Err(Error::invalid(format!(
            "vector[{at}, 0] is {}; the place along a member must lie in 0..1",
            vector[0]
        )));
    }
    if outputs.kind[at] == 3 || !structure.frame[member] {
        return Ok(());
    }
    for (name, array, needed) in [
        ("A", &structure.area, true),
        ("Iz", &structure.iz, vector[1] != 0.0),
        ("Iy", &structure.iy, vector[2] != 0.0),
    ] {
        if needed {
            array.check_member(name, member, "positive where a strain is read", positive)?;
        }
    }
    Ok(())
}
