//! The window detector: 84 sensors, a window of 200 values, one core; many rows in a call, and one
//! by one.
//!
//! The roof is to read the rows, which caches do not hold: bytes a second beside bytes a second.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pulp::{Arch, Simd, WithSimd};
use rga_detect::{Array, GaussianWindow, WindowRule};

const SENSORS: usize = 84;
const ROWS: usize = 200_000;

const RULE: WindowRule = WindowRule {
    sensors: SENSORS as i64,
    window: 200,
    z: 3.0,
    inclusive: false,
    persistence: (1, 1),
    frozen: false,
};

/// Squares, as of gaps, that repeat in every run; one in a hundred alarms.
fn squares(count: usize) -> Vec<f64> {
    let uniform = |at: usize| ((at as f64 + 1.0) * 0.754_877_666).fract() - 0.5;
    (0..count)
        .map(|at| (uniform(3 * at) + uniform(5 * at) + uniform(7 * at)).powi(2))
        .collect()
}

/// All bits of values, on the widest vectors.
struct Read<'a>(&'a [f64]);

impl WithSimd for Read<'_> {
    type Output = [u64; 64];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [u64; 64] {
        let (lanes, _) = self.0.as_chunks::<64>();
        let mut sums = [0; 64];
        for lane in lanes {
            for (sum, value) in sums.iter_mut().zip(lane) {
                *sum ^= value.to_bits();
            }
        }
        sums
    }
}

fn bench(criterion: &mut Criterion) {
    let rows = squares(ROWS * SENSORS);
    let mut alarms = vec![false; rows.len()];
    let mut group = criterion.benchmark_group("gaussian window");
    group.throughput(Throughput::Bytes(8 * rows.len() as u64));
    group.sample_size(20);
    group.bench_function("read", |bencher| {
        bencher.iter(|| Arch::new().dispatch(Read(black_box(&rows))));
    });
    let mut window = GaussianWindow::new(RULE).expect("the rule is sound");
    group.bench_function("update_many", |bencher| {
        bencher.iter(|| window.update_many(Array::new(&rows, &[ROWS, SENSORS]), &mut alarms));
    });
    group.bench_function("update", |bencher| {
        bencher.iter(|| {
            for (row, alarms) in rows.chunks(SENSORS).zip(alarms.chunks_mut(SENSORS)) {
                window
                    .update(Array::new(row, &[SENSORS]), alarms)
                    .expect("finite");
            }
        });
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
