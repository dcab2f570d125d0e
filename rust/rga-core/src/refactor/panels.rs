//! Where the numbers of the stiffness and of its factor stand, worked out once for all samples.
//!
//! A panel holds the columns of a supernode, row by row: those of its own unknowns, of which only
//! the lower triangle counts, then those below.

use crate::bilinear::Entry;
use super::elimination::{Elimination, Supernode};

#[derive(Debug)]
pub struct Panels {
    pub panels: Vec<Panel>,
    /// Numbers of all panels.
    pub numbers: usize,
    /// Sums that are not zero of the stiffness, panel by panel.
    places: Vec<Place>,
    /// (weight, value) of each sum, one behind the other.
    terms: Vec<(usize, f64)>,
}

#[derive(Debug)]
pub struct Panel {
    /// Its first unknown; the others follow.
    pub first: usize,
    pub width: usize,
    /// Unknowns of the rows below.
    pub below: Vec<usize>,
    /// Where its numbers begin.
    pub start: usize,
    pub updates: Vec<Update>,
    /// Panels that are filled in before it: itself, or those to which it is the first to hand on.
    /// What is filled in is used at once, while it is in the cache.
    pub fills: Vec<usize>,
    places: std::ops::Range<usize>,
}

/// What a panel hands on to another.
#[derive(Debug)]
pub struct Update {
    pub to: usize,
    /// Rows below, by number, that are columns of the other panel; those behind `from` are rows
    /// there.
    pub from: usize,
    pub end: usize,
    /// The row there of each row from `from` on; for a column, its number there too.
    pub rows: Vec<usize>,
}

#[derive(Debug)]
pub struct Place {
    /// In its panel.
    pub at: usize,
    terms: std::ops::Range<usize>,
}

impl Panels {
    /// `stiffness` holds the lower triangle or all of it, in places of the elimination.
    pub fn new(elimination: &Elimination, stiffness: &[Entry]) -> Self {
        let supernodes = &elimination.supernodes;
        let mut owner = vec![0; elimination.order.len()];
        for (index, node) in supernodes.iter().enumerate() {
            node.columns.iter().for_each(|&column| owner[column] = index);
        }
        let mut start = 0;
        let mut panels: Vec<Panel> = Vec::with_capacity(supernodes.len());
        for node in supernodes {
            let width = node.columns.len();
            panels.push(Panel {
                first: node.columns[0],
                width,
                below: node.below.clone(),
                start,
                updates: updates(node, supernodes, &owner),
                fills: Vec::new(),
                places: 0..0,
            });
            start += width * (width + node.below.len());
        }
        let mut filled = vec![false; panels.len()];
        for index in 0..panels.len() {
            let targets = panels[index].updates.iter().map(|update| update.to);
            let needed = std::iter::once(index).chain(targets);
            let fills = needed.filter(|&at| !std::mem::replace(&mut filled[at], true));
            panels[index].fills = fills.collect();
        }
        let mut found = Self {
            panels,
            numbers: start,
            places: Vec::new(),
            terms: Vec::new(),
        };
        found.place(&owner, stiffness);
        found
    }

    fn place(&mut self, owner: &[usize], stiffness: &[Entry]) {
        let lower = stiffness.iter().filter(|entry| entry.row >= entry.column);
        let mut sums: Vec<(usize, usize, usize, f64)> = lower
            .map(|entry| {
                let index = owner[entry.column];
                let panel = &self.panels[index];
                let at = panel.row(entry.row) * panel.width + entry.column - panel.first;
                (index, at, entry.weight, entry.value)
            })
            .collect();
        sums.sort_by_key(|&(panel, at, weight, _)| (panel, at, weight));
        for own in sums.chunk_by(|one, other| one.0 == other.0) {
            let before = self.places.len();
            for sum in own.chunk_by(|one, other| one.1 == other.1) {
                let first = self.terms.len();
                self.terms.extend(sum.iter().map(|&(_, _, weight, value)| (weight, value)));
                self.places.push(Place {
                    at: sum[0].1,
                    terms: first..self.terms.len(),
                });
            }
            self.panels[own[0].0].places = before..self.places.len();
        }
    }

    /// Sums of a panel.
    pub fn places(&self, panel: &Panel) -> &[Place] {
        &self.places[panel.places.clone()]
    }

    /// (weight, value)
    pub fn terms(&self, place: &Place) -> &[(usize, f64)] {
        &self.terms[place.terms.clone()]
    }

    /// Numbers of the largest panel.
    pub fn size(&self) -> usize {
        self.panels.last().map_or(0, |panel| panel.first + panel.width)
    }
}

impl Panel {
    /// Numbers of the panel.
    pub fn numbers(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.width * (self.width + self.below.len())
    }

    /// The row of an unknown that has one.
    fn row(&self, unknown: usize) -> usize {
        if unknown < self.first + self.width {
            unknown - self.first
        } else {
            self.width + self.below.partition_point(|&other| other < unknown)
        }
    }
}

fn updates(node: &Supernode, supernodes: &[Supernode], owner: &[usize]) -> Vec<Update> {
    let mut from = 0;
    let runs = node.below.chunk_by(|&one, &other| owner[one] == owner[other]);
    runs.map(|run| {
        let to = owner[run[0]];
        let Supernode { columns, below } = &supernodes[to];
        let row = |&unknown: &usize| match unknown.checked_sub(columns[0]) {
            Some(row) if row < columns.len() => row,
            _ => columns.len() + below.partition_point(|&other| other < unknown),
        };
        let update = Update {
            to,
            from,
            end: from + run.len(),
            rows: node.below[from..].iter().map(row).collect(),
        };
        from += run.len();
        update
    })
    .collect()
}
