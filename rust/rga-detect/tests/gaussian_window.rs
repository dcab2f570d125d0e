//! Decisions of the window against exact integer arithmetic, on every instruction set.

use std::collections::VecDeque;

use rga_detect::{Array, GaussianWindow, Refusal, WindowRule, instructions};

/// Values of hard streams are whole multiples of this, so that integers hold them exactly.
const QUANTUM: f64 = 1.0 / (1u64 << 26) as f64;

/// An xorshift generator.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11
    }

    fn uniform(&mut self) -> f64 {
        self.bits() as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }

    /// As normal as the sum of twelve uniform numbers is.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// The rule as it is told, for one sensor, in integers; z must be whole.
struct Exact {
    rule: WindowRule,
    values: VecDeque<i128>,
    sum: i128,
    square: i128,
    tested: VecDeque<bool>,
}

impl Exact {
    fn new(rule: WindowRule) -> Self {
        Self {
            rule,
            values: VecDeque::new(),
            sum: 0,
            square: 0,
            tested: VecDeque::new(),
        }
    }

    fn alarms(&mut self, value: i128) -> bool {
        let inclusive = i128::from(self.rule.inclusive);
        let count = i128::from(self.rule.window) - inclusive;
        let full = self.values.len() as i128 == count;
        let reach = count * value - self.sum;
        let spread = count * self.square - self.sum * self.sum;
        let variance = (self.rule.z * self.rule.z) as i128;
        let (own, others) = match self.rule.inclusive {
            true => (count - variance, variance * (count + 1)),
            false => (1, variance),
        };
        let exceeds = full && reach > 0 && own * reach * reach > others * spread;
        if !(exceeds && self.rule.frozen) {
            if full && let Some(oldest) = self.values.pop_front() {
                self.sum -= oldest;
                self.square -= oldest * oldest;
            }
            self.values.push_back(value);
            self.sum += value;
            self.square += value * value;
        }
        let (k, n) = self.rule.persistence;
        if full {
            self.tested.push_back(exceeds);
        }
        if self.tested.len() as i64 > n {
            self.tested.pop_front();
        }
        full && self.tested.iter().filter(|&&one| one).count() as i64 >= k
    }
}

/// An outlier of 1e9 now and then; a level of 1e4 with a spread of 1e-2; a scale that drops by 1e8.
fn hard_value(random: &mut Random, row: usize, sensor: usize) -> f64 {
    let noise = random.normal();
    let value = match sensor % 3 {
        0 if row % 1777 == 1000 => noise + 1e9,
        0 => noise,
        1 => 1e4 + 1e-2 * noise,
        _ if (row / 5000).is_multiple_of(2) => 1e3 * noise,
        _ => 1e-5 * noise,
    };
    (value / QUANTUM).round() * QUANTUM
}

fn hard_streams_are_decided_exactly(sensors: usize, rows: usize) -> Result<(), Refusal> {
    let rule = WindowRule {
        sensors: sensors as i64,
        window: 100,
        z: 3.0,
        inclusive: false,
        persistence: (1, 1),
        frozen: false,
    };
    let mut window = GaussianWindow::new(rule)?;
    let mut exact: Vec<Exact> = (0..sensors).map(|_| Exact::new(rule)).collect();
    let mut exceeded = vec![0; sensors];
    let mut random = Random(20_250_101);
    let batch = 1000;
    let (mut values, mut found) = (vec![0.0; batch * sensors], vec![false; batch * sensors]);
    for from in (0..rows).step_by(batch) {
        for (at, value) in values.iter_mut().enumerate() {
            *value = hard_value(&mut random, from + at / sensors, at % sensors);
        }
        window.update_many(Array::new(&values, &[batch, sensors]), &mut found)?;
        for (at, (value, found)) in values.iter().zip(&found).enumerate() {
            let (row, sensor) = (from + at / sensors, at % sensors);
            let right = exact[sensor].alarms((value / QUANTUM) as i128);
            assert_eq!(*found, right, "sensor {sensor}, row {row}");
            exceeded[sensor] += usize::from(right);
        }
    }
    assert!(
        exceeded.iter().all(|&count| count > rows / 2000),
        "{exceeded:?}: a stream tests nothing"
    );
    Ok(())
}

#[test]
fn decisions_are_exact() -> Result<(), Refusal> {
    hard_streams_are_decided_exactly(9, 60_000)
}

#[test]
#[ignore = "1e8 values: a minute in a debug build"]
fn a_hundred_million_decisions_are_exact() -> Result<(), Refusal> {
    hard_streams_are_decided_exactly(84, 1_200_000)
}

