//! Natural frequencies with closed forms, clusters of equal ones, and masses that are singular.

mod common;

use common::masses::{mass, with_masses};
use common::*;
use rga_core::{Error, ModalEnergies, ModalReanalysis, Modes, Result, modal_energies, modes};

const ALL: [usize; 6] = [0, 1, 2, 3, 4, 5];
const LINE: f64 = 60.0;
const L: f64 = 4.0;

/// Modes of a case with `line` kg/m along every member and masses on nodes.
fn found(case: &Case, line: f64, nodal: &[(usize, [f64; 6])], count: usize) -> Result<Modes> {
    with_masses(case, line, nodal, |structure, masses| {
        modes(structure, masses, count)
    })
}

/// The same of a case near another.
fn near(
    known: &Case,
    case: &Case,
    line: f64,
    nodal: &[(usize, [f64; 6])],
    count: usize,
) -> Result<Modes> {
    let known = with_masses(known, line, nodal, |structure, masses| {
        ModalReanalysis::new(structure, masses, count)
    })?;
    with_masses(case, line, nodal, |structure, masses| {
        known.modes(structure, masses, count)
    })
}

fn energies(
    case: &Case,
    line: f64,
    nodal: &[(usize, [f64; 6])],
    shapes: &[f64],
) -> Result<ModalEnergies> {
    with_masses(case, line, nodal, |structure, masses| {
        modal_energies(structure, masses, shapes)
    })
}

#[test]
fn mass_on_a_weightless_bar() -> Result<()> {
    let bar = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    let bar = bar.fix(0, &[0, 1, 2]).fix(1, &[1, 2]);
    let modes = found(&bar, 0.0, &[(1, mass(500.0))], 3)?;
    assert_eq!(modes.eigenvalues.len(), 1);
    close(modes.eigenvalues[0], E * AREA / L / 500.0);
    close(modes.shapes[6], 1.0 / 500.0_f64.sqrt());
    Ok(())
}

#[test]
fn bar_with_its_own_mass() -> Result<()> {
    let bar = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    let bar = bar.fix(0, &[0, 1, 2]).fix(1, &[1, 2]);
    let modes = found(&bar, LINE, &[], 1)?;
    close(modes.eigenvalues[0], 3.0 * E * AREA / (LINE * L * L));
    Ok(())
}

/// One element of a cantilever, whose consistent mass gives 140 x^2 - 408 x + 12 = 0 with
/// x = rho A L^4 w^2 / (420 E I).
#[test]
fn cantilever_of_one_element() -> Result<()> {
    let held = [0, 2, 3, 4];
    let beam = Case::beam(L).fix(0, &ALL).fix(1, &held);
    let modes = found(&beam, LINE, &[], 2)?;
    let root = (408.0_f64.powi(2) - 4.0 * 140.0 * 12.0).sqrt();
    for (value, x) in modes.eigenvalues.iter().zip([408.0 - root, 408.0 + root]) {
        close(*value, x / 280.0 * 420.0 * E * IZ / (LINE * L.powi(4)));
    }
    Ok(())
}

/// Both planes of a cantilever of many elements: 1.8751 and 4.6941 (Blevins, Formulas for Natural
/// Frequency and Mode Shape, 1979, table 8-1).
#[test]
fn cantilever_of_many_elements() -> Result<()> {
    let count = 16;
    let nodes: Vec<[f64; 3]> = (0..=count)
        .map(|at| [L * at as f64 / count as f64, 0.0, 0.0])
        .collect();
    let members: Vec<([i64; 2], bool)> = (0..count).map(|at| ([at, at + 1], true)).collect();
    let beam = Case::new(&nodes, &members).fix(0, &ALL);
    let modes = found(&beam, LINE, &[], 4)?;
    let exact = |root: f64, inertia: f64| root.powi(4) * E * inertia / (LINE * L.powi(4));
    let mut expected =
        [1.875_104_069, 4.694_091_133].map(|root| [exact(root, IY), exact(root, IZ)]);
    let expected = expected.as_flattened_mut();
    expected.sort_by(f64::total_cmp);
    for (value, exact) in modes.eigenvalues.iter().zip(expected) {
        assert!(
            (value / *exact - 1.0).abs() < 2e-5,
            "{value} instead of {exact}"
        );
    }
    Ok(())
}

