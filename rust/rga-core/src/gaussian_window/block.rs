//! Eight sensors side by side, one a lane of SIMD vectors.

use super::LARGEST;
use super::columns::Columns;
use super::moments::{Moments, Weights};
use super::ring::{Eight, Ring, WIDTH};
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
    pub fn take<L: Lanes>(
        &mut self,
        task: &Task<L>,
        ring: &mut Ring,
        columns: &mut Columns,
    ) -> bool {
        let mut row = 0;
        while row < columns.rows {
            let next = if self.pace == Pace::Together && task.persistence.1 == 1 {
                self.walk(task, ring, columns, row)
            } else {
                Some(row)
            };
            let next = match next {
                Some(next) if next < columns.rows => self.careful(task, ring, columns, next),
                next => next,
            };
            match next {
                Some(next) => row = next,
                None => return false,
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
        ring: &mut Ring,
        columns: &mut Columns,
        from: usize,
    ) -> Option<usize> {
        let Task { lanes, weights, .. } = *task;
        let mut moments = Moments::load(lanes, &self.moments);
        let mut largest = lanes.splat(0.0);
        let mut cell = ring.next(self.lag[0]);
        let mut row = from;
        while row < columns.rows {
            columns.prefetch(row + columns.rows);
            let value = lanes.load(columns.values(row));
            let Some(place) = ring.cells.get_mut(cell) else {
                break;
            };
            let moved = moments.moved(lanes, &weights, value, lanes.load(&place.0));
            if !lanes.all(moved.sound(lanes, &weights)) {
                break;
            }
            let exceeds = moments.exceeded(lanes, &weights, value);
            if lanes.any(exceeds) {
                if task.frozen {
                    break;
                }
                columns.alarm(row, lanes.bits(exceeds));
            } else {
                columns.alarm(row, 0);
            }
            largest = lanes.max(largest, lanes.abs(value));
            lanes.store(value, &mut place.0);
            moments = moved;
            cell += ring.stride;
            row += 1;
        }
        moments.store(lanes, &mut self.moments);
        ring.step(row - from);
        let within = lanes.at_most(largest, lanes.splat(LARGEST));
        lanes.all(within).then_some(row)
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
