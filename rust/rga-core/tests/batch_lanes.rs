//! Samples side by side in SIMD lanes have the bits that they have alone, on any instruction set.

mod common;

use common::samples::{
    Random, all_outputs, batch_solver, batch_solver_with, bridge, expected, run, with_loads,
};
use common::*;
use rga_core::{Array, BatchSolver, Directions, Result, Samples, instructions};

/// Samples and everything that can be asked about them.
struct Question {
    rows: usize,
    factors: Vec<f64>,
    coefficients: Vec<f64>,
    directions: Directions,
    rates: (Vec<f64>, Vec<f64>),
    gradients: Vec<f64>,
}

impl Question {
    fn new(batch: &BatchSolver, rows: usize) -> Self {
        let mut random = Random(3);
        let (elements, patterns) = (batch.elements(), batch.patterns());
        let directions = Directions {
            count: 5,
            loads: (0..patterns).map(|at| (at, at)).collect(),
            changes: vec![(3, 0), (4, 1), (4, elements - 1), (0, 2)],
        };
        Self {
            rows,
            factors: random.many(rows * elements, 0.3, 2.0),
            coefficients: random.many(rows * patterns, -1.0, 2.0),
            rates: (
                random.many(rows * directions.loads.len(), -1.0, 1.0),
                random.many(rows * directions.changes.len(), -1.0, 1.0),
            ),
            directions,
            gradients: random.many(rows * batch.width(), -1.0, 1.0),
        }
    }

    /// Of rows in a range: outputs, derivatives, gradients.
    fn ask(&self, batch: &BatchSolver, from: usize, to: usize) -> Result<[Vec<f64>; 3]> {
        let own = |values: &[f64]| {
            let width = values.len() / self.rows;
            (
                values[from * width..to * width].to_vec(),
                [to - from, width],
            )
        };
        let (factors, coefficients) = (own(&self.factors), own(&self.coefficients));
        let (loads, changes) = (own(&self.rates.0), own(&self.rates.1));
        let gradients = own(&self.gradients);
        let samples = Samples {
            factors: Array::new(&factors.0, &factors.1),
            coefficients: Array::new(&coefficients.0, &coefficients.1),
        };
        let rates = (
            Array::new(&loads.0, &loads.1),
            Array::new(&changes.0, &changes.1),
        );
        Ok([
            batch.respond(samples, 1)?,
            batch.differentiate(samples, &self.directions, rates, 1)?,
            batch.pull_back(samples, Array::new(&gradients.0, &gradients.1), 1)?,
        ])
    }
}

fn structures() -> Vec<Vec<Case>> {
    let mut truss = bridge(4, false);
    truss.springs.push(([13, -1], 1, 2e6));
    truss.inclined.push((6, [0.6, 0.0, 0.8], 0.0));
    let mut frame = bridge(2, true);
    frame.shear_area = 4e-3;
    frame = frame.connect(1, 5, 0.0).connect(6, 11, 0.0);
    [truss, frame].iter().map(with_loads).collect()
}

#[test]
fn instruction_sets_and_batches_of_any_size_give_the_same_bits() -> Result<()> {
    assert!(instructions().contains(&"portable"));
    for patterns in structures() {
        let outputs = all_outputs(&patterns[0]);
        let whole = batch_solver(&patterns, &outputs)?;
        let question = Question::new(&whole, 21);
        let right = question.ask(&whole, 0, 21)?;
        for name in instructions() {
            let batch = batch_solver_with(&patterns, &outputs, Some(name))?;
            assert_eq!(question.ask(&batch, 0, 21)?, right, "{name}");
            for (from, to) in [(0, 1), (5, 6), (3, 14)] {
                let part = question.ask(&batch, from, to)?;
                for (part, right) in part.iter().zip(&right) {
                    let width = right.len() / 21;
                    assert_eq!(*part, right[from * width..to * width], "{name}");
                }
            }
        }
    }
    Ok(())
}

/// A sample that is nearly a mechanism is solved with care; those beside it keep their bits.
#[test]
fn a_delicate_sample_is_solved_beside_others() -> Result<()> {
    let patterns = with_loads(&bridge(3, false));
    let outputs = all_outputs(&patterns[0]);
    let batch = batch_solver(&patterns, &outputs)?;
    let question = Question::new(&batch, 16);
    let (mut factors, coefficients) = (question.factors.clone(), &question.coefficients);
    let all_well = run(&batch, &factors, coefficients, 16, 1)?;
    // Nearly all that holds node 4 along x.
    let elements = batch.elements();
    for (member, ends) in patterns[0].ends.iter().enumerate() {
        if ends.contains(&4) {
            factors[5 * elements + member] = 1e-7;
        }
    }
    let found = run(&batch, &factors, coefficients, 16, 1)?;
    let width = outputs.len();
    for row in (0..16).filter(|&row| row != 5) {
        let own = row * width..(row + 1) * width;
        assert_eq!(found[own.clone()], all_well[own]);
    }
    let own = &factors[5 * elements..6 * elements];
    let load = &coefficients[5 * patterns.len()..6 * patterns.len()];
    let right = expected(&patterns, &outputs, own, load)?;
    let largest = right
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    for (value, right) in found[5 * width..6 * width].iter().zip(right) {
        assert!((value - right).abs() <= 1e-9 * largest);
    }
    Ok(())
}

#[test]
fn unknown_instructions_are_refused() {
    let patterns = with_loads(&bridge(1, false));
    let refused = batch_solver_with(&patterns, &[], Some("sse9"));
    assert!(refused.is_err_and(|error| {
        let text = error.to_string();
        text.contains("\"sse9\"") && text.contains("portable")
    }));
}
