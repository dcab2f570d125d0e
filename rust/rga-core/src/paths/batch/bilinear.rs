//! Sparse forms that are linear in weights and in a vector: y = sum over k of w[k] A[k] x.
//!
//! Each A[k] is kept as a sum of outer products u v': there is one of a truss member or a spring,
//! and there are six of a frame member. What is summed may be one row or many, one a lane.

use std::ops::Range;

use nalgebra::DMatrix;
use rga_simd::f64::Lanes;

/// `value` in row and column of the matrix of one weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub weight: usize,
    pub row: usize,
    pub column: usize,
    pub value: f64,
}

/// A part of a sum below this is the rounding of its terms.
const ROUNDING: f64 = 1e-14;

/// Entries of one weight that are looked at together; an element has 144.
const ELEMENT: usize = 200;

#[derive(Debug)]
pub(super) struct Bilinear {
    /// Of one shape behind each other: where a loop over their terms ends is then foreseen.
    products: Vec<Product>,
    /// The products of each weight.
    own: Vec<Vec<usize>>,
    /// u and v of each product: index and value.
    rows: Vec<(usize, f64)>,
    columns: Vec<(usize, f64)>,
}

#[derive(Debug)]
struct Product {
    weight: usize,
    rows: Range<usize>,
    columns: Range<usize>,
}

impl Product {
    fn shape(&self) -> (usize, usize) {
        (self.rows.len(), self.columns.len())
    }
}

/// Products of one shape, one behind the other.
struct Run<'a> {
    form: &'a Bilinear,
    run: &'a [Product],
}

impl Run<'_> {
    #[inline(always)]
    fn add<L: Lanes, const ROWS: usize, const COLUMNS: usize>(
        &self,
        lanes: L,
        weights: &[L::Numbers],
        x: &[L::Numbers],
        out: &mut [L::Numbers],
    ) {
        let (rows, _) = self.form.rows[self.run[0].rows.start..].as_chunks::<ROWS>();
        let (columns, _) = self.form.columns[self.run[0].columns.start..].as_chunks::<COLUMNS>();
        for ((product, rows), columns) in self.run.iter().zip(rows).zip(columns) {
            let along = lanes.mul(weights[product.weight], dot(lanes, columns, x));
            for &(row, value) in rows {
                out[row] = lanes.mul_add(lanes.splat(value), along, out[row]);
            }
        }
    }
}

impl Bilinear {
    /// Entries of one place are summed, in their order.
    pub(super) fn new(entries: Vec<Entry>, weights: usize) -> Self {
        let entries = merged(entries);
        let groups = entries.chunk_by(|one, other| one.weight == other.weight);
        let all = groups.flat_map(|own| {
            let products = outer_products(own).into_iter();
            products.map(|(u, v)| (own[0].weight, u, v))
        });
        let mut all: Vec<(usize, Terms, Terms)> = all.collect();
        all.sort_by_key(|(_, u, v)| (u.len(), v.len()));
        let mut form = Self {
            products: Vec::with_capacity(all.len()),
            own: vec![Vec::new(); weights],
            rows: Vec::new(),
            columns: Vec::new(),
        };
        for (weight, u, v) in all {
            let (row, column) = (form.rows.len(), form.columns.len());
            form.rows.extend(u);
            form.columns.extend(v);
            form.own[weight].push(form.products.len());
            form.products.push(Product {
                weight,
                rows: row..form.rows.len(),
                columns: column..form.columns.len(),
            });
        }
        form
    }

    /// `out` += w A x
    #[inline(always)]
    pub(super) fn add<L: Lanes>(
        &self,
        lanes: L,
        weights: &[L::Numbers],
        x: &[L::Numbers],
        out: &mut [L::Numbers],
    ) {
        for run in self
            .products
            .chunk_by(|one, other| one.shape() == other.shape())
        {
            let sweep = Run { form: self, run };
            // Loops of a fixed length cost far less than their few terms.
            match run[0].shape() {
                (1, 1) => sweep.add::<L, 1, 1>(lanes, weights, x, out),
                (2, 1) => sweep.add::<L, 2, 1>(lanes, weights, x, out),
                (2, 2) => sweep.add::<L, 2, 2>(lanes, weights, x, out),
                (4, 1) => sweep.add::<L, 4, 1>(lanes, weights, x, out),
                (4, 2) => sweep.add::<L, 4, 2>(lanes, weights, x, out),
                (4, 4) => sweep.add::<L, 4, 4>(lanes, weights, x, out),
                (6, 1) => sweep.add::<L, 6, 1>(lanes, weights, x, out),
                (6, 2) => sweep.add::<L, 6, 2>(lanes, weights, x, out),
                (6, 6) => sweep.add::<L, 6, 6>(lanes, weights, x, out),
                _ => {
                    for product in run {
                        let along =
                            lanes.mul(weights[product.weight], self.columns(lanes, product, x));
                        self.spread_rows(lanes, product, along, out);
                    }
                }
            }
        }
    }

