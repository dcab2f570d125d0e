//! The state of a window as bytes: words of eight, little-endian, all of it.

use super::{GaussianWindow, Refusal, WindowRule};

/// What the bytes are, and the version of their layout.
const MARK: u64 = u64::from_le_bytes(*b"rgawin01");

const HEADER: usize = 9;

/// Arrays with one word a sensor.
const COLUMNS: usize = 7;

impl GaussianWindow {
    pub fn to_bytes(&self) -> Vec<u8> {
        let rule = &self.rule;
        let header: [u64; HEADER] = [
            MARK,
            rule.sensors as u64,
            rule.window as u64,
            rule.z.to_bits(),
            u64::from(rule.inclusive),
            rule.persistence.0 as u64,
            rule.persistence.1 as u64,
            u64::from(rule.frozen),
            self.rows,
        ];
        let counts = [&self.slot, &self.laps, &self.recent];
        let sums = [&self.shift, &self.sum, &self.square, &self.peak, &self.ring];
        let counts = counts.into_iter().flatten().copied();
        let sums = sums.into_iter().flatten().map(|value| value.to_bits());
        let words = header.into_iter().chain(counts).chain(sums);
        words.flat_map(u64::to_le_bytes).collect()
    }

    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Refusal> {
        let (words, rest) = bytes.as_chunks::<8>();
        let mut words = words.iter().map(|word| u64::from_le_bytes(*word));
        let mut next = || words.next();
        let (Some(MARK), []) = (next(), rest) else {
            return Err(foreign("do not begin as such a state does"));
        };
        let header: [u64; HEADER - 1] = std::array::from_fn(|_| next().unwrap_or_default());
        let [sensors, window, z, inclusive, k, n, frozen, rows] = header;
        let rule = WindowRule {
            sensors: sensors as i64,
            window: window as i64,
            z: f64::from_bits(z),
            inclusive: inclusive != 0,
            persistence: (k as i64, n as i64),
            frozen: frozen != 0,
        };
        rule.check()?;
        let columns = (rule.earlier() as u128 + COLUMNS as u128) * u128::from(sensors);
        if bytes.len() as u128 / 8 != HEADER as u128 + columns {
            return Err(foreign("have another length than their header says"));
        }
        let mut window = Self::new(rule)?;
        window.rows = rows;
        for counts in [&mut window.slot, &mut window.laps, &mut window.recent] {
            for (count, word) in counts.iter_mut().zip(&mut words) {
                *count = word;
            }
        }
        for sums in [
            &mut window.shift,
            &mut window.sum,
            &mut window.square,
            &mut window.peak,
            &mut window.ring,
        ] {
            for (value, word) in sums.iter_mut().zip(&mut words) {
                *value = f64::from_bits(word);
            }
        }
        let end = window.earlier as u64;
        if window.slot.iter().any(|&slot| slot >= end) {
            return Err(foreign("name a place outside the window"));
        }
        Ok(window)
    }
}

fn foreign(how: &str) -> Refusal {
    let remedy = "give the bytes that to_bytes() of a GaussianWindow returned";
    Refusal::new(format!("the bytes {how}"), "from_bytes", remedy)
}
