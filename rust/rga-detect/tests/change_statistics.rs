//! Statistics of change: the same bits on all instructions and after a restart; other bytes are
//! refused.

use pulp::Arch;
use rga_detect::{Array, ChangeStatistics, Reference, ReferenceArrays, Refusal, STATISTICS};

const ROWS: usize = 300;
const KEPT: usize = 40;
const ORDER: usize = 3;
const KNOTS: usize = 5;

/// A xorshift generator.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// As normal as the sum of twelve uniform numbers is.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }

    fn many(&mut self, count: usize, scale: f64) -> Vec<f64> {
        (0..count).map(|_| scale * self.normal()).collect()
    }
}

/// Statistics with memory, bends and mixing, or with none of them.
fn statistics(sensors: usize, plain: bool) -> Result<ChangeStatistics, Refusal> {
    let mut random = Random(7 + sensors as u64);
    let (order, knots) = if plain { (0, 0) } else { (ORDER, KNOTS) };
    let level = random.many(sensors, 10.0);
    // A sensor has the order of its number, so that some need none of the rows before.
    let mut weights = random.many(order * sensors, 0.1);
    for (at, weight) in weights.iter_mut().enumerate() {
        if at / sensors >= at % sensors % (ORDER + 1) {
            *weight = 0.0;
        }
    }
    let place = |at: usize| (at / sensors) as f64 - 2.0;
    let knot: Vec<f64> = (0..knots * sensors).map(place).collect();
    let bends = random.many(knots * sensors, 0.05);
    let mut mixing = vec![0.0; sensors * sensors];
    for row in 0..sensors {
        for column in 0..row {
            let common = if plain { 0.0 } else { random.normal() * 0.1 };
            mixing[row * sensors + column] = common;
            mixing[column * sensors + row] = common;
        }
        mixing[row * sensors + row] = 1.0;
    }
    let (ones, zeros) = (vec![1.0; sensors], vec![0.0; sensors]);
    let signature = vec![1.0 / (sensors as f64).sqrt(); sensors];
    let reference = Reference::new(ReferenceArrays {
        level: Array::new(&level, &[sensors]),
        weights: Array::new(&weights, &[order, sensors]),
        units: Array::new(&ones, &[sensors]),
        offset: Array::new(&zeros, &[sensors]),
        slope: Array::new(&ones, &[sensors]),
        knots: Array::new(&knot, &[knots, sensors]),
        bends: Array::new(&bends, &[knots, sensors]),
        mixing: Array::new(&mixing, &[sensors, sensors]),
        signature: Array::new(&signature, &[sensors]),
        largest: 4.0,
    })?;
    Ok(ChangeStatistics::new(reference, [1e4; STATISTICS], KEPT))
}

/// A stream with a step at two thirds; perhaps with gaps, and a sensor that dies.
fn stream(sensors: usize, gaps: bool) -> Vec<f64> {
    let mut random = Random(99 + sensors as u64);
    let mut rows = random.many(ROWS * sensors, 1.0);
    for (at, value) in rows.iter_mut().enumerate() {
        let (row, sensor) = (at / sensors, at % sensors);
        if row >= ROWS * 2 / 3 && sensor == 0 {
            *value += 3.0;
        }
        let dead = sensor + 1 == sensors && row > ROWS / 2 && sensors > 1;
        if gaps && (dead || random.uniform() < 0.1) {
            *value = f64::NAN;
        }
    }
    rows
}

fn instruction_sets() -> Vec<(&'static str, Arch)> {
    let mut known = vec![("portable", Arch::Scalar), ("best", Arch::new())];
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{V3, V4};
        known.extend(V3::try_new().map(|simd| ("avx2", Arch::V3(simd))));
        known.extend(V4::try_new().map(|simd| ("avx512", Arch::V4(simd))));
    }
    known
}

/// Every case that is worth telling apart: sensors, without memory and mixing, with gaps.
fn cases() -> impl Iterator<Item = (usize, bool, bool)> {
    [1, 7, 15, 16, 17, 84].into_iter().flat_map(|sensors| {
        [(true, false), (true, true), (false, false), (false, true)]
            .map(|(plain, gaps)| (sensors, plain, gaps))
    })
}

