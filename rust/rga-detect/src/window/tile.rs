//! A few rows, and the windows of all sensors that they go into.

use std::ops::Range;

use super::LARGEST;

/// Sensors of a block.
pub(super) const WIDTH: usize = 8;

/// Rows of a tile at most: they stay in the nearest cache while one block after the other takes
/// them.
pub(super) const TILE: usize = 32;

/// A number of each sensor of a block, in one line of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Eight(pub [f64; WIDTH]);

impl Eight {
    pub(super) const ZERO: Self = Self([0.0; WIDTH]);
}

/// Rows that do not go beyond the last place of a window.
pub(super) struct Tile<'a> {
    /// `[rows, sensors]`
    pub values: &'a [f64],
    /// `[rows, sensors]`
    pub alarms: &'a mut [bool],
    pub rows: usize,
    pub sensors: usize,
    /// `[places, blocks]`
    pub windows: &'a mut [Eight],
    /// M
    pub places: usize,
    pub blocks: usize,
    /// Where the first row goes.
    pub slot: usize,
}

/// The part of a block in a tile.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub block: usize,
    /// Its first sensor.
    pub first: usize,
}

impl Tile<'_> {
    /// The same, borrowed once more.
    #[inline(always)]
    pub(super) fn again(&mut self) -> Tile<'_> {
        Tile {
            alarms: &mut *self.alarms,
            windows: &mut *self.windows,
            ..*self
        }
    }

    /// Index of the first value of a block in a row.
    #[inline(always)]
    pub(super) fn at(&self, part: Part, row: usize) -> usize {
        row * self.sensors + part.first
    }

    /// Where a row goes in a lane that is some places behind.
    #[inline(always)]
    pub(super) fn place(&self, row: usize, lag: u64) -> usize {
        let (slot, lag) = (self.slot + row, lag as usize);
        let around = if lag > slot { self.places } else { 0 };
        slot + around - lag
    }

    /// Whether no value of a block in rows is too large.
    #[inline(never)]
    pub(super) fn within(&self, part: Part, rows: Range<usize>) -> bool {
        let mut values = rows.flat_map(|row| &self.values[self.at(part, row)..][..WIDTH]);
        values.all(|value| value.abs() <= LARGEST)
    }
}

/// Writes the alarms of lanes, given by their bits.
#[inline(always)]
pub(super) fn mark(alarms: &mut [bool], bits: u64) {
    alarms.copy_from_slice(&MARKS[bits as usize]);
}

/// Marks of lanes by their bits.
const MARKS: [[bool; WIDTH]; 1 << WIDTH] = {
    let mut marks = [[false; WIDTH]; 1 << WIDTH];
    let mut at = 0;
    while at < WIDTH << WIDTH {
        marks[at / WIDTH][at % WIDTH] = (at / WIDTH) >> (at % WIDTH) & 1 == 1;
        at += 1;
    }
    marks
};

/// Asks for what stands ahead of values, maybe behind all of them, to be brought to the cache.
///
/// Blocks read rows with strides, which processors do not foresee.
#[inline(always)]
pub(super) fn prefetch(values: &[f64], ahead: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a hint that may name any address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(values.as_ptr().wrapping_add(ahead).cast()) };
    }
}
