//! Batches of samples: loads vary (C1), few stiffnesses vary (C2), and derivatives.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rga_core::{Condensed, Directions};

const ROWS: usize = 4096;
const PATTERNS: usize = 12;
const OUTPUTS: usize = 16;

/// Numbers that are spread evenly and repeat in every run.
fn spread(count: usize) -> Vec<f64> {
    (0..count)
        .map(|at| ((at as f64 + 1.0) * 0.754_877_666).fract() - 0.5)
        .collect()
}

fn condensed(terms: usize) -> Condensed {
    let mut stiffness = spread(terms * terms);
    for row in 0..terms {
        for column in 0..row {
            stiffness[row * terms + column] = stiffness[column * terms + row];
        }
        stiffness[row * terms + row] = terms as f64;
    }
    Condensed::new(
        [PATTERNS, terms, OUTPUTS],
        &spread(PATTERNS * OUTPUTS),
        &spread(PATTERNS * terms),
        &stiffness,
        &spread(terms * OUTPUTS),
    )
    .expect("the sizes fit")
}

fn bench(criterion: &mut Criterion) {
    let coefficients = spread(ROWS * PATTERNS);
    let mut group = criterion.benchmark_group("4096 samples");
    group.throughput(Throughput::Elements(ROWS as u64));
    for (name, terms) in [("C1", 0), ("C2, ten terms", 10)] {
        let structure = condensed(terms);
        let changes = spread(ROWS * terms);
        let mut results = vec![0.0; ROWS * OUTPUTS];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                structure
                    .respond(black_box(&coefficients), &changes, &mut results, 1)
                    .expect("stable")
            });
        });
    }
    let structure = condensed(10);
    let changes = spread(ROWS * 10);
    let directions = Directions {
        count: 8,
        loads: (0..6).map(|at| (at, at)).collect(),
        changes: vec![(6, 0), (7, 1)],
    };
    let rates = (spread(ROWS * 6), spread(ROWS * 2));
    let mut results = vec![0.0; ROWS * OUTPUTS * 8];
    group.bench_function("derivatives along eight directions", |bencher| {
        bencher.iter(|| {
            let rates = (rates.0.as_slice(), rates.1.as_slice());
            structure
                .differentiate(
                    black_box(&coefficients),
                    &changes,
                    &directions,
                    rates,
                    &mut results,
                    1,
                )
                .expect("stable")
        });
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
