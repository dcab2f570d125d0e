//! Scores of a row in which some are missing: independent by the law of those that are there.

use rga_simd::f32::SIXTEEN;

use crate::change::Block;

/// Least share of a direction that is left where scores are missing.
const LEAST_LEFT: f64 = 1e-6;

/// Rotations beyond which nothing of a matrix is left to be turned, in sweeps over all pairs.
const SWEEPS: usize = 30;

/// What W times scores becomes where some scores are missing, p sensors and k missing scores.
///
/// Scores z of correlation R have W = R^(-1/2). With missing scores at their conditional means, W z
/// is what is orthogonal to the columns of W that belong to them; its part at the sensors that are
/// there has the covariance 1 - B B', B being the rows there of an orthonormal basis of those
/// columns. Its inverse root makes these as many independent scores of variance 1 as there are
/// readings, by the marginal law of what is there: 1 + B f(B' B) B', f(t) = ((1 - t)^(-1/2) - 1) / t.
#[derive(Debug, Clone, Default)]
pub(super) struct Gaps {
    missing: Vec<usize>,
    /// `[k, p]` rows are orthonormal
    basis: Vec<f64>,
    /// `[k, k]` f(B' B)
    stretch: Vec<f64>,
}

impl Gaps {
    /// Of missing scores in rising order; `mixing`: symmetric W `[p, p]`.
    fn of(missing: Vec<usize>, mixing: &[f64], sensors: usize) -> Self {
        let mut basis: Vec<f64> = Vec::with_capacity(missing.len() * sensors);
        for sensor in &missing {
            let mut own = mixing[sensor * sensors..][..sensors].to_vec();
            for before in basis.chunks_exact(sensors) {
                let along = product(before, &own);
                add(&mut own, -along, before);
            }
            let length = product(&own, &own).sqrt().max(f64::MIN_POSITIVE);
            own.iter_mut().for_each(|value| *value /= length);
            basis.extend(own);
        }
        let mut there = basis.clone();
        for row in there.chunks_exact_mut(sensors) {
            missing.iter().for_each(|sensor| row[*sensor] = 0.0);
        }
        let rows = || there.chunks_exact(sensors);
        let products = rows().flat_map(|one| rows().map(move |other| product(one, other)));
        let stretch = stretched(products.collect(), missing.len());
        Self {
            missing,
            basis,
            stretch,
        }
    }

    /// The same where the same scores are missing as in the row before.
    pub(super) fn again(&mut self, missing: Vec<usize>, mixing: &[f64], sensors: usize) {
        if self.missing != missing {
            *self = Self::of(missing, mixing, sensors);
        }
    }

    /// W times scores in which missing ones are 0, `[p]`, becomes independent scores; those of
    /// missing ones mean nothing.
    pub(super) fn close(&self, mixed: &mut [f64]) {
        let rows = || self.basis.chunks_exact(mixed.len());
        let mut whole = mixed.to_vec();
        for row in rows() {
            let along = product(row, &whole);
            add(&mut whole, -along, row);
        }
        for sensor in &self.missing {
            whole[*sensor] = 0.0;
        }
        let along: Vec<f64> = rows().map(|row| product(row, &whole)).collect();
        let stretch = self.stretch.chunks_exact(self.missing.len());
        let sizes: Vec<f64> = stretch.map(|row| product(row, &along)).collect();
        for (row, size) in rows().zip(sizes) {
            add(&mut whole, size, row);
        }
        mixed.copy_from_slice(&whole);
    }
}

