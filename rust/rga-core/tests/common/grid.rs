//! Roofs: double-layer grids, square on offset square.

use super::Case;

/// Panels of 3 m; the upper layer, node by node along y and then x, comes before the lower one. The
/// roof rests on its edge and carries 10 kN at each upper node.
pub fn roof(panels: usize) -> Case {
    let side = panels + 1;
    let upper = |i: usize, j: usize| i * side + j;
    let lower = |i: usize, j: usize| side * side + i * panels + j;
    let place = |offset: f64, z: f64| {
        move |i: usize, j: usize| [3.0 * (i as f64 + offset), 3.0 * (j as f64 + offset), z]
    };
    let square = |side: usize| (0..side).flat_map(move |i| (0..side).map(move |j| (i, j)));
    let mut nodes: Vec<[f64; 3]> = square(side).map(|(i, j)| place(0.0, 2.0)(i, j)).collect();
    nodes.extend(square(panels).map(|(i, j)| place(0.5, 0.0)(i, j)));
    let mut members = Vec::new();
    let mut join = |from: usize, to: usize| members.push(([from as i64, to as i64], false));
    for (i, j) in square(side) {
        if i < panels {
            join(upper(i, j), upper(i + 1, j));
        }
        if j < panels {
            join(upper(i, j), upper(i, j + 1));
        }
    }
    for (i, j) in square(panels) {
        if i + 1 < panels {
            join(lower(i, j), lower(i + 1, j));
        }
        if j + 1 < panels {
            join(lower(i, j), lower(i, j + 1));
        }
        for corner in [
            upper(i, j),
            upper(i + 1, j),
            upper(i, j + 1),
            upper(i + 1, j + 1),
        ] {
            join(lower(i, j), corner);
        }
    }
    let mut roof = Case::new(&nodes, &members);
    for (i, j) in square(side) {
        if i % panels == 0 || j % panels == 0 {
            roof = roof.fix(upper(i, j), &[2]);
        }
        roof = roof.force(upper(i, j), 2, -1e4);
    }
    let corners = [upper(0, 0), upper(0, panels)];
    roof.fix(corners[0], &[0, 1]).fix(corners[1], &[0])
}
