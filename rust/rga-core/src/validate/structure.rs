//! A structure is checked in full before any step uses it.

use crate::error::{Error, Result};
use crate::fe::axes::local_axes;
use crate::input::Structure;
use crate::validate::arrays::{CheckIndices, CheckNumbers, CheckShape, not_negative, positive};

pub(crate) fn check_structure(structure: &Structure) -> Result<()> {
    let (n, m) = (structure.node_count(), structure.member_count());
    let (k, s, t) = (
        structure.inclined_node.len(),
        structure.spring_node.len(),
        structure.tie_node.len(),
    );
    structure.coordinates.check_shape("coordinates", &[n, 3])?;
    structure.ends.check_shape("ends", &[m, 2])?;
    structure.frame.check_shape("frame", &[m])?;
    for (name, array) in [
        ("E", &structure.young),
        ("G", &structure.shear),
        ("A", &structure.area),
        ("Iy", &structure.iy),
        ("Iz", &structure.iz),
        ("J", &structure.torsion),
        ("Asy", &structure.shear_area_y),
        ("Asz", &structure.shear_area_z),
    ] {
        array.check_shape(name, &[m])?;
    }
    structure.local_y.check_shape("local_y", &[m, 3])?;
    structure.connection.check_shape("connection", &[m, 12])?;
    structure.rigid_end.check_shape("rigid_end", &[m, 2])?;
    structure.fixed.check_shape("fixed", &[n, 6])?;
    structure.inclined_node.check_shape("inclined_node", &[k])?;
    structure
        .inclined_direction
        .check_shape("inclined_direction", &[k, 3])?;
    structure.spring_node.check_shape("spring_node", &[s, 2])?;
    structure.spring_dof.check_shape("spring_dof", &[s])?;
    structure
        .spring_stiffness
        .check_shape("spring_stiffness", &[s])?;
    structure.tie_node.check_shape("tie_node", &[t, 2])?;
    structure.tie_dof.check_shape("tie_dof", &[t])?;

    structure.coordinates.check_finite("coordinates")?;
    structure.ends.check_range("ends", 0, n)?;
    for member in 0..m {
        check_member(structure, member)?;
    }
    structure.inclined_node.check_range("inclined_node", 0, n)?;
    structure
        .inclined_direction
        .check_finite("inclined_direction")?;
    for index in 0..k {
        if structure.inclined_direction.row(index) == [0.0; 3] {
            return Err(Error::invalid(format!(
                "inclined_direction[{index}] is zero; it must be a direction"
            )));
        }
    }
    structure.spring_dof.check_range("spring_dof", 0, 6)?;
    structure.spring_stiffness.check_each(
        "spring_stiffness",
        "finite and not negative",
        not_negative,
    )?;
    structure.spring_node.check_range("spring_node", -1, n)?;
    for index in 0..s {
        let ends = structure.spring_node.row(index);
        if ends[0] < 0 || ends[0] == ends[1] {
            return Err(Error::invalid(format!(
                "spring_node[{index}] is {ends:?}; it must be two different nodes, or a node and -1"
            )));
        }
    }
    structure.tie_dof.check_range("tie_dof", 0, 6)?;
    structure.tie_node.check_range("tie_node", 0, n)?;
    for index in 0..t {
        let ends = structure.tie_node.row(index);
        if ends[0] == ends[1] {
            return Err(Error::invalid(format!(
                "tie_node[{index}] is {ends:?}; it must be two different nodes"
            )));
        }
    }
    Ok(())
}

fn check_member(structure: &Structure, member: usize) -> Result<()> {
    structure
        .young
        .check_member("E", member, "positive", positive)?;
    structure
        .area
        .check_member("A", member, "finite and not negative", not_negative)?;
    if local_axes(structure, member).is_none() {
        return Err(Error::invalid(format!(
            "member {member} has no local axes: its nodes (ends[{member}] is {:?}) must be apart, \
             and local_y[{member}] must be NaN or a direction across the member",
            structure.ends.row(member)
        )));
    }
    if !structure.frame[member] {
        return Ok(());
    }
    for (name, array) in [
        ("G", &structure.shear),
        ("Iy", &structure.iy),
        ("Iz", &structure.iz),
        ("J", &structure.torsion),
    ] {
        array.check_member(name, member, "finite and not negative", not_negative)?;
    }
    for (name, array) in [
        ("Asy", &structure.shear_area_y),
        ("Asz", &structure.shear_area_z),
    ] {
        array.check_member(
            name,
            member,
            "positive, or inf for Euler-Bernoulli",
            |value| value > 0.0,
        )?;
        if array[member].is_finite() && structure.shear[member] == 0.0 {
            return Err(Error::invalid(format!(
                "G[{member}] is 0 and {name}[{member}] is finite; a Timoshenko member needs a positive G"
            )));
        }
    }
    for (dof, &stiffness) in structure.connection.row(member).iter().enumerate() {
        if stiffness.is_nan() || stiffness < 0.0 {
            return Err(Error::invalid(format!(
                "connection[{member}, {dof}] is {stiffness}; it must be inf (rigid), 0 (released) or a stiffness"
            )));
        }
    }
    let rigid = structure.rigid_end.row(member);
    let length = local_axes(structure, member).map_or(0.0, |(length, _)| length);
    if !rigid.iter().all(|&zone| not_negative(zone)) || rigid[0] + rigid[1] >= length {
        return Err(Error::invalid(format!(
            "rigid_end[{member}] is {rigid:?}; both must be 0 or more, and together below the length {length}"
        )));
    }
    Ok(())
}
