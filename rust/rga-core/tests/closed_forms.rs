//! Textbook answers.

mod common;

use common::*;
use rga_core::Result;

const ALL: [usize; 6] = [0, 1, 2, 3, 4, 5];
const L: f64 = 3.0;
const P: f64 = 1e4;

#[test]
fn bar_lengthens_by_its_force() -> Result<()> {
    let bar = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    let bar = bar.fix(0, &[0, 1, 2]).fix(1, &[1, 2]).force(1, 0, P);
    let found = bar.solve(&[
        at(DISPLACEMENT, 1, 0),
        (SECTION_FORCE, 0, 0, [0.5, 0.0, 0.0]),
        (STRAIN, 0, -1, [0.5, 0.0, 0.0]),
        at(REACTION, 0, 0),
    ])?;
    close(found[0], P * L / (E * AREA));
    close(found[1], P);
    close(found[2], P / (E * AREA));
    close(found[3], -P);
    Ok(())
}

#[test]
fn cantilever_bends_in_both_planes() -> Result<()> {
    let beam = Case::beam(L).fix(0, &ALL).force(1, 1, P).force(1, 2, P);
    let found = beam.solve(&[
        at(DISPLACEMENT, 1, 1),
        at(ROTATION, 1, 2),
        at(DISPLACEMENT, 1, 2),
        at(ROTATION, 1, 1),
        at(MOMENT, 0, 2),
        at(MOMENT, 0, 1),
    ])?;
    close(found[0], P * L.powi(3) / (3.0 * E * IZ));
    close(found[1], P * L * L / (2.0 * E * IZ));
    close(found[2], P * L.powi(3) / (3.0 * E * IY));
    close(found[3], -P * L * L / (2.0 * E * IY));
    close(found[4], -P * L);
    close(found[5], P * L);
    Ok(())
}

#[test]
fn timoshenko_cantilever_adds_shear() -> Result<()> {
    let mut beam = Case::beam(L).fix(0, &ALL).force(1, 1, P);
    beam.shear_area = 2e-3;
    let found = beam.solve(&[at(DISPLACEMENT, 1, 1)])?;
    close(
        found[0],
        P * L.powi(3) / (3.0 * E * IZ) + P * L / (G * beam.shear_area),
    );
    let beam = Case {
        forces: vec![[0.0; 6]; 2],
        ..beam
    }
    .uniform(0, 1, L, P);
    let found = beam.solve(&[at(DISPLACEMENT, 1, 1)])?;
    let shear = P * L * L / (2.0 * G * beam.shear_area);
    close(found[0], P * L.powi(4) / (8.0 * E * IZ) + shear);
    Ok(())
}

#[test]
fn warm_bar_pushes_against_its_spring() -> Result<()> {
    let (strain, spring) = (4e-4, 3e7);
    let mut bar = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    bar = bar.fix(0, &[0, 1, 2]).fix(1, &[1, 2]);
    bar.strain[0][0] = strain;
    bar.springs.push(([1, -1], 0, spring));
    let own = E * AREA / L;
    let found = bar.solve(&[
        at(DISPLACEMENT, 1, 0),
        (SECTION_FORCE, 0, 0, [0.0; 3]),
        at(REACTION, 1, 0),
        (STRAIN, 0, -1, [0.0; 3]),
    ])?;
    let motion = strain * L * own / (own + spring);
    close(found[0], motion);
    close(found[1], -spring * motion);
    close(found[2], -spring * motion);
    close(found[3], motion / L - strain);
    Ok(())
}

