//! What moves where nothing holds it, by name.

use crate::error::Error;

/// Among motions within this part of the largest, the first dof is named.
const AS_LARGE: f64 = 1.0 - 1e-6;

/// Where a motion is largest; `arm` makes rotations count as translations.
pub(crate) fn mechanism(displacements: &[f64], arm: f64) -> Error {
    let size = |dof: usize| {
        let lever = if dof % 6 < 3 { 1.0 } else { arm };
        displacements[dof].abs() * lever
    };
    let dofs = displacements.len();
    let most = (0..dofs).map(size).fold(0.0, f64::max);
    let worst = (0..dofs)
        .find(|&dof| size(dof) >= AS_LARGE * most)
        .unwrap_or(0);
    let node = worst / 6;
    let mut direction = [0.0; 6];
    direction.copy_from_slice(&displacements[6 * node..6 * node + 6]);
    let norm = direction
        .iter()
        .map(|value| value * value)
        .sum::<f64>()
        .sqrt();
    if norm > 0.0 {
        // The sign is free: the named dof moves forward.
        let norm = norm.copysign(direction[worst % 6]);
        direction.iter_mut().for_each(|value| *value /= norm);
    }
    Error::UnstableStructure {
        node,
        dof: worst % 6,
        direction,
    }
}
