//! Rows go through all blocks.

use pulp::{Simd, WithSimd};

use super::block::Task;
use super::columns::Columns;
use super::moments::Weights;
use super::ring::{Ring, WIDTH};
use super::{GaussianWindow, LAPS, LARGEST};
use crate::lanes::{Lanes, Packs};

/// Rows that stay in the nearest cache while one block after the other takes them.
const TILE: usize = 8;

/// Tests rows and lets them into the windows. False: some have, and a value is infinite.
pub struct Pass<'a> {
    pub window: &'a mut GaussianWindow,
    pub values: &'a [f64],
    pub alarms: &'a mut [bool],
    /// Values are checked before anything enters: nothing has where false is told.
    pub checked: bool,
}

impl WithSimd for Pass<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        match S::F64_LANES {
            8 => self.through(Packs::<S, 1>(simd)),
            4 => self.through(Packs::<S, 2>(simd)),
            2 => self.through(Packs::<S, 4>(simd)),
            _ => self.through(Packs::<S, 8>(simd)),
        }
    }
}

impl Pass<'_> {
    #[inline(always)]
    fn through<L: Lanes>(self, lanes: L) -> bool {
        if self.checked && !within(self.values) {
            return false;
        }
        let GaussianWindow {
            rule,
            rows: seen,
            blocks,
            ring,
            ..
        } = self.window;
        let task = Task {
            lanes,
            weights: Weights::new(lanes, rule),
            persistence: rule.persistence,
            frozen: rule.frozen,
        };
        let (sensors, places, stride) = (rule.sensors(), rule.earlier(), blocks.len());
        let (mut values, mut alarms) = (self.values, self.alarms);
        while !values.is_empty() {
            let slot = (*seen % places as u64) as usize;
            let rows = TILE.min(places - slot).min(values.len() / sensors);
            let (tile, marks);
            (tile, values) = values.split_at(rows * sensors);
            (marks, alarms) = alarms.split_at_mut(rows * sensors);
            for (at, block) in blocks.iter_mut().enumerate() {
                let first = rule.first(at);
                let mut ring = Ring {
                    cells: &mut ring[at..],
                    stride,
                    places,
                    slot,
                };
                let mut columns = Columns {
                    values: &tile[first..],
                    alarms: &mut marks[first..],
                    stride: sensors,
                    rows,
                };
                if !block.take(&task, &mut ring, &mut columns) {
                    return false;
                }
            }
            *seen += rows as u64;
            if seen.is_multiple_of(places as u64 * LAPS) {
                for (at, block) in blocks.iter_mut().enumerate() {
                    let ring = Ring {
                        cells: &mut ring[at..],
                        stride,
                        places,
                        slot: 0,
                    };
                    block.sum_anew(&ring, u64::MAX);
                }
            }
        }
        true
    }
}

/// Whether no value is too large; NaN is not.
#[inline(always)]
fn within(values: &[f64]) -> bool {
    let mut within = true;
    for value in values {
        within &= !(value.abs() > LARGEST);
    }
    within
}