    /// The part of one weight.
    #[inline(always)]
    pub(super) fn add_one<L: Lanes>(
        &self,
        lanes: L,
        (at, weight): (usize, L::Numbers),
        x: &[L::Numbers],
        out: &mut [L::Numbers],
    ) {
        for product in self.of(at) {
            let along = lanes.mul(weight, self.columns(lanes, product, x));
            self.spread_rows(lanes, product, along, out);
        }
    }

    /// `out` += (w A)' y
    #[inline(always)]
    pub(super) fn add_transposed<L: Lanes>(
        &self,
        lanes: L,
        weights: &[L::Numbers],
        y: &[L::Numbers],
        out: &mut [L::Numbers],
    ) {
        for product in &self.products {
            let along = lanes.mul(weights[product.weight], self.rows(lanes, product, y));
            for &(column, value) in &self.columns[product.columns.clone()] {
                out[column] = lanes.mul_add(lanes.splat(value), along, out[column]);
            }
        }
    }

    /// `out[k]` += y' A[k] x
    #[inline(always)]
    pub(super) fn add_to_weights<L: Lanes>(
        &self,
        lanes: L,
        y: &[L::Numbers],
        x: &[L::Numbers],
        out: &mut [L::Numbers],
    ) {
        for product in &self.products {
            let (rows, columns) = (
                self.rows(lanes, product, y),
                self.columns(lanes, product, x),
            );
            out[product.weight] = lanes.mul_add(rows, columns, out[product.weight]);
        }
    }

    fn of(&self, weight: usize) -> impl Iterator<Item = &Product> {
        self.own[weight].iter().map(|&at| &self.products[at])
    }

    /// v' x
    #[inline(always)]
    fn columns<L: Lanes>(&self, lanes: L, product: &Product, x: &[L::Numbers]) -> L::Numbers {
        dot(lanes, &self.columns[product.columns.clone()], x)
    }

    /// u' y
    #[inline(always)]
    fn rows<L: Lanes>(&self, lanes: L, product: &Product, y: &[L::Numbers]) -> L::Numbers {
        dot(lanes, &self.rows[product.rows.clone()], y)
    }

    #[inline(always)]
    fn spread_rows<L: Lanes>(
        &self,
        lanes: L,
        product: &Product,
        along: L::Numbers,
        out: &mut [L::Numbers],
    ) {
        for &(row, value) in &self.rows[product.rows.clone()] {
            out[row] = lanes.mul_add(lanes.splat(value), along, out[row]);
        }
    }
}

#[inline(always)]
fn dot<L: Lanes>(lanes: L, terms: &[(usize, f64)], x: &[L::Numbers]) -> L::Numbers {
    let mut sum = lanes.splat(0.0);
    for &(at, value) in terms {
        sum = lanes.mul_add(lanes.splat(value), x[at], sum);
    }
    sum
}

/// Entries by weight, row and column, of one place one.
pub(super) fn merged(mut entries: Vec<Entry>) -> Vec<Entry> {
    let place = |entry: &Entry| (entry.weight, entry.row, entry.column);
    entries.sort_by_key(place);
    entries.dedup_by(|next, sum| {
        let same = place(next) == place(sum);
        if same {
            sum.value += next.value;
        }
        same
    });
    entries.retain(|entry| entry.value != 0.0);
    entries
}

type Terms = Vec<(usize, f64)>;

/// A matrix as a sum of u v', of as few numbers as are easily found.
fn outer_products(entries: &[Entry]) -> Vec<(Terms, Terms)> {
    let mut found = by_lines(entries);
    if entries.len() <= ELEMENT {
        let crossed = by_crosses(entries);
        if numbers(&crossed) < numbers(&found) {
            found = crossed;
        }
    }
    found
}

fn numbers(products: &[(Terms, Terms)]) -> usize {
    products.iter().map(|(u, v)| u.len() + v.len()).sum()
}

/// One product a row, or one a column.
fn by_lines(entries: &[Entry]) -> Vec<(Terms, Terms)> {
    let mut across = entries.to_vec();
    across.sort_by_key(|entry| (entry.column, entry.row));
    let rows = entries.chunk_by(|one, other| one.row == other.row);
    let columns = across.chunk_by(|one, other| one.column == other.column);
    if columns.clone().count() < rows.clone().count() {
        let own = |line: &[Entry]| line.iter().map(|entry| (entry.row, entry.value)).collect();
        columns
            .map(|line| (own(line), vec![(line[0].column, 1.0)]))
            .collect()
    } else {
        let own = |line: &[Entry]| {
            line.iter()
                .map(|entry| (entry.column, entry.value))
                .collect()
        };
        rows.map(|line| (vec![(line[0].row, 1.0)], own(line)))
            .collect()
    }
}

