//! Modes of samples side by side: against dense matrices, closed forms and structures by
//! themselves.

mod common;

use common::masses::{mass, with_masses};
use common::samples::{Random, bridge};
use common::*;
use nalgebra::{DMatrix, DVector};
use rga_core::{Array, Error, ModalBatch, Result, instructions, modal_energies, modes};

const LINE: f64 = 60.0;

/// Masses on nodes.
type Nodal = [(usize, [f64; 6])];

struct Swinging {
    case: Case,
    line: f64,
    nodal: Vec<(usize, [f64; 6])>,
}

impl Swinging {
    /// A bridge of crooked members with masses on some nodes.
    fn bridge(frame: bool) -> Self {
        let (case, mut random) = (bridge(5, frame), Random(9));
        let nodal = (0..case.nodes.len()).step_by(3);
        Self {
            nodal: nodal
                .map(|node| (node, mass(random.between(100.0, 900.0))))
                .collect(),
            line: LINE,
            case,
        }
    }

    /// Masses on bars of their own, of unit mass, with stiffnesses of `squares`.
    fn oscillators(squares: &[f64]) -> Self {
        let apart = |at: usize| 10.0 * at as f64;
        let length = |square: f64| E * AREA / square;
        let held: Vec<[f64; 3]> = (0..squares.len()).map(|at| [0.0, apart(at), 0.0]).collect();
        let free = squares.iter().enumerate();
        let free = free.map(|(at, square)| [length(*square), apart(at), 0.0]);
        let nodes: Vec<[f64; 3]> = held.iter().copied().chain(free).collect();
        let count = squares.len() as i64;
        let bars: Vec<([i64; 2], bool)> = (0..count).map(|at| ([at, at + count], false)).collect();
        let mut case = Case::new(&nodes, &bars);
        for at in 0..squares.len() {
            case = case.fix(at, &[0, 1, 2]).fix(at + squares.len(), &[1, 2]);
        }
        let masses = (0..squares.len()).map(|at| (at + squares.len(), mass(1.0)));
        Self {
            nodal: masses.collect(),
            line: 0.0,
            case,
        }
    }

    fn elements(&self) -> usize {
        self.case.ends.len() + self.case.springs.len()
    }

    fn all_dofs(&self) -> Vec<usize> {
        (0..6 * self.case.nodes.len()).collect()
    }

    fn batch(&self, count: usize, dofs: &[usize], set: Option<&str>) -> Result<ModalBatch> {
        let all: Vec<usize> = (0..self.elements()).collect();
        self.batch_of(&all, count, dofs, set)
    }

    fn batch_of(
        &self,
        varied: &[usize],
        count: usize,
        dofs: &[usize],
        set: Option<&str>,
    ) -> Result<ModalBatch> {
        with_masses(&self.case, self.line, &self.nodal, |structure, masses| {
            ModalBatch::new(structure, masses, varied, count, dofs, set)
        })
    }

    /// Of all dofs that move: which, K by factors and M, from energies of motions of one or two.
    fn dense(&self, factors: &[f64]) -> (Vec<usize>, DMatrix<f64>, DMatrix<f64>) {
        let dofs = self.all_dofs();
        let energies = |motions: &[f64]| {
            with_masses(&self.case, self.line, &self.nodal, |structure, masses| {
                modal_energies(structure, masses, motions)
            })
        };
        let of_pair = |pairs: &[[usize; 2]]| {
            let mut motions = vec![0.0; pairs.len() * dofs.len()];
            for (motion, pair) in motions.chunks_exact_mut(dofs.len()).zip(pairs) {
                pair.iter().for_each(|&dof| motion[dof] += 1.0);
            }
            let found = energies(&motions).unwrap();
            let sums = |values: &[f64], factor: &dyn Fn(usize) -> f64| -> Vec<f64> {
                let each = values.chunks_exact(values.len() / pairs.len());
                let terms =
                    |own: &[f64]| own.iter().enumerate().map(|(at, v)| factor(at) * v).sum();
                each.map(terms).collect()
            };
            (
                sums(&found.strain, &|at| factors[at]),
                sums(&found.kinetic, &|_| 1.0),
            )
        };
        let alone: Vec<[usize; 2]> = dofs.iter().map(|&dof| [dof, dof]).collect();
        // Twice the motion has four times the energy.
        let (stiff, heavy) = of_pair(&alone);
        let fixed = self.case.fixed.as_flattened();
        let moving = |dof: &usize| !fixed[*dof] && stiff[*dof] > 0.0;
        let moving: Vec<usize> = dofs.iter().copied().filter(moving).collect();
        let size = moving.len();
        let pairs: Vec<[usize; 2]> = moving
            .iter()
            .flat_map(|&one| moving.iter().map(move |&other| [one, other]))
            .collect();
        let (both, both_heavy) = of_pair(&pairs);
        let entries = |both: &[f64], own: &[f64]| {
            DMatrix::from_fn(size, size, |i, j| {
                let alone = 0.25 * (own[moving[i]] + own[moving[j]]);
                let both = both[i * size + j];
                if i == j {
                    0.25 * both
                } else {
                    0.5 * (both - alone)
                }
            })
        };
        let (stiffness, masses) = (entries(&both, &stiff), entries(&both_heavy, &heavy));
        (moving, stiffness, masses)
    }