#[test]
fn released_beam_is_simply_supported() -> Result<()> {
    let beam = Case::beam(L).fix(0, &ALL).fix(1, &ALL).uniform(0, 1, L, P);
    let pinned = beam.clone().connect(0, 5, 0.0).connect(0, 11, 0.0);
    let middle = [0.5, 0.1, 0.0];
    let found = pinned.solve(&[end_force(0, 5), end_force(0, 1), (STRAIN, 0, -1, middle)])?;
    close(found[0], 0.0);
    close(found[1], -P * L / 2.0);
    // Load upward: the moment EI v'' is -w L^2 / 8, and the strain -y M / EI.
    close(found[2], 0.1 * P * L * L / 8.0 / (E * IZ));
    let propped = beam
        .connect(0, 5, 0.0)
        .solve(&[end_force(0, 11), end_force(0, 1)])?;
    close(propped[0], P * L * L / 8.0);
    close(propped[1], -3.0 / 8.0 * P * L);
    Ok(())
}

#[test]
fn sections_carry_what_lies_beyond_them() -> Result<()> {
    let section = |part, place| (SECTION_FORCE, 0, part, [place, 0.0, 0.0]);
    // A cantilever: whatever pushes at its end comes through every section.
    let mut arm = Case::beam(L).fix(0, &ALL);
    arm.forces[1] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let found = arm.solve(&[0, 1, 2, 3, 4, 5].map(|part| section(part, 0.25)))?;
    let lever = 0.75 * L;
    for (found, expected) in
        found
            .into_iter()
            .zip([1.0, 2.0, 3.0, 4.0, 5.0 - 3.0 * lever, 6.0 + 2.0 * lever])
    {
        close(found, expected);
    }
    // A simple beam under loads along local y and z, the one upwards, the other downwards.
    let beam = Case::beam(L).fix(0, &ALL).fix(1, &ALL).uniform(0, 1, L, P);
    let beam = [4, 5, 10, 11]
        .iter()
        .fold(beam.uniform(0, 2, L, -P), |beam, &dof| {
            beam.connect(0, dof, 0.0)
        });
    let found = beam.solve(&[
        section(5, 0.5),
        section(1, 0.0),
        section(1, 0.75),
        section(4, 0.5),
        section(2, 0.0),
        section(2, 0.75),
    ])?;
    for (found, expected) in found.into_iter().zip([
        -P * L * L / 8.0,
        P * L / 2.0,
        -P * L / 4.0,
        -P * L * L / 8.0,
        -P * L / 2.0,
        P * L / 4.0,
    ]) {
        close(found, expected);
    }
    Ok(())
}

#[test]
fn semirigid_ends_share_the_moment() -> Result<()> {
    for spring in [1e3, 2.5e7, 1e15] {
        let beam = Case::beam(L).fix(0, &ALL).fix(1, &ALL).uniform(0, 1, L, -P);
        let beam = beam.connect(0, 5, spring).connect(0, 11, spring);
        let found = beam.solve(&[end_force(0, 5), end_force(0, 11)])?;
        let moment = P * L * L / 12.0 / (1.0 + 2.0 * E * IZ / (spring * L));
        close(found[0], moment);
        close(found[1], -moment);
    }
    Ok(())
}

#[test]
fn axial_spring_stands_in_series() -> Result<()> {
    let spring = 1e8;
    let bar = Case::beam(L)
        .fix(0, &ALL)
        .force(1, 0, P)
        .connect(0, 0, spring);
    let found = bar.solve(&[at(DISPLACEMENT, 1, 0)])?;
    close(found[0], P * L / (E * AREA) + P / spring);
    Ok(())
}

#[test]
fn torsion_released_at_both_ends_leaves_the_rest() -> Result<()> {
    let beam = Case::beam(L).fix(0, &ALL).force(1, 1, P);
    let beam = beam.connect(0, 3, 0.0).connect(0, 9, 0.0);
    let found = beam.solve(&[at(DISPLACEMENT, 1, 1), at(ROTATION, 1, 0)])?;
    close(found[0], P * L.powi(3) / (3.0 * E * IZ));
    close(found[1], 0.0);
    Ok(())
}

