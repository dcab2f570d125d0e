//! Decisions of the window against exact integer arithmetic, on streams that break running sums.

use rga_core::{Array, GaussianWindow, Refusal, WindowRule};

const WINDOW: usize = 100;
const STREAMS: usize = 3;
const ROWS: usize = 200_000;
/// Values are whole multiples of this, so that integers hold them exactly.
const QUANTUM: f64 = 1.0 / (1u64 << 26) as f64;

/// An xorshift generator, as normal as the sum of twelve uniform numbers is.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// An outlier of 1e9 now and then; a level of 1e4 with a spread of 1e-2; a scale that drops by 1e8.
fn values(noise: &mut Noise, row: usize) -> [f64; STREAMS] {
    let outlier = if row % 1777 == 1000 { 1e9 } else { 0.0 };
    let scale = if (row / 5000).is_multiple_of(2) {
        1e3
    } else {
        1e-5
    };
    [
        noise.next() + outlier,
        1e4 + 1e-2 * noise.next(),
        scale * noise.next(),
    ]
    .map(|value| (value / QUANTUM).round() * QUANTUM)
}

/// z = 3 over the values before, in integers.
#[derive(Default)]
struct Exact {
    values: std::collections::VecDeque<i128>,
    sum: i128,
    square: i128,
}

impl Exact {
    fn exceeds(&mut self, value: f64) -> bool {
        let (count, value) = (WINDOW as i128, (value / QUANTUM) as i128);
        let full = self.values.len() == WINDOW;
        let reach = count * value - self.sum;
        let spread = count * self.square - self.sum * self.sum;
        if full && let Some(oldest) = self.values.pop_front() {
            self.sum -= oldest;
            self.square -= oldest * oldest;
        }
        self.values.push_back(value);
        self.sum += value;
        self.square += value * value;
        full && reach > 0 && reach * reach > 9 * spread
    }
}

#[test]
fn decisions_are_exact() -> Result<(), Refusal> {
    let mut window = GaussianWindow::new(WindowRule {
        sensors: STREAMS as i64,
        window: WINDOW as i64,
        z: 3.0,
        inclusive: false,
        persistence: (1, 1),
        frozen: false,
    })?;
    let mut noise = Noise(20_250_101);
    let mut exact: [Exact; STREAMS] = Default::default();
    let mut exceeded = [0; STREAMS];
    for row in 0..ROWS {
        let values = values(&mut noise, row);
        let mut found = [false; STREAMS];
        window.update(Array::new(&values, &[STREAMS]), &mut found)?;
        for stream in 0..STREAMS {
            let right = exact[stream].exceeds(values[stream]);
            assert_eq!(found[stream], right, "stream {stream}, row {row}");
            exceeded[stream] += usize::from(right);
        }
    }
    assert!(
        exceeded.iter().all(|&count| count > 100),
        "{exceeded:?}: a stream tests nothing"
    );
    Ok(())
}
