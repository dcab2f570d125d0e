//! Structures of thousands of unknowns: solved to the last digits, or refused with the place.

mod common;

use common::grid::roof;
use common::samples::{batch_solver, run};
use common::*;
use rga_core::{Error, Result};

const STIFFNESS: f64 = E * AREA;

/// Of all nodes, `[nodes, 3]`.
fn displacements(case: &Case) -> Vec<Output> {
    let nodes = 0..case.nodes.len() as i64;
    nodes
        .flat_map(|node| [0, 1, 2].map(|axis| at(DISPLACEMENT, node, axis)))
        .collect()
}

/// By one analysis, and as a sample.
fn both(case: &Case, outputs: &[Output]) -> Result<[Vec<f64>; 2]> {
    let sample = batch_solver(std::slice::from_ref(case), outputs)?;
    let found = run(&sample, &vec![1.0; case.ends.len()], &[1.0], 1, 1)?;
    Ok([case.solve(outputs)?, found])
}

fn length(case: &Case, ends: [i64; 2]) -> ([f64; 3], f64) {
    let [from, to] = ends.map(|node| case.nodes[node as usize]);
    let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
    let length = way.iter().map(|part| part * part).sum::<f64>().sqrt();
    (way.map(|part| part / length), length)
}

/// The largest force that is left on a free direction, beside the largest in a member.
fn unbalanced(case: &Case, displacements: &[f64]) -> f64 {
    let mut left: Vec<[f64; 3]> = (case.forces.iter())
        .map(|force| [force[0], force[1], force[2]])
        .collect();
    let mut largest = 0.0_f64;
    for &ends in &case.ends {
        let (axis, length) = length(case, ends);
        let [from, to] = ends.map(|node| node as usize);
        let stretch = |at: usize| displacements[3 * to + at] - displacements[3 * from + at];
        let tension = STIFFNESS / length * (0..3).map(|at| axis[at] * stretch(at)).sum::<f64>();
        largest = largest.max(tension.abs());
        for at in 0..3 {
            left[from][at] += tension * axis[at];
            left[to][at] -= tension * axis[at];
        }
    }
    let free = left.iter().zip(&case.fixed).flat_map(|(left, fixed)| {
        let pairs = left.iter().zip(fixed);
        pairs
            .filter(|(_, fixed)| !**fixed)
            .map(|(left, _)| left.abs())
    });
    free.fold(0.0, f64::max) / largest
}

fn differ(one: &[f64], other: &[f64]) -> f64 {
    let largest = one
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let pairs = one.iter().zip(other);
    pairs.fold(0.0_f64, |most, (one, other)| most.max((one - other).abs())) / largest
}

#[test]
fn a_roof_is_in_equilibrium() -> Result<()> {
    let roof = roof(24);
    let [one, sample] = both(&roof, &displacements(&roof))?;
    for found in [&one, &sample] {
        let left = unbalanced(&roof, found);
        assert!(left < 1e-10, "{left}");
    }
    assert!(differ(&one, &sample) < 1e-9);
    // A roof that is a little wrong is not.
    let mut other = roof.clone();
    other.ends.pop();
    assert!(unbalanced(&other, &one) > 1e-4);
    Ok(())
}

/// One analysis is not worth a dissection, samples are: `a_lattice_is_dissected`.
#[test]
fn both_orders_give_one_answer() -> Result<()> {
    let side = 10;
    let number = |x: usize, y: usize, z: usize| (x * side + y) * side + z;
    let mut nodes = Vec::new();
    let mut members = Vec::new();
    for (x, y, z) in cube(side) {
        nodes.push([x, y, z].map(|at| 3.0 * at as f64));
        let steps = [
            [1, 0, 0],
            [0, 1, 0],
            [0, 0, 1],
            [1, 1, 0],
            [1, 0, 1],
            [0, 1, 1],
        ];
        for [dx, dy, dz] in steps {
            let [x2, y2, z2] = [x + dx, y + dy, z + dz];
            if [x2, y2, z2].iter().all(|&at| at < side) {
                let ends = [number(x, y, z), number(x2, y2, z2)];
                members.push((ends.map(|node| node as i64), false));
            }
        }
    }
    let mut block = Case::new(&nodes, &members).force(number(4, 9, 9), 0, 1e5);
    for (x, y, z) in cube(side).filter(|place| place.2 == 0) {
        block = block.fix(number(x, y, z), &[0, 1, 2]);
    }
    let outputs = displacements(&block);
    let [one, sample] = both(&block, &outputs)?;
    assert!(differ(&one, &sample) < 1e-9);
    let batch = batch_solver(std::slice::from_ref(&block), &outputs)?;
    let factors = vec![1.0; 20 * block.ends.len()];
    for row in run(&batch, &factors, &[1.0; 20], 20, 2)?.chunks_exact(sample.len()) {
        assert_eq!(row, sample);
    }
    assert!(unbalanced(&block, &one) < 1e-10 && unbalanced(&block, &sample) < 1e-10);
    Ok(())
}

