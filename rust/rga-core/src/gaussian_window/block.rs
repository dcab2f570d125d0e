//! Eight sensors side by side, one a lane of SIMD vectors.

use super::LARGEST;
use super::moments::{Moments, Weights};
use super::tile::{Eight, Part, Tile, WIDTH};
use crate::lanes::Lanes;

#[derive(Debug, Clone)]
pub struct Block {
    /// Rows of which nothing entered, modulo M: places that a lane is behind.
    pub lag: [u64; WIDTH],
    /// Values until the window is full.
    pub lacking: [u64; WIDTH],
    /// Bits of the last tested values, newest lowest: it exceeded. Kept where alarms persist.
    pub recent: [u64; WIDTH],
    pub moments: Moments<Eight>,
    pub pace: Pace,
}

/// What the lanes of a block have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// Some windows are not full.
    Filling,
    /// The next values go to several places.
    Apart,
    /// The next values go to one place.
    Together,
}

/// A rule as blocks follow it.
#[derive(Clone, Copy)]
pub struct Task<L: Lanes> {
    pub lanes: L,
    pub weights: Weights<L::Numbers>,
    pub persistence: (i64, i64),
    pub frozen: bool,
}

impl Block {
    pub fn new(earlier: usize) -> Self {
        Self {
            lag: [0; WIDTH],
            lacking: [earlier as u64; WIDTH],
            recent: [0; WIDTH],
            moments: Moments::FILLING,
            pace: Pace::Filling,
        }
    }

    /// Tests rows and lets them into the windows. False: some have, and a value is infinite.
    #[inline(always)]
    pub fn take<L: Lanes>(&mut self, task: &Task<L>, tile: &mut Tile, part: Part) -> bool {
        let mut row = 0;
        while row < tile.rows {
            if self.pace == Pace::Together && task.persistence.1 == 1 {
                match self.walk(task, tile, part, row) {
                    Some(next) => row = next,
                    None => return false,
                }
            }
            if row < tile.rows {
                match self.careful(task, tile, part, row) {
                    Some(next) => row = next,
                    None => return false,
                }
            }
        }
        true
    }

    /// Takes rows while all their values enter windows that are full and together, and leave
    /// enough digits; tells the first row that is left. None: a value is infinite.
    #[inline(always)]
    fn walk<L: Lanes>(
        &mut self,
        task: &Task<L>,
        tile: &mut Tile,
        part: Part,
        from: usize,
    ) -> Option<usize> {
        let Task { lanes, weights, .. } = *task;
        let mut moments = Moments::load(lanes, &self.moments);
        let mut largest = lanes.splat(0.0);
        let mut cell = tile.cell(part, from, self.lag[0]);
        let mut row = from;
        while row < tile.rows {
            tile.prefetch(part, row + tile.rows);
            let value = lanes.load(tile.values(part, row));
            let Some(place) = tile.windows.get_mut(cell) else {
                break;
            };
            let moved = moments.moved(lanes, &weights, value, lanes.load(&place.0));
            if !lanes.all(moved.sound(lanes, &weights)) {
                break;
            }
            let exceeds = moments.exceeded(lanes, &weights, value);
            let mut alarms = 0;
            if lanes.any(exceeds) {
                if task.frozen {
                    break;
                }
                alarms = lanes.bits(exceeds);
            }
            largest = lanes.max(largest, lanes.abs(value));
            lanes.store(value, &mut place.0);
            tile.alarm(part, row, alarms);
            moments = moved;
            cell += tile.blocks;
            row += 1;
        }
        moments.store(lanes, &mut self.moments);
        let within = lanes.at_most(largest, lanes.splat(LARGEST));
        lanes.all(within).then_some(row)
    }

    /// Sums full windows of lanes, given by their bits, from what they hold.
    ///
    /// The shift is the value nearest to the mean: values that are alike leave no rounding, and
    /// M Q - S^2 is then at least half of M Q.
    #[inline(never)]
    pub fn sum_anew(&mut self, tile: &Tile, part: Part, bits: u64) {
        let values = || tile.windows[part.block..].iter().step_by(tile.blocks);
        let count = tile.places as f64;
        let first = tile.windows[part.block].0;
        let (mut mean, mut shift) = ([0.0; WIDTH], first);
        let (mut sum, mut square) = ([0.0; WIDTH], [0.0; WIDTH]);
        for value in values() {
            for lane in 0..WIDTH {
                mean[lane] += value.0[lane] - first[lane];
            }
        }
        for lane in 0..WIDTH {
            mean[lane] = first[lane] + mean[lane] / count;
        }
        for value in values() {
            for lane in 0..WIDTH {
                let nearer = (value.0[lane] - mean[lane]).abs() < (shift[lane] - mean[lane]).abs();
                shift[lane] = if nearer { value.0[lane] } else { shift[lane] };
            }
        }
        for value in values() {
            for lane in 0..WIDTH {
                let gained = value.0[lane] - shift[lane];
                sum[lane] += gained;
                square[lane] += gained * gained;
            }
        }
        let moments = &mut self.moments;
        for lane in 0..WIDTH {
            if bits >> lane & 1 == 1 && self.lacking[lane] == 0 {
                moments.shift.0[lane] = shift[lane];
                moments.sum.0[lane] = sum[lane];
                moments.square.0[lane] = square[lane];
                moments.peak.0[lane] = square[lane];
                let spread = count * square[lane] - sum[lane] * sum[lane];
                moments.spread.0[lane] = spread.max(0.0);
            }
        }
    }
}

impl Pace {
    pub fn of(lag: &[u64; WIDTH], lacking: &[u64; WIDTH]) -> Self {
        if *lacking != [0; WIDTH] {
            Self::Filling
        } else if *lag == [lag[0]; WIDTH] {
            Self::Together
        } else {
            Self::Apart
        }
    }
}