/// Rigid zones and releases: a rigid rod on a pin with a spring at its middle.
#[test]
fn members_between_rigid_zones_move_as_a_body() -> Result<()> {
    let mut rod = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], true)]);
    rod.rigid_end = vec![[0.4 * L, 0.5 * L]];
    rod.springs = vec![([1, -1], 1, 1e3)];
    let rod = rod.fix(0, &[0, 1, 2, 3, 4]).fix(1, &[0, 2, 3, 4]);
    let modes = found(&rod, LINE, &[], 1)?;
    let expected = 1e3 * L * L / (LINE * L.powi(3) / 3.0);
    // What is left between the zones yields a little under the spring.
    assert!((modes.eigenvalues[0] / expected - 1.0).abs() < 1e-3);
    Ok(())
}

#[test]
fn released_ends_swing_without_their_node() -> Result<()> {
    // Pinned to a heavy node: the beam alone turns, as on a support.
    let pinned = |case: Case| case.fix(0, &[0, 1, 2, 3, 4]).fix(1, &[0, 2, 3, 4]);
    let mut own = pinned(Case::beam(L));
    own.springs = vec![([1, -1], 1, 1e3)];
    let mut released = Case::beam(L).fix(0, &ALL).fix(1, &[0, 2, 3, 4]);
    released.springs = vec![([1, -1], 1, 1e3)];
    let released = released.connect(0, 5, 0.0);
    let (own, released) = (found(&own, LINE, &[], 3)?, found(&released, LINE, &[], 3)?);
    // What a release passes on is condensed as in statics: the lowest mode, a body's, hardly changes.
    assert!((own.eigenvalues[0] / released.eigenvalues[0] - 1.0).abs() < 1e-5);
    Ok(())
}

/// More equal modes than a block of vectors finds at once.
#[test]
fn no_copy_of_equal_modes_is_missed() -> Result<()> {
    let count = 11;
    let mut nodes = Vec::new();
    let mut members = Vec::new();
    for at in 0..count {
        nodes.extend([[0.0, at as f64, 0.0], [L, at as f64, 0.0]]);
        members.push(([2 * at as i64, 2 * at as i64 + 1], false));
    }
    let mut bars = Case::new(&nodes, &members);
    for at in 0..count {
        bars = bars.fix(2 * at, &[0, 1, 2]).fix(2 * at + 1, &[1, 2]);
    }
    let expected = 3.0 * E * AREA / (LINE * L * L);
    for wanted in [1, 5, 11, 14] {
        let modes = found(&bars, LINE, &[], wanted)?;
        assert_eq!(modes.eigenvalues.len(), wanted.min(count));
        modes
            .eigenvalues
            .iter()
            .for_each(|&value| close(value, expected));
    }
    Ok(())
}

/// Shapes are orthogonal in the mass, pairs of equal frequency too.
#[test]
fn shapes_of_a_square_column_are_orthogonal() -> Result<()> {
    let column = Case::new(&[[0.0; 3], [0.0, 0.0, L]], &[([0, 1], false)]);
    let mut column = column.fix(0, &[0, 1, 2]);
    column.springs = vec![([1, -1], 0, 5e4), ([1, -1], 1, 5e4)];
    let modes = found(&column, 0.0, &[(1, mass(200.0))], 3)?;
    close(modes.eigenvalues[0], 250.0);
    close(modes.eigenvalues[1], 250.0);
    let of = |mode: usize| &modes.shapes[12 * mode + 6..12 * mode + 9];
    for (one, other, product) in [(0, 0, 1.0), (0, 1, 0.0), (0, 2, 0.0), (1, 1, 1.0)] {
        let sum: f64 = of(one).iter().zip(of(other)).map(|(a, b)| a * b).sum();
        close(200.0 * sum, product);
    }
    Ok(())
}

/// An inertia about what nothing stiffens is no mode, and changes none.
#[test]
fn inertia_of_a_free_rotation_does_nothing() -> Result<()> {
    let bar = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    let bar = bar.fix(0, &[0, 1, 2]).fix(1, &[1, 2]);
    let turning = [500.0, 500.0, 500.0, 7.0, 8.0, 9.0];
    let modes = found(&bar, 0.0, &[(1, turning)], 3)?;
    assert_eq!(modes.eigenvalues.len(), 1);
    close(modes.eigenvalues[0], E * AREA / L / 500.0);
    Ok(())
}

