//! Rows of which some values are missing, fill windows, do not enter, or go to several places.

use pulp::NullaryFnOnce;

use super::LARGEST;
use super::block::{Block, Pace, Task};
use super::columns::Columns;
use super::moments::Moments;
use super::ring::{Ring, WIDTH};
use crate::lanes::Lanes;

impl Block {
    /// Takes a row or more, and tells the first that is left. None: a value is infinite.
    ///
    /// A function of its own: the registers of those that call it are theirs.
    #[inline(never)]
    pub fn careful<L: Lanes>(
        &mut self,
        task: &Task<L>,
        ring: &mut Ring,
        columns: &mut Columns,
        row: usize,
    ) -> Option<usize> {
        task.lanes.vectorize(Careful {
            block: self,
            task,
            ring,
            columns,
            row,
        })
    }
}

struct Careful<'a, 'b, 'c, L: Lanes> {
    block: &'a mut Block,
    task: &'a Task<L>,
    ring: &'a mut Ring<'b>,
    columns: &'a mut Columns<'c>,
    row: usize,
}

impl<L: Lanes> NullaryFnOnce for Careful<'_, '_, '_, L> {
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

impl<L: Lanes> Careful<'_, '_, '_, L> {
    /// Takes rows while all their values are within reach and enter full windows, and leave enough
    /// digits.
    #[inline(always)]
    fn walk(&mut self) -> usize {
        let Self {
            block,
            task,
            ring,
            columns,
            row: from,
        } = self;
        let Task { lanes, weights, .. } = **task;
        let mut moments = Moments::load(lanes, &block.moments);
        let mut cells = [0; WIDTH];
        for lane in 0..WIDTH {
            cells[lane] = ring.next(block.lag[lane]);
        }
        let largest = lanes.splat(LARGEST);
        let mut row = *from;
        while row < columns.rows {
            columns.prefetch(row + columns.rows);
            let value = lanes.load(columns.values(row));
            let mut oldest = [0.0; WIDTH];
            for lane in 0..WIDTH {
                oldest[lane] = ring.cells[cells[lane]].0[lane];
            }
            let moved = moments.moved(lanes, &weights, value, lanes.load(&oldest));
            let within = lanes.at_most(lanes.abs(value), largest);
            let exceeds = lanes.bits(moments.exceeded(lanes, &weights, value));
            let enter = lanes.all(lanes.and(within, moved.sound(lanes, &weights)));
            if !enter || task.frozen && exceeds != 0 {
                break;
            }
            for lane in 0..WIDTH {
                ring.cells[cells[lane]].0[lane] = columns.values(row)[lane];
                cells[lane] = ring.behind(cells[lane]);
            }
            let alarms = block.persist(task.persistence, exceeds, u64::MAX);
            columns.alarm(row, alarms);
            moments = moved;
            row += 1;
        }
        moments.store(lanes, &mut block.moments);
        ring.step(row - *from);
        row
    }

    /// Takes a row.
    #[inline(always)]
    fn sift(self) -> Option<usize> {
        let Self {
            block,
            task,
            ring,
            columns,
            row,
        } = self;
        let Task { lanes, weights, .. } = *task;
        let mut values = [0.0; WIDTH];
        values.copy_from_slice(columns.values(row));
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
            let cell = &mut ring.cells[ring.next(block.lag[lane])].0[lane];
            oldest[lane] = *cell;
            if entered >> lane & 1 == 1 {
                *cell = values[lane];
            }
        }
        let moved = moments.moved(lanes, &weights, value, lanes.load(&oldest));
        let moved = moved.select(lanes, lanes.and(enters, full), &moments);
        moved.store(lanes, &mut block.moments);
        let filled = block.count(ring.places as u64, entered);
        let lost = !lanes.bits(moved.sound(lanes, &weights));
        block.sum_anew(ring, filled | lost);
        let alarms = block.persist(task.persistence, lanes.bits(exceeds), tested);
        columns.alarm(row, alarms);
        ring.step(1);
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

    /// Sums full windows of lanes, given by their bits, from what they hold.
    ///
    /// The shift is the value nearest to the mean: values that are alike leave no rounding, and
    /// M Q - S^2 is then at least half of M Q.
    #[inline(never)]
    pub fn sum_anew(&mut self, ring: &Ring, bits: u64) {
        let count = ring.places as f64;
        let full = |lane: &usize| bits >> lane & 1 == 1 && self.lacking[*lane] == 0;
        for lane in (0..WIDTH).filter(full) {
            let values = || ring.of(lane);
            let first = ring.cells[0].0[lane];
            let mean = first + values().map(|value| value - first).sum::<f64>() / count;
            let shift = values().fold(first, |nearest, value| {
                if (value - mean).abs() < (nearest - mean).abs() {
                    value
                } else {
                    nearest
                }
            });
            let sum = values().map(|value| value - shift).sum::<f64>();
            let square = values().map(|value| (value - shift).powi(2)).sum::<f64>();
            let moments = &mut self.moments;
            moments.shift.0[lane] = shift;
            moments.sum.0[lane] = sum;
            moments.square.0[lane] = square;
            moments.peak.0[lane] = square;
            moments.spread.0[lane] = (count * square - sum * sum).max(0.0);
        }
    }
}
