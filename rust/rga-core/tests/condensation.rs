//! Structures near one that is solved, against the same structures anew.

mod common;

use common::*;
use rga_core::{
    Array, Condensation, Loads, Outputs, Reanalysis, Result, StiffnessDifference, Structure,
    Varied, respond,
};

/// Frames with a rigid zone and a release, braces, and a spring to the ground; loads of all kinds.
fn portal() -> Case {
    let nodes = [
        [0.0, 0.0, 0.0],
        [4.0, 0.3, 0.0],
        [0.1, 0.0, 3.0],
        [4.2, 0.2, 3.1],
        [2.0, 1.5, 3.4],
    ];
    let members = [
        ([0, 2], true),
        ([1, 3], true),
        ([2, 3], true),
        ([3, 4], true),
        ([2, 4], true),
        ([0, 3], false),
        ([1, 2], false),
    ];
    let mut portal = Case::new(&nodes, &members)
        .fix(0, &[0, 1, 2, 3, 4, 5])
        .fix(1, &[0, 1, 2])
        .connect(4, 5, 0.0)
        .force(4, 1, 2e3)
        .force(3, 4, -1e3)
        .uniform(2, 2, 4.0, -5e3)
        .point(3, 1, 0.9, 3e3);
    portal.rigid_end[2] = [0.2, 0.1];
    portal.springs.push(([4, -1], 2, 2e6));
    portal.strain[2] = [2e-4, 1e-4, -3e-4];
    portal.strain[5] = [-3e-4, 0.0, 0.0];
    portal.prescribed[1][0] = 1e-3;
    portal
}

fn outputs() -> Vec<Output> {
    let ends = (0..5).flat_map(|member| (0..12).map(move |dof| end_force(member, dof)));
    let gauges = (0..7).map(|member| (STRAIN, member, -1, [0.4, 0.05, -0.03]));
    let braces = [5, 6].map(|member| (STRAIN, member, -1, [0.5, 0.0, 0.0]));
    let sections = (0..7)
        .flat_map(|member| (0..6).map(move |part| (SECTION_FORCE, member, part, [0.3, 0.0, 0.0])));
    let nodes = (0..5)
        .flat_map(|node| [DISPLACEMENT, ROTATION, REACTION, MOMENT].map(|kind| at(kind, node, 2)));
    (ends.chain(gauges.take(5)).chain(braces).chain(sections))
        .chain(nodes)
        .collect()
}

/// Calls `check` with the portal, its loads, its outputs, and the portal with some stiffness factors
/// on members and on its spring.
fn beside(
    factors: &[(usize, f64)],
    spring: f64,
    check: impl FnOnce(&Structure, &Loads, &Outputs, &Structure) -> Result<()>,
) -> Result<()> {
    portal().lend(&outputs(), |structure, loads, outputs| {
        let scaled = |array: Array<f64>| {
            let mut values = array.values.to_vec();
            factors
                .iter()
                .for_each(|&(at, factor)| values[at] *= factor);
            values
        };
        let (young, shear) = (scaled(structure.young), scaled(structure.shear));
        let stiffness = [structure.spring_stiffness[0] * spring];
        let other = Structure {
            young: Array::new(&young, structure.young.shape),
            shear: Array::new(&shear, structure.shear.shape),
            spring_stiffness: Array::new(&stiffness, structure.spring_stiffness.shape),
            ..*structure
        };
        check(structure, loads, outputs, &other)
    })
}

/// To 1e-9 of the largest of its kind.
fn agree(found: &[f64], expected: &[f64]) {
    let kinds = outputs();
    for (at, (value, right)) in found.iter().zip(expected).enumerate() {
        let alike = expected
            .iter()
            .zip(&kinds)
            .filter(|(_, other)| other.0 == kinds[at].0);
        let size = alike.fold(0.0_f64, |most, (value, _)| most.max(value.abs()));
        let miss = (value - right).abs();
        assert!(
            miss <= 1e-9 * size,
            "output {at}: {value} instead of {right}"
        );
    }
    assert_eq!(found.len(), expected.len());
}

#[test]
fn a_condensed_structure_is_the_structure_anew() -> Result<()> {
    let factors = [(2, 0.4), (4, 1.9), (6, 0.6)];
    beside(&factors, 0.5, |structure, loads, outputs, other| {
        let varied = Varied {
            members: &[2, 4, 6],
            springs: &[0],
            axial: false,
        };
        let few = Condensation::of(structure, loads, outputs, varied)?;
        let length = 3.0_f64.hypot(3.9).hypot(0.3);
        let stiffness = [E * 0.4, E * 1.9, E * AREA * 0.6 / length, 1e6];
        let mut found = vec![0.0; outputs.kind.len()];
        few.samples()?.respond(&[1.0], &stiffness, &mut found, 1)?;
        agree(&found, &respond(other, loads, outputs)?);
        Ok(())
    })
}

#[test]
fn few_members_that_differ_are_the_structure_anew() -> Result<()> {
    let braces: (&[_], f64) = (&[(5, 0.3), (6, 2.0)], 3.0);
    let frames: (&[_], f64) = (&[(0, 0.5), (2, 0.3), (4, 1.5)], 1.0);
    let nothing: (&[_], f64) = (&[], 1.0);
    for (factors, spring) in [braces, frames, nothing] {
        beside(factors, spring, |structure, loads, outputs, other| {
            let near = Reanalysis::new(structure, outputs)?;
            let loaded = near.under(structure, loads)?;
            let difference = StiffnessDifference::between((structure, outputs), (other, outputs));
            let difference = difference.expect("few stiffnesses differ");
            assert_eq!(difference.is_empty(), factors.is_empty());
            let found = near.changed(&loaded, other, &difference)?;
            agree(&found, &respond(other, loads, outputs)?);
            Ok(())
        })?;
    }
    Ok(())
}

#[test]
fn more_than_few_stiffnesses_are_no_neighbours() -> Result<()> {
    let all: Vec<(usize, f64)> = (0..5).map(|member| (member, 0.9)).collect();
    for factors in [all, vec![(0, 0.9), (5, 0.9)]] {
        beside(&factors, 1.0, |structure, _, outputs, other| {
            let found = StiffnessDifference::between((structure, outputs), (other, outputs));
            assert!(found.is_none());
            Ok(())
        })?;
    }
    Ok(())
}
