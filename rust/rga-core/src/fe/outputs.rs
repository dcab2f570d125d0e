//! Outputs read off a solved pattern.

use crate::fe::constraint::Constraints;
use crate::fe::deformed_member::Deformed;
use crate::fe::element::Vector12;
use crate::fe::load::{MemberLoad, PatternLoads};
use crate::fe::model::Model;
use crate::input::{OutputKind, Outputs};

/// One pattern, solved.
pub(crate) struct State<'a> {
    pub loads: &'a PatternLoads,
    pub strain: &'a [f64],
    pub forces: &'a [f64],
    pub fixed_end: Vec<Vector12>,
    pub displacements: Vec<f64>,
    /// Applied minus internal forces.
    pub unbalanced: Vec<f64>,
    /// Of each member, where displacements are large.
    pub deformed: Option<&'a [Deformed]>,
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Output {
    Motion(Motion),
    /// Of a member.
    Member(usize, Reading),
    /// Force or moment of supports on a node (first dof).
    Reaction(usize, [f64; 3]),
}

/// Displacement or rotation of a node, relative to another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    /// First dof of the node.
    first: usize,
    reference: Option<usize>,
    direction: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Reading {
    /// At (place in 0..1, y, z); total or mechanical.
    Strain([f64; 3], bool),
    /// A component of the `Section` at a place in 0..1.
    SectionForce(usize, f64),
    /// Of a local end dof.
    EndForce(usize),
}

pub(crate) struct Observer<'a> {
    model: &'a Model,
    constraints: &'a Constraints,
    outputs: &'a [Output],
}

/// What the part beyond a section does to the part before it, in local axes: N, Vy, Vz, T, My, Mz.
///
/// With deflections v and w along local y and z, Mz = EI (v'' + free curvature) and
/// My = -EI (w'' + free curvature): a positive My stretches fibres at +z, a positive Mz at -y.
pub(crate) struct Section(pub [f64; 6]);

impl<'a> Observer<'a> {
    pub(crate) fn new(
        model: &'a Model,
        constraints: &'a Constraints,
        outputs: &'a [Output],
    ) -> Self {
        Self {
            model,
            constraints,
            outputs,
        }
    }

    pub(crate) fn read(&self, state: &State, results: &mut Vec<f64>) {
        let reacts = |output: &Output| matches!(output, Output::Reaction(..));
        let reactions = if self.outputs.iter().any(reacts) {
            self.reactions(state)
        } else {
            Vec::new()
        };
        let values = self.outputs.iter().map(|output| match output {
            Output::Motion(motion) => motion.of(&state.displacements),
            Output::Member(index, reading) => self.member(state, *index, reading),
            Output::Reaction(first, direction) => along(&reactions, *first, direction),
        });
        results.extend(values);
    }

    /// What is read of one member.
    pub(crate) fn member(&self, state: &State, index: usize, reading: &Reading) -> f64 {
        match *reading {
            Reading::Strain(place, total) => self.strain(state, index, &place, total),
            Reading::SectionForce(component, place) => {
                let x = place * self.model.members[index].length;
                self.section(state, index, x).0[component]
            }
            Reading::EndForce(dof) => self.end_forces(state, index)[dof],
        }
    }

    fn reactions(&self, state: &State) -> Vec<f64> {
        let needed: Vec<f64> = state.unbalanced.iter().map(|force| -force).collect();
        let mut reactions = self.constraints.support_forces(&needed);
        for spring in self
            .model
            .springs
            .iter()
            .filter(|spring| spring.other.is_none())
        {
            reactions[spring.dof] -= spring.stiffness * state.displacements[spring.dof];
        }
        reactions
    }

    fn end_forces(&self, state: &State, index: usize) -> Vector12 {
        match state.deformed {
            Some(deformed) => deformed[index].end_forces(),
            None => {
                self.model.members[index].end_forces(&state.displacements, &state.fixed_end[index])
            }
        }
    }

