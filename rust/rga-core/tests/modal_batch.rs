//! Modes of samples side by side: against dense matrices, closed forms and structures by
//! themselves.

mod common;

use common::masses::with_masses;
use common::samples::Random;
use common::swinging::Swinging;
use common::*;
use rga_core::{Array, Error, ModalBatch, Result, instructions, modes};

/// Bays of a truss with room for few vectors beside it, and of one that is solved in the whole.
const LONG: i64 = 5;
const SHORT: i64 = 2;

fn close_all(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (one, other) in found.iter().zip(expected) {
        assert!((one / other - 1.0).abs() < 1e-9, "{one} instead of {other}");
    }
}

#[test]
fn random_frames_and_trusses_are_those_of_dense_matrices() -> Result<()> {
    for frame in [false, true] {
        let swinging = Swinging::bridge(SHORT, frame);
        let elements = swinging.elements();
        let all: Vec<usize> = (0..elements).collect();
        let factors = Random(4).many(11 * elements, 0.4, 1.9);
        swinging.check(&all, 6, &factors)?;
    }
    Ok(())
}

/// Rotations of a frame, and all that bears no mass on a node.
#[test]
fn dofs_without_mass_make_no_mode() -> Result<()> {
    let mut swinging = Swinging::bridge(SHORT, true);
    swinging.line = 0.0;
    let all: Vec<usize> = (0..swinging.elements()).collect();
    let factors = Random(6).many(5 * all.len(), 0.5, 1.5);
    swinging.check(&all, 5, &factors)
}

/// A frame of which one member varies, and a truss of which three do and a spring.
fn few(frame: bool) -> (Swinging, Vec<usize>) {
    if frame {
        return (Swinging::bridge(SHORT, true), vec![3]);
    }
    let mut swinging = Swinging::bridge(LONG, false);
    swinging.case.springs.push(([9, -1], 1, 2e6));
    let spring = swinging.elements() - 1;
    (swinging, vec![3, 20, 41, spring])
}

#[test]
fn where_few_vary_they_are_those_of_dense_matrices() -> Result<()> {
    for frame in [false, true] {
        let (swinging, varied) = few(frame);
        let near = Random(4).many(9 * varied.len(), 0.98, 1.02);
        let far = Random(4).many(7 * varied.len(), 0.1, 1.9);
        swinging.check(&varied, 5, &[near, far].concat())?;
    }
    Ok(())
}

/// Near the structure few vectors answer, with last bits of their own. Where they do not suffice
/// the whole structure does, with the bits that it has where all may vary.
#[test]
fn what_few_vectors_do_not_prove_is_found_in_the_whole() -> Result<()> {
    for frame in [false, true] {
        let (swinging, varied) = few(frame);
        let near = Random(5).many(varied.len(), 0.999, 1.001);
        let far: Vec<f64> = [1e5, 3e-3].into_iter().cycle().take(varied.len()).collect();
        let whole = [&near, &far].map(|factors| swinging.on_all(&varied, factors));
        let few = swinging
            .batch_of(&varied, 5, &[], None)?
            .modes(Array::new(&[near, far].concat(), &[2, varied.len()]), 1)?;
        let whole = swinging
            .batch(5, &[], None)?
            .modes(Array::new(&whole.concat(), &[2, swinging.elements()]), 1)?;
        close_all(&few, &whole);
        assert_ne!(few[..5], whole[..5]);
        assert_eq!(few[5..], whole[5..]);
    }
    Ok(())
}

