//! A few rows, and the windows of all sensors that they go into.

/// Sensors of a block.
pub const WIDTH: usize = 8;

/// A number of each sensor of a block, in one line of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Eight(pub [f64; WIDTH]);

impl Eight {
    pub const ZERO: Self = Self([0.0; WIDTH]);
}

/// Rows that do not go beyond the last place of a window.
pub struct Tile<'a> {
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
pub struct Part {
    pub block: usize,
    /// Its first sensor.
    pub first: usize,
}

impl Tile<'_> {
    #[inline(always)]
    pub fn values(&self, part: Part, row: usize) -> &[f64] {
        &self.values[row * self.sensors + part.first..][..WIDTH]
    }

    /// Alarms of lanes, given by their bits.
    #[inline(always)]
    pub fn alarm(&mut self, part: Part, row: usize, bits: u64) {
        let own = &mut self.alarms[row * self.sensors + part.first..][..WIDTH];
        own.copy_from_slice(&MARKS[bits as usize]);
    }

    /// Asks for the values of a row, which may lie behind the last one, to be brought to the cache.
    ///
    /// Blocks read rows with strides, which processors do not foresee.
    #[inline(always)]
    pub fn prefetch(&self, part: Part, row: usize) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            let at = row * self.sensors + part.first;
            // SAFETY: a hint that may name any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(self.values.as_ptr().wrapping_add(at).cast()) };
        }
    }

    /// The cell that a row goes into, in a lane that is some places behind.
    #[inline(always)]
    pub fn cell(&self, part: Part, row: usize, lag: u64) -> usize {
        let (slot, lag) = (self.slot + row, lag as usize);
        let around = if lag > slot { self.places } else { 0 };
        (slot + around - lag) * self.blocks + part.block
    }
}

/// Marks of lanes by their bits.
const MARKS: [[bool; WIDTH]; 1 << WIDTH] = {
    let mut marks = [[false; WIDTH]; 1 << WIDTH];
    let mut at = 0;
    while at < WIDTH << WIDTH {
        marks[at / WIDTH][at % WIDTH] = at / WIDTH >> (at % WIDTH) & 1 == 1;
        at += 1;
    }
    marks
};
