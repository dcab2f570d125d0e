//! Rows of a structure of which some terms have play: the sides on which they bear are sought.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rga_core::{Laws, UnitResponses, pseudo_forces};

const ROWS: usize = 300;
const PATTERNS: usize = 4;

/// Numbers that are spread evenly and repeat in every run.
fn spread(count: usize) -> Vec<f64> {
    (0..count)
        .map(|at| ((at as f64 + 1.0) * 0.754_877_666).fract() - 0.5)
        .collect()
}

/// Terms of stiffness one beside others as stiff, that give way to each other a little.
fn condensed(terms: usize) -> UnitResponses {
    let drawn = spread(terms * terms);
    let flexibility = |row: usize, column: usize| {
        let both = drawn[row * terms + column] + drawn[column * terms + row];
        if row == column {
            0.5
        } else {
            0.2 * both / terms as f64
        }
    };
    UnitResponses {
        patterns: PATTERNS,
        outputs: 1,
        elements: terms,
        element: (0..terms).collect(),
        stiffness: vec![1.0; terms],
        loaded: vec![0.0; PATTERNS],
        stretched: spread(PATTERNS * terms),
        influence: vec![0.0; terms],
        unit: (0..terms * terms)
            .map(|at| flexibility(at / terms, at % terms))
            .collect(),
    }
}

fn bench(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("300 rows with play");
    group.throughput(Throughput::Elements(ROWS as u64));
    for terms in [1, 10, 50] {
        let structure = condensed(terms);
        let coefficients = spread(ROWS * PATTERNS);
        let (size, stiffness) = (vec![0.1; ROWS * terms], vec![1.0; ROWS * terms]);
        group.bench_function(format!("{terms} terms"), |bencher| {
            bencher.iter(|| {
                let laws = Laws {
                    size: &size,
                    stiffness: &stiffness,
                    rod: &vec![false; terms],
                };
                pseudo_forces(&structure, black_box(&coefficients), laws).expect("held")
            });
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
