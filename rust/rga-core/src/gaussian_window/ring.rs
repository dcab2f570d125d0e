//! The last values of eight sensors, side by side.

/// Sensors of a block.
pub const WIDTH: usize = 8;

/// A number of each sensor of a block, in one line of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Eight(pub [f64; WIDTH]);

impl Eight {
    pub const ZERO: Self = Self([0.0; WIDTH]);
}

/// The windows of a block, in the cells of all.
pub struct Ring<'a> {
    /// From the block's first on.
    pub cells: &'a mut [Eight],
    /// From a place to the next.
    pub stride: usize,
    /// M, the number of places.
    pub places: usize,
    /// Where the next value of a lane without lag goes.
    pub slot: usize,
}

impl Ring<'_> {
    /// Index of the cell that takes the next value of a lane.
    #[inline(always)]
    pub fn next(&self, lag: u64) -> usize {
        let lag = lag as usize;
        let around = if lag > self.slot { self.places } else { 0 };
        (self.slot + around - lag) * self.stride
    }

    /// Index of the cell behind another.
    #[inline(always)]
    pub fn behind(&self, cell: usize) -> usize {
        let next = cell + self.stride;
        if next < self.places * self.stride {
            next
        } else {
            0
        }
    }

    #[inline(always)]
    pub fn step(&mut self, rows: usize) {
        self.slot += rows;
    }

    /// Values of a lane.
    pub fn of(&self, lane: usize) -> impl Iterator<Item = f64> {
        let cells = self.cells.iter().step_by(self.stride);
        cells.map(move |cell| cell.0[lane])
    }
}
