//! Masses of the cases.

use rga_core::{Array, Masses, Structure};

use super::Case;

/// What `does` makes of a case with `line` kg/m along every member and masses on nodes.
pub fn with_masses<T>(
    case: &Case,
    line: f64,
    nodal: &[(usize, [f64; 6])],
    does: impl FnOnce(&Structure, &Masses) -> T,
) -> T {
    let (n, m) = (case.nodes.len(), case.ends.len());
    let (line, section) = (vec![line; m], vec![0.0; 3 * m]);
    let mut masses = vec![0.0; 6 * n];
    for (node, mass) in nodal {
        masses[6 * node..6 * node + 6].copy_from_slice(mass);
    }
    let (members, sections, nodes) = ([m], [m, 3], [n, 6]);
    let masses = Masses {
        line: Array::new(&line, &members),
        section: Array::new(&section, &sections),
        nodal: Array::new(&masses, &nodes),
    };
    case.lend(&[], |structure, _, _| does(structure, &masses))
}

/// The same along all three axes.
pub fn mass(mass: f64) -> [f64; 6] {
    [mass, mass, mass, 0.0, 0.0, 0.0]
}
