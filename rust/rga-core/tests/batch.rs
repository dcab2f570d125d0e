//! Samples agree with one analysis each of the structure they stand for.

mod common;

use common::samples::{Random, all_outputs, batch_solver, bridge, expected, run, with_loads};
use common::*;
use rga_core::{Error, Result};

/// All rows, each output against the largest of its kind; then threads.
fn agree(patterns: &[Case], outputs: &[Output], rows: usize, range: (f64, f64)) -> Result<()> {
    let elements = patterns[0].ends.len() + patterns[0].springs.len();
    let mut random = Random(11);
    let mut factors = random.many(rows * elements, range.0, range.1);
    let yields = |ends: &[f64; 12]| ends.iter().any(|end| end.is_finite() && *end > 0.0);
    for (member, ends) in patterns[0].connection.iter().enumerate() {
        // Ends that yield do not scale with their member.
        if yields(ends) {
            (0..rows).for_each(|row| factors[row * elements + member] = 1.0);
        }
    }
    let coefficients = random.many(rows * patterns.len(), -1.0, 2.0);
    let batch = batch_solver(patterns, outputs)?;
    let found = run(&batch, &factors, &coefficients, rows, 1)?;
    assert_eq!(found.len(), rows * outputs.len());
    for row in 0..rows {
        let own = &factors[row * elements..(row + 1) * elements];
        let load = &coefficients[row * patterns.len()..(row + 1) * patterns.len()];
        let right = expected(patterns, outputs, own, load)?;
        for (at, (value, right_value)) in (found[row * outputs.len()..].iter())
            .zip(&right)
            .enumerate()
        {
            let alike = outputs.iter().zip(&right);
            let largest = alike
                .filter(|(output, _)| output.0 == outputs[at].0)
                .fold(0.0_f64, |most, (_, value)| most.max(value.abs()));
            assert!(
                (value - right_value).abs() <= 1e-9 * largest,
                "row {row}, output {at}: {value} instead of {right_value} (largest {largest})"
            );
        }
    }
    for threads in [2, 3] {
        assert!(same_bits(
            &found,
            &run(&batch, &factors, &coefficients, rows, threads)?
        ));
    }
    Ok(())
}

fn same_bits(one: &[f64], other: &[f64]) -> bool {
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    bits(one) == bits(other)
}

#[test]
fn a_truss_agrees() -> Result<()> {
    let truss = bridge(3, false);
    agree(&with_loads(&truss), &all_outputs(&truss), 40, (0.2, 3.0))
}

#[test]
fn springs_ties_and_inclined_supports_agree() -> Result<()> {
    let mut truss = bridge(3, false);
    truss.springs.push(([13, -1], 1, 2e6));
    truss.springs.push(([5, 6], 0, 5e7));
    truss.ties.push(([9, 11], 1));
    truss.inclined.push((6, [0.6, 0.0, 0.8], 0.0));
    agree(&with_loads(&truss), &all_outputs(&truss), 20, (0.05, 20.0))
}

#[test]
fn frames_with_every_end_agree() -> Result<()> {
    let mut frame = bridge(2, true);
    frame.shear_area = 4e-3;
    frame.frame[8] = false;
    frame.rigid_end[3] = [0.2, 0.1];
    frame.rigid_end[7] = [0.0, 0.15];
    frame.springs.push(([5, -1], 4, 1e6));
    frame.ties.push(([9, 10], 2));
    frame.inclined.push((11, [0.0, 0.6, 0.8], 0.0));
    frame = frame
        .connect(1, 5, 0.0)
        .connect(3, 4, 3e5)
        .connect(3, 11, 8e5)
        .connect(6, 11, 0.0)
        .connect(6, 5, 2e6)
        .connect(10, 0, 4e7);
    agree(&with_loads(&frame), &all_outputs(&frame), 20, (0.1, 10.0))
}

/// Along the axes most entries of a stiffness vanish, and some only just.
#[test]
fn a_portal_with_yielding_ends_agrees() -> Result<()> {
    let nodes = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 3.0],
        [4.0, 0.0, 3.0],
        [4.0, 0.0, 0.0],
    ];
    let portal = Case::new(&nodes, &[([0, 1], true), ([1, 2], true), ([2, 3], true)])
        .fix(0, &[0, 1, 2, 3, 4, 5])
        .fix(3, &[0, 1, 2, 3, 4, 5])
        .connect(1, 5, 1e-3)
        .connect(1, 11, 1e9)
        .connect(2, 4, 0.0);
    let mut warm = portal.clone();
    warm.strain.fill([1e-4, 0.0, 2e-4]);
    let blown = portal.clone().uniform(0, 1, 3.0, 2e3).force(1, 1, 5e3);
    agree(&[warm, blown], &all_outputs(&portal), 10, (0.01, 100.0))
}

