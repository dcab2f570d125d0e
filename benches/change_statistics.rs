//! The statistics of the monitor: 84 sensors, one core, rows that caches do not hold; each sensor by
//! itself, and with memory and sensors that go together.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rga_detect::{Array, ChangeStatistics, Reference, ReferenceArrays, STATISTICS};

const SENSORS: usize = 84;
const ROWS: usize = 100_000;
const KNOTS: usize = 9;
const KEPT: usize = 2048;

/// About normal, and the same in every run.
fn noise(count: usize) -> Vec<f64> {
    let uniform = |at: usize| ((at as f64 + 1.0) * 0.754_877_666).fract() - 0.5;
    (0..count)
        .map(|at| 2.0 * (uniform(3 * at) + uniform(5 * at) + uniform(7 * at)))
        .collect()
}

/// Statistics that never alarm.
fn statistics(order: usize, in_common: f64) -> ChangeStatistics {
    let (zeros, ones) = (vec![0.0; SENSORS], vec![1.0; SENSORS]);
    let weights = vec![0.3; order * SENSORS];
    let knots: Vec<f64> = (0..KNOTS * SENSORS)
        .map(|at| (at / SENSORS) as f64 - 4.0)
        .collect();
    let bends = vec![0.0; KNOTS * SENSORS];
    let mixing: Vec<f64> = (0..SENSORS * SENSORS)
        .map(|at| f64::from(u8::from(at / SENSORS == at % SENSORS)) - in_common)
        .collect();
    let signature = vec![(SENSORS as f64).powf(-0.5); SENSORS];
    let reference = Reference::new(ReferenceArrays {
        level: Array::new(&zeros, &[SENSORS]),
        weights: Array::new(&weights, &[order, SENSORS]),
        units: Array::new(&ones, &[SENSORS]),
        offset: Array::new(&zeros, &[SENSORS]),
        slope: Array::new(&ones, &[SENSORS]),
        knots: Array::new(&knots, &[KNOTS, SENSORS]),
        bends: Array::new(&bends, &[KNOTS, SENSORS]),
        mixing: Array::new(&mixing, &[SENSORS, SENSORS]),
        signature: Array::new(&signature, &[SENSORS]),
        largest: 3.5,
    })
    .expect("the arrays fit");
    ChangeStatistics::new(reference, [f32::INFINITY; STATISTICS], KEPT)
}

fn bench(criterion: &mut Criterion) {
    let rows = noise(ROWS * SENSORS);
    let mut group = criterion.benchmark_group("change statistics");
    group.throughput(Throughput::Bytes(8 * rows.len() as u64));
    group.sample_size(20);
    for (name, order, in_common) in [("each by itself", 0, 0.0), ("in common", 1, 1e-3)] {
        let mut statistics = statistics(order, in_common);
        group.bench_function(name, |bencher| {
            bencher.iter(|| statistics.update_many(Array::new(&rows, &[ROWS, SENSORS])));
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
