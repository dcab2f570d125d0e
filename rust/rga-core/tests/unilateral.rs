//! Play, stops and slack beside a spring, against their closed forms.

use rga_core::{Error, Laws, UnitResponses, pseudo_forces};

/// A term of stiffness `own` beside a spring of stiffness `beside`, both under one load.
fn side_by_side(own: f64, beside: f64) -> UnitResponses {
    let flexibility = 1.0 / (own + beside);
    UnitResponses {
        patterns: 1,
        outputs: 1,
        elements: 1,
        element: vec![0],
        stiffness: vec![own],
        loaded: vec![flexibility],
        stretched: vec![flexibility],
        influence: vec![flexibility],
        unit: vec![flexibility],
    }
}

/// Elongations under loads of a term with laws of its rows, size and stiffness: v = v0 - G w.
fn elongations(
    system: &UnitResponses,
    loads: &[f64],
    laws: &[(f64, f64)],
    rod: bool,
) -> Result<Vec<f64>, Error> {
    let (size, stiffness): (Vec<f64>, Vec<f64>) = laws.iter().copied().unzip();
    let laws = Laws {
        size: &size,
        stiffness: &stiffness,
        rod: &[rod],
    };
    let pseudo = pseudo_forces(system, loads, laws)?;
    let pairs = loads.iter().zip(pseudo);
    Ok(pairs
        .map(|(load, pseudo)| system.stretched[0] * load - system.unit[0] * pseudo)
        .collect())
}

fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 1e-9 * expected.abs().max(1e-3),
        "{found} instead of {expected}"
    );
}

#[test]
fn play_is_idle_between_its_ends_and_bears_beyond() {
    let (own, beside, size) = (3e6, 1e6, 0.01);
    let loads = [0.0, 5e3, -9e3, 3e4, -4e4];
    let laws = [(size, own); 5];
    let found = elongations(&side_by_side(own, beside), &loads, &laws, false).unwrap();
    for (load, found) in loads.iter().zip(found) {
        let free = load / beside;
        let bearing = (load + load.signum() * own * size) / (own + beside);
        close(found, if free.abs() <= size { free } else { bearing });
    }
}

#[test]
fn a_rod_bears_in_tension_beyond_its_slack_alone() {
    let (own, beside, size) = (2e6, 5e5, 0.004);
    let loads = [-4e4, 1e3, 8e3];
    let laws = [(size, own); 3];
    let found = elongations(&side_by_side(own, beside), &loads, &laws, true).unwrap();
    close(found[0], loads[0] / beside);
    close(found[1], loads[1] / beside);
    close(found[2], (loads[2] + own * size) / (own + beside));
}

#[test]
fn a_stop_may_be_stiffer_from_row_to_row_or_not_be_there() {
    let (own, beside, size) = (1e6, 1e6, 0.01);
    let loads = [3e4, 3e4, 3e4, -3e4];
    let laws = [
        (size, own),
        (size, 4e6),
        (f64::INFINITY, own),
        (0.5 * size, 9e6),
    ];
    let found = elongations(&side_by_side(own, beside), &loads, &laws, false).unwrap();
    for ((load, (size, stiffness)), found) in loads.iter().zip(laws).zip(found) {
        let bearing = (load + load.signum() * stiffness * size) / (stiffness + beside);
        close(
            found,
            if size.is_finite() {
                bearing
            } else {
                load / beside
            },
        );
    }
}

#[test]
fn the_row_that_nothing_holds_is_named() {
    let found = elongations(
        &side_by_side(1e6, 0.0),
        &[2e3, -2e3],
        &[(0.0, 1e6); 2],
        true,
    );
    assert_eq!(found, Err(Error::UnstableSample { row: 1 }));
}

#[test]
fn a_rod_of_any_slack_that_nothing_else_holds_is_refused_under_small_loads() {
    let system = side_by_side(1e8, 0.0);
    // A tenth of a nanometre, were the rod not slack.
    for slack in [0.0, 3e-4] {
        let found = elongations(&system, &[-1e-2], &[(slack, 1e8)], true);
        assert_eq!(found, Err(Error::UnstableSample { row: 0 }), "{slack}");
    }
    // Where no load asks it to bear, any place within its slack is as good.
    let idle = elongations(&system, &[0.0], &[(3e-4, 1e8)], true).unwrap();
    assert!(idle[0].abs() <= 3e-4);
}

#[test]
fn a_rod_of_endless_slack_carries_nothing() {
    let (own, beside, load) = (1e6, 3e6, 5e3);
    let laws = [(f64::INFINITY, own)];
    let found = elongations(&side_by_side(own, beside), &[load], &laws, true).unwrap();
    close(found[0], load / beside);
}

#[test]
fn every_term_needs_a_law_in_every_row() {
    let found = elongations(&side_by_side(1e6, 1e6), &[1.0, 2.0], &[(0.0, 1e6)], true);
    assert!(matches!(found, Err(Error::InvalidInput(_))));
}
