//! Where the numbers of the stiffness and of its factor stand, worked out once for all samples.
//!
//! A panel holds the columns of a supernode, one behind the other: rows of its own unknowns, of
//! which only the lower triangle counts, then those below.

use std::ops::Range;

use super::bilinear::Entry;
use super::elimination::{Elimination, Supernode};

#[derive(Debug)]
pub(super) struct Panels {
    pub panels: Vec<Panel>,
    /// Numbers of all panels.
    pub numbers: usize,
    /// Of the stiffness, panel by panel; of each, places of one term come before sums of many.
    terms: Vec<Term>,
}

/// A part of the stiffness: a value times a weight, at a place in its panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub place: u32,
    pub weight: u32,
    pub value: f64,
}

#[derive(Debug)]
pub(super) struct Panel {
    /// Its first unknown; the others follow.
    pub first: usize,
    pub width: usize,
    /// Unknowns of the rows below.
    pub below: Vec<usize>,
    /// Where its numbers begin.
    pub start: usize,
    pub updates: Vec<Update>,
    /// Nothing is handed on to it.
    pub is_first: bool,
    /// Panels to which it is the first to hand on. They are filled in when it is factorised: each
    /// is in the cache while it is worked on.
    pub fills: Vec<usize>,
    /// Places of the lower triangle that no term fills.
    pub empty: Vec<u32>,
    /// Its terms: those that stand alone, and those of sums.
    alone: Range<usize>,
    sums: Range<usize>,
}

/// What a panel hands on to another.
#[derive(Debug)]
pub(super) struct Update {
    pub to: usize,
    /// Rows below, by number, that are columns of the other panel; those behind `from` are rows
    /// there.
    pub from: usize,
    pub end: usize,
    /// The row there of each row from `from` on; for a column, its number there too.
    pub rows: Vec<usize>,
}

impl Panels {
    /// `stiffness` holds the lower triangle or all of it, in places of the elimination.
    pub(super) fn new(elimination: &Elimination, stiffness: &[Entry]) -> Self {
        let supernodes = &elimination.supernodes;
        let mut owner = vec![0; elimination.order.len()];
        for (index, node) in supernodes.iter().enumerate() {
            node.columns
                .iter()
                .for_each(|&column| owner[column] = index);
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
                is_first: false,
                fills: Vec::new(),
                empty: Vec::new(),
                alone: 0..0,
                sums: 0..0,
            });
            start += width * (width + node.below.len());
        }
        let mut filled = vec![false; panels.len()];
        for (index, panel) in panels.iter_mut().enumerate() {
            panel.is_first = !filled[index];
            let targets = panel.updates.iter().map(|update| update.to);
            let fills = targets.filter(|&at| !std::mem::replace(&mut filled[at], true));
            panel.fills = fills.collect();
        }
        let mut found = Self {
            panels,
            numbers: start,
            terms: Vec::with_capacity(stiffness.len()),
        };
        found.place(&owner, stiffness);
        found
    }

    fn place(&mut self, owner: &[usize], stiffness: &[Entry]) {
        let lower = stiffness.iter().filter(|entry| entry.row >= entry.column);
        let mut placed: Vec<(usize, Term)> = lower
            .map(|entry| {
                let index = owner[entry.column];
                let panel = &self.panels[index];
                let column = entry.column - panel.first;
                let term = Term {
                    place: (column * panel.rows() + panel.row(entry.row)) as u32,
                    weight: entry.weight as u32,
                    value: entry.value,
                };
                (index, term)
            })
            .collect();
        placed.sort_by_key(|(panel, term)| (*panel, term.place, term.weight));
        for own in placed.chunk_by(|one, other| one.0 == other.0) {
            let places = own.chunk_by(|one, other| one.1.place == other.1.place);
            let (alone, mut sums): (Vec<_>, Vec<_>) = places.partition(|terms| terms.len() == 1);
            // Sums of one length behind each other: where a loop ends is then foreseen.
            sums.sort_by_key(|terms| terms.len());
            let mut take = |places: &[&[(usize, Term)]]| {
                let before = self.terms.len();
                let terms = places.iter().copied().flatten();
                self.terms.extend(terms.map(|(_, term)| *term));
                before..self.terms.len()
            };
            let (alone, sums) = (take(&alone), take(&sums));
            let panel = &mut self.panels[own[0].0];
            (panel.alone, panel.sums) = (alone, sums);
        }
        for panel in &mut self.panels {
            let own = [panel.alone.clone(), panel.sums.clone()];
            let mut filled = vec![false; panel.width * panel.rows()];
            for term in own.into_iter().flat_map(|own| &self.terms[own]) {
                filled[term.place as usize] = true;
            }
            let rows = panel.rows();
            let lower =
                (0..panel.width).flat_map(|column| column * (rows + 1)..(column + 1) * rows);
            panel.empty = lower
                .filter(|&at| !filled[at])
                .map(|at| at as u32)
                .collect();
        }
    }

    /// Terms of a panel that stand alone at their place.
    pub(super) fn alone(&self, panel: &Panel) -> &[Term] {
        &self.terms[panel.alone.clone()]
    }

    /// Terms of a panel of which many make a sum; those of a sum behind each other.
    pub(super) fn sums(&self, panel: &Panel) -> &[Term] {
        &self.terms[panel.sums.clone()]
    }

    /// Number of unknowns.
    pub(super) fn size(&self) -> usize {
        self.panels
            .last()
            .map_or(0, |panel| panel.first + panel.width)
    }
}

impl Panel {
    pub(super) fn rows(&self) -> usize {
        self.width + self.below.len()
    }

    /// Numbers of the panel.
    pub(super) fn numbers(&self) -> Range<usize> {
        self.start..self.start + self.width * self.rows()
    }

    /// The unknown of a row.
    #[inline(always)]
    pub(super) fn unknown(&self, row: usize) -> usize {
        match row.checked_sub(self.width) {
            None => self.first + row,
            Some(row) => self.below[row],
        }
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
    let runs = node
        .below
        .chunk_by(|&one, &other| owner[one] == owner[other]);
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
