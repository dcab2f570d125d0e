//! Local axes of a member.

use nalgebra::{Matrix3, Vector3};

use crate::input::Structure;

/// Length and local axes (rows x, y, z in global components), or nothing
/// where the member has no length or `local_y` lies along it.
///
/// x runs from the first node to the second. Without a `local_y`, y is
/// global z cross x (horizontal), and global y for a vertical member.
/// z = x cross y, and y is re-orthogonalised.
pub(crate) fn local_axes(structure: &Structure, member: usize) -> Option<(f64, Matrix3<f64>)> {
    let point = |end: usize| {
        let node = structure.ends.row(member)[end] as usize;
        Vector3::from_column_slice(structure.coordinates.row(node))
    };
    let along = point(1) - point(0);
    let length = along.norm();
    if !(length.is_finite() && length > 0.0) {
        return None;
    }
    let x = along / length;
    let given = Vector3::from_column_slice(structure.local_y.row(member));
    let y = if given.iter().all(|value| value.is_nan()) {
        let horizontal = Vector3::new(-x.y, x.x, 0.0);
        if horizontal.norm() > 1e-9 {
            horizontal
        } else {
            Vector3::y()
        }
    } else {
        given
    };
    let z = x.cross(&y.try_normalize(0.0)?);
    if !z.iter().all(|value| value.is_finite()) {
        return None;
    }
    let z = z.try_normalize(1e-9)?;
    let y = z.cross(&x);
    Some((
        length,
        Matrix3::from_rows(&[x.transpose(), y.transpose(), z.transpose()]),
    ))
}
