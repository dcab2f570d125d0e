//! One bearing against the closed form of its hysteresis loop; two against rest.

use rga_core::{Array, Bearings, Result, slide};

const FLEXIBILITY: f64 = 2e-8;
const MU: f64 = 0.05;
const NORMAL: f64 = 4e5;

fn friction(
    free: &[f64],
    count: usize,
    flexibility: &[f64],
    influence: &[f64],
) -> Result<Vec<f64>> {
    friction_after(&vec![0.0; 2 * count], free, flexibility, influence)
}

fn friction_after(
    before: &[f64],
    free: &[f64],
    flexibility: &[f64],
    influence: &[f64],
) -> Result<Vec<f64>> {
    let count = before.len() / 2;
    let rows = free.len() / count;
    let normal = vec![NORMAL; free.len()];
    let mu = vec![MU; count];
    slide(&Bearings {
        free_displacement: Array::new(free, &[rows, count]),
        flexibility: Array::new(flexibility, &[count, count]),
        normal_free: Array::new(&normal, &[rows, count]),
        normal_influence: Array::new(influence, &[count, count]),
        mu: Array::new(&mu, &[count]),
        before: Array::new(before, &[2, count]),
    })
}

fn wave(rows: usize) -> Vec<f64> {
    (0..rows)
        .map(|row| 3e-3 * (row as f64 * 0.05).sin())
        .collect()
}

/// The free motion is a play of half width F mu N, with r = -(free - u) / F:
/// an elastic-perfectly plastic element.
#[test]
fn one_bearing_follows_its_loop() -> Result<()> {
    let free = wave(400);
    let found = friction(&free, 1, &[FLEXIBILITY], &[0.0])?;
    let (limit, mut force, mut before) = (MU * NORMAL, 0.0_f64, 0.0);
    let mut dissipated = 0.0;
    let mut place = 0.0;
    for (row, &displacement) in free.iter().enumerate() {
        force = (force - (displacement - before) / FLEXIBILITY).clamp(-limit, limit);
        before = displacement;
        assert!((found[row] - force).abs() <= 1e-9 * limit, "row {row}");
        let now = displacement + FLEXIBILITY * found[row];
        let work = -found[row] * (now - place);
        assert!(work >= -1e-12 * limit, "friction gives energy at row {row}");
        dissipated += work;
        place = now;
    }
    assert!(dissipated > 0.0);
    Ok(())
}

#[test]
fn coupled_bearings_stay_within_their_cones() -> Result<()> {
    let free: Vec<f64> = wave(300).into_iter().flat_map(|u| [u, 0.7 * u]).collect();
    let flexibility = [
        FLEXIBILITY,
        0.8 * FLEXIBILITY,
        0.8 * FLEXIBILITY,
        FLEXIBILITY,
    ];
    let influence = [0.0, 0.1, -0.1, 0.0];
    let found = friction(&free, 2, &flexibility, &influence)?;
    assert_eq!(found, friction(&free, 2, &flexibility, &influence)?);
    let mut place = [0.0; 2];
    for (free, r) in free.chunks(2).zip(found.chunks(2)) {
        for bearing in 0..2 {
            let own = 2 * bearing;
            let now = free[bearing] + flexibility[own] * r[0] + flexibility[own + 1] * r[1];
            let normal = NORMAL + influence[own] * r[0] + influence[own + 1] * r[1];
            let slip = now - place[bearing];
            assert!(r[bearing].abs() <= MU * normal * (1.0 + 1e-9));
            let slides = r[bearing].abs() >= MU * normal * (1.0 - 1e-9);
            assert!(slides && r[bearing] * slip <= 1e-12 || slip.abs() < 1e-12);
            place[bearing] = now;
        }
    }
    Ok(())
}

/// Bit for bit: nothing else is kept of the rows before.
#[test]
fn rows_go_on_where_the_row_before_came_to_rest() -> Result<()> {
    let free: Vec<f64> = wave(300).into_iter().flat_map(|u| [u, 0.7 * u]).collect();
    let flexibility = [
        FLEXIBILITY,
        0.8 * FLEXIBILITY,
        0.8 * FLEXIBILITY,
        FLEXIBILITY,
    ];
    let influence = [0.0, 0.1, -0.1, 0.0];
    let whole = friction(&free, 2, &flexibility, &influence)?;
    for cut in [2, 100, 598] {
        let before = [&free[cut - 2..cut], &whole[cut - 2..cut]].concat();
        let rest = friction_after(&before, &free[cut..], &flexibility, &influence)?;
        assert_eq!(rest, whole[cut..]);
    }
    Ok(())
}

#[test]
fn a_lifted_bearing_carries_no_friction() -> Result<()> {
    let free = wave(20);
    let normal = vec![-1.0; 20];
    let found = slide(&Bearings {
        free_displacement: Array::new(&free, &[20, 1]),
        flexibility: Array::new(&[FLEXIBILITY], &[1, 1]),
        normal_free: Array::new(&normal, &[20, 1]),
        normal_influence: Array::new(&[0.0], &[1, 1]),
        mu: Array::new(&[MU], &[1]),
        before: Array::new(&[0.0, 0.0], &[2, 1]),
    })?;
    assert!(found.iter().all(|&force| force == 0.0));
    Ok(())
}
