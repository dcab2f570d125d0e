//! The latest scores: what an alarm is explained by.

use rga_simd::f32::SIXTEEN;

use crate::change::Block;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Recent {
    sensors: usize,
    /// `[rows kept, sensors]`
    pub(super) ring: Vec<f32>,
    /// Where the next row goes.
    pub(super) next: usize,
    pub(super) filled: usize,
}

impl Recent {
    pub(super) fn new(sensors: usize, rows: usize) -> Self {
        Self {
            sensors,
            ring: vec![0.0; sensors * rows],
            next: 0,
            filled: 0,
        }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, scores: &[Block], row: usize) {
        let rows = self.rows();
        if rows == 0 {
            return;
        }
        let place = &mut self.ring[self.next * self.sensors..][..self.sensors];
        let (sixteens, rest) = place.as_chunks_mut::<SIXTEEN>();
        for (place, block) in sixteens.iter_mut().zip(scores) {
            *place = block[row];
        }
        if let Some(block) = scores.get(sixteens.len()) {
            rest.copy_from_slice(&block[row][..rest.len()]);
        }
        self.next = if self.next + 1 == rows {
            0
        } else {
            self.next + 1
        };
        self.filled = rows.min(self.filled + 1);
    }

    pub(super) fn clear(&mut self) {
        (self.next, self.filled) = (0, 0);
    }

    /// Oldest row first.
    pub(super) fn in_order(&self) -> Vec<f32> {
        if self.filled < self.rows() {
            return self.ring[..self.filled * self.sensors].to_vec();
        }
        let (late, early) = self.ring.split_at(self.next * self.sensors);
        [early, late].concat()
    }

    pub(super) fn filled(&self) -> usize {
        self.filled
    }

    pub(super) fn rows(&self) -> usize {
        self.ring.len() / self.sensors
    }
}