#[test]
fn double_pinned_frame_member_is_a_truss_member() -> Result<()> {
    let nodes = [[0.0; 3], [4.0, 0.0, 0.0], [2.0, 1.0, 3.0], [2.0, -3.0, 0.5]];
    let members = [([0, 2], false), ([1, 2], false), ([3, 2], false)];
    let truss = Case::new(&nodes, &members)
        .force(2, 2, -P)
        .force(2, 0, P / 2.0);
    let truss = (0..4)
        .filter(|&node| node != 2)
        .fold(truss, |case, node| case.fix(node, &ALL));
    let mut pinned = truss.clone();
    pinned.frame = vec![true; 3];
    for member in 0..3 {
        for dof in [3, 4, 5, 9, 10, 11] {
            pinned = pinned.connect(member, dof, 0.0);
        }
    }
    let outputs: Vec<_> = (0..3).map(|axis| at(DISPLACEMENT, 2, axis)).collect();
    for (one, other) in truss
        .solve(&outputs)?
        .into_iter()
        .zip(pinned.solve(&outputs)?)
    {
        assert!(
            (one - other).abs() <= 1e-12 * one.abs(),
            "{one} instead of {other}"
        );
    }
    Ok(())
}

#[test]
fn rigid_zones_shorten_the_beam_and_carry_loads() -> Result<()> {
    let (a, b) = (0.4, 0.3);
    let mut beam = Case::beam(L).fix(0, &ALL).force(1, 1, P);
    beam.rigid_end[0] = [a, b];
    let found = beam.solve(&[at(DISPLACEMENT, 1, 1), at(MOMENT, 0, 2)])?;
    let s = L - a - b;
    let ei = E * IZ;
    let (moment, slope) = (P * b, P * s * s / (2.0 * ei) + P * b * s / ei);
    let deflection = P * s.powi(3) / (3.0 * ei) + moment * s * s / (2.0 * ei);
    close(found[0], deflection + slope * b);
    close(found[1], -P * L);
    let mut loaded = Case::beam(L).fix(0, &ALL).uniform(0, 1, L, P);
    loaded = loaded.point(0, 2, 0.1, P).point(0, 5, L - 0.1, P);
    loaded.rigid_end[0] = [a, b];
    let found = loaded.solve(&[at(MOMENT, 0, 2), at(MOMENT, 0, 1), at(REACTION, 0, 1)])?;
    close(found[0], -P * L * L / 2.0 - P);
    close(found[1], P * 0.1);
    close(found[2], -P * L);
    Ok(())
}

#[test]
fn trapezoid_and_points_agree_with_statics() -> Result<()> {
    let mut beam = Case::beam(L).fix(0, &ALL);
    beam.member_loads.push((0, 1, 0.5, 2.5, 1e3, 4e3));
    let found = beam.solve(&[at(REACTION, 0, 1), at(MOMENT, 0, 2), end_force(0, 7)])?;
    close(found[0], -5e3);
    // Centroid of the trapezoid: from its start 2 (1 + 2 * 4) / (3 (1 + 4)).
    close(found[1], -5e3 * (0.5 + 2.0 * 9.0 / 15.0));
    assert!(found[2].abs() < 1e-9 * 5e3);
    let torque = Case::beam(L)
        .fix(0, &ALL)
        .point(0, 3, 1.0, P)
        .point(0, 4, 2.0, P);
    let found = torque.solve(&[at(MOMENT, 0, 0), at(MOMENT, 0, 1), at(ROTATION, 1, 0)])?;
    close(found[0], -P);
    close(found[1], -P);
    close(found[2], P / (G * TORSION));
    Ok(())
}

#[test]
fn thermal_gradients_curve_a_free_beam() -> Result<()> {
    let mut beam = Case::beam(L).fix(0, &ALL);
    beam.strain[0] = [1e-4, 2e-4, 3e-4];
    let found = beam.solve(&[
        at(DISPLACEMENT, 1, 0),
        at(DISPLACEMENT, 1, 1),
        at(DISPLACEMENT, 1, 2),
        (STRAIN, 0, -1, [0.5, 0.1, 0.1]),
    ])?;
    close(found[0], 1e-4 * L);
    close(found[1], -2e-4 * L * L / 2.0);
    close(found[2], -3e-4 * L * L / 2.0);
    close(found[3], 0.0);
    Ok(())
}
