//! What a block reads and writes in rows of all sensors.

use super::ring::WIDTH;

/// The columns of a block in rows of values and alarms.
pub struct Columns<'a> {
    /// From the block's first on.
    pub values: &'a [f64],
    pub alarms: &'a mut [bool],
    /// From a row to the next.
    pub stride: usize,
    pub rows: usize,
}

impl Columns<'_> {
    #[inline(always)]
    pub fn values(&self, row: usize) -> &[f64] {
        &self.values[row * self.stride..][..WIDTH]
    }

    /// Alarms of lanes, given by their bits.
    #[inline(always)]
    pub fn alarm(&mut self, row: usize, bits: u64) {
        let own = &mut self.alarms[row * self.stride..][..WIDTH];
        own.copy_from_slice(&MARKS[bits as usize]);
    }

    /// Asks for the values of a row, which may lie behind the last one, to be brought to the cache.
    ///
    /// Blocks read rows with strides, which processors do not foresee.
    #[inline(always)]
    pub fn prefetch(&self, row: usize) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            let at = self.values.as_ptr().wrapping_add(row * self.stride);
            // SAFETY: a hint that may name any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) };
        }
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