/// Sensors of a row whose scores are missing.
pub(super) fn missing(scores: &[Block], row: usize, sensors: usize) -> Vec<usize> {
    let none = |sensor: &usize| scores[sensor / SIXTEEN][row][sensor % SIXTEEN].is_nan();
    (0..sensors).filter(none).collect()
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

fn add(to: &mut [f64], size: f64, row: &[f64]) {
    for (to, value) in to.iter_mut().zip(row) {
        *to += size * value;
    }
}

/// f of a symmetric matrix `[k, k]` whose eigenvalues are from 0 to 1, by Jacobi's rotations.
fn stretched(mut matrix: Vec<f64>, k: usize) -> Vec<f64> {
    let mut vectors = vec![0.0; k * k];
    (0..k).for_each(|at| vectors[at * k + at] = 1.0);
    for _ in 0..SWEEPS {
        let mut turned = false;
        for one in 0..k {
            for other in one + 1..k {
                let beside = matrix[one * k + other];
                let (own, its) = (matrix[one * k + one], matrix[other * k + other]);
                if beside.abs() <= f64::EPSILON * (own.abs() + its.abs()).max(LEAST_LEFT) {
                    continue;
                }
                turned = true;
                let slope = (its - own) / (2.0 * beside);
                let tangent = slope.signum() / (slope.abs() + (1.0 + slope * slope).sqrt());
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                let turn = (one, other, cosine, tangent * cosine);
                turn_columns(&mut matrix, k, turn);
                turn_rows(&mut matrix, k, turn);
                turn_rows(&mut vectors, k, turn);
            }
        }
        if !turned {
            break;
        }
    }
    let mut found = vec![0.0; k * k];
    for (at, vector) in vectors.chunks_exact(k).enumerate() {
        let root = (1.0 - matrix[at * k + at]).clamp(LEAST_LEFT, 1.0).sqrt();
        // f(t) with t = 1 - root^2, without a difference of what is nearly equal.
        let size = 1.0 / (root * (1.0 + root));
        for (row, value) in found.chunks_exact_mut(k).zip(vector) {
            add(row, size * value, vector);
        }
    }
    found
}

type Turn = (usize, usize, f64, f64);

fn turn_rows(matrix: &mut [f64], k: usize, (one, other, cosine, sine): Turn) {
    for at in 0..k {
        let (first, last) = (matrix[one * k + at], matrix[other * k + at]);
        matrix[one * k + at] = cosine * first - sine * last;
        matrix[other * k + at] = sine * first + cosine * last;
    }
}

fn turn_columns(matrix: &mut [f64], k: usize, (one, other, cosine, sine): Turn) {
    for row in matrix.chunks_exact_mut(k) {
        let (first, last) = (row[one], row[other]);
        row[one] = cosine * first - sine * last;
        row[other] = sine * first + cosine * last;
    }
}

#[cfg(test)]
mod tests {
    use super::Gaps;

    /// W of three sensors; with the first missing, covariance R of the others is that of W^-2.
    #[test]
    fn scores_that_are_there_have_the_identity_as_covariance() {
        let root = [[1.2, 0.3, -0.2], [0.3, 0.9, 0.1], [-0.2, 0.1, 1.1]];
        let inverse = inverse(root);
        let mixing: Vec<f64> = root.into_iter().flatten().collect();
        for missing in [vec![0], vec![2], vec![0, 1]] {
            let gaps = Gaps::of(missing.clone(), &mixing, 3);
            // Columns of A W^-1: A takes scores of covariance W^-2 to independent ones.
            let columns: Vec<Vec<f64>> = (0..3)
                .map(|at| {
                    let scores: Vec<f64> = (0..3)
                        .map(|row| {
                            if missing.contains(&row) {
                                0.0
                            } else {
                                inverse[row][at]
                            }
                        })
                        .collect();
                    let mut mixed: Vec<f64> = root
                        .iter()
                        .map(|row| row.iter().zip(&scores).map(|(w, z)| w * z).sum())
                        .collect();
                    gaps.close(&mut mixed);
                    mixed
                })
                .collect();
            let there = (0..3).filter(|at| !missing.contains(at));
            for one in there.clone() {
                for other in there.clone() {
                    let found: f64 = columns.iter().map(|own| own[one] * own[other]).sum();
                    let right = f64::from(u8::from(one == other));
                    assert!((found - right).abs() < 1e-12, "{missing:?}: {found}");
                }
            }
        }
    }

    fn inverse(of: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        let minor = |row: usize, column: usize| {
            let (a, b) = ((row + 1) % 3, (row + 2) % 3);
            let (c, d) = ((column + 1) % 3, (column + 2) % 3);
            of[a][c] * of[b][d] - of[a][d] * of[b][c]
        };
        let size: f64 = (0..3).map(|at| of[0][at] * minor(0, at)).sum();
        let mut found = [[0.0; 3]; 3];
        for (row, own) in found.iter_mut().enumerate() {
            for (column, value) in own.iter_mut().enumerate() {
                *value = minor(column, row) / size;
            }
        }
        found
    }
}
