//! The state of a window as bytes: words of eight, little-endian, all of it.

use super::block::{Block, Pace};
use super::moments::Moments;
use super::tile::{Eight, WIDTH};
use super::{GaussianWindow, WindowRule};
use crate::refusal::Refusal;

/// What the bytes are, and the version of their layout.
const MARK: u64 = u64::from_le_bytes(*b"rgawin02");

const HEADER: usize = 9;

/// One word a lane.
type Line = [u64; WIDTH];

/// Lines of a block beside its windows.
const LINES: usize = 8;

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
        let blocks = self.blocks.iter().flat_map(Block::lines);
        let lines = blocks.chain(self.ring.iter().copied().map(Eight::to_bits));
        let words = header.into_iter().chain(lines.flatten());
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
        let blocks = rule.sensors().div_ceil(WIDTH) as u128;
        let lines = (rule.earlier() + LINES) as u128 * blocks;
        if bytes.len() as u128 / 8 != HEADER as u128 + lines * WIDTH as u128 {
            return Err(foreign("have another length than their header says"));
        }
        let mut window = Self::new(rule)?;
        window.rows = rows;
        window.slot = (rows % rule.earlier() as u64) as usize;
        let mut line = || -> Line { std::array::from_fn(|_| words.next().unwrap_or_default()) };
        for block in &mut window.blocks {
            *block = Block::from_lines(std::array::from_fn(|_| line()));
        }
        for cell in &mut window.ring {
            *cell = Eight::from_bits(line());
        }
        let end = rule.earlier() as u64;
        let mut lags = window.blocks.iter().flat_map(|block| block.lag);
        if lags.any(|lag| lag >= end) {
            return Err(foreign("name a place outside the window"));
        }
        Ok(window)
    }
}

impl Block {
    fn lines(&self) -> [Line; LINES] {
        let Moments {
            shift,
            sum,
            square,
            peak,
            spread,
        } = self.moments;
        let sums = [shift, sum, square, peak, spread];
        let [shift, sum, square, peak, spread] = sums.map(Eight::to_bits);
        let counts = [self.lag, self.lacking, self.recent];
        let [lag, lacking, recent] = counts;
        [lag, lacking, recent, shift, sum, square, peak, spread]
    }

    fn from_lines(lines: [Line; LINES]) -> Self {
        let [lag, lacking, recent, sums @ ..] = lines;
        let [shift, sum, square, peak, spread] = sums.map(Eight::from_bits);
        Self {
            lag,
            lacking,
            recent,
            pace: Pace::of(&lag, &lacking),
            moments: Moments {
                shift,
                sum,
                square,
                peak,
                spread,
            },
        }
    }
}

impl Eight {
    fn to_bits(self) -> Line {
        self.0.map(f64::to_bits)
    }

    fn from_bits(line: Line) -> Self {
        Self(line.map(f64::from_bits))
    }
}

fn foreign(how: &str) -> Refusal {
    let remedy = "give the bytes that to_bytes() of a GaussianWindow returned";
    Refusal::new(format!("the bytes {how}"), "from_bytes", remedy)
}