/// Modes that few vectors have no part in come to be among the lowest, as those below them leave:
/// residuals are those of rounding and tell nothing of it, the count does.
#[test]
fn a_mode_that_hides_from_few_vectors_is_found() -> Result<()> {
    // A gap behind the eighth, where modes are counted: twelve are in the space, and one more.
    let square = |at: i32| 1e6 * 1.2_f64.powi(at) * if at < 8 { 1.0 } else { 1.5 };
    let squares: Vec<f64> = (0..70).map(square).collect();
    let swinging = Swinging::oscillators(&squares);
    let varied = [0, 1, 2, 3, 4, 5, 40];
    let batch = swinging.batch_of(&varied, 7, &[], None)?;
    let mut factors = Random(3).many(3 * 7, 0.9, 1.1);
    factors[7..13].fill(1e4);
    let found = batch.modes(Array::new(&factors, &[3, 7]), 1)?;
    for (factors, found) in factors.chunks_exact(7).zip(found.chunks_exact(7)) {
        let factors = swinging.on_all(&varied, factors);
        let mut expected: Vec<f64> = squares.iter().zip(&factors).map(|(s, f)| s * f).collect();
        expected.sort_by(f64::total_cmp);
        close_all(found, &expected[..7]);
    }
    // The thirteenth of the structure as it is.
    assert!((found[7 + 6] / squares[12] - 1.0).abs() < 1e-9);
    Ok(())
}

/// Pairs that are exact, or as near as one likes, among those wanted and where these end.
#[test]
fn pairs_are_told_whole() -> Result<()> {
    let mut squares: Vec<f64> = (0..40).map(|at| 1e6 * 1.17_f64.powi(at)).collect();
    for pair in [2, 5, 9] {
        squares[pair + 1] = squares[pair];
    }
    let swinging = Swinging::oscillators(&squares);
    for count in [4, 6, 7] {
        let batch = swinging.batch(count, &[], None)?;
        for apart in [0.0, 1e-13, 1e-9, 1e-5, 1e-3] {
            let mut factors = vec![1.0; 40];
            [2, 5, 9].iter().for_each(|&pair| factors[pair] += apart);
            let found = batch.modes(Array::new(&factors, &[1, 40]), 1)?;
            let mut expected: Vec<f64> = squares.iter().zip(&factors).map(|(s, f)| s * f).collect();
            expected.sort_by(f64::total_cmp);
            close_all(&found, &expected[..count]);
        }
    }
    Ok(())
}

/// A mode that the known ones have no part in comes to be the lowest: no residual tells of it, the
/// count does. And one that leaves those wanted.
#[test]
fn a_mode_that_comes_from_elsewhere_is_not_missed() -> Result<()> {
    let squares: Vec<f64> = (0..40).map(|at| 1e6 * 1.2_f64.powi(at)).collect();
    let swinging = Swinging::oscillators(&squares);
    let batch = swinging.batch(5, &[], None)?;
    let mut factors = vec![1.0; 3 * 40];
    factors[30] = 0.5 / 1.2_f64.powi(30);
    factors[40 + 1] = 1e4;
    let found = batch.modes(Array::new(&factors, &[3, 40]), 1)?;
    for (row, found) in found.chunks_exact(5).enumerate() {
        let own = &factors[40 * row..40 * (row + 1)];
        let mut expected: Vec<f64> = squares.iter().zip(own).map(|(s, f)| s * f).collect();
        expected.sort_by(f64::total_cmp);
        close_all(found, &expected[..5]);
    }
    assert!(found[0] < 0.6e6);
    Ok(())
}

/// A member nearly without stiffness asks for care, beside others that do not.
#[test]
fn samples_that_ask_for_care_are_right() -> Result<()> {
    let swinging = Swinging::bridge(SHORT, false);
    let elements = swinging.elements();
    let mut factors = Random(8).many(6 * elements, 0.6, 1.4);
    for row in [1, 4] {
        factors[row * elements + 7] = 1e-7;
    }
    let batch = swinging.batch(4, &[], None)?;
    let found = batch.modes(Array::new(&factors, &[6, elements]), 1)?;
    for (factors, found) in factors.chunks_exact(elements).zip(found.chunks_exact(4)) {
        let young: Vec<f64> = factors.iter().map(|factor| factor * E).collect();
        let Swinging { case, line, nodal } = &swinging;
        let alone = with_masses(case, *line, nodal, |structure, masses| {
            let mut own = *structure;
            own.young = Array::new(&young, own.young.shape);
            modes(&own, masses, 4)
        })?;
        close_all(found, &alone.eigenvalues);
    }
    Ok(())
}