    fn section(&self, state: &State, index: usize, x: f64) -> Section {
        let ends = match state.deformed {
            Some(deformed) => deformed[index].ends,
            None => self.end_forces(state, index),
        };
        let mut section = Section::of_ends(&ends, x);
        for load in state.loads.of(index) {
            section.add(load, x);
        }
        if let Some(deformed) = state.deformed {
            let member = &self.model.members[index];
            let bow = deformed[index].bow(member, x);
            section.0[5] += deformed[index].tension * bow[0];
            section.0[4] -= deformed[index].tension * bow[1];
        }
        section
    }

    fn strain(&self, state: &State, index: usize, place: &[f64], total: bool) -> f64 {
        let member = &self.model.members[index];
        let initial = &state.strain[3 * index..3 * index + 3];
        let Some(frame) = &member.frame else {
            let elongation = match state.deformed {
                Some(deformed) => deformed[index].elongation,
                None => member.elongation(&state.displacements),
            };
            return elongation / member.length - if total { 0.0 } else { initial[0] };
        };
        let Section(forces) = self.section(state, index, place[0] * member.length);
        let (fibre, moments) = (&place[1..], [forces[5], -forces[4]]);
        let mut strain = forces[0] / frame.beam.ea;
        for ((plane, moment), distance) in frame.beam.planes.iter().zip(moments).zip(fibre) {
            if *distance != 0.0 {
                strain -= distance * moment / plane.ei;
            }
        }
        if total {
            strain += initial[0] + initial[1] * fibre[0] + initial[2] * fibre[1];
        }
        strain
    }
}

impl Motion {
    fn of(&self, displacements: &[f64]) -> f64 {
        let terms = self.terms();
        terms.map(|(dof, factor)| factor * displacements[dof]).sum()
    }

    /// (dof, factor)
    pub(crate) fn terms(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        let direction = self.direction;
        let at = move |first: usize, sign: f64| {
            (0..3).map(move |axis| (first + axis, sign * direction[axis]))
        };
        let reference = self.reference.into_iter();
        at(self.first, 1.0).chain(reference.flat_map(move |first| at(first, -1.0)))
    }
}

impl Section {
    /// At x, of the forces of the nodes on a member without loads.
    pub(crate) fn of_ends(ends: &Vector12, x: f64) -> Self {
        Self([
            -ends[0],
            -ends[1],
            -ends[2],
            -ends[3],
            -(ends[2] * x + ends[4]),
            ends[1] * x - ends[5],
        ])
    }

    /// The part of a member load between the first node and the section at x.
    fn add(&mut self, load: &MemberLoad, x: f64) {
        if load.from >= x {
            return;
        }
        for (at, size) in load.points(0.0, x) {
            self.0[load.axis] -= size;
            match load.axis {
                1 => self.0[5] += size * (x - at),
                2 => self.0[4] -= size * (x - at),
                _ => {}
            }
        }
    }
}

pub(crate) fn read_outputs(outputs: &Outputs) -> Vec<Output> {
    let kinds = outputs.kinds().enumerate();
    kinds
        .map(|(at, kind)| read_output(outputs, at, kind))
        .collect()
}

fn read_output(outputs: &Outputs, at: usize, kind: OutputKind) -> Output {
    let index = outputs.index.at(at);
    let other = outputs.other[at];
    let mut vector = [0.0; 3];
    vector.copy_from_slice(outputs.vector.row(at));
    let motion = |first: usize| {
        Output::Motion(Motion {
            first: 6 * index + first,
            reference: (other >= 0).then(|| 6 * other as usize + first),
            direction: vector,
        })
    };
    match kind {
        OutputKind::Displacement => motion(0),
        OutputKind::Rotation => motion(3),
        OutputKind::Strain => Output::Member(index, Reading::Strain(vector, outputs.total[at])),
        OutputKind::SectionForce => {
            Output::Member(index, Reading::SectionForce(other as usize, vector[0]))
        }
        OutputKind::ReactionForce => Output::Reaction(6 * index, vector),
        OutputKind::ReactionMoment => Output::Reaction(6 * index + 3, vector),
        OutputKind::EndForce => Output::Member(index, Reading::EndForce(other as usize)),
    }
}

fn along(values: &[f64], first: usize, direction: &[f64]) -> f64 {
    let terms = values[first..first + 3].iter().zip(direction);
    terms.map(|(value, cosine)| value * cosine).sum()
}