#[test]
fn masses_that_are_none_are_refused() {
    let bar = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    let bar = bar.fix(0, &[0, 1, 2]).fix(1, &[1, 2]);
    for (line, nodal) in [(0.0, 0.0), (-1.0, 0.0), (f64::NAN, 0.0), (1.0, -200.0)] {
        let refused = found(&bar, line, &[(1, mass(nodal))], 1);
        assert!(
            matches!(refused, Err(Error::InvalidInput(_))),
            "{refused:?}"
        );
    }
    let free = Case::new(&[[0.0; 3], [L, 0.0, 0.0]], &[([0, 1], false)]);
    let refused = found(&free, LINE, &[], 1);
    assert!(matches!(refused, Err(Error::UnstableStructure { .. })));
}

/// A frame of two bays whose members differ, and masses on its nodes.
fn two_bays(soft: f64) -> Case {
    let nodes = [
        [0.0, 0.0, 0.0],
        [4.0, 0.5, 0.0],
        [8.0, 0.0, 0.3],
        [0.0, 0.0, 3.0],
        [4.0, 0.0, 3.2],
        [8.0, 0.4, 3.0],
    ];
    let ends = [[0, 3], [1, 4], [2, 5], [3, 4], [4, 5], [0, 4], [1, 5]];
    let members: Vec<([i64; 2], bool)> = ends.map(|ends| (ends, true)).to_vec();
    let mut case = Case::new(&nodes, &members);
    case.springs.push(([4, -1], 0, 2e5 * soft));
    case.fix(0, &ALL).fix(1, &ALL).fix(2, &ALL)
}

#[test]
fn modes_near_a_structure_are_those_of_the_other() -> Result<()> {
    let masses = [(3, mass(800.0)), (5, mass(500.0))];
    for soft in [1.0, 0.5, 20.0, 1e4] {
        let alone = found(&two_bays(soft), LINE, &masses, 6)?;
        let near = near(&two_bays(1.0), &two_bays(soft), LINE, &masses, 6)?;
        for (one, other) in near.eigenvalues.iter().zip(&alone.eigenvalues) {
            close(*one, *other);
        }
        let apart = near.shapes.iter().zip(&alone.shapes);
        assert!(
            apart
                .map(|(one, other)| (one - other).abs())
                .fold(0.0, f64::max)
                < 1e-7
        );
    }
    Ok(())
}

#[test]
fn modes_below_an_eigenvalue_come_with_the_next() -> Result<()> {
    let masses = [(3, mass(800.0)), (5, mass(500.0))];
    let all = found(&two_bays(0.5), LINE, &masses, 9)?.eigenvalues;
    let known = with_masses(&two_bays(1.0), LINE, &masses, |structure, masses| {
        ModalReanalysis::new(structure, masses, 2)
    })?;
    let below = |at: f64, least: usize, most: usize| {
        with_masses(&two_bays(0.5), LINE, &masses, |structure, masses| {
            known.modes_below(structure, masses, at, (least, most))
        })
    };
    let between = 0.5 * (all[4] + all[5]);
    for (least, most, count) in [(2, 9, 6), (8, 9, 8), (2, 3, 3)] {
        let found = below(between, least, most)?.eigenvalues;
        assert_eq!(found.len(), count);
        for (one, other) in found.iter().zip(&all) {
            close(*one, *other);
        }
    }
    for wrong in [0.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(below(wrong, 2, 9), Err(Error::InvalidInput(_))));
    }
    Ok(())
}

#[test]
fn energies_are_the_slopes_of_eigenvalues() -> Result<()> {
    let (step, masses) = (1e-4_f64, [(3, mass(800.0)), (5, mass(500.0))]);
    let middle = found(&two_bays(1.0), LINE, &masses, 4)?;
    let [below, above] = [-step, step].map(|step| found(&two_bays(step.exp()), LINE, &masses, 4));
    let energies = energies(&two_bays(1.0), LINE, &masses, &middle.shapes)?;
    let (below, above) = (below?, above?);
    for mode in 0..4 {
        let slope = (above.eigenvalues[mode] - below.eigenvalues[mode]) / (2.0 * step);
        // Seven members, and the spring behind them.
        let own = energies.strain[8 * mode + 7];
        assert!((slope - own).abs() < 1e-6 * middle.eigenvalues[mode]);
        let kinetic: f64 = energies.kinetic[13 * mode..13 * (mode + 1)].iter().sum();
        close(kinetic, 1.0);
        let strain: f64 = energies.strain[8 * mode..8 * (mode + 1)].iter().sum();
        close(strain, middle.eigenvalues[mode]);
    }
    Ok(())
}
