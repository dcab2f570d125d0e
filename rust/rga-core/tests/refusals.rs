//! Unstable structures and hostile input end in errors that name the place.

mod common;

use common::*;
use rga_core::{Array, Bearings, Error, slide};

fn message(case: &Case, outputs: &[Output]) -> String {
    match case.solve(outputs) {
        Err(Error::InvalidInput(text)) => text,
        other => panic!("expected a refusal, got {other:?}"),
    }
}

fn mechanism(case: &Case) -> (usize, usize, [f64; 6]) {
    match case.solve(&[]) {
        Err(Error::UnstableStructure {
            node,
            dof,
            direction,
        }) => (node, dof, direction),
        other => panic!("expected a mechanism, got {other:?}"),
    }
}

fn triangle() -> Case {
    let nodes = [[0.0; 3], [4.0, 0.0, 0.0], [2.0, 0.0, 3.0]];
    let truss = Case::new(&nodes, &[([0, 1], false), ([1, 2], false), ([0, 2], false)]);
    (0..3).fold(truss, |case, node| case.fix(node, &[1]))
}

#[test]
fn a_sliding_truss_moves_along_x() {
    let (_, dof, direction) = mechanism(&triangle().fix(0, &[2]).fix(1, &[2]));
    assert_eq!(dof, 0);
    assert!((direction[0] - 1.0).abs() < 1e-9, "{direction:?}");
}

#[test]
fn a_node_on_collinear_members_moves_across() {
    let nodes = [[0.0; 3], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]];
    let line = Case::new(&nodes, &[([0, 1], false), ([1, 2], false)]);
    let line = line.fix(0, &[0, 1, 2]).fix(2, &[0, 1, 2]).fix(1, &[2]);
    let (node, _, direction) = mechanism(&line);
    assert_eq!(node, 1);
    let half = 0.5_f64.sqrt();
    assert!((direction[0].abs() - half).abs() < 1e-6 && direction[0] * direction[1] < 0.0);
}

#[test]
fn a_cantilever_without_its_clamp_swings() {
    let swinging = Case::beam(3.0).fix(0, &[0, 1, 2, 3, 4]);
    let (node, dof, _) = mechanism(&swinging);
    assert_eq!((node, dof), (1, 1));
}

#[test]
fn a_beam_spins_about_its_axis() {
    let spinning = Case::beam(3.0).fix(0, &[0, 1, 2]).fix(1, &[1, 2]);
    let (_, dof, direction) = mechanism(&spinning);
    assert_eq!(dof, 3);
    assert!((direction[3] - 1.0).abs() < 1e-9);
}

#[test]
fn a_lone_node_is_named() {
    let mut lone = triangle().fix(0, &[0, 2]).fix(1, &[2]);
    lone.nodes.push([9.0, 9.0, 9.0]);
    lone.fixed.push([true, true, false, false, false, false]);
    lone.forces.push([0.0; 6]);
    lone.prescribed.push([0.0; 6]);
    let (node, dof, _) = mechanism(&lone);
    assert_eq!((node, dof), (3, 2));
}

#[test]
fn a_released_hinge_in_midspan_is_a_mechanism() {
    let nodes = [[0.0; 3], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]];
    let beam = Case::new(&nodes, &[([0, 1], true), ([1, 2], true)]);
    let beam = beam
        .fix(0, &[0, 1, 2, 3])
        .fix(2, &[1, 2, 3])
        .connect(0, 11, 0.0);
    let (node, dof, _) = mechanism(&beam);
    assert_eq!((node, dof), (1, 1));
}

#[test]
fn an_empty_structure_gives_an_empty_answer() {
    assert_eq!(Case::new(&[], &[]).solve(&[]), Ok(Vec::new()));
}

#[test]
fn loads_on_nothing_are_refused() {
    let held = triangle().fix(0, &[0, 2]).fix(1, &[2]);
    assert!(held.solve(&[]).is_ok());
    let text = message(&held.clone().force(2, 4, 1.0), &[]);
    assert!(text.contains("ry of node 2"), "{text}");
    let text = message(&held.point(1, 3, 0.5, 1.0), &[]);
    assert!(text.contains("member_axis[0]"), "{text}");
    let loose = Case::beam(2.0)
        .fix(0, &[0, 1, 2, 3, 4, 5])
        .point(0, 3, 1.0, 5.0);
    let text = message(&loose.connect(0, 3, 0.0).connect(0, 9, 0.0), &[]);
    assert!(text.contains("connection[0]"), "{text}");
}