/// Gaussian elimination with the largest pivot: as many products as the rank.
fn by_crosses(entries: &[Entry]) -> Vec<(Terms, Terms)> {
    let names = |name: fn(&Entry) -> usize| {
        let mut names: Vec<usize> = entries.iter().map(name).collect();
        names.sort_unstable();
        names.dedup();
        names
    };
    let (rows, columns) = (names(|entry| entry.row), names(|entry| entry.column));
    let mut rest = DMatrix::<f64>::zeros(rows.len(), columns.len());
    for entry in entries {
        let row = rows.partition_point(|&row| row < entry.row);
        let column = columns.partition_point(|&column| column < entry.column);
        rest[(row, column)] = entry.value;
    }
    let mut products = Vec::new();
    for _ in 0..rows.len().min(columns.len()) {
        let (row, column) = rest.iamax_full();
        let pivot = rest[(row, column)];
        if pivot == 0.0 {
            break;
        }
        let u = rest.column(column).clone_owned();
        let v = rest.row(row).clone_owned() / pivot;
        for i in 0..rows.len() {
            for j in 0..columns.len() {
                let (value, taken) = (rest[(i, j)], u[i] * v[j]);
                let rounding = ROUNDING * (value.abs() + taken.abs());
                let known = i == row || j == column || (value - taken).abs() <= rounding;
                rest[(i, j)] = if known { 0.0 } else { value - taken };
            }
        }
        let terms = |names: &[usize], values: &[f64]| -> Terms {
            let pairs = names.iter().copied().zip(values.iter().copied());
            pairs.filter(|(_, value)| *value != 0.0).collect()
        };
        products.push((terms(&rows, u.as_slice()), terms(&columns, v.as_slice())));
    }
    products
}

#[cfg(test)]
mod tests {
    use super::*;
    use rga_simd::f64::ONE;

    /// `[weights, rows, columns]` = `[2, 4, 5]`: one of rank one, one of full rank.
    fn entries() -> Vec<Entry> {
        let (u, v) = ([1.0, -2.0, 0.5, 3.0], [0.3, 0.0, -1.0, 2.0, 1e-9]);
        let mut entries = Vec::new();
        for (row, u) in u.into_iter().enumerate() {
            for (column, v) in v.into_iter().enumerate() {
                let scale = 10f64.powi(3 * row as i32);
                let full = ((row * 7 + column * 3) as f64).sin() * scale;
                for (weight, value) in [u * v, full].into_iter().enumerate() {
                    let entry = |value| Entry {
                        weight,
                        row,
                        column,
                        value,
                    };
                    entries.extend([entry(0.25 * value), entry(0.75 * value)]);
                }
            }
        }
        entries
    }

    #[test]
    fn products_give_the_matrix_again() {
        let form = Bilinear::new(entries(), 3);
        assert_eq!(form.of(0).count(), 1);
        assert!(form.of(2).next().is_none());
        let weights = [2.0, -3.0, 7.0];
        let whole = |row: usize, column: usize| -> f64 {
            let own = entries().into_iter();
            let own = own.filter(|entry| (entry.row, entry.column) == (row, column));
            own.map(|entry| weights[entry.weight] * entry.value).sum()
        };
        let weighted = weights.map(|weight| [weight]);
        for column in 0..5 {
            let mut x = [[0.0]; 5];
            x[column] = [1.0];
            let mut out = [[0.0]; 4];
            form.add(ONE, &weighted, &x, &mut out);
            for (row, [value]) in out.into_iter().enumerate() {
                let right = whole(row, column);
                let close = |value: f64| (value - right).abs() <= 1e-13 * right.abs();
                assert!(close(value), "{row} {column}");
                let mut y = [[0.0]; 4];
                y[row] = [1.0];
                let mut back = [[0.0]; 5];
                form.add_transposed(ONE, &weighted, &y, &mut back);
                assert!(close(back[column][0]));
                let mut of_weights = [[0.0]; 3];
                form.add_to_weights(ONE, &y, &x, &mut of_weights);
                let sums = of_weights.iter().zip(weights);
                assert!(close(sums.map(|([rate], weight)| rate * weight).sum()));
                let mut of_one = [[0.0]; 4];
                for (weight, value) in weights.into_iter().enumerate() {
                    form.add_one(ONE, (weight, [value]), &x, &mut of_one);
                }
                assert!(close(of_one[row][0]));
            }
        }
    }
}