/// Fewer unknowns than vectors fill.
#[test]
fn small_structures_are_solved_one_by_one() -> Result<()> {
    let squares = [4e6, 1e6, 9e6];
    let swinging = Swinging::oscillators(&squares);
    let found = swinging
        .batch(2, &[18], None)?
        .modes(Array::new(&[1.0, 2.0, 1.0, 8.0, 2.0, 1.0], &[2, 3]), 1)?;
    close_all(
        &[found[0], found[2], found[4], found[6]],
        &[2e6, 4e6, 2e6, 9e6],
    );
    // The first oscillator swings in the second mode of the first sample.
    close(found[3], 1.0);
    assert!(found[1].abs() < 1e-6);
    Ok(())
}

/// Rows beyond those that a thread takes at a time; in the whole, and by few vectors.
#[test]
fn a_sample_has_the_same_bits_anywhere() -> Result<()> {
    let (truss, frame) = (
        Swinging::bridge(SHORT, false),
        Swinging::bridge(SHORT, true),
    );
    let (long, varied) = few(false);
    let all = |swinging: &Swinging| (0..swinging.elements()).collect::<Vec<_>>();
    let of = [
        (all(&truss), truss, 0.4),
        (all(&frame), frame, 0.4),
        (varied, long, 0.98),
    ];
    for (varied, swinging, least) in of {
        let (width, rows, dofs) = (varied.len(), 35, [13, 20, 45]);
        let mut factors = Random(2).many(rows * width, least, 2.0 - least);
        factors[3 * width + 1] = 1e-7;
        let best = swinging.batch_of(&varied, 6, &dofs, None)?;
        let ask = |batch: &ModalBatch, from: usize, to: usize, threads: usize| {
            let own = &factors[from * width..to * width];
            batch.modes(Array::new(own, &[to - from, width]), threads)
        };
        let all = ask(&best, 0, rows, 1)?;
        assert_eq!(all, ask(&best, 0, rows, 3)?);
        for set in instructions() {
            let batch = swinging.batch_of(&varied, 6, &dofs, Some(set))?;
            assert_eq!(all, ask(&batch, 0, rows, 1)?, "{set}");
        }
        let width = best.width();
        for (from, to) in [(0, 1), (2, 5), (3, 4), (7, 30)] {
            assert_eq!(all[from * width..to * width], ask(&best, from, to, 1)?[..]);
        }
    }
    Ok(())
}

#[test]
fn bad_input_is_refused() -> Result<()> {
    let swinging = Swinging::bridge(SHORT, false);
    let (elements, nodes) = (swinging.elements(), swinging.case.nodes.len());
    let batch = swinging.batch(4, &[], None)?;
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut factors = vec![1.0; 2 * elements];
        factors[elements + 3] = bad;
        let refused = batch.modes(Array::new(&factors, &[2, elements]), 1);
        let Err(Error::InvalidInput(message)) = refused else {
            panic!("{bad} was taken");
        };
        assert!(message.contains("factors[1, 3]"), "{message}");
    }
    let factors = vec![1.0; elements];
    let shape = [1, elements];
    let one = Array::new(&factors, &shape);
    assert!(batch.modes(one, 0).is_err());
    assert!(
        batch
            .modes(Array::new(&factors[1..], &[1, elements - 1]), 1)
            .is_err()
    );
    assert!(swinging.batch(4, &[6 * nodes], None).is_err());
    assert!(swinging.batch(1000, &[], None).is_err());
    assert!(swinging.batch_of(&[elements], 4, &[], None).is_err());
    assert!(swinging.batch_of(&[1, 2, 1], 4, &[], None).is_err());
    assert!(swinging.batch(4, &[], Some("none")).is_err());
    let nothing = with_masses(&swinging.case, 0.0, &[], |structure, masses| {
        ModalBatch::new(structure, masses, &[0], 4, &[], None)
    });
    assert!(nothing.is_err());
    let nothing = batch.modes(Array::new(&[], &[0, elements]), 2)?;
    assert!(nothing.is_empty());
    Ok(())
}
