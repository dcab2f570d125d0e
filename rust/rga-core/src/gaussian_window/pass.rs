//! Rows go through all blocks.

use pulp::{Simd, WithSimd};

use super::block::Task;
use super::moments::Weights;
use super::tile::{Part, TILE, Tile, WIDTH};
use super::{GaussianWindow, LAPS, LARGEST};
use crate::lanes::{Lanes, Packs};

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
            slot: next,
            blocks,
            ring: windows,
            ..
        } = self.window;
        let task = Task {
            lanes,
            weights: Weights::new(lanes, rule),
            persistence: rule.persistence,
            frozen: rule.frozen,
        };
        let (sensors, places, count) = (rule.sensors(), rule.earlier(), blocks.len());
        let part = |block| Part {
            block,
            first: rule.first(block),
        };
        let mut broad = (sensors < WIDTH).then(Broad::default);
        let (mut values, mut alarms) = (self.values, self.alarms);
        while !values.is_empty() {
            let rows = TILE.min(places - *next).min(values.len() / sensors);
            let (own, marks);
            (own, values) = values.split_at(rows * sensors);
            (marks, alarms) = alarms.split_at_mut(rows * sensors);
            let (values, alarms) = match &mut broad {
                Some(broad) => broad.widen(own, sensors),
                None => (own, &mut *marks),
            };
            let mut tile = Tile {
                values,
                alarms,
                rows,
                sensors: sensors.max(WIDTH),
                windows: &mut *windows,
                places,
                blocks: count,
                slot: *next,
            };
            for (at, block) in blocks.iter_mut().enumerate() {
                if !block.take(&task, &mut tile, part(at)) {
                    return false;
                }
            }
            *seen += rows as u64;
            *next += rows;
            if *next == places {
                *next = 0;
                if (*seen / places as u64).is_multiple_of(LAPS) {
                    for (at, block) in blocks.iter_mut().enumerate() {
                        block.sum_anew(&tile, part(at), u64::MAX);
                    }
                }
            }
            if let Some(broad) = &broad {
                broad.narrow(marks, sensors);
            }
        }
        true
    }
}

/// A tile of fewer sensors than a block has; the last one fills the lanes behind it.
#[derive(Default)]
struct Broad {
    values: [[f64; WIDTH]; TILE],
    alarms: [[bool; WIDTH]; TILE],
}

impl Broad {
    fn widen(&mut self, values: &[f64], sensors: usize) -> (&[f64], &mut [bool]) {
        for (row, own) in self.values.iter_mut().zip(values.chunks_exact(sensors)) {
            for (lane, value) in row.iter_mut().enumerate() {
                *value = own[lane.min(sensors - 1)];
            }
        }
        (self.values.as_flattened(), self.alarms.as_flattened_mut())
    }

    fn narrow(&self, alarms: &mut [bool], sensors: usize) {
        for (row, own) in self.alarms.iter().zip(alarms.chunks_exact_mut(sensors)) {
            own.copy_from_slice(&row[..sensors]);
        }
    }
}

/// Whether no value is too large; NaN is not.
#[inline(always)]
fn within(values: &[f64]) -> bool {
    let mut beyond = false;
    for value in values {
        beyond |= value.abs() > LARGEST;
    }
    !beyond
}