#[test]
fn a_removed_member_is_as_if_it_never_was() -> Result<()> {
    let mut frame = bridge(2, true);
    frame.nodes.push([3.0, 6.0, 1.0]);
    for list in [&mut frame.forces, &mut frame.prescribed] {
        list.push([0.0; 6]);
    }
    frame.fixed.push([false; 6]);
    // Only the first of these four bends: without it node 12 is a hinge.
    for (foot, bends) in [(4, true), (5, false), (8, false), (9, false)] {
        frame.ends.push([foot, 12]);
        frame.frame.push(bends);
        frame.connection.push([f64::INFINITY; 12]);
        frame.rigid_end.push([0.0; 2]);
        frame.strain.push([0.0; 3]);
    }
    let removed = frame.ends.len() - 4;
    let loaded = frame.clone().force(12, 2, -1e4).force(12, 1, 3e3);
    let outputs: Vec<Output> = (4..13).map(|node| at(DISPLACEMENT, node, 2)).collect();
    let mut factors = vec![1.0; 2 * frame.ends.len()];
    factors[removed] = 0.0;
    let batch = batch_solver(std::slice::from_ref(&loaded), &outputs)?;
    let found = run(&batch, &factors, &[1.0, 1.0], 2, 1)?;
    let (without, with) = found.split_at(outputs.len());
    let mut cut = loaded.clone();
    cut.ends.remove(removed);
    cut.frame.remove(removed);
    cut.connection.remove(removed);
    cut.rigid_end.remove(removed);
    cut.strain.remove(removed);
    for (found, case) in [(without, &cut), (with, &loaded)] {
        for (value, right) in found.iter().zip(case.solve(&outputs)?) {
            close(*value, right);
        }
    }
    assert!((without[8] - with[8]).abs() > 1e-6 * with[8].abs());

    // The strain of a removed member is that of its ends, as of a member that is all but gone.
    let gauge = [(STRAIN, removed as i64, -1, [0.5, 0.0, 0.0])];
    let strained = batch_solver(std::slice::from_ref(&loaded), &gauge)?;
    let gone = run(&strained, &factors, &[1.0, 1.0], 2, 1)?[0];
    factors[removed] = 1e-9;
    let almost = run(&strained, &factors, &[1.0, 1.0], 2, 1)?[0];
    assert!(gone != 0.0 && (gone - almost).abs() < 1e-6 * gone.abs());
    factors[removed] = 0.0;

    let turned = batch_solver(&[loaded.force(12, 4, 1e3)], &outputs)?;
    let refused = run(&turned, &factors, &[1.0, 1.0], 2, 1);
    assert!(refused.is_err_and(|error| error.to_string().contains("ry of node 12")));
    Ok(())
}

#[test]
fn a_mechanism_names_row_and_place() -> Result<()> {
    let nodes = [[0.0; 3], [4.0, 0.0, 0.0], [2.0, 0.0, 3.0]];
    let truss = Case::new(&nodes, &[([0, 1], false), ([1, 2], false), ([0, 2], false)]);
    let truss = (0..3).fold(truss, |case, node| case.fix(node, &[1]));
    let truss = truss.fix(0, &[0, 2]).fix(1, &[2]).force(2, 2, -1e4);
    let batch = batch_solver(&[truss], &[at(DISPLACEMENT, 2, 2)])?;
    let rows = 100;
    let mut factors = vec![1.0; 3 * rows];
    let coefficients = vec![1.0; rows];
    assert!(run(&batch, &factors, &coefficients, rows, 2).is_ok());
    // Without its bottom chord node 1 slides.
    for row in [70, 37, 90] {
        factors[3 * row] = if row == 70 { 0.0 } else { 1e-16 };
    }
    for threads in [1, 2, 3] {
        match run(&batch, &factors, &coefficients, rows, threads) {
            Err(Error::Row { row: 37, error }) => match *error {
                Error::UnstableStructure { node, dof, .. } => assert_eq!((node, dof), (1, 0)),
                other => panic!("expected a mechanism, got {other:?}"),
            },
            other => panic!("expected row 37, got {other:?}"),
        }
    }
    factors[3 * 37] = 1.0;
    let refused = run(&batch, &factors, &coefficients, rows, 1);
    assert!(refused.is_err_and(|error| {
        let text = error.to_string();
        text.starts_with("row 70: the structure is unstable: nothing holds node 1 in ux")
    }));
    Ok(())
}

#[test]
fn bad_samples_are_refused() -> Result<()> {
    let truss = bridge(1, false).force(5, 2, -1e4);
    let outputs = [at(DISPLACEMENT, 5, 2)];
    let members = truss.ends.len();
    let batch = batch_solver(&[truss], &outputs)?;
    let good = vec![1.0; 2 * members];
    let expect = |text: &str, factors: &[f64], coefficients: &[f64], threads: usize| {
        let found = run(&batch, factors, coefficients, 2, threads);
        let message = found.map_err(|error| error.to_string());
        assert!(
            message.as_ref().is_err_and(|found| found.contains(text)),
            "{message:?}"
        );
    };
    let spoilt = |value: f64| {
        let mut factors = good.clone();
        factors[members + 2] = value;
        factors
    };
    expect("factors[1, 2] is NaN", &spoilt(f64::NAN), &[1.0; 2], 1);
    expect("factors[1, 2] is -1", &spoilt(-1.0), &[1.0; 2], 1);
    expect("factors[1, 2] is inf", &spoilt(f64::INFINITY), &[1.0; 2], 1);
    expect(
        "row 1: the stiffness overflows",
        &spoilt(1e305),
        &[1.0; 2],
        1,
    );
    expect("factors has shape", &good[2..], &[1.0; 2], 1);
    expect("coefficients[1, 0] is NaN", &good, &[1.0, f64::NAN], 1);
    expect("coefficients has shape", &good, &[1.0; 4], 1);
    expect("row 0: the load overflows", &good, &[1e305, 1.0], 1);
    expect("threads must be", &good, &[1.0; 2], 0);
    assert!(run(&batch, &[], &[], 0, 4)?.is_empty());
    Ok(())
}

#[test]
fn no_outputs_still_check_the_structure() -> Result<()> {
    let sliding = Case::new(&[[0.0; 3], [1.0, 0.0, 0.0]], &[([0, 1], false)]).fix(0, &[0, 1, 2]);
    let batch = batch_solver(&[sliding], &[])?;
    let refused = run(&batch, &[1.0; 20], &[1.0; 20], 20, 2);
    assert!(refused.is_err_and(|error| error.to_string().starts_with("row 0: ")));
    Ok(())
}
