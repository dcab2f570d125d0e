//! In which order unknowns are eliminated, and which of them together.
//!
//! Unknowns of one supernode have the same rows below them in the factor. Small supernodes are put
//! together where the zeros that this adds cost less than what is moved between them (relaxed
//! amalgamation; Ashcraft and Grimes, The influence of relaxed supernode partitions on the
//! multifrontal method, 1989).

use crate::sparse::lower_triangle::LowerTriangle;
use crate::sparse::minimum_degree::minimum_degree;
use crate::sparse::ordering::inverse;

#[derive(Debug)]
pub(super) struct Elimination {
    /// The unknown of each place, in the order of elimination.
    pub order: Vec<usize>,
    /// Children before their parents; each begins where the one before ends.
    pub supernodes: Vec<Supernode>,
}

/// Places in the order of elimination.
#[derive(Debug, Clone, Default)]
pub(super) struct Supernode {
    pub columns: Vec<usize>,
    /// Ascending.
    pub below: Vec<usize>,
}

impl Elimination {
    /// Nothing where the factor would have more than `most` numbers.
    pub(super) fn new(matrix: &LowerTriangle, most: usize) -> Option<Self> {
        // It has all that the matrix has.
        if matrix.rows.len() > most {
            return None;
        }
        let (by_degree, _) = minimum_degree(&matrix.first, &matrix.rows)?;
        let orders = [by_degree, breadth_first(matrix)];
        let found = orders.map(|order| Self::along(matrix, order, most));
        let found = found.into_iter().flatten();
        found.min_by(|one, other| one.cost().total_cmp(&other.cost()))
    }

    /// Numbers of the factor, zeros among them.
    pub(super) fn numbers(&self) -> usize {
        let of_one =
            |node: &Supernode| node.columns.len() * (node.columns.len() + node.below.len());
        self.supernodes.iter().map(of_one).sum()
    }

    fn cost(&self) -> f64 {
        let of_one = |node: &Supernode| cost(node.columns.len(), node.below.len());
        self.supernodes.iter().map(of_one).sum()
    }

    fn along(matrix: &LowerTriangle, order: Vec<usize>, most: usize) -> Option<Self> {
        let columns = columns_of_factor(matrix, &order, most)?;
        let found = Self::numbered(&order, &amalgamated(columns));
        (found.numbers() <= most).then_some(found)
    }

    /// Supernodes one behind the other, a large one before a small one of the same parent.
    fn numbered(order: &[usize], nodes: &[Node]) -> Self {
        let mut found = Self {
            order: Vec::with_capacity(order.len()),
            supernodes: Vec::new(),
        };
        let mut place = vec![0; order.len()];
        let roots = (0..nodes.len()).filter(|&node| nodes[node].is_root());
        // (node, whether its children are done)
        let mut waiting: Vec<(usize, bool)> = roots.map(|root| (root, false)).collect();
        let mut sequence = Vec::new();
        while let Some((node, done)) = waiting.pop() {
            if done {
                sequence.push(node);
                continue;
            }
            waiting.push((node, true));
            let mut children = nodes[node].children.clone();
            children.sort_by_key(|&child| nodes[child].below.len());
            waiting.extend(children.into_iter().map(|child| (child, false)));
        }
        for &node in &sequence {
            for &column in &nodes[node].columns {
                place[column] = found.order.len();
                found.order.push(order[column]);
            }
        }
        for node in sequence {
            let places = |columns: &[usize]| {
                let mut places: Vec<usize> = columns.iter().map(|&column| place[column]).collect();
                places.sort_unstable();
                places
            };
            found.supernodes.push(Supernode {
                columns: places(&nodes[node].columns),
                below: places(&nodes[node].below),
            });
        }
        found
    }
}

/// What a supernode costs, in additions and multiplications of a lane: those of the factor, and
/// moving numbers, each number of the factor and of what is handed on.
fn cost(width: usize, below: usize) -> f64 {
    let (w, m) = (width as f64, below as f64);
    let handed = 0.5 * m * (m + 1.0);
    let inside = w * w * (w / 6.0 + 0.5 * m);
    let numbers = w * (0.5 * w + m);
    NODE + COLUMN * w + inside + w * handed + NUMBER * numbers + HANDED * handed
}

/// Measured on bridges, in one such operation.
const NODE: f64 = 20.0;
const COLUMN: f64 = 10.0;
const NUMBER: f64 = 5.0;
const HANDED: f64 = 3.0;

