//! Orders of elimination: each unknown once, and few numbers in the factor.

use std::collections::BTreeSet;

use rga_core::{LowerTriangle, fill_reducing};

/// So many factorisations that the better order is worth any time.
const MANY: f64 = 1e9;

/// Three unknowns a node; nodes are coupled along the axes and across the faces of a lattice.
fn lattice(shape: [usize; 3]) -> (LowerTriangle, Vec<[f64; 3]>) {
    let steps = [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 1, 0],
        [1, 0, 1],
        [0, 1, 1],
    ];
    let number = |at: [usize; 3]| (at[0] * shape[1] + at[1]) * shape[2] + at[2];
    let mut pairs = Vec::new();
    let mut places = Vec::new();
    for x in 0..shape[0] {
        for y in 0..shape[1] {
            for z in 0..shape[2] {
                places.extend([[x, y, z].map(|at| 3.0 * at as f64); 3]);
                pairs.push([number([x, y, z]); 2]);
                let ends = steps.map(|step| [x + step[0], y + step[1], z + step[2]]);
                let ends = ends
                    .iter()
                    .filter(|end| (0..3).all(|axis| end[axis] < shape[axis]));
                pairs.extend(ends.map(|&end| [number([x, y, z]), number(end)]));
            }
        }
    }
    let unknowns = pairs
        .iter()
        .flat_map(|pair| (0..9).map(|at| [3 * pair[0] + at % 3, 3 * pair[1] + at / 3]));
    (coupled(unknowns, places.len()), places)
}

fn coupled(pairs: impl Iterator<Item = [usize; 2]> + Clone, size: usize) -> LowerTriangle {
    LowerTriangle::sum(size, |add| {
        (pairs.clone()).for_each(|[one, other]| add(one.max(other), one.min(other), 1.0));
    })
}

fn order(matrix: &LowerTriangle, places: &[[f64; 3]], repeats: f64) -> Vec<usize> {
    let order = fill_reducing(matrix, places, repeats).expect("there is memory");
    let each: BTreeSet<usize> = order.iter().copied().collect();
    assert_eq!((order.len(), each.len()), (places.len(), places.len()));
    assert!(each.last().is_none_or(|&last| last < places.len()));
    order
}

/// Multiplications, column by column: each hands its pattern on to the first row below it.
fn work(matrix: &LowerTriangle, order: &[usize]) -> usize {
    let mut position = vec![0; order.len()];
    order
        .iter()
        .enumerate()
        .for_each(|(at, &unknown)| position[unknown] = at);
    let mut below = vec![BTreeSet::new(); order.len()];
    for column in 0..order.len() {
        for &row in &matrix.rows[matrix.first[column]..matrix.first[column + 1]] {
            let (one, other) = (position[row], position[column]);
            if one != other {
                below[one.min(other)].insert(one.max(other));
            }
        }
    }
    let mut work = 0;
    for column in 0..order.len() {
        let rows = std::mem::take(&mut below[column]);
        work += (rows.len() + 1) * (rows.len() + 2) / 2;
        if let Some(&first) = rows.first() {
            below[first].extend(rows.into_iter().filter(|&row| row > first));
        }
    }
    work
}

#[test]
fn a_lattice_is_dissected() {
    let (matrix, places) = lattice([12, 12, 12]);
    let (quick, slow) = (order(&matrix, &places, 0.0), order(&matrix, &places, MANY));
    let (quick, slow) = (work(&matrix, &quick), work(&matrix, &slow));
    assert!(
        5 * slow < 4 * quick,
        "{slow} multiplications instead of {quick}"
    );
}

#[test]
fn storeys_of_any_height_are_dissected_alike() {
    let (matrix, mut places) = lattice([9, 9, 9]);
    let cubes = order(&matrix, &places, MANY);
    places.iter_mut().for_each(|place| place[2] *= 1e-3);
    assert_eq!(order(&matrix, &places, MANY), cubes);
}

#[test]
fn a_long_chain_is_not_dissected() {
    let (matrix, places) = lattice([300, 2, 2]);
    assert_eq!(order(&matrix, &places, MANY), order(&matrix, &places, 0.0));
}

#[test]
fn places_need_not_tell_anything() {
    let (matrix, places) = lattice([12, 12, 4]);
    let size = places.len();
    let one_place = vec![[1.0, 2.0, 3.0]; size];
    let two_places: Vec<_> = (0..size).map(|at| [(at % 2) as f64, 0.0, 0.0]).collect();
    let scattered: Vec<_> = (0..size)
        .map(|at| [0.618, 0.414, 0.732].map(|part| (part * at as f64).fract()))
        .collect();
    for places in [one_place, two_places, scattered] {
        order(&matrix, &places, MANY);
    }
    let apart = coupled(std::iter::empty(), size);
    order(&apart, &places, MANY);
    order(&coupled(std::iter::empty(), 0), &[], MANY);
}
