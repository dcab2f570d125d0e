//! The state of statistics as bytes, little-endian, all of it.

use rga_simd::Array;

use super::recent_scores::Recent;
use super::reference::{Reference, ReferenceArrays};
use super::statistics::Banks;
use super::{Alarm, ChangeStatistics, STATISTICS};
use crate::refusal::Refusal;

/// What the bytes are, and the version of their layout.
const MARK: u64 = u64::from_le_bytes(*b"rgachg02");

/// No stream is longer.
const MOST: u64 = 1 << 62;

/// Stands for no alarm.
const NONE: u64 = u64::MAX;

impl ChangeStatistics {
    pub fn to_bytes(&self) -> Vec<u8> {
        let (reference, banks, recent) = (&self.reference, &self.banks, &self.recent);
        let sensors = reference.sensors();
        let (alarm, statistic) = match self.alarm {
            Some(alarm) => (alarm.row, alarm.statistic as u64),
            None => (NONE, 0),
        };
        let header = [
            MARK,
            sensors as u64,
            (reference.weights.len() / sensors) as u64,
            (reference.knots.len() / sensors) as u64,
            recent.rows() as u64,
            recent.next as u64,
            recent.filled as u64,
            self.rows,
            alarm,
            statistic,
            banks.rows,
        ];
        let memory = [&reference.past, &reference.doubt];
        let doubles = reference.arrays().into_iter().chain(memory);
        let singles = [
            &self.thresholds[..],
            &self.peaks,
            &banks.quick,
            &banks.slow,
            &banks.sums,
            &recent.ring,
        ];
        let counts = header.into_iter();
        let doubles = doubles.flatten().map(|value| value.to_bits());
        let singles = singles.into_iter().flatten();
        counts
            .chain(doubles)
            .flat_map(u64::to_le_bytes)
            .chain(singles.flat_map(|value| value.to_le_bytes()))
            .collect()
    }

    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Refusal> {
        let mut rest = Rest(bytes);
        let header: [u64; 11] = rest.counts(11)?.try_into().unwrap_or_default();
        let [
            mark,
            sensors,
            order,
            knots,
            kept,
            next,
            filled,
            rows,
            alarm,
            statistic,
            blocks,
        ] = header;
        let whole = |count: u64| usize::try_from(count).ok().filter(|n| *n <= bytes.len());
        let (Some(sensors), Some(order), Some(knots), Some(kept)) =
            (whole(sensors), whole(order), whole(knots), whole(kept))
        else {
            return Err(foreign());
        };
        let ring = kept as u64;
        let placed = if filled < ring {
            next == filled
        } else {
            filled == ring && next < ring.max(1)
        };
        let raised = alarm == NONE || (alarm < rows && statistic < STATISTICS as u64);
        if mark != MARK || sensors == 0 || !placed || !raised || rows.max(blocks) > MOST {
            return Err(foreign());
        }
        let mut array = |rows: usize| rest.doubles(rows * sensors);
        let (level, weights) = (array(1)?, array(order)?);
        let (units, offset, slope) = (array(1)?, array(1)?, array(1)?);
        let (knot, bends) = (array(knots)?, array(knots)?);
        let (mixing, signature) = (array(sensors)?, array(1)?);
        let largest = rest.doubles(1)?[0];
        let past = rest.doubles(order * sensors)?;
        let doubt = rest.doubles(order * order * sensors)?;
        let mut reference = Reference::new(ReferenceArrays {
            level: Array::new(&level, &[sensors]),
            weights: Array::new(&weights, &[order, sensors]),
            units: Array::new(&units, &[sensors]),
            offset: Array::new(&offset, &[sensors]),
            slope: Array::new(&slope, &[sensors]),
            knots: Array::new(&knot, &[knots, sensors]),
            bends: Array::new(&bends, &[knots, sensors]),
            mixing: Array::new(&mixing, &[sensors, sensors]),
            signature: Array::new(&signature, &[sensors]),
            largest,
        })?;
        (reference.past, reference.doubt) = (past, doubt);
        let mut banks = Banks::new(sensors);
        banks.rows = blocks;
        let mut recent = Recent::new(sensors, kept);
        (recent.next, recent.filled) = (next as usize, filled as usize);
        let (mut thresholds, mut peaks) = ([0.0; _], [0.0; _]);
        for singles in [
            &mut thresholds[..],
            &mut peaks,
            &mut banks.quick,
            &mut banks.slow,
            &mut banks.sums,
            &mut recent.ring,
        ] {
            rest.singles(singles)?;
        }
        if !rest.0.is_empty() {
            return Err(foreign());
        }
        Ok(Self {
            reference,
            thresholds,
            banks,
            recent,
            rows,
            alarm: (alarm != NONE).then_some(Alarm {
                row: alarm,
                statistic: statistic as usize,
            }),
            peaks,
        })
    }
}

/// What has not been read yet.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    fn counts(&mut self, count: usize) -> Result<Vec<u64>, Refusal> {
        let taken = self
            .0
            .split_off(..count.saturating_mul(8))
            .ok_or_else(foreign)?;
        let (words, _) = taken.as_chunks::<8>();
        Ok(words.iter().map(|word| u64::from_le_bytes(*word)).collect())
    }

    fn doubles(&mut self, count: usize) -> Result<Vec<f64>, Refusal> {
        let words = self.counts(count)?;
        Ok(words.into_iter().map(f64::from_bits).collect())
    }

    fn singles(&mut self, found: &mut [f32]) -> Result<(), Refusal> {
        let taken = self.0.split_off(..found.len() * 4).ok_or_else(foreign)?;
        let (words, _) = taken.as_chunks::<4>();
        for (value, word) in found.iter_mut().zip(words) {
            *value = f32::from_le_bytes(*word);
        }
        Ok(())
    }
}

fn foreign() -> Refusal {
    Refusal::new(
        "the bytes are no such state".into(),
        "from_bytes",
        "give the bytes that to_bytes() returned",
    )
}
