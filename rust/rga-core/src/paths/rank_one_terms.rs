//! Stiffness of members and springs as a sum of terms of rank one.
//!
//! A term of stiffness k and elongation v = b . u carries the force k (v - v0) along b. A truss
//! member or a spring is one term. A frame member is up to six, its natural modes of deformation:
//! it grows longer, twists, and in each of its two planes bends evenly and to both sides (Argyris
//! et al., On the geometrical stiffness of a beam in space, Comput. Methods Appl. Mech. Eng. 20,
//! 1979). A release leaves a plane one mode fewer.

use nalgebra::{RowVector3, Vector2};

use crate::error::{Error, Result};
use crate::fe::element::Vector12;
use crate::fe::member::{Frame, Member};
use crate::fe::model::{Model, Spring};
use crate::fe::outputs::{Output, Reading, Section, read_outputs};
use crate::input::{Outputs, Structure};
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;

/// What is left of a release that others imply.
const NEGLIGIBLE: f64 = 1e-9;

/// A term of a list of members and springs that vary.
#[derive(Debug, Clone)]
pub(super) struct Term {
    /// Its place in the list, members first.
    pub element: usize,
    /// EA / L of a truss member, E of modes and gauges, of a spring its own.
    pub stiffness: f64,
    pub kind: TermKind,
}

#[derive(Debug, Clone)]
pub(super) enum TermKind {
    /// Of a member.
    Mode(Box<Mode>),
    Spring(Spring),
    /// The output that a gauge on a frame member gives: under a load between the ends it reads a
    /// strain of 1 / E that does not hang on how the ends move.
    Gauge(usize),
}

/// How a member deforms. Modes of a frame member are scaled so that each has the stiffness E.
#[derive(Debug, Clone)]
pub(super) struct Mode {
    member: usize,
    length: f64,
    /// First dof of either end.
    first: [usize; 2],
    /// b in local axes, and in global ones.
    local: Vector12,
    global: Vector12,
    /// v0 by the initial strain of the member and its gradients.
    rest: RowVector3<f64>,
}

/// What varies: numbers of members and of springs.
#[derive(Debug, Clone, Copy)]
pub struct Varied<'a> {
    /// Each as a whole; no end of a frame member among them yields.
    pub members: &'a [usize],
    pub springs: &'a [usize],
    /// Of frame members too, no more varies than how they resist growing longer.
    pub axial: bool,
}

impl Varied<'_> {
    /// Against a checked structure.
    pub(super) fn check(&self, structure: &Structure) -> Result<()> {
        let springs = structure.spring_node.len();
        for (name, numbers, end) in [
            ("members", self.members, structure.member_count()),
            ("springs", self.springs, springs),
        ] {
            if let Some(number) = numbers.iter().find(|&&number| number >= end) {
                return Err(Error::invalid(format!(
                    "{name} that vary hold {number}; they must be below {end}"
                )));
            }
        }
        Ok(())
    }
}

/// How many terms of rank one vary with members and springs.
pub fn count_terms(structure: &Structure, outputs: &Outputs, varied: Varied) -> Result<usize> {
    check_structure(structure)?;
    check_outputs(structure, outputs)?;
    varied.check(structure)?;
    let model = Model::new(structure)?;
    let (terms, _) = find_terms(structure, &model, &read_outputs(outputs), varied);
    Ok(terms.len())
}