/// Small whole numbers, of which some lie on the bound; outliers; missing values and rows.
fn rough_rows(random: &mut Random, rows: usize, sensors: usize) -> Vec<f64> {
    let mut values = Vec::new();
    for _ in 0..rows {
        let lost = random.below(25) == 0;
        for sensor in 0..sensors {
            values.push(match random.below(400) {
                _ if lost => f64::NAN,
                0..4 if sensor % 5 != 4 => f64::NAN,
                4 => 65_536.0,
                draw => (draw % 13) as f64,
            });
        }
    }
    values
}

/// Takes rows in calls of so many as the cuts tell, over and over.
fn in_calls(
    window: &mut GaussianWindow,
    values: &[f64],
    sensors: usize,
    cuts: &[usize],
) -> Result<Vec<bool>, Refusal> {
    let mut alarms = vec![false; values.len()];
    let (mut rest, mut written, mut cuts) = (values, alarms.as_mut_slice(), cuts.iter().cycle());
    while !rest.is_empty() {
        let rows = cuts.next().copied().unwrap_or(1).min(rest.len() / sensors);
        let (own, marks);
        (own, rest) = rest.split_at(rows * sensors);
        (marks, written) = written.split_at_mut(rows * sensors);
        window.update_many(Array::new(own, &[rows, sensors]), marks)?;
    }
    Ok(alarms)
}

#[test]
fn every_rule_is_followed_on_every_instruction_set() -> Result<(), Box<dyn std::error::Error>> {
    let mut random = Random(7);
    let mut raised = 0;
    for sensors in [1, 7, 8, 9, 84] {
        let rows = 1500 / sensors.min(8);
        for (inclusive, frozen, persistence) in [
            (false, false, (1, 1)),
            (true, false, (1, 1)),
            (false, true, (1, 1)),
            (true, true, (2, 3)),
            (false, false, (2, 5)),
        ] {
            let rule = WindowRule {
                sensors: sensors as i64,
                window: 2 + random.below(20) as i64,
                z: 1.0 + random.below(2) as f64,
                inclusive,
                persistence,
                frozen,
            };
            let values = rough_rows(&mut random, rows, sensors);
            let mut exact: Vec<Exact> = (0..sensors).map(|_| Exact::new(rule)).collect();
            let right: Vec<bool> = (values.iter().enumerate())
                .map(|(at, value)| !value.is_nan() && exact[at % sensors].alarms(*value as i128))
                .collect();
            raised += right.iter().filter(|&&alarm| alarm).count();
            let mut states = Vec::new();
            for name in instructions() {
                for cuts in [&[1][..], &[3, 1, 40, 17], &[rows]] {
                    let mut window = GaussianWindow::new(rule)?.with_instructions(Some(name))?;
                    let found = in_calls(&mut window, &values, sensors, cuts)?;
                    let wrong = found
                        .iter()
                        .zip(&right)
                        .position(|(one, other)| one != other);
                    assert_eq!(wrong, None, "{sensors} sensors, {rule:?}, {name}, {cuts:?}");
                    states.push(window.to_bytes());
                }
            }
            assert!(states.windows(2).all(|two| two[0] == two[1]), "{rule:?}");
        }
    }
    assert!(raised > 1000, "{raised} alarms: nothing is tested");
    Ok(())
}

#[test]
fn a_refused_call_leaves_no_trace() -> Result<(), Refusal> {
    let sensors = 9;
    let rule = WindowRule {
        sensors: sensors as i64,
        window: 20,
        z: 3.0,
        inclusive: false,
        persistence: (1, 1),
        frozen: false,
    };
    let mut random = Random(5);
    let mut window = GaussianWindow::new(rule)?;
    let begin = rough_rows(&mut random, 50, sensors);
    in_calls(&mut window, &begin, sensors, &[50])?;
    let before = window.to_bytes();
    for rows in [1, 10, 3000] {
        for bad in [f64::INFINITY, f64::NEG_INFINITY, 1.001e60] {
            let mut values: Vec<f64> = rough_rows(&mut random, rows, sensors);
            let at = values.len() - 4;
            values[at] = bad;
            let refused = in_calls(&mut window, &values, sensors, &[rows]);
            let place = format!(
                "row {} of the stream, sensor {}",
                50 + rows - 1,
                sensors - 4
            );
            assert_eq!(refused.map_err(|refusal| refusal.place), Err(place));
            assert_eq!(window.to_bytes(), before);
            values[at] = 1e60;
            in_calls(&mut window.clone(), &values, sensors, &[rows])?;
        }
    }
    Ok(())
}

#[test]
fn alarms_need_their_place() -> Result<(), Refusal> {
    let rule = WindowRule {
        sensors: 2,
        window: 3,
        z: 3.0,
        inclusive: false,
        persistence: (1, 1),
        frozen: false,
    };
    let mut window = GaussianWindow::new(rule)?;
    let refused = window.update(Array::new(&[1.0, 2.0], &[2]), &mut [false]);
    assert_eq!(
        refused.map_err(|refusal| refusal.place),
        Err("alarms".into())
    );
    Ok(())
}
