//! Outputs are checked in full against a checked structure.

use crate::error::{Error, Result};
use crate::input::{OutputKind, Outputs, Structure};
use crate::validate::arrays::{CheckIndices, CheckNumbers, CheckShape, positive};

pub(crate) fn check_outputs(structure: &Structure, outputs: &Outputs) -> Result<()> {
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
    outputs.kind.check_range("kind", 0, OutputKind::ALL.len())?;
    outputs.vector.check_finite("vector")?;
    let kinds: Vec<OutputKind> = outputs.kinds().collect();
    for (at, &kind) in kinds.iter().enumerate() {
        let member = kind.reads_member();
        let end = if member { m } else { n };
        if !(0..end as i64).contains(&outputs.index[at]) {
            let what = if member { "member" } else { "node" };
            return Err(Error::invalid(format!(
                "index[{at}] is {}; it must be a {what}, at least 0 and below {end}",
                outputs.index[at]
            )));
        }
        let (low, end) = match kind {
            OutputKind::Displacement | OutputKind::Rotation => (-1, n as i64),
            OutputKind::SectionForce => (0, 6),
            OutputKind::EndForce => (0, 12),
            _ => continue,
        };
        if !(low..end).contains(&outputs.other[at]) {
            return Err(Error::invalid(format!(
                "other[{at}] is {}; for kind {} it must be at least {low} and below {end}",
                outputs.other[at], kind as i64
            )));
        }
    }
    for (at, &kind) in kinds.iter().enumerate() {
        if matches!(kind, OutputKind::Strain | OutputKind::SectionForce) {
            check_section(structure, outputs, at, kind)?;
        }
    }
    Ok(())
}

fn check_section(
    structure: &Structure,
    outputs: &Outputs,
    at: usize,
    kind: OutputKind,
) -> Result<()> {
    let member = outputs.index.at(at);
    let vector = outputs.vector.row(at);
    if !(0.0..=1.0).contains(&vector[0]) {
        return Err(Error::invalid(format!(
            "vector[{at}, 0] is {}; the place along a member must lie in 0..1",
            vector[0]
        )));
    }
    if kind == OutputKind::SectionForce || !structure.frame[member] {
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