/// Terms that can stretch: those of members, of springs, then gauges; and modes of frame members
/// that supports hold still.
pub(super) fn find_terms(
    structure: &Structure,
    model: &Model,
    outputs: &[Output],
    varied: Varied,
) -> (Vec<Term>, Vec<Term>) {
    let (mut terms, mut held, mut gauges) = (Vec::new(), Vec::new(), Vec::new());
    for (element, &number) in varied.members.iter().enumerate() {
        let member = &model.members[number];
        let mode = |(local, rest)| Mode::new(member, number, local, rest);
        let Some(frame) = member.frame.as_deref().filter(|_| !varied.axial) else {
            let (length, own) = elongation(member);
            terms.push(Term {
                element,
                stiffness: member.ea / length,
                kind: TermKind::Mode(Box::new(mode(own))),
            });
            continue;
        };
        let young = structure.young[number];
        let term = |kind| Term {
            element,
            stiffness: young,
            kind,
        };
        for own in modes(member, frame, young, structure.connection.row(number)) {
            let mode = mode(own);
            let moves = mode.moves(structure);
            let found = term(TermKind::Mode(Box::new(mode)));
            if moves { &mut terms } else { &mut held }.push(found);
        }
        let reads = |output: &Output| matches!(output, Output::Member(at, Reading::Strain(..)) if *at == number);
        let reading = outputs
            .iter()
            .enumerate()
            .filter(|(_, output)| reads(output));
        gauges.extend(reading.map(|(at, _)| term(TermKind::Gauge(at))));
    }
    let springs = varied.springs.iter().enumerate();
    terms.extend(springs.map(|(at, &number)| Term {
        element: varied.members.len() + at,
        stiffness: model.springs[number].stiffness,
        kind: TermKind::Spring(model.springs[number]),
    }));
    terms.append(&mut gauges);
    (terms, held)
}

impl Term {
    /// v, of all displacements.
    pub(super) fn elongation(&self, displacements: &[f64]) -> f64 {
        match &self.kind {
            TermKind::Mode(mode) => mode.along(displacements),
            TermKind::Spring(spring) => {
                let terms = spring.terms();
                terms.map(|(dof, sign)| sign * displacements[dof]).sum()
            }
            TermKind::Gauge(_) => 0.0,
        }
    }

    /// v0, of the initial strains of all members, `[m, 3]`.
    pub(super) fn at_rest(&self, strain: &[f64]) -> f64 {
        match &self.kind {
            TermKind::Mode(mode) => mode.at_rest(strain),
            _ => 0.0,
        }
    }

    /// Adds what a unit of pseudo-force puts on all dofs.
    pub(super) fn push(&self, forces: &mut [f64]) {
        match &self.kind {
            TermKind::Mode(mode) => mode.push(forces),
            TermKind::Spring(spring) => spring.terms().for_each(|(dof, sign)| forces[dof] += sign),
            TermKind::Gauge(_) => {}
        }
    }

    /// What an output on the term reads of a unit of its pseudo-force itself: that of a member is
    /// a part of its end forces, that of a spring to the ground a part of the reaction there.
    pub(super) fn own_reading(&self, output: &Output) -> f64 {
        match (&self.kind, output) {
            (TermKind::Mode(mode), Output::Member(member, reading)) if mode.member == *member => {
                match reading {
                    Reading::SectionForce(component, place) => {
                        Section::of_ends(&-mode.local, place * mode.length).0[*component]
                    }
                    Reading::EndForce(dof) => -mode.local[*dof],
                    Reading::Strain(..) => 0.0,
                }
            }
            (TermKind::Spring(spring), Output::Reaction(first, direction))
                if spring.other.is_none() =>
            {
                let own = spring.dof.checked_sub(*first);
                own.and_then(|axis| direction.get(axis))
                    .copied()
                    .unwrap_or(0.0)
            }
            _ => 0.0,
        }
    }
}

impl Mode {
    fn new(member: &Member, number: usize, local: Vector12, rest: RowVector3<f64>) -> Self {
        let mut global = Vector12::zeros();
        for block in 0..4 {
            let turned = member.axes.tr_mul(&local.fixed_rows::<3>(3 * block));
            global.fixed_rows_mut::<3>(3 * block).copy_from(&turned);
        }
        Self {
            member: number,
            length: member.length,
            first: member.nodes.map(|node| 6 * node),
            local,
            global,
            rest,
        }
    }

    /// The dofs of both ends, with b there.
    fn entries(&self) -> impl Iterator<Item = (usize, f64)> {
        let dofs = self.first.iter().flat_map(|&first| first..first + 6);
        dofs.zip(self.global.iter().copied())
    }

    fn along(&self, displacements: &[f64]) -> f64 {
        self.entries().map(|(dof, b)| b * displacements[dof]).sum()
    }