    /// Holds the modes of samples against dense matrices.
    fn check(&self, varied: &[usize], count: usize, factors: &[f64]) -> Result<()> {
        let dofs = self.all_dofs();
        let batch = self.batch_of(varied, count, &dofs, None)?;
        let rows = factors.len() / varied.len();
        let found = batch.modes(Array::new(factors, &[rows, varied.len()]), 1)?;
        let of_rows = found.chunks_exact(batch.width());
        for (factors, found) in factors.chunks_exact(varied.len()).zip(of_rows) {
            let mut all = vec![1.0; self.elements()];
            for (&element, factor) in varied.iter().zip(factors) {
                all[element] = *factor;
            }
            let (moving, stiffness, masses) = self.dense(&all);
            let lower = stiffness.clone().cholesky().unwrap().l();
            let half = lower.solve_lower_triangular(&masses).unwrap();
            let whole = lower.solve_lower_triangular(&half.transpose()).unwrap();
            let mut exact: Vec<f64> = whole.symmetric_eigenvalues().iter().copied().collect();
            exact.sort_by(|one, other| other.total_cmp(one));
            for (mode, exact) in found.chunks_exact(1 + dofs.len()).zip(exact) {
                let (value, shape) = (mode[0], &mode[1..]);
                assert!(
                    (value * exact - 1.0).abs() < 1e-9,
                    "{value} {}",
                    1.0 / exact
                );
                let shape =
                    DVector::from_iterator(moving.len(), moving.iter().map(|&at| shape[at]));
                let force = &stiffness * &shape;
                let left = &force - &masses * &shape * value;
                // In the norm of K^-1.
                let solved = |force: &DVector<f64>| lower.solve_lower_triangular(force).unwrap();
                assert!(solved(&left).norm() < 1e-5 * solved(&force).norm());
                assert!((shape.dot(&(&masses * &shape)) - 1.0).abs() < 1e-9);
            }
        }
        Ok(())
    }
}

fn close_all(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (one, other) in found.iter().zip(expected) {
        assert!((one / other - 1.0).abs() < 1e-9, "{one} instead of {other}");
    }
}

#[test]
fn random_frames_and_trusses_are_those_of_dense_matrices() -> Result<()> {
    for frame in [false, true] {
        let swinging = Swinging::bridge(frame);
        let elements = swinging.elements();
        let all: Vec<usize> = (0..elements).collect();
        let factors = Random(4).many(7 * elements, 0.4, 1.9);
        swinging.check(&all, 6, &factors)?;
    }
    Ok(())
}

/// Rotations of a frame, and all that bears no mass on a node.
#[test]
fn dofs_without_mass_make_no_mode() -> Result<()> {
    let mut swinging = Swinging::bridge(true);
    swinging.line = 0.0;
    let all: Vec<usize> = (0..swinging.elements()).collect();
    let factors = Random(6).many(5 * all.len(), 0.5, 1.5);
    swinging.check(&all, 5, &factors)
}

/// A bridge with a spring, and a few members of it.
fn few(frame: bool) -> (Swinging, Vec<usize>) {
    let mut swinging = Swinging::bridge(frame);
    swinging.case.springs.push(([13, -1], 1, 2e6));
    let varied = if frame {
        vec![3, 80]
    } else {
        vec![3, 20, 41, 80]
    };
    (swinging, varied)
}

