//! Batches of samples: loads vary (C1), few stiffnesses vary (C2), and derivatives.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rga_core::{Condensation, Directions, UnitResponses};

const ROWS: usize = 4096;
const PATTERNS: usize = 12;
const OUTPUTS: usize = 16;

/// Numbers that are spread evenly and repeat in every run.
fn spread(count: usize) -> Vec<f64> {
    (0..count)
        .map(|at| ((at as f64 + 1.0) * 0.754_877_666).fract() - 0.5)
        .collect()
}

fn condensation(terms: usize) -> Condensation {
    let mut unit = spread(terms * terms);
    for row in 0..terms {
        for column in 0..row {
            unit[row * terms + column] = unit[column * terms + row];
        }
        unit[row * terms + row] = terms as f64;
    }
    Condensation::new(UnitResponses {
        patterns: PATTERNS,
        outputs: OUTPUTS,
        elements: terms,
        element: (0..terms).collect(),
        stiffness: vec![0.0; terms],
        loaded: spread(PATTERNS * OUTPUTS),
        stretched: spread(PATTERNS * terms),
        influence: spread(terms * OUTPUTS),
        unit,
    })
}

fn bench(criterion: &mut Criterion) {
    let coefficients = spread(ROWS * PATTERNS);
    let mut group = criterion.benchmark_group("4096 samples");
    group.throughput(Throughput::Elements(ROWS as u64));
    for (name, terms) in [("C1", 0), ("C2, ten terms", 10)] {
        let structure = condensation(terms);
        let structure = structure.samples().expect("terms are independent");
        let changes: Vec<f64> = spread(ROWS * terms)
            .iter()
            .map(|change| 0.01 * change)
            .collect();
        let mut results = vec![0.0; ROWS * OUTPUTS];
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                structure
                    .respond(black_box(&coefficients), &changes, &mut results, 1)
                    .expect("stable")
            });
        });
    }
    let structure = condensation(10);
    let structure = structure.samples().expect("terms are independent");
    let changes: Vec<f64> = spread(ROWS * 10)
        .iter()
        .map(|change| 0.01 * change)
        .collect();
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
