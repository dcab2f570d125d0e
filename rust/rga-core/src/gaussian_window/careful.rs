//! Rows of which some values are missing, fill windows, do not enter, or go to several places.

use pulp::NullaryFnOnce;

use super::LARGEST;
use super::block::{Block, Pace, Task};
use super::moments::Moments;
use super::tile::{Part, Tile, WIDTH};
use crate::lanes::Lanes;

impl Block {
    /// Takes a row or more, and tells the first that is left. None: a value is infinite.
    ///
    /// A function of its own: the registers of those that call it are theirs.
    #[inline(never)]
    pub fn careful<L: Lanes>(
        &mut self,
        task: &Task<L>,
        tile: &mut Tile,
        part: Part,
        row: usize,
    ) -> Option<usize> {
        task.lanes.vectorize(Careful {
            block: self,
            task,
            tile,
            part,
            row,
        })
    }
}

struct Careful<'a, 'b, L: Lanes> {
    block: &'a mut Block,
    task: &'a Task<L>,
    tile: &'a mut Tile<'b>,
    part: Part,
    row: usize,
}

impl<L: Lanes> NullaryFnOnce for Careful<'_, '_, L> {
    type Output = Option<usize>;

    #[inline(always)]
    fn call(mut self) -> Option<usize> {
        let next = match self.block.pace {
            Pace::Filling => self.row,
            Pace::Apart | Pace::Together => self.walk(),
        };
        if next > self.row {
            Some(next)
        } else {
            self.sift()
        }
    }
}

impl<L: Lanes> Careful<'_, '_, L> {
    /// Takes rows while all their values are within reach and enter full windows, and leave enough
    /// digits.
    #[inline(always)]
    fn walk(&mut self) -> usize {
        let Self {
            block,
            task,
            tile,
            part,
            ..
        } = self;
        let (part, from) = (*part, self.row);
        let Task { lanes, weights, .. } = **task;
        let mut moments = Moments::load(lanes, &block.moments);
        let largest = lanes.splat(LARGEST);
        let mut row = from;
        while row < tile.rows {
            tile.prefetch(part, row + tile.rows);
            let value = lanes.load(tile.values(part, row));
            let (mut cells, mut oldest) = ([0; WIDTH], [0.0; WIDTH]);
            for lane in 0..WIDTH {
                cells[lane] = tile.cell(part, row, block.lag[lane]);
            }
            for lane in 0..WIDTH {
                oldest[lane] = tile.windows[cells[lane]].0[lane];
            }
            let moved = moments.moved(lanes, &weights, value, lanes.load(&oldest));
            let within = lanes.at_most(lanes.abs(value), largest);
            let exceeds = lanes.bits(moments.exceeded(lanes, &weights, value));
            let enter = lanes.all(lanes.and(within, moved.sound(lanes, &weights)));
            if !enter || task.frozen && exceeds != 0 {
                break;
            }
            let mut own = [0.0; WIDTH];
            lanes.store(value, &mut own);
            for lane in 0..WIDTH {
                tile.windows[cells[lane]].0[lane] = own[lane];
            }
            let alarms = block.persist(task.persistence, exceeds, u64::MAX);
            tile.alarm(part, row, alarms);
            moments = moved;
            row += 1;
        }
        moments.store(lanes, &mut block.moments);
        row
    }

    /// Takes a row.
    #[inline(always)]
    fn sift(self) -> Option<usize> {
        let Self {
            block,
            task,
            tile,
            part,
            row,
        } = self;
        let Task { lanes, weights, .. } = *task;
        let mut values = [0.0; WIDTH];
        values.copy_from_slice(tile.values(part, row));
        for value in values {
            if value.abs() > LARGEST {
                return None;
            }
        }
        let value = lanes.load(&values);
        let moments = Moments::load(lanes, &block.moments);
        let exceeds = moments.exceeded(lanes, &weights, value);
        let entering = if task.frozen {
            lanes.select(exceeds, lanes.splat(f64::NAN), value)
        } else {
            value
        };
        let enters = lanes.equal(entering, entering);
        let full = lanes.above(lanes.splat(f64::INFINITY), moments.spread);
        let tested = lanes.bits(lanes.and(lanes.equal(value, value), full));
        let entered = lanes.bits(enters);
        let mut oldest = [0.0; WIDTH];
        for lane in 0..WIDTH {
            let cell = tile.cell(part, row, block.lag[lane]);
            let cell = &mut tile.windows[cell].0[lane];
            oldest[lane] = *cell;
            if entered >> lane & 1 == 1 {
                *cell = values[lane];
            }
        }
        let moved = moments.moved(lanes, &weights, value, lanes.load(&oldest));
        let moved = moved.select(lanes, lanes.and(enters, full), &moments);
        moved.store(lanes, &mut block.moments);
        let filled = block.count(tile.places as u64, entered);
        let lost = !lanes.bits(moved.sound(lanes, &weights)) & 0xff;
        if filled | lost != 0 {
            block.sum_anew(tile, part, filled | lost);
        }
        let alarms = block.persist(task.persistence, lanes.bits(exceeds), tested);
        tile.alarm(part, row, alarms);
        Some(row + 1)
    }
}

impl Block {
    /// Counts what entered, and tells the windows that are full with it.
    #[inline(always)]
    fn count(&mut self, places: u64, entered: u64) -> u64 {
        let mut filled = 0;
        for lane in 0..WIDTH {
            if entered >> lane & 1 == 0 {
                self.lag[lane] = (self.lag[lane] + 1) % places;
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