#[test]
fn instruction_sets_give_the_same_bits() -> Result<(), Refusal> {
    for (sensors, plain, gaps) in cases() {
        let rows = stream(sensors, gaps);
        let mut right = statistics(sensors, plain)?;
        let alarms = right.update_with(Array::new(&rows, &[ROWS, sensors]), Arch::Scalar)?;
        assert!(
            alarms[ROWS - 1],
            "{sensors} {plain} {gaps}: nothing is found"
        );
        for (name, arch) in instruction_sets() {
            let mut other = statistics(sensors, plain)?;
            let found = other.update_with(Array::new(&rows, &[ROWS, sensors]), arch)?;
            let case = format!("{name} {sensors} {plain} {gaps}");
            assert_eq!(found, alarms, "{case}");
            assert!(other.to_bytes() == right.to_bytes(), "{case}");
        }
    }
    Ok(())
}

#[test]
fn parts_and_restarts_give_the_same_bits() -> Result<(), Refusal> {
    for (sensors, plain, gaps) in cases() {
        let rows = stream(sensors, gaps);
        let mut whole = statistics(sensors, plain)?;
        let alarms = whole.update_many(Array::new(&rows, &[ROWS, sensors]))?;
        let mut parts = statistics(sensors, plain)?;
        let mut found = Vec::new();
        for (from, to) in [(0, 0), (0, 1), (1, 6), (6, 39), (39, 41), (41, ROWS)] {
            parts = ChangeStatistics::from_bytes(&parts.to_bytes())?;
            let part = &rows[from * sensors..to * sensors];
            found.extend(parts.update_many(Array::new(part, &[to - from, sensors]))?);
        }
        assert_eq!(found, alarms);
        assert!(parts.to_bytes() == whole.to_bytes());
        let alarm = parts.alarm().expect("something is found");
        let end = ROWS.min(alarm.row as usize + 1 + KEPT / 2);
        let first = end.saturating_sub(KEPT);
        assert_eq!(parts.recent_first(), first as u64);
        assert_eq!(parts.recent().len(), (end - first) * sensors);
    }
    Ok(())
}

#[test]
fn a_refused_row_leaves_no_trace() -> Result<(), Refusal> {
    let mut watching = statistics(7, false)?;
    let mut rows = stream(7, true);
    watching.update_many(Array::new(&rows, &[ROWS, 7]))?;
    let before = watching.to_bytes();
    rows[10] = f64::INFINITY;
    assert!(watching.update_many(Array::new(&rows, &[ROWS, 7])).is_err());
    assert!(
        watching
            .update_many(Array::new(&rows[..6], &[1, 6]))
            .is_err()
    );
    assert!(watching.update_many(Array::new(&rows[..7], &[7])).is_err());
    assert!(watching.to_bytes() == before);
    Ok(())
}

#[test]
fn truncated_and_foreign_bytes_are_refused() -> Result<(), Refusal> {
    let mut watching = statistics(3, false)?;
    let rows = stream(3, true);
    watching.update_many(Array::new(&rows, &[ROWS, 3]))?;
    let state = watching.to_bytes();
    for length in 0..state.len() {
        assert!(ChangeStatistics::from_bytes(&state[..length]).is_err());
    }
    assert!(ChangeStatistics::from_bytes(&[&state[..], &[0]].concat()).is_err());
    assert!(ChangeStatistics::from_bytes(&vec![0xff; state.len()]).is_err());
    Ok(())
}

/// What is not refused goes on: nothing panics, however a state was spoiled.
#[test]
fn spoiled_bytes_never_panic() -> Result<(), Refusal> {
    let mut watching = statistics(3, false)?;
    let rows = stream(3, true);
    watching.update_many(Array::new(&rows, &[ROWS, 3]))?;
    let state = watching.to_bytes();
    let mut random = Random(5);
    let mut refused = 0;
    for draw in 0..6_000 {
        let mut spoiled = state.clone();
        // Every other draw, one of the numbers that come first: they tell how to read the rest.
        let span = if draw % 2 == 0 { 14 * 8 } else { state.len() };
        let word = random.bits() as usize % (span / 8) * 8;
        let values = [
            0,
            1,
            2,
            3,
            KEPT as u64,
            u64::MAX,
            u64::MAX - 1,
            random.bits(),
        ];
        let value = values[random.bits() as usize % values.len()];
        spoiled[word..word + 8].copy_from_slice(&value.to_le_bytes());
        match ChangeStatistics::from_bytes(&spoiled) {
            Err(_) => refused += 1,
            Ok(mut other) => {
                let _ = other.update_many(Array::new(&rows[..30 * 3], &[30, 3]))?;
                assert!(other.recent().len() <= KEPT * 3);
                assert!(
                    other
                        .alarm()
                        .is_none_or(|alarm| alarm.statistic < STATISTICS)
                );
            }
        }
    }
    assert!(refused > 1_000, "{refused}: nothing was spoiled");
    Ok(())
}
