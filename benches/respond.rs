//! Box bridges: a truss of 32 nodes, and a frame of 404.

#[path = "../rust/rga-core/tests/common/mod.rs"]
mod common;

use std::hint::black_box;

use common::{Case, heights_and_forces};
use criterion::{Criterion, criterion_group, criterion_main};

/// Boxes of 3 m in a row, four nodes a section, on four bearings.
fn bridge(bays: i64, frame: bool) -> Case {
    let section = [[0.0, 0.0], [0.0, 2.5], [3.0, 0.0], [3.0, 2.5]];
    let nodes: Vec<[f64; 3]> = (0..=bays)
        .flat_map(|bay| section.map(|[y, z]| [3.0 * bay as f64, y, z]))
        .collect();
    let within = [[0, 1], [0, 2], [1, 3], [2, 3], [0, 3]];
    let chords = [[0, 4], [1, 5], [2, 6], [3, 7]];
    let diagonals = [[0, 5], [2, 7], [0, 6], [1, 7], [1, 4], [3, 6]];
    let mut members = Vec::new();
    for bay in 0..=bays {
        let onward = chords.iter().chain(&diagonals).filter(|_| bay < bays);
        for pair in within.iter().chain(onward) {
            members.push((pair.map(|corner| 4 * bay + corner), frame));
        }
    }
    let last = 4 * bays as usize;
    let bridge = Case::new(&nodes, &members)
        .fix(0, &[0, 1, 2])
        .fix(2, &[0, 2])
        .fix(last, &[1, 2])
        .fix(last + 2, &[2]);
    (0..nodes.len()).fold(bridge, |case, node| case.force(node, 2, -1e4))
}

fn bench(criterion: &mut Criterion) {
    let outputs = heights_and_forces(14);
    for (name, bays, frame) in [
        ("truss of 32 nodes", 7, false),
        ("frame of 404 nodes", 100, true),
    ] {
        let case = bridge(bays, frame);
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| black_box(&case).solve(black_box(&outputs)));
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
