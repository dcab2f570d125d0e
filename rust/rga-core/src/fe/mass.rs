//! Mass of members and nodes, consistent with the shapes in which they deform.
//!
//! Kinetic energy of a motion, with the velocities that the shapes of the stiffness give everywhere
//! along a member (Archer, Consistent mass matrix for distributed mass systems, J. Struct. Div.
//! ASCE 89, 1963): connections pass on what they do in statics, and rigid zones move with their
//! nodes.

use nalgebra::Vector4;

use crate::fe::element::{Beam, Bending, Matrix12, Shape, Vector12};
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

/// What a member weighs per length.
#[derive(Debug, Clone, Copy)]
struct LineMass {
    /// [kg/m]
    mass: f64,
    /// Of the section about the local axes [kg m].
    section: [f64; 3],
}

/// Calls `add(row, column, value)` for all entries; entries repeat.
pub(crate) fn for_each_mass(
    model: &Model,
    masses: &Masses,
    mut add: impl FnMut(usize, usize, f64),
) {
    for (index, member) in model.members.iter().enumerate() {
        let section = masses.section.row(index);
        let line = LineMass {
            mass: masses.line[index],
            section: [section[0], section[1], section[2]],
        };
        member_mass(member, line, &mut add);
    }
    for (dof, &mass) in masses.nodal.values.iter().enumerate() {
        add(dof, dof, mass);
    }
}

fn member_mass(member: &Member, line: LineMass, mut add: impl FnMut(usize, usize, f64)) {
    match &member.frame {
        None => {
            let total = line.mass * member.length;
            for (a, b) in pairs(2) {
                let share = if a == b { 1.0 / 3.0 } else { 1.0 / 6.0 };
                for axis in 0..3 {
                    let (row, column) = (6 * member.nodes[a] + axis, 6 * member.nodes[b] + axis);
                    add(row, column, total * share);
                }
            }
        }
        Some(frame) => {
            let global = member.to_global(&frame_mass(frame, line));
            for (row, column) in pairs(12) {
                add(
                    6 * member.nodes[row / 6] + row % 6,
                    6 * member.nodes[column / 6] + column % 6,
                    global[(row, column)],
                );
            }
        }
    }
}

/// Between the nodes, in local axes.
fn frame_mass(frame: &Frame, line: LineMass) -> Matrix12 {
    let mut mass = frame.at_nodes(&beam_mass(&frame.beam, line));
    for (end, reach) in [(0, frame.rigid[0]), (1, -frame.rigid[1])] {
        mass += zone_mass(end, reach, line);
    }
    mass
}

fn beam_mass(beam: &Beam, line: LineMass) -> Matrix12 {
    let mut mass = Matrix12::zeros();
    for (place, weight) in POINTS {
        let [shape_xy, shape_xz] =
            [0, 1].map(|plane| moving(&beam.planes[plane], beam.length, place));
        let along = |first: usize| {
            let mut row = Vector12::zeros();
            (row[first], row[first + 6]) = (1.0 - place, place);
            row
        };
        let across = |plane: usize, shape: &Vector4<f64>| {
            let mut row = Vector12::zeros();
            for (&(dof, sign), value) in beam.planes[plane].dofs.iter().zip(shape.iter()) {
                row[dof] = sign * value;
            }
            row
        };
        let [about_x, about_y, about_z] = line.section;
        let motions = [
            (line.mass, along(0)),
            (line.mass, across(0, &shape_xy.deflection)),
            (line.mass, across(1, &shape_xz.deflection)),
            (if beam.gj > 0.0 { about_x } else { 0.0 }, along(3)),
            (about_y, across(1, &shape_xz.rotation)),
            (about_z, across(0, &shape_xy.rotation)),
        ];
        for (inertia, motion) in motions {
            mass += motion * motion.transpose() * (inertia * weight * beam.length);
        }
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
fn zone_mass(end: usize, reach: f64, line: LineMass) -> Matrix12 {
    let mut mass = Matrix12::zeros();
    let first = 6 * end;
    for (place, weight) in POINTS {
        let lever = place * reach;
        let unit = |dof: usize| {
            let mut row = Vector12::zeros();
            row[first + dof] = 1.0;
            row
        };
        let motions = [
            (line.mass, unit(0)),
            (line.mass, unit(1) + unit(5) * lever),
            (line.mass, unit(2) - unit(4) * lever),
            (line.section[0], unit(3)),
            (line.section[1], unit(4)),
            (line.section[2], unit(5)),
        ];
        for (inertia, motion) in motions {
            mass += motion * motion.transpose() * (inertia * weight * reach.abs());
        }
    }
    mass
}
