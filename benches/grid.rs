//! A roof of 25 thousand unknowns: its analysis, and one factorisation with its solve.

#[path = "../rust/rga-core/tests/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::time::Duration;

use common::grid::roof;
use common::samples::{batch_solver, run};
use common::{DISPLACEMENT, at};
use criterion::{Criterion, criterion_group, criterion_main};

const PANELS: usize = 64;

fn bench(criterion: &mut Criterion) {
    let roof = [roof(PANELS)];
    let middle = [at(DISPLACEMENT, (PANELS / 2 * (PANELS + 2)) as i64, 2)];
    let factors = vec![1.0; roof[0].ends.len()];
    let analyse = || batch_solver(black_box(&roof), &middle).expect("it is well formed");
    let batch = analyse();
    let mut group = criterion.benchmark_group("roof of 25 thousand unknowns");
    group
        .sample_size(20)
        .measurement_time(Duration::from_secs(10));
    group.bench_function("analysis", |bencher| bencher.iter(analyse));
    group.bench_function("one sample", |bencher| {
        bencher.iter(|| run(&batch, black_box(&factors), &[1.0], 1, 1).expect("it stands"));
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
