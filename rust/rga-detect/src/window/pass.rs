//! Rows go through all blocks.

use pulp::{Simd, WithSimd};
use rga_simd::f64::{Lanes, Packs};

use super::block::{Block, Task};
use super::moments::Weights;
use super::tile::{TILE, Tile, WIDTH};
use super::{GaussianWindow, LAPS, LARGEST};

/// Tests rows and lets them into the windows. False: some have, and a value is infinite.
pub(super) struct Pass<'a> {
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
        if self.checked && !within(lanes, self.values) {
            return false;
        }
        let window = self.window;
        let rule = window.rule;
        let task = Task {
            lanes,
            weights: Weights::new(lanes, &rule),
            persistence: rule.persistence,
            frozen: rule.frozen,
        };
        let sensors = rule.sensors();
        let (mut values, mut alarms) = (self.values, self.alarms);
        let mut stepped = 0;
        if self.checked && values.len() == sensors && sensors >= WIDTH {
            stepped = window.step(&task, values, alarms);
            if stepped == window.blocks.len() {
                window.close(1);
                return true;
            }
        }
        let mut broad = (sensors < WIDTH).then(Broad::default);
        while !values.is_empty() {
            let rows = TILE
                .min(rule.earlier() - window.slot)
                .min(values.len() / sensors);
            let (own, marks);
            (own, values) = values.split_at(rows * sensors);
            (marks, alarms) = alarms.split_at_mut(rows * sensors);
            let (values, alarms) = match &mut broad {
                Some(broad) => broad.widen(own, sensors),
                None => (own, &mut *marks),
            };
            let (mut tile, blocks) = window.tile(values, alarms, rows);
            for (at, block) in blocks.iter_mut().enumerate().skip(stepped) {
                if !block.take(&task, &mut tile, rule.part(at)) {
                    return false;
                }
            }
            window.close(rows);
            if let Some(broad) = &broad {
                broad.narrow(marks, sensors);
            }
        }
        true
    }
}

impl GaussianWindow {
    /// Tests a row and lets it into the windows, one block after the other, until one needs more
    /// care: tells how many have taken it.
    #[inline(always)]
    fn step<L: Lanes>(&mut self, task: &Task<L>, row: &[f64], alarms: &mut [bool]) -> usize {
        let rule = self.rule;
        let (mut tile, blocks) = self.tile(row, alarms, 1);
        let mut taken = 0;
        for (at, block) in blocks.iter_mut().enumerate() {
            if !block.step(task, &mut tile, rule.part(at)) {
                break;
            }
            taken += 1;
        }
        taken
    }

    #[inline(always)]
    fn tile<'a>(
        &'a mut self,
        values: &'a [f64],
        alarms: &'a mut [bool],
        rows: usize,
    ) -> (Tile<'a>, &'a mut [Block]) {
        let tile = Tile {
            values,
            alarms,
            rows,
            sensors: self.rule.sensors().max(WIDTH),
            windows: &mut self.ring,
            places: self.rule.earlier(),
            blocks: self.blocks.len(),
            slot: self.slot,
        };
        (tile, &mut self.blocks)
    }

    /// All blocks have taken these rows.
    fn close(&mut self, rows: usize) {
        let places = self.rule.earlier();
        self.rows += rows as u64;
        self.slot += rows;
        if self.slot == places {
            self.slot = 0;
            if (self.rows / places as u64).is_multiple_of(LAPS) {
                let count = self.blocks.len();
                for (at, block) in self.blocks.iter_mut().enumerate() {
                    block.sum_anew(&self.ring, count, at, u64::MAX);
                }
            }
        }
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
fn within<L: Lanes>(lanes: L, values: &[f64]) -> bool {
    let (eights, rest) = values.as_chunks::<WIDTH>();
    let (zero, largest) = (lanes.splat(0.0), lanes.splat(LARGEST));
    let mut near = lanes.equal(zero, zero);
    for eight in eights {
        let size = lanes.abs(lanes.load(eight));
        near = lanes.and(near, lanes.at_most(size, largest));
    }
    let near = lanes.all(near) && rest.iter().all(|value| value.abs() <= LARGEST);
    // What is not near may be missing.
    near || !values.iter().any(|value| value.abs() > LARGEST)
}
