//! Equilibrium, rigid motion, ties, and inclined supports.

mod common;

use common::*;
use rga_core::Result;

/// Two bays of a space frame with diagonals, skew to all axes.
fn tower() -> Case {
    let square = [[0.0, 0.0], [3.1, 0.2], [3.0, 2.9], [-0.1, 3.0]];
    let nodes: Vec<[f64; 3]> = (0..3)
        .flat_map(|level| {
            square.map(|[x, y]| [x + 0.1 * f64::from(level), y, 2.7 * f64::from(level)])
        })
        .collect();
    let mut members = Vec::new();
    for level in 0..2_i64 {
        for corner in 0..4 {
            let (foot, next) = (4 * level + corner, 4 * level + (corner + 1) % 4);
            members.push(([foot, foot + 4], true));
            members.push(([foot + 4, next + 4], true));
            members.push(([foot, next + 4], false));
        }
    }
    let tower = Case::new(&nodes, &members);
    (0..4).fold(tower, |case, node| case.fix(node, &[0, 1, 2]))
}

#[test]
fn reactions_balance_the_loads() -> Result<()> {
    let mut tower = tower()
        .force(9, 0, 1e4)
        .force(10, 2, -3e4)
        .force(11, 4, 2e3);
    tower = tower.uniform(1, 2, 1.5, 5e3).point(3, 1, 0.7, 4e3);
    tower.strain.fill([2e-4, 1e-4, -1e-4]);
    tower.springs.push(([8, -1], 1, 1e6));
    let nodes = [0, 1, 2, 3, 8];
    let outputs: Vec<Output> = nodes
        .iter()
        .flat_map(|&node| (0..6).map(move |dof| at(REACTION + dof as i64 / 3, node, dof % 3)))
        .collect();
    let found = tower.solve(&outputs)?;
    let unloaded = Case {
        member_loads: Vec::new(),
        ..tower.clone()
    }
    .solve(&outputs)?;
    let mut sums = [[0.0; 6]; 2];
    for (sum, values) in sums.iter_mut().zip([&found, &unloaded]) {
        for (node, r) in nodes.iter().zip(values.chunks(6)) {
            let [x, y, z] = tower.nodes[*node as usize];
            let turned = [
                y * r[2] - z * r[1],
                z * r[0] - x * r[2],
                x * r[1] - y * r[0],
            ];
            for axis in 0..3 {
                sum[axis] += r[axis];
                sum[axis + 3] += r[axis + 3] + turned[axis];
            }
        }
    }
    let [with, without] = sums;
    assert!((without[0] + 1e4).abs() < 1e-6);
    assert!(without[1].abs() < 1e-6);
    assert!((without[2] - 3e4).abs() < 1e-6);
    let [x, y, z] = tower.nodes[10];
    let [_, y9, z9] = tower.nodes[9];
    assert!((without[3] - 3e4 * y).abs() < 1e-5);
    assert!((without[4] - (-z9 * 1e4 - 3e4 * x - 2e3)).abs() < 1e-5);
    assert!((without[5] - y9 * 1e4).abs() < 1e-5);
    let size = (0..3)
        .map(|axis| (with[axis] - without[axis]).powi(2))
        .sum::<f64>();
    // Two member loads, in local axes of two members that are not parallel.
    assert!(size > 0.0 && size.sqrt() <= 7.5e3 + 4e3 + 1e-6 && z > 0.0);
    Ok(())
}

#[test]
fn rigid_motion_costs_no_force() -> Result<()> {
    let mut tower = tower();
    let (shift, turn) = ([0.01, -0.02, 0.03], [1e-3, 2e-3, -3e-3]);
    let moved = |[x, y, z]: [f64; 3]| {
        [
            shift[0] + turn[1] * z - turn[2] * y,
            shift[1] + turn[2] * x - turn[0] * z,
            shift[2] + turn[0] * y - turn[1] * x,
        ]
    };
    for node in 0..4 {
        tower.prescribed[node][..3].copy_from_slice(&moved(tower.nodes[node]));
    }
    let mut outputs: Vec<Output> = (0..3).map(|axis| at(DISPLACEMENT, 11, axis)).collect();
    outputs.extend((0..3).map(|axis| at(ROTATION, 11, axis)));
    outputs.extend((0..24).map(|member| (STRAIN, member, -1, [0.3, 0.0, 0.0])));
    let found = tower.solve(&outputs)?;
    for axis in 0..3 {
        close(found[axis], moved(tower.nodes[11])[axis]);
        close(found[3 + axis], turn[axis]);
    }
    assert!(found[6..].iter().all(|strain| strain.abs() < 1e-14));
    Ok(())
}

