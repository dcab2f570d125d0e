//! Where the tangent stiffness of members, and the stiffness of springs, goes in K = T' K T.

use crate::fe::model::Model;
use crate::fe::reduction::Reduction;
use crate::sparse::lower_triangle::LowerTriangle;

/// Entries of a member's stiffness.
pub(super) const MOST: usize = 144;

#[derive(Debug)]
pub(super) struct TangentPlacement {
    members: Vec<Vec<Link>>,
    springs: Vec<Vec<Link>>,
}

/// One entry of a stiffness, by its number in `for_each_stiffness`, and its
/// weight in one value of K.
#[derive(Debug)]
struct Link {
    place: usize,
    entry: usize,
    weight: f64,
}

/// What one call of `add` in `for_each_stiffness` puts into K.
struct Addition {
    row: usize,
    column: usize,
    entry: usize,
    weight: f64,
}

impl TangentPlacement {
    /// Together with K, whose values are yet to be filled in.
    pub(super) fn new(model: &Model, reduction: &Reduction) -> (Self, LowerTriangle) {
        let members = model.members.iter();
        let members: Vec<Vec<Addition>> = members
            .map(|member| additions(reduction, |add| member.for_each_stiffness(add)))
            .collect();
        let springs = model.springs.iter();
        let springs: Vec<Vec<Addition>> = springs
            .map(|spring| additions(reduction, |add| spring.for_each_stiffness(add)))
            .collect();
        let size = reduction.unknowns.len();
        let matrix = LowerTriangle::sum(size, |add| {
            let added = members.iter().chain(&springs).flatten();
            added.for_each(|addition| add(addition.row, addition.column, 0.0));
        });
        let placed = |of_each: &[Vec<Addition>]| {
            let of_each = of_each.iter();
            of_each.map(|own| links(own, &matrix)).collect()
        };
        let placement = Self {
            members: placed(&members),
            springs: placed(&springs),
        };
        (placement, matrix)
    }

    /// Values of K, from the entries of each member's stiffness.
    pub(super) fn fill(
        &self,
        model: &Model,
        of_member: impl Fn(usize) -> [f64; MOST],
        values: &mut [f64],
    ) {
        values.fill(0.0);
        let mut add = |links: &[Link], stiffness: [f64; MOST]| {
            for link in links {
                values[link.place] += link.weight * stiffness[link.entry];
            }
        };
        for (index, links) in self.members.iter().enumerate() {
            add(links, of_member(index));
        }
        for (spring, links) in model.springs.iter().zip(&self.springs) {
            add(links, listed(|add| spring.for_each_stiffness(add)));
        }
    }
}

/// The values that `for_each` passes on, in their order.
pub(super) fn listed(for_each: impl FnOnce(&mut dyn FnMut(usize, usize, f64))) -> [f64; MOST] {
    let mut entries = [0.0; MOST];
    let mut next = entries.iter_mut();
    for_each(&mut |_, _, value| {
        if let Some(entry) = next.next() {
            *entry = value;
        }
    });
    entries
}

fn additions(
    reduction: &Reduction,
    for_each_stiffness: impl FnOnce(&mut dyn FnMut(usize, usize, f64)),
) -> Vec<Addition> {
    let mut additions = Vec::new();
    let mut entry = 0;
    for_each_stiffness(&mut |row, column, _| {
        for &(i, left) in reduction.entries(row) {
            for &(j, right) in reduction.entries(column) {
                if i >= j {
                    additions.push(Addition {
                        row: i,
                        column: j,
                        entry,
                        weight: left * right,
                    });
                }
            }
        }
        entry += 1;
    });
    additions
}

fn links(additions: &[Addition], matrix: &LowerTriangle) -> Vec<Link> {
    let link = |addition: &Addition| Link {
        place: matrix.place(addition.row, addition.column),
        entry: addition.entry,
        weight: addition.weight,
    };
    additions.iter().map(link).collect()
}
