//! Mass of members and nodes, consistent with the shapes in which they deform.
//!
//! Kinetic energy of a motion, with the velocities that the shapes of the stiffness give everywhere
//! along a member (Archer, Consistent mass matrix for distributed mass systems, J. Struct. Div.
//! ASCE 89, 1963): connections pass on what they do in statics, and rigid zones move with their
//! nodes.

use nalgebra::Vector4;

use crate::fe::element::{Beam, Bending, Matrix12, Shape};
use crate::fe::member::{Frame, Member, pairs};
use crate::fe::model::Model;
use crate::input::Masses;

/// Places in 0..1 and weights that integrate squares of cubic shapes exactly (Gauss and Legendre).
const POINTS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Of every member and node, in global axes.
pub(crate) struct ElementMasses {
    members: Vec<MemberMass>,
    /// Of all dofs.
    nodal: Vec<f64>,
}

enum MemberMass {
    /// Of a bar, along each axis.
    Bar { nodes: [usize; 2], total: f64 },
    Frame {
        nodes: [usize; 2],
        mass: Box<Matrix12>,
    },
}

impl ElementMasses {
    pub(crate) fn new(model: &Model, masses: &Masses) -> Self {
        let of_member = |(index, member): (usize, &Member)| {
            let section = masses.section.row(index);
            let line = LineMass {
                mass: masses.line[index],
                section: [section[0], section[1], section[2]],
            };
            let nodes = member.nodes;
            match &member.frame {
                None => MemberMass::Bar {
                    nodes,
                    total: line.mass * member.length,
                },
                Some(frame) => MemberMass::Frame {
                    nodes,
                    mass: Box::new(member.to_global(&frame_mass(frame, line))),
                },
            }
        };
        Self {
            members: model.members.iter().enumerate().map(of_member).collect(),
            nodal: masses.nodal.values.to_vec(),
        }
    }

    /// Calls `add(row, column, value)` for all entries; entries repeat.
    pub(crate) fn for_each(&self, mut add: impl FnMut(usize, usize, f64)) {
        for member in &self.members {
            member.for_each(&mut add);
        }
        for (dof, &mass) in self.nodal.iter().enumerate() {
            add(dof, dof, mass);
        }
    }

    /// Of a motion, twice the kinetic energy of every member, then of every node.
    pub(crate) fn kinetic_energies(&self, motion: &[f64]) -> impl Iterator<Item = f64> {
        let of_members = self.members.iter().map(|member| {
            let mut energy = 0.0;
            member.for_each(|row, column, value| energy += motion[row] * value * motion[column]);
            energy
        });
        let own = self.nodal.chunks_exact(6).zip(motion.chunks_exact(6));
        let of_nodes = own.map(|(masses, motion)| {
            let each = masses.iter().zip(motion);
            each.map(|(mass, motion)| mass * motion * motion).sum()
        });
        of_members.chain(of_nodes)
    }
}

impl MemberMass {
    fn for_each(&self, mut add: impl FnMut(usize, usize, f64)) {
        match self {
            Self::Bar { nodes, total } => {
                for (a, b) in pairs(2) {
                    let share = if a == b { 1.0 / 3.0 } else { 1.0 / 6.0 };
                    for axis in 0..3 {
                        add(6 * nodes[a] + axis, 6 * nodes[b] + axis, total * share);
                    }
                }
            }
            Self::Frame { nodes, mass } => {
                for (row, column) in pairs(12) {
                    add(
                        6 * nodes[row / 6] + row % 6,
                        6 * nodes[column / 6] + column % 6,
                        mass[(row, column)],
                    );
                }
            }
        }
    }
}

/// What a member weighs per length.
#[derive(Debug, Clone, Copy)]
struct LineMass {
    /// [kg/m]
    mass: f64,
    /// Of the section about the local axes [kg m].
    section: [f64; 3],
}

/// Between the nodes, in local axes.
fn frame_mass(frame: &Frame, line: LineMass) -> Matrix12 {
    let mut mass = frame.at_nodes(&beam_mass(&frame.beam, line));
    for (end, reach) in [(0, frame.rigid[0]), (1, -frame.rigid[1])] {
        if reach != 0.0 {
            add_zone_mass(&mut mass, end, reach, line);
        }
    }
    mass
}

/// A motion by its few dofs.
type Motion<const N: usize> = [(usize, f64); N];

/// `mass` += motion inertia motion'
fn add<const N: usize>(mass: &mut Matrix12, motion: Motion<N>, inertia: f64) {
    for (row, left) in motion {
        for (column, right) in motion {
            mass[(row, column)] += left * inertia * right;
        }
    }
}

fn beam_mass(beam: &Beam, line: LineMass) -> Matrix12 {
    let mut mass = Matrix12::zeros();
    let [about_x, about_y, about_z] = line.section;
    let about_x = if beam.gj > 0.0 { about_x } else { 0.0 };
    for (place, weight) in POINTS {
        let [xy, xz] = [0, 1].map(|plane| moving(&beam.planes[plane], beam.length, place));
        let along = |first: usize| [(first, 1.0 - place), (first + 6, place)];
        let across = |plane: usize, shape: &Vector4<f64>| -> Motion<4> {
            std::array::from_fn(|at| {
                let (dof, sign) = beam.planes[plane].dofs[at];
                (dof, sign * shape[at])
            })
        };
        let part = weight * beam.length;
        add(&mut mass, along(0), line.mass * part);
        add(&mut mass, across(0, &xy.deflection), line.mass * part);
        add(&mut mass, across(1, &xz.deflection), line.mass * part);
        add(&mut mass, along(3), about_x * part);
        add(&mut mass, across(1, &xz.rotation), about_y * part);
        add(&mut mass, across(0, &xy.rotation), about_z * part);
    }
    mass
}

/// What does not bend at all moves as a string between its ends.
fn moving(bending: &Bending, length: f64, place: f64) -> Shape {
    if bending.ei > 0.0 {
        return bending.shape(length, place);
    }
    Shape {
        deflection: Vector4::new(1.0 - place, 0.0, place, 0.0),
        rotation: Vector4::zeros(),
    }
}

/// A rigid zone from its node, `reach` along the member.
fn add_zone_mass(mass: &mut Matrix12, end: usize, reach: f64, line: LineMass) {
    let first = 6 * end;
    for (place, weight) in POINTS {
        let (lever, part) = (place * reach, weight * reach.abs());
        add(mass, [(first, 1.0)], line.mass * part);
        add(
            mass,
            [(first + 1, 1.0), (first + 5, lever)],
            line.mass * part,
        );
        add(
            mass,
            [(first + 2, 1.0), (first + 4, -lever)],
            line.mass * part,
        );
        for (axis, inertia) in line.section.into_iter().enumerate() {
            add(mass, [(first + 3 + axis, 1.0)], inertia * part);
        }
    }
}
