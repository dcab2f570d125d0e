//! In which order unknowns are eliminated: it decides how many numbers a factor holds.
//!
//! Approximate minimum degree is quick and near the best on long bridges; dissection by place wins
//! on grids and frames that are wide in two directions or three, the more the larger they are.

use crate::sparse::dissection::dissect;
use crate::sparse::graph::Graph;
use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::minimum_degree::minimum_degree;

/// Multiplications of all factorisations, for each unknown, from which on a dissection may save
/// the time that it takes: a third of them, or so.
const WORTHWHILE: f64 = 5e4;

/// Factorisations of a pattern that samples share.
pub(crate) const OFTEN: f64 = 10.0;

/// The unknowns in the order of their elimination; nothing where memory does not suffice.
///
/// `places` are those of the unknowns, and `repeats` the number of factorisations that the
/// order is for: a better one must be worth the time that it takes.
pub fn fill_reducing(
    matrix: &LowerTriangle,
    places: &[[f64; 3]],
    repeats: f64,
) -> Option<Vec<usize>> {
    let (order, work) = minimum_degree(&matrix.first, &matrix.rows)?;
    if work * repeats < WORTHWHILE * matrix.size() as f64 {
        return Some(order);
    }
    let graph = Graph::new(matrix);
    let dissected = dissect(&graph, places)?;
    let better = multiplications(&graph, &dissected) < work;
    Some(if better { dissected } else { order })
}

/// Multiplications of a factorisation, from the lengths of the factor's columns (Liu, The role of
/// elimination trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11, 1990).
fn multiplications(graph: &Graph, order: &[usize]) -> f64 {
    let inverse = inverse(order);
    let none = u32::MAX;
    let mut parent = vec![none; order.len()];
    let mut seen = vec![none; order.len()];
    let mut lengths = vec![1_u32; order.len()];
    for (column, &at) in order.iter().enumerate() {
        let own = column as u32;
        seen[column] = own;
        for neighbour in graph.neighbours(at) {
            let mut descendant = inverse[neighbour];
            while descendant < column && seen[descendant] != own {
                seen[descendant] = own;
                lengths[descendant] += 1;
                if parent[descendant] == none {
                    parent[descendant] = own;
                }
                descendant = parent[descendant] as usize;
            }
        }
    }
    let products = |&length: &u32| 0.5 * f64::from(length) * (f64::from(length) + 1.0);
    lengths.iter().map(products).sum()
}

/// Where each unknown stands in the order.
pub(crate) fn inverse(order: &[usize]) -> Vec<usize> {
    let mut inverse = vec![0; order.len()];
    for (position, &at) in order.iter().enumerate() {
        inverse[at] = position;
    }
    inverse
}