#[test]
fn each_refusal_names_array_and_index() {
    let good = triangle().fix(0, &[0, 2]).fix(1, &[2]);
    let expect = |name: &str, spoil: &dyn Fn(&mut Case)| {
        let mut bad = good.clone();
        spoil(&mut bad);
        let text = message(&bad, &[]);
        assert!(text.contains(name), "{text}");
    };
    expect("coordinates[2, 1]", &|case| case.nodes[2][1] = f64::NAN);
    expect("ends[1, 1]", &|case| case.ends[1][1] = 3);
    expect("ends[0, 0]", &|case| case.ends[0][0] = -1);
    expect("member 1", &|case| case.ends[1] = [2, 2]);
    expect("fixed has shape", &|case| case.fixed.truncate(0));
    expect("inclined_node[0]", &|case| {
        case.inclined.push((7, [1.0; 3], 0.0))
    });
    expect("inclined_direction[0]", &|case| {
        case.inclined.push((1, [0.0; 3], 0.0))
    });
    expect("spring_dof[0]", &|case| {
        case.springs.push(([0, -1], 6, 1.0))
    });
    expect("spring_node[0]", &|case| {
        case.springs.push(([-1, 0], 0, 1.0))
    });
    expect("spring_stiffness[0]", &|case| {
        case.springs.push(([0, -1], 0, f64::NAN))
    });
    expect("tie_node[0]", &|case| case.ties.push(([1, 1], 0)));
    expect("forces[0, 1, 2]", &|case| case.forces[1][2] = f64::INFINITY);
    expect("strain[0, 0, 0]", &|case| case.strain[0][0] = f64::NAN);
    expect("prescribed[0, 2, 0]", &|case| case.prescribed[2][0] = 1.0);
    expect("member load 0", &|case| {
        case.member_loads.push((0, 1, 0.0, 9.0, 1.0, 1.0))
    });
    expect("member_index[0]", &|case| {
        case.member_loads.push((-1, 1, 0.0, 1.0, 1.0, 1.0))
    });
    expect("member_axis[0]", &|case| {
        case.member_loads.push((0, 5, 0.0, 1.0, 1.0, 1.0))
    });
    let text = message(&good, &[(7, 0, -1, [0.0; 3])]);
    assert!(text.contains("kind[0]"), "{text}");
    let text = message(&good, &[(6, 0, 12, [0.0; 3])]);
    assert!(text.contains("other[0]"), "{text}");
    let text = message(&good, &[(2, 3, -1, [0.5, 0.0, 0.0])]);
    assert!(text.contains("index[0]"), "{text}");
    let text = message(&good, &[(2, 0, -1, [1.5, 0.0, 0.0])]);
    assert!(text.contains("vector[0, 0]"), "{text}");
}

#[test]
fn frame_members_are_checked() {
    let good = Case::beam(2.0).fix(0, &[0, 1, 2, 3, 4, 5]);
    let text = message(&good.clone().connect(0, 4, -1.0), &[]);
    assert!(text.contains("connection[0, 4]"), "{text}");
    let mut long = good.clone();
    long.rigid_end[0] = [1.0, 1.0];
    assert!(message(&long, &[]).contains("rigid_end[0]"));
    let mut flat = good;
    flat.shear_area = 0.0;
    assert!(message(&flat, &[]).contains("Asy[0]"));
}

#[test]
fn friction_input_is_checked() {
    let one = [1.0];
    let bearings = Bearings {
        free_displacement: Array::new(&one, &[1, 1]),
        flexibility: Array::new(&[0.0], &[1, 1]),
        normal_free: Array::new(&one, &[1, 1]),
        normal_influence: Array::new(&[0.0], &[1, 1]),
        mu: Array::new(&one, &[1]),
        before: Array::new(&[1.0, 1.0], &[2, 1]),
    };
    let refused = slide(&bearings).map_err(|error| error.to_string());
    assert!(refused.is_err_and(|text| text.contains("flexibility[0, 0]")));
    let shaped = Bearings {
        mu: Array::new(&one, &[1, 1]),
        ..bearings
    };
    assert!(slide(&shaped).is_err_and(|error| error.to_string().contains("mu has shape")));
    let shaped = Bearings {
        flexibility: Array::new(&one, &[1, 1]),
        before: Array::new(&one, &[1, 1]),
        ..bearings
    };
    assert!(slide(&shaped).is_err_and(|error| error.to_string().contains("before has shape")));
}