fn cube(side: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    let line = move |x: usize| (0..side).flat_map(move |y| (0..side).map(move |z| (x, y, z)));
    (0..side).flat_map(line)
}

/// A roof with a lamp on three bars below the node of the upper layer in the middle.
fn with_lamp() -> (Case, usize) {
    let panels = 16;
    let plain = roof(panels);
    let lamp = plain.nodes.len();
    let side = panels + 1;
    let lower = |i: usize, j: usize| (side * side + i * panels + j) as i64;
    let mut nodes = plain.nodes.clone();
    nodes.push([24.0, 24.5, -1.0]);
    let mut members: Vec<_> = plain.ends.iter().map(|&ends| (ends, false)).collect();
    for hanger in [lower(7, 7), lower(8, 7), lower(8, 8)] {
        members.push(([hanger, lamp as i64], false));
    }
    let mut case = Case::new(&nodes, &members).force(lamp, 2, -100.0);
    case.fixed[..lamp].copy_from_slice(&plain.fixed);
    (case, lamp)
}

fn without_last(mut case: Case) -> Case {
    case.ends.pop();
    case.frame.pop();
    case.connection.pop();
    case.rigid_end.pop();
    case.strain.pop();
    case
}

fn named(found: Result<Vec<f64>>) -> (usize, [f64; 6]) {
    let found = found.map_err(|error| match error {
        Error::Row { error, .. } => *error,
        error => error,
    });
    match found {
        Err(Error::UnstableStructure {
            node, direction, ..
        }) => (node, direction),
        other => panic!("expected a mechanism, got {other:?}"),
    }
}

#[test]
fn a_node_that_swings_is_named() -> Result<()> {
    let (hung, lamp) = with_lamp();
    let [one, sample] = both(&hung, &displacements(&hung))?;
    assert!(unbalanced(&hung, &one) < 1e-10 && unbalanced(&hung, &sample) < 1e-10);
    let last = hung.ends.len() - 1;
    let cut = without_last(hung.clone());
    let batch = batch_solver(std::slice::from_ref(&hung), &[at(DISPLACEMENT, 0, 2)])?;
    let mut factors = vec![1.0; last + 1];
    let before = run(&batch, &factors, &[1.0], 1, 1)?;
    factors[last] = 0.0;
    for found in [cut.solve(&[]), run(&batch, &factors, &[1.0], 1, 1)] {
        let (node, direction) = named(found);
        assert_eq!(node, lamp);
        // It swings about the two bars that are left.
        for ends in &hung.ends[last - 2..last] {
            let (axis, _) = length(&hung, *ends);
            let along: f64 = (0..3).map(|at| axis[at] * direction[at]).sum();
            assert!(along.abs() < 1e-6, "{direction:?}");
        }
    }
    factors[last] = 1.0;
    assert_eq!(run(&batch, &factors, &[1.0], 1, 1)?, before);
    Ok(())
}

/// A cantilever truss of bays 1 m square, in a plane; its tip is as soft as a mechanism almost is.
fn mast(bays: usize) -> Case {
    let mut nodes = Vec::new();
    let mut members = Vec::new();
    for bay in 0..=bays {
        nodes.extend([[bay as f64, 0.0, 0.0], [bay as f64, 0.0, 1.0]]);
        let first = 2 * bay as i64;
        if bay > 0 {
            let own = [
                [first, first + 1],
                [first - 2, first],
                [first - 1, first + 1],
            ];
            members.extend(own.map(|ends| (ends, false)));
            members.push(([first - 2, first + 1], false));
        }
    }
    let tip = 2 * bays;
    let mast = Case::new(&nodes, &members).force(tip, 2, -1.0);
    let mast = mast.fix(0, &[0, 2]).fix(1, &[0, 2]);
    (0..nodes.len()).fold(mast, |mast, node| mast.fix(node, &[1]))
}

#[test]
fn a_long_mast_stands() -> Result<()> {
    let bays = 300;
    let mast = mast(bays);
    // The unit force takes its way through each bay: bars below and above carry its moments.
    let mut work = 0.0;
    for bay in 1..=bays {
        let lever = (bays - bay) as f64;
        let diagonal = 2.0_f64.sqrt();
        work += lever.powi(2) + (lever + 1.0).powi(2) + diagonal.powi(3) + 1.0;
    }
    let exact = -work / STIFFNESS;
    for found in both(&mast, &[at(DISPLACEMENT, 2 * bays as i64, 2)])? {
        assert!(
            (found[0] / exact - 1.0).abs() < 1e-6,
            "{} instead of {exact}",
            found[0]
        );
    }
    // Without the last diagonal its bay is a parallelogram.
    let cut = without_last(mast);
    let (node, _) = named(cut.solve(&[]));
    assert!(node >= 2 * bays, "{node}");
    Ok(())
}