#[test]
fn relative_motion_is_a_difference() -> Result<()> {
    let tower = tower().force(9, 0, 1e4);
    let relative = (DISPLACEMENT, 9, 10, [0.6, 0.8, 0.0]);
    let own = (DISPLACEMENT, 9, -1, [0.6, 0.8, 0.0]);
    let other = (DISPLACEMENT, 10, -1, [0.6, 0.8, 0.0]);
    let found = tower.solve(&[relative, own, other])?;
    close(found[0], found[1] - found[2]);
    Ok(())
}

#[test]
fn a_tie_is_a_very_stiff_spring() -> Result<()> {
    let mut tied = tower().force(9, 0, 1e4).force(11, 1, 1e4);
    let mut sprung = tied.clone();
    tied.ties.push(([9, 11], 0));
    sprung.springs.push(([9, 11], 0, 1e13));
    let outputs = [
        at(DISPLACEMENT, 9, 0),
        at(DISPLACEMENT, 11, 0),
        at(REACTION, 0, 2),
    ];
    let (tied, sprung) = (tied.solve(&outputs)?, sprung.solve(&outputs)?);
    assert_eq!(tied[0], tied[1]);
    for (one, other) in tied.iter().zip(&sprung) {
        assert!((one - other).abs() < 1e-5 * other.abs());
    }
    Ok(())
}

#[test]
fn a_node_tied_to_a_support_hands_its_force_over() -> Result<()> {
    let mut bar = Case::new(
        &[[0.0; 3], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        &[([0, 1], false)],
    );
    bar = bar
        .fix(0, &[0, 1, 2])
        .fix(1, &[1, 2])
        .fix(2, &[0, 1, 2])
        .force(1, 0, 5.0);
    bar.ties.push(([2, 1], 0));
    bar.prescribed[2][0] = 1e-3;
    let found = bar.solve(&[
        at(DISPLACEMENT, 1, 0),
        at(REACTION, 2, 0),
        at(REACTION, 0, 0),
    ])?;
    let pull = E * AREA / 2.0 * 1e-3;
    close(found[0], 1e-3);
    close(found[1], pull - 5.0);
    close(found[2], -pull);
    Ok(())
}

#[test]
fn inclined_support_pushes_along_its_normal() -> Result<()> {
    let nodes = [[0.0; 3], [3.0, 0.0, 0.0], [1.0, 2.0, 0.0]];
    let mut truss = Case::new(&nodes, &[([0, 1], false), ([1, 2], false), ([0, 2], false)]);
    for node in 0..3 {
        truss = truss.fix(node, &[2]);
    }
    truss = truss.fix(0, &[0, 1]).force(2, 1, -6e3);
    let normal = [-0.6, 0.8, 0.0];
    truss
        .inclined
        .push((1, normal.map(|value| 5.0 * value), 2e-3));
    let along = (DISPLACEMENT, 1, -1, normal);
    let found = truss.solve(&[along, at(REACTION, 1, 0), at(REACTION, 1, 1)])?;
    close(found[0], 2e-3);
    // Moments about node 0: the support carries 6e3 * 1 / 3 upward.
    close(found[2], 2e3);
    close(found[1], -0.75 * 2e3);
    Ok(())
}

#[test]
fn contradicting_supports_are_refused() {
    let mut bar = Case::new(&[[0.0; 3], [2.0, 0.0, 0.0]], &[([0, 1], false)]);
    bar = bar.fix(0, &[0, 1, 2]).fix(1, &[0, 1, 2]);
    bar.ties.push(([0, 1], 0));
    assert!(bar.solve(&[]).is_ok());
    bar.prescribed[1][0] = 1e-3;
    let error = bar.solve(&[]).map_err(|error| error.to_string());
    assert!(error.is_err_and(|text| text.contains("contradict")));
}
