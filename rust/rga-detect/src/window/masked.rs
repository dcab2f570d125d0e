//! Rows of which some values are missing, fill windows, do not enter, or go to several places.

use pulp::NullaryFnOnce;
use rga_simd::f64::Lanes;

use super::LARGEST;
use super::block::{Block, Pace, Task};
use super::moments::Moments;
use super::tile::{Part, TILE, Tile, WIDTH, mark, prefetch};

/// Bits of all lanes.
const ALL: u64 = (1 << WIDTH) - 1;

impl Block {
    /// Takes a row and those behind it until `walk` can go on; tells the first that is left. None:
    /// a value is infinite.
    ///
    /// A function of its own: the registers of those that call it are theirs.
    #[inline(never)]
    pub(super) fn masked<L: Lanes>(
        &mut self,
        task: &Task<L>,
        tile: &mut Tile,
        part: Part,
        row: usize,
    ) -> Option<usize> {
        task.lanes.vectorize(Masked {
            block: self,
            task,
            tile,
            part,
            row,
        })
    }
}

struct Masked<'a, 'b, L: Lanes> {
    block: &'a mut Block,
    task: &'a Task<L>,
    tile: &'a mut Tile<'b>,
    part: Part,
    row: usize,
}

impl<L: Lanes> NullaryFnOnce for Masked<'_, '_, L> {
    type Output = Option<usize>;

    #[inline(always)]
    fn call(self) -> Option<usize> {
        let Self {
            block,
            task,
            tile,
            part,
            mut row,
        } = self;
        let Task { lanes, weights, .. } = *task;
        let ahead = TILE * tile.sensors;
        let largest = lanes.splat(LARGEST);
        let infinite = lanes.splat(f64::INFINITY);
        let missing = lanes.splat(f64::NAN);
        let mut moments = Moments::load(lanes, &block.moments);
        while row < tile.rows {
            let at = tile.at(part, row);
            let values = &tile.values[at..][..WIDTH];
            prefetch(values, ahead);
            let value = lanes.load(values);
            if lanes.any(lanes.above(lanes.abs(value), largest)) {
                return None;
            }
            let exceeds = moments.exceeded(lanes, &weights, value);
            let entering = if task.frozen {
                lanes.select(exceeds, missing, value)
            } else {
                value
            };
            let enter = lanes.equal(entering, entering);
            let full = lanes.above(infinite, moments.spread);
            let entered = lanes.bits(enter);
            let mut oldest = [0.0; WIDTH];
            for lane in 0..WIDTH {
                let cell = tile.place(row, block.lag[lane]) * tile.blocks + part.block;
                let place = &mut tile.windows[cell].0[lane];
                oldest[lane] = *place;
                if entered >> lane & 1 == 1 {
                    *place = values[lane];
                }
            }
            let moved = moments.moved(lanes, &weights, value, lanes.load(&oldest));
            moments = moved.select(lanes, lanes.and(enter, full), &moments);

            let tested = lanes.bits(lanes.and(lanes.equal(value, value), full));
            let alarms = block.persist(task.persistence, lanes.bits(exceeds), tested);
            mark(&mut tile.alarms[at..][..WIDTH], alarms);
            let mut due = ALL & !lanes.bits(moments.sound(lanes, &weights));
            if entered != ALL || block.pace == Pace::Filling {
                due |= block.count(tile.places as u64, entered);
            }
            if due != 0 {
                moments.store(lanes, &mut block.moments);
                block.sum_anew(tile.windows, tile.blocks, part.block, due);
                moments = Moments::load(lanes, &block.moments);
            }
            row += 1;
            if block.walks(task) {
                break;
            }
        }
        moments.store(lanes, &mut block.moments);
        Some(row)
    }
}

impl Block {
    /// Counts what entered, and tells the windows that are full with it.
    #[inline(always)]
    fn count(&mut self, places: u64, entered: u64) -> u64 {
        let mut filled = 0;
        for lane in 0..WIDTH {
            if entered >> lane & 1 == 0 {
                let lag = self.lag[lane] + 1;
                self.lag[lane] = if lag == places { 0 } else { lag };
            } else if self.lacking[lane] > 0 {
                self.lacking[lane] -= 1;
                filled |= u64::from(self.lacking[lane] == 0) << lane;
            }
        }
        self.pace = Pace::of(&self.lag, &self.lacking);
        filled
    }

    /// Alarms of tested values of which some exceed, in bits of the lanes.
    #[inline(always)]
    fn persist(&mut self, (k, n): (i64, i64), exceeds: u64, tested: u64) -> u64 {
        if n == 1 {
            return exceeds;
        }
        let mut alarms = 0;
        for lane in 0..WIDTH {
            if tested >> lane & 1 == 1 {
                let recent = self.recent[lane] << 1 | exceeds >> lane & 1;
                self.recent[lane] = recent & (u64::MAX >> (64 - n));
                alarms |= u64::from(i64::from(self.recent[lane].count_ones()) >= k) << lane;
            }
        }
        alarms
    }
}
