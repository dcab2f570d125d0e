//! A roof solved once, and roofs near it: springs under its edge that are softer.

#[path = "../rust/rga-core/tests/common/mod.rs"]
mod common;

use std::hint::black_box;

use common::grid::roof;
use common::{Case, heights_and_forces};
use criterion::{Criterion, criterion_group, criterion_main};
use rga_core::{Reanalysis, StiffnessDifference};

const PANELS: usize = 6;
const SPRINGS: usize = 12;

/// A roof on springs beside its supports, of which some are softer.
fn on_springs(softer: usize) -> Case {
    let mut case = roof(PANELS);
    for spring in 0..SPRINGS {
        let share = if spring < softer { 0.5 } else { 1.0 };
        case.springs.push(([8 + spring as i64, -1], 2, 1e7 * share));
    }
    case
}

fn bench(criterion: &mut Criterion) {
    let outputs = heights_and_forces(14);
    let mut group = criterion.benchmark_group("a roof of 85 nodes");
    on_springs(0).lend(&outputs, |structure, loads, wanted| {
        let near = Reanalysis::new(structure, wanted).expect("stable");
        let loaded = near.under(structure, loads).expect("loads of this roof");
        for softer in [1, SPRINGS] {
            on_springs(softer).lend(&outputs, |other, _, others| {
                group.bench_function(format!("{softer} stiffnesses differ"), |bencher| {
                    bencher.iter(|| {
                        let pair = ((structure, wanted), (black_box(other), others));
                        let difference = StiffnessDifference::between(pair.0, pair.1);
                        let difference = difference.expect("few stiffnesses differ");
                        near.changed(&loaded, other, &difference).expect("stable")
                    });
                });
            });
        }
        group.bench_function("solved anew", |bencher| {
            bencher.iter(|| rga_core::respond(black_box(structure), loads, wanted));
        });
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