/// A supernode in the making; columns are numbered along the order given.
#[derive(Debug, Default)]
struct Node {
    columns: Vec<usize>,
    below: Vec<usize>,
    children: Vec<usize>,
    /// Whether another node has taken its columns or waits for what it hands on.
    taken: bool,
    child: bool,
}

impl Node {
    fn is_root(&self) -> bool {
        !self.taken && !self.child
    }
}

/// Rows below the diagonal of each column of the factor; nothing where they are more than `most`.
fn columns_of_factor(
    matrix: &LowerTriangle,
    order: &[usize],
    most: usize,
) -> Option<Vec<Vec<usize>>> {
    let place = inverse(order);
    let mut columns = vec![Vec::new(); order.len()];
    for (unknown, &own) in place.iter().enumerate() {
        for &row in &matrix.rows[matrix.first[unknown]..matrix.first[unknown + 1]] {
            let other = place[row];
            if other != own {
                columns[own.min(other)].push(own.max(other));
            }
        }
    }
    let mut numbers = 0;
    let mut seen = vec![usize::MAX; order.len()];
    for column in 0..columns.len() {
        let mut own = std::mem::take(&mut columns[column]);
        own.retain(|&row| std::mem::replace(&mut seen[row], column) != column);
        own.sort_unstable();
        numbers += own.len();
        if numbers > most {
            return None;
        }
        // What it hands on goes to its parent in the elimination tree.
        if let Some((&parent, further)) = own.split_first() {
            columns[parent].extend_from_slice(further);
        }
        columns[column] = own;
    }
    Some(columns)
}

fn amalgamated(columns: Vec<Vec<usize>>) -> Vec<Node> {
    let mut nodes: Vec<Node> = Vec::with_capacity(columns.len());
    nodes.resize_with(columns.len(), Node::default);
    for (column, below) in columns.into_iter().enumerate() {
        let parent = below.first().copied();
        nodes[column].columns.push(column);
        nodes[column].below = below;
        while let Some(child) = best_child(&nodes, column) {
            let taken = std::mem::take(&mut nodes[child]);
            nodes[child].taken = true;
            let own = &mut nodes[column];
            own.children.retain(|&other| other != child);
            own.children.extend(taken.children);
            own.columns.splice(0..0, taken.columns);
        }
        if let Some(parent) = parent {
            nodes[column].child = true;
            nodes[parent].children.push(column);
        }
    }
    nodes
}

/// The child that it pays most to eliminate together with `node`.
fn best_child(nodes: &[Node], node: usize) -> Option<usize> {
    let own = &nodes[node];
    let size = |node: &Node| (node.columns.len(), node.below.len());
    let (width, below) = size(own);
    let gain = |child: usize| {
        let (its_width, its_below) = size(&nodes[child]);
        cost(width, below) + cost(its_width, its_below) - cost(width + its_width, below)
    };
    let gains = own.children.iter().map(|&child| (gain(child), child));
    let best = gains.max_by(|one, other| one.0.total_cmp(&other.0))?;
    (best.0 > 0.0).then_some(best.1)
}

/// From one end to the other (reverse Cuthill-McKee): good where a structure is long.
fn breadth_first(matrix: &LowerTriangle) -> Vec<usize> {
    let size = matrix.size();
    let mut neighbours = vec![Vec::new(); size];
    for column in 0..size {
        for &row in &matrix.rows[matrix.first[column] + 1..matrix.first[column + 1]] {
            neighbours[column].push(row);
            neighbours[row].push(column);
        }
    }
    let degrees: Vec<usize> = neighbours.iter().map(Vec::len).collect();
    for own in &mut neighbours {
        own.sort_by_key(|&other| degrees[other]);
    }
    let walk = |start: usize, seen: &mut [bool]| {
        let mut order = vec![start];
        seen[start] = true;
        let mut at = 0;
        while let Some(&here) = order.get(at) {
            for &next in &neighbours[here] {
                if !std::mem::replace(&mut seen[next], true) {
                    order.push(next);
                }
            }
            at += 1;
        }
        order
    };
    let mut seen = vec![false; size];
    let mut order = Vec::with_capacity(size);
    for start in 0..size {
        if seen[start] {
            continue;
        }
        // The last of a walk is at an end; so is the last of a walk from there.
        let mut end = start;
        for _ in 0..2 {
            end = *walk(end, &mut seen.clone()).last().unwrap_or(&end);
        }
        order.extend(walk(end, &mut seen));
    }
    order.reverse();
    order
}
