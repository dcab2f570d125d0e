//! Eight sensors side by side, one a lane of SIMD vectors.

use rga_simd::f64::Lanes;

use super::LARGEST;
use super::moments::{Moments, Weights};
use super::tile::{Eight, Part, TILE, Tile, WIDTH, mark, prefetch};

/// Sensors and blocks that no window has.
const MANY: usize = u32::MAX as usize;

/// Values of this size are far from the largest, and so are their differences.
const USUAL: f64 = 1e-2 * LARGEST;

#[derive(Debug, Clone)]
pub(super) struct Block {
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
pub(super) enum Pace {
    /// Some windows are not full.
    Filling,
    /// The next values go to several places.
    Apart,
    /// The next values go to one place.
    Together,
}

/// A rule as blocks follow it.
#[derive(Clone, Copy)]
pub(super) struct Task<L: Lanes> {
    pub lanes: L,
    pub weights: Weights<L::Numbers>,
    pub persistence: (i64, i64),
    pub frozen: bool,
}

impl Block {
    pub(super) fn new(earlier: usize) -> Self {
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
    pub(super) fn take<L: Lanes>(&mut self, task: &Task<L>, tile: &mut Tile, part: Part) -> bool {
        let mut row = 0;
        loop {
            if self.walks(task) {
                match self.walk(task, tile, part, row) {
                    Some(next) => row = next,
                    None => return false,
                }
            }
            if row >= tile.rows {
                return true;
            }
            // Copies, so that what is copied stays in registers.
            let task = *task;
            match self.masked(&task, &mut tile.again(), part, row) {
                Some(next) => row = next,
                None => return false,
            }
        }
    }

    /// Tests the only row of a tile, which holds no infinite value, and lets it into the windows.
    /// False: it takes `take` for that, and nothing has changed.
    #[inline(always)]
    pub(super) fn step<L: Lanes>(&mut self, task: &Task<L>, tile: &mut Tile, part: Part) -> bool {
        let Task {
            lanes,
            weights,
            frozen,
            ..
        } = *task;
        if !self.walks(task) {
            return false;
        }
        let own = part.first..part.first + WIDTH;
        let cell = tile.place(0, self.lag[0]) * tile.blocks + part.block;
        let cell = &mut tile.windows[cell].0;
        let moments = Moments::load(lanes, &self.moments);
        let values = &tile.values[own.clone()];
        prefetch(values, TILE * tile.sensors);
        let value = lanes.load(values);
        let moved = moments.moved(lanes, &weights, value, lanes.load(cell));
        let exceeds = lanes.bits(moments.exceeded(lanes, &weights, value));
        if !lanes.all(moved.sound(lanes, &weights)) || frozen && exceeds != 0 {
            return false;
        }
        lanes.store(value, cell);
        mark(&mut tile.alarms[own], exceeds);
        moved.store(lanes, &mut self.moments);
        true
    }

    /// Whether `walk` can take rows.
    #[inline(always)]
    pub(super) fn walks<L: Lanes>(&self, task: &Task<L>) -> bool {
        self.pace == Pace::Together && task.persistence.1 == 1
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
        let Task {
            lanes,
            weights,
            frozen,
            ..
        } = *task;
        let place = tile.place(from, self.lag[0]);
        let until = tile.rows.min(from + tile.places - place);
        let ahead = TILE * tile.sensors;
        // With these bounds a compiler sees that products do not wrap, and need not divide lengths.
        let count = until.saturating_sub(from).min(TILE);
        let (sensors, blocks) = (tile.sensors.min(MANY), tile.blocks.min(MANY));
        let values = tile.values[from * sensors..][..count * sensors].chunks_exact(sensors);
        let alarms = tile.alarms[from * sensors..][..count * sensors].chunks_exact_mut(sensors);
        let cells = tile.windows[place * blocks..][..count * blocks].chunks_exact_mut(blocks);
        let own = part.first..part.first + WIDTH;
        let mut moments = Moments::load(lanes, &self.moments);
        let mut row = from;
        for ((values, alarms), cells) in values.zip(alarms).zip(cells) {
            let (values, alarms) = (&values[own.clone()], &mut alarms[own.clone()]);
            let cell = &mut cells[part.block].0;
            prefetch(values, ahead);
            let value = lanes.load(values);
            let moved = moments.moved(lanes, &weights, value, lanes.load(cell));
            let exceeds = lanes.bits(moments.exceeded(lanes, &weights, value));
            if !lanes.all(moved.sound(lanes, &weights)) || frozen && exceeds != 0 {
                break;
            }
            lanes.store(value, cell);
            mark(alarms, exceeds);
            moments = moved;
            row += 1;
        }
        moments.store(lanes, &mut self.moments);
        // What is too large has left a trace, unless the shift is as large.
        let usual = lanes.splat(USUAL);
        let near = lanes.at_most(lanes.abs(moments.shift), usual);
        let small = lanes.at_most(moments.peak, lanes.mul(usual, usual));
        let within = lanes.all(lanes.and(near, small)) || tile.within(part, from..row);
        within.then_some(row)
    }

    /// Sums full windows of lanes, given by their bits, from what they hold; windows are
    /// `[places, blocks]`, and this block is `own` of them.
    ///
    /// The shift is the value nearest to the mean: values that are alike leave no rounding, and
    /// M Q - S^2 is then at least half of M Q.
    #[inline(never)]
    pub(super) fn sum_anew(&mut self, windows: &[Eight], blocks: usize, own: usize, bits: u64) {
        let values = || windows[own..].iter().step_by(blocks);
        let count = (windows.len() / blocks) as f64;
        let first = windows[own].0;
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
                let spread = (-sum[lane]).mul_add(sum[lane], count * square[lane]);
                moments.spread.0[lane] = spread.max(0.0);
            }
        }
    }
}

impl Pace {
    pub(super) fn of(lag: &[u64; WIDTH], lacking: &[u64; WIDTH]) -> Self {
        if *lacking != [0; WIDTH] {
            Self::Filling
        } else if *lag == [lag[0]; WIDTH] {
            Self::Together
        } else {
            Self::Apart
        }
    }
}