    fn push(&self, forces: &mut [f64]) {
        self.entries().for_each(|(dof, b)| forces[dof] += b);
    }

    fn at_rest(&self, strain: &[f64]) -> f64 {
        let own = &strain[3 * self.member..3 * self.member + 3];
        self.rest
            .iter()
            .zip(own)
            .map(|(rest, own)| rest * own)
            .sum()
    }

    /// Whether supports leave it any motion.
    fn moves(&self, structure: &Structure) -> bool {
        self.entries()
            .any(|(dof, b)| b != 0.0 && !structure.fixed[dof])
    }
}

/// The elastic length of a member, and how it grows longer: b in local axes, and v0.
fn elongation(member: &Member) -> (f64, (Vector12, RowVector3<f64>)) {
    let length = member
        .frame
        .as_deref()
        .map_or(member.length, |frame| frame.beam.length);
    let mut local = Vector12::zeros();
    (local[0], local[6]) = (-1.0, 1.0);
    (length, (local, RowVector3::new(member.length, 0.0, 0.0)))
}

/// Of a frame member without yielding ends.
fn modes(
    member: &Member,
    frame: &Frame,
    young: f64,
    connection: &[f64],
) -> Vec<(Vector12, RowVector3<f64>)> {
    let (beam, length) = (&frame.beam, frame.beam.length);
    let mode = |entries: &[(usize, f64)], shape: f64, (at, rest): (usize, f64)| {
        let scale = (shape / length).sqrt();
        let mut local = Vector12::zeros();
        entries
            .iter()
            .for_each(|&(dof, value)| local[dof] = scale * value);
        let mut initial = RowVector3::zeros();
        initial[at] = scale * rest;
        (shape > 0.0).then_some((local, initial))
    };
    let longer = mode(&[(0, -1.0), (6, 1.0)], beam.ea / young, (0, member.length));
    let twisted = mode(&[(3, -1.0), (9, 1.0)], beam.gj / young, (0, 0.0));
    let mut blocks = vec![vec![longer], vec![twisted]];
    for (plane, bending) in beam.planes.iter().enumerate() {
        let [(near, _), (turn, sign), (far, _), (turn_far, _)] = bending.dofs;
        let second = bending.ei / young;
        let even = [(turn, -sign), (turn_far, sign)];
        let odd = [
            (turn, sign),
            (turn_far, sign),
            (near, 2.0 / length),
            (far, -2.0 / length),
        ];
        blocks.push(vec![
            mode(&even, second, (1 + plane, -length)),
            mode(&odd, 3.0 * second / (1.0 + bending.phi), (0, 0.0)),
        ]);
    }
    let blocks = blocks
        .into_iter()
        .map(|block| block.into_iter().flatten().collect());
    let mut found: Vec<_> = blocks
        .flat_map(|block| release(block, connection))
        .collect();
    found
        .iter_mut()
        .for_each(|(local, _)| *local = frame.face_to_node(local));
    found
}

/// Modes that share dofs, mixed so that no force acts along a released dof.
fn release(
    block: Vec<(Vector12, RowVector3<f64>)>,
    connection: &[f64],
) -> Vec<(Vector12, RowVector3<f64>)> {
    let released = (0..12).filter(|&dof| connection[dof] == 0.0);
    match &block[..] {
        [(one, rest), (other, of_other)] => {
            let rows =
                released.filter_map(|dof| Vector2::new(one[dof], other[dof]).try_normalize(0.0));
            let rows: Vec<_> = rows.collect();
            let Some(first) = rows.first() else {
                return block;
            };
            let across = Vector2::new(-first.y, first.x);
            if rows.iter().any(|row| row.dot(&across).abs() > NEGLIGIBLE) {
                return Vec::new();
            }
            vec![(
                one * across.x + other * across.y,
                rest * across.x + of_other * across.y,
            )]
        }
        [(one, _)] if released.clone().any(|dof| one[dof] != 0.0) => Vec::new(),
        _ => block,
    }
}
