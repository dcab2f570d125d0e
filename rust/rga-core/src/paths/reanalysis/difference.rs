//! Where two structures differ in a few stiffnesses alone.

use rga_simd::Array;

use crate::fe::axes::local_axes;
use crate::input::{Outputs, Structure};

/// Frame members that may differ, beyond which a solve of the whole structure is no dearer.
const FEW: usize = 4;

/// Terms that differ, or few frame members, or nothing.
#[derive(Debug, Clone, Default)]
pub struct StiffnessDifference {
    /// (truss member, or spring behind all members; by how much it is stiffer)
    pub terms: Vec<(usize, f64)>,
    pub frames: Vec<usize>,
}

impl StiffnessDifference {
    /// None where more than few stiffnesses differ. The first structure and its outputs are
    /// checked ones.
    pub fn between(
        one: (&Structure, &Outputs),
        other: (&Structure, &Outputs),
    ) -> Option<StiffnessDifference> {
        if !same_outputs(one.1, other.1) {
            return None;
        }
        let (one, other) = (one.0, other.0);
        if !same_but_stiffness(one, other) {
            return None;
        }
        let mut found = Self::default();
        for member in 0..one.member_count() {
            if one.frame[member] {
                if differs(one, other, member) {
                    found.frames.push(member);
                }
                continue;
            }
            if one.young[member] == other.young[member] && one.area[member] == other.area[member] {
                continue;
            }
            let length = local_axes(one, member)?.0;
            let axial =
                |structure: &Structure| structure.young[member] * structure.area[member] / length;
            found.push(member, axial(one), axial(other));
        }
        for spring in 0..one.spring_stiffness.len() {
            let (before, after) = (one.spring_stiffness[spring], other.spring_stiffness[spring]);
            found.push(one.member_count() + spring, before, after);
        }
        let mixed = !found.frames.is_empty() && !found.terms.is_empty();
        (found.frames.len() <= FEW && !mixed).then_some(found)
    }

    pub fn is_empty(&self) -> bool {
        self.terms.is_empty() && self.frames.is_empty()
    }

    fn push(&mut self, element: usize, before: f64, after: f64) {
        if before != after {
            self.terms.push((element, after - before));
        }
    }
}

/// Whether a frame member differs in a stiffness.
fn differs(one: &Structure, other: &Structure, member: usize) -> bool {
    let pairs = [
        (one.young, other.young),
        (one.shear, other.shear),
        (one.area, other.area),
        (one.iy, other.iy),
        (one.iz, other.iz),
    ];
    pairs
        .iter()
        .any(|(one, other)| one[member] != other[member])
        || one.connection.row(member) != other.connection.row(member)
}

/// All but E, G, A, Iy, Iz, the connections, and the stiffness of springs, bit by bit.
fn same_but_stiffness(one: &Structure, other: &Structure) -> bool {
    let shapes = [
        (one.young, other.young),
        (one.shear, other.shear),
        (one.area, other.area),
        (one.iy, other.iy),
        (one.iz, other.iz),
        (one.connection, other.connection),
        (one.spring_stiffness, other.spring_stiffness),
    ];
    let numbers = [
        (one.coordinates, other.coordinates),
        (one.torsion, other.torsion),
        (one.shear_area_y, other.shear_area_y),
        (one.shear_area_z, other.shear_area_z),
        (one.local_y, other.local_y),
        (one.rigid_end, other.rigid_end),
        (one.inclined_direction, other.inclined_direction),
    ];
    let indices = [
        (one.ends, other.ends),
        (one.inclined_node, other.inclined_node),
        (one.spring_node, other.spring_node),
        (one.spring_dof, other.spring_dof),
        (one.tie_node, other.tie_node),
        (one.tie_dof, other.tie_dof),
    ];
    shapes.iter().all(|(one, other)| one.shape == other.shape)
        && numbers
            .into_iter()
            .all(|(one, other)| same_numbers(one, other))
        && indices.into_iter().all(|(one, other)| same(one, other))
        && same(one.frame, other.frame)
        && same(one.fixed, other.fixed)
}

fn same_outputs(one: &Outputs, other: &Outputs) -> bool {
    same(one.kind, other.kind)
        && same(one.index, other.index)
        && same(one.other, other.other)
        && same_numbers(one.vector, other.vector)
        && same(one.total, other.total)
}

fn same<T: PartialEq>(one: Array<T>, other: Array<T>) -> bool {
    shared(&one, &other) || (one.shape == other.shape && one.values == other.values)
}

/// What is not a number is the same as itself.
fn same_numbers(one: Array<f64>, other: Array<f64>) -> bool {
    if shared(&one, &other) {
        return true;
    }
    let mut pairs = one.values.iter().zip(other.values);
    one.shape == other.shape && pairs.all(|(one, other)| one.to_bits() == other.to_bits())
}

/// Whether both are the same numbers in memory: a copy shares what it does not change.
fn shared<T>(one: &Array<T>, other: &Array<T>) -> bool {
    one.shape == other.shape && std::ptr::eq(one.values, other.values)
}
