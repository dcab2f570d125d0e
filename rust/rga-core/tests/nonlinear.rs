//! The equilibrium of the deformed structure: it derives from an energy, and no rotation as a
//! whole costs a frame member tension.

mod common;

use common::*;
use rga_core::{Array, Result, respond_nonlinear};

const MOVES: [i64; 2] = [DISPLACEMENT, ROTATION];

fn solve(case: &Case, outputs: &[Output]) -> Result<Vec<f64>> {
    case.lend(outputs, |structure, loads, outputs| {
        respond_nonlinear(structure, loads, outputs, Array::new(&[1.0], &[1, 1]), 1)
    })
}

/// Three crooked frame members in space with rigid zones, shear, a hinge and a soft joint, and a
/// bar; pushed and loaded along a member.
fn crooked() -> Case {
    let nodes = [[0.0; 3], [0.3, 0.2, 3.0], [3.1, -0.2, 3.4], [3.3, 0.4, 0.0]];
    let members = [
        ([0, 1], true),
        ([1, 2], true),
        ([3, 2], true),
        ([0, 2], false),
    ];
    let mut case = Case::new(&nodes, &members)
        .fix(0, &[0, 1, 2, 3, 4, 5])
        .fix(3, &[0, 1, 2, 3, 5])
        .connect(1, 4, 2e6)
        .connect(1, 11, 0.0)
        .connect(2, 1, 3e7)
        .uniform(1, 2, 2.0, -4e4)
        .force(1, 2, -2e6)
        .force(2, 0, 3e5)
        .force(2, 1, -1e5)
        .force(2, 3, 2e4);
    case.shear_area = 2e-3;
    case.rigid_end = vec![[0.2, 0.1], [0.0, 0.3], [0.1, 0.0], [0.0, 0.0]];
    case.strain[1] = [2e-4, 1e-3, -5e-4];
    case
}

#[test]
fn displacements_answer_each_other_forces() -> Result<()> {
    let loaded: Vec<usize> = (0..6).collect();
    let axis = |dof: usize| {
        let mut direction = [0.0; 3];
        direction[dof % 3] = 1.0;
        direction
    };
    let outputs: Vec<Output> = [1, 2]
        .into_iter()
        .flat_map(|node| loaded.iter().map(move |&dof| (node, dof)))
        .map(|(node, dof)| (MOVES[dof / 3], node, -1, axis(dof)))
        .collect();
    let places: Vec<(usize, usize)> = (0..12).map(|at| (1 + at / 6, at % 6)).collect();
    let step = 5.0;
    let rates: Vec<Vec<f64>> = places
        .iter()
        .map(|&(node, dof)| {
            let ahead = solve(&crooked().force(node, dof, step), &outputs)?;
            let behind = solve(&crooked().force(node, dof, -step), &outputs)?;
            let differences = ahead.iter().zip(&behind);
            Ok(differences.map(|(a, b)| (a - b) / (2.0 * step)).collect())
        })
        .collect::<Result<_>>()?;
    let linear = crooked().solve(&outputs)?;
    let curved = solve(&crooked(), &outputs)?;
    assert!(
        (curved[6] / linear[6] - 1.0).abs() > 0.05,
        "{linear:?} {curved:?}"
    );
    for (a, row) in rates.iter().enumerate() {
        for (b, rate) in row.iter().enumerate() {
            let size = (rates[a][a] * rates[b][b]).sqrt();
            assert!(
                (rate - rates[b][a]).abs() < 1e-7 * size,
                "{a} {b}: {rate} {}",
                rates[b][a]
            );
        }
    }
    Ok(())
}

#[test]
fn a_turn_as_a_whole_costs_no_tension() -> Result<()> {
    let (length, turn) = (4.0, 0.05_f64);
    for rigid in [[0.0, 0.0], [0.5, 0.8]] {
        let mut beam = Case::beam(length)
            .fix(0, &[0, 1, 2, 3, 4, 5])
            .fix(1, &[0, 1, 2, 3, 4, 5]);
        beam.rigid_end = vec![rigid];
        beam.prescribed[0][4] = turn;
        let (along, across) = (length * (turn.cos() - 1.0), -length * turn.sin());
        beam.prescribed[1] = [along, 0.0, across, 0.0, turn, 0.0];
        let tension = solve(&beam, &[(SECTION_FORCE, 0, 0, [0.5, 0.0, 0.0])])?[0];
        // Without its chord, EA turn^2 / 2 would be missed.
        assert!(tension.abs() < 1e-8 * E * AREA, "{tension}");
    }
    Ok(())
}