#[test]
fn where_few_vary_they_are_those_of_dense_matrices() -> Result<()> {
    for frame in [false, true] {
        let (swinging, mut varied) = few(frame);
        let last = swinging.elements() - 1;
        varied.retain(|element| *element < last);
        varied.push(last);
        let factors = Random(4).many(7 * varied.len(), 0.1, 1.9);
        swinging.check(&varied, 6, &factors)?;
    }
    Ok(())
}

/// Where the few vectors do not suffice, the whole structure answers, with the bits that it has
/// where all may vary. Where they do, the last bits are their own.
#[test]
fn what_few_vectors_do_not_show_is_found_in_the_whole() -> Result<()> {
    let (swinging, varied) = few(false);
    let elements = swinging.elements();
    let varied: Vec<usize> = varied.into_iter().filter(|at| *at < elements).collect();
    let apart = [1.0, 1e5, 3e-3, 1e4];
    let (mut few, mut all) = (Vec::new(), Vec::new());
    for row in 0..2 {
        let mut own = vec![1.0; elements];
        for (at, &element) in varied.iter().enumerate() {
            let factor = if row == 0 { 1.1 } else { apart[at % 4] };
            own[element] = factor;
            few.push(factor);
        }
        all.extend(own);
    }
    let few = swinging
        .batch_of(&varied, 6, &[], None)?
        .modes(Array::new(&few, &[2, varied.len()]), 1)?;
    let all = swinging
        .batch(6, &[], None)?
        .modes(Array::new(&all, &[2, elements]), 1)?;
    close_all(&few, &all);
    assert_ne!(few[..6], all[..6]);
    assert_eq!(few[6..], all[6..]);
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
    let swinging = Swinging::bridge(false);
    let elements = swinging.elements();
    let mut factors = Random(8).many(6 * elements, 0.6, 1.4);
    for row in [1, 4] {
        factors[row * elements + 7] = 1e-7;
    }
    let batch = swinging.batch(4, &[], None)?;
    let found = batch.modes(Array::new(&factors, &[6, elements]), 1)?;
    for (factors, found) in factors.chunks_exact(elements).zip(found.chunks_exact(4)) {
        let young: Vec<f64> = factors.iter().map(|factor| factor * E).collect();
        let alone = with_masses(
            &swinging.case,
            swinging.line,
            &swinging.nodal,
            |structure, masses| {
                let mut own = *structure;
                own.young = Array::new(&young, own.young.shape);
                modes(&own, masses, 4)
            },
        )?;
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

#[test]
fn a_sample_has_the_same_bits_anywhere() -> Result<()> {
    for frame in [false, true] {
        let swinging = Swinging::bridge(frame);
        let (elements, rows, dofs) = (swinging.elements(), 45, [13, 20, 45]);
        let mut factors = Random(2).many(rows * elements, 0.4, 1.9);
        factors[3 * elements + 7] = 1e-7;
        let ask = |set: Option<&str>, from: usize, to: usize, threads: usize| {
            let own = &factors[from * elements..to * elements];
            let shape = [to - from, elements];
            swinging
                .batch(6, &dofs, set)?
                .modes(Array::new(own, &shape), threads)
        };
        let all = ask(None, 0, rows, 1)?;
        assert_eq!(all, ask(None, 0, rows, 3)?);
        for set in instructions() {
            assert_eq!(all, ask(Some(set), 0, rows, 1)?, "{set}");
        }
        let width = all.len() / rows;
        for (from, to) in [(0, 1), (2, 5), (3, 4), (7, 30)] {
            assert_eq!(all[from * width..to * width], ask(None, from, to, 1)?[..]);
        }
    }
    Ok(())
}

#[test]
fn bad_input_is_refused() -> Result<()> {
    let swinging = Swinging::bridge(false);
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
    let none: &Nodal = &[];
    let nothing = with_masses(&swinging.case, 0.0, none, |structure, masses| {
        ModalBatch::new(structure, masses, &[0], 4, &[], None)
    });
    assert!(nothing.is_err());
    let nothing = batch.modes(Array::new(&[], &[0, elements]), 2)?;
    assert!(nothing.is_empty());
    Ok(())
}
