//! The reduced stiffness as a function of the factors of members and springs.

use crate::assembly::{Entry, LowerTriangle};
use crate::member::Member;
use crate::model::Model;
use crate::reduction::Reduction;

/// Entries of a member's stiffness.
pub const MOST: usize = 144;

/// Where the stiffness of members and springs goes in K = T' K T.
#[derive(Debug)]
pub struct Scatter {
    members: Vec<Element>,
    springs: Vec<Vec<Term>>,
}

#[derive(Debug)]
enum Element {
    /// K is linear in the factor.
    Proportional(Vec<Term>),
    /// End connections that yield do not scale with the member.
    Yielding(Vec<Link>),
}

/// What a factor of 1 adds to one value of K.
#[derive(Debug)]
struct Term {
    place: usize,
    value: f64,
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
    value: f64,
}

impl Scatter {
    /// Together with K, whose values are yet to be filled in.
    pub fn new(model: &Model, reduction: &Reduction) -> (Self, LowerTriangle) {
        Self::with(model, reduction, Member::is_proportional)
    }

    /// For members of which every entry may change (`fill_with`).
    pub fn of_tangents(model: &Model, reduction: &Reduction) -> (Self, LowerTriangle) {
        Self::with(model, reduction, |_| false)
    }

    fn with(
        model: &Model,
        reduction: &Reduction,
        is_proportional: impl Fn(&Member) -> bool,
    ) -> (Self, LowerTriangle) {
        let members: Vec<Vec<Addition>> = (model.members.iter())
            .map(|member| {
                let mut additions = additions(reduction, |add| member.for_each_stiffness(add));
                if is_proportional(member) {
                    // What is zero is so for every factor.
                    additions.retain(|addition| addition.value != 0.0);
                }
                additions
            })
            .collect();
        let springs: Vec<Vec<Addition>> = (model.springs.iter())
            .map(|spring| additions(reduction, |add| spring.for_each_stiffness(add)))
            .collect();
        let size = reduction.unknowns.len();
        let diagonal = (0..size).map(|at| (at, at, 0.0));
        let added = (members.iter().chain(&springs).flatten())
            .map(|addition| (addition.row, addition.column, 0.0));
        let entries: Vec<Entry> = diagonal.chain(added).collect();
        let matrix = LowerTriangle::from_entries(&entries, size);
        let element = |(member, additions): (&Member, &Vec<Addition>)| {
            if is_proportional(member) {
                Element::Proportional(terms(additions, &matrix))
            } else {
                Element::Yielding(links(additions, &matrix))
            }
        };
        let scatter = Self {
            members: model.members.iter().zip(&members).map(element).collect(),
            springs: springs.iter().map(|each| terms(each, &matrix)).collect(),
        };
        (scatter, matrix)
    }

    /// `model` is scaled by the same factors, those of members before those
    /// of springs.
    pub fn fill(&self, model: &Model, factors: &[f64], values: &mut [f64]) {
        let entries = |index: usize| {
            let member: &Member = &model.members[index];
            listed(|add| member.for_each_stiffness(add))
        };
        self.fill_with(entries, factors, values);
    }

    /// The same with the entries of member `index` from `entries`, where they are not
    /// proportional to its factor.
    pub fn fill_with(
        &self,
        entries: impl Fn(usize) -> [f64; MOST],
        factors: &[f64],
        values: &mut [f64],
    ) {
        values.fill(0.0);
        let (of_members, of_springs) = factors.split_at(self.members.len());
        for (index, (element, factor)) in self.members.iter().zip(of_members).enumerate() {
            match element {
                Element::Proportional(terms) => add(terms, *factor, values),
                Element::Yielding(links) => {
                    let stiffness = entries(index);
                    for link in links {
                        values[link.place] += link.weight * stiffness[link.entry];
                    }
                }
            }
        }
        for (terms, factor) in self.springs.iter().zip(of_springs) {
            add(terms, *factor, values);
        }
    }
}

fn additions(
    reduction: &Reduction,
    for_each_stiffness: impl FnOnce(&mut dyn FnMut(usize, usize, f64)),
) -> Vec<Addition> {
    let mut additions = Vec::new();
    let mut entry = 0;
    for_each_stiffness(&mut |row, column, value| {
        for &(i, left) in reduction.entries(row) {
            for &(j, right) in reduction.entries(column) {
                if i >= j {
                    additions.push(Addition {
                        row: i,
                        column: j,
                        entry,
                        weight: left * right,
                        value: left * value * right,
                    });
                }
            }
        }
        entry += 1;
    });
    additions
}

fn terms(additions: &[Addition], matrix: &LowerTriangle) -> Vec<Term> {
    let term = |addition: &Addition| Term {
        place: matrix.place(addition.row, addition.column),
        value: addition.value,
    };
    additions.iter().map(term).collect()
}

fn links(additions: &[Addition], matrix: &LowerTriangle) -> Vec<Link> {
    let link = |addition: &Addition| Link {
        place: matrix.place(addition.row, addition.column),
        entry: addition.entry,
        weight: addition.weight,
    };
    additions.iter().map(link).collect()
}

fn add(terms: &[Term], factor: f64, values: &mut [f64]) {
    for term in terms {
        values[term.place] += factor * term.value;
    }
}

/// The values that `for_each` passes on, in their order.
pub fn listed(for_each: impl FnOnce(&mut dyn FnMut(usize, usize, f64))) -> [f64; MOST] {
    let mut entries = [0.0; MOST];
    let mut next = entries.iter_mut();
    for_each(&mut |_, _, value| {
        if let Some(entry) = next.next() {
            *entry = value;
        }
    });
    entries
}
