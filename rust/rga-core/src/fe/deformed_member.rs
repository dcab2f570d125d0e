//! A member under large displacements: its tension, forces and tangent stiffness.
//!
//! The elongation is that of the chord between the moved nodes, exactly, and on a frame member
//! the bow of its axis beside the chord, averaged over the length,
//!
//!   elongation = l - L + d' B d / 2,    N = EA / L (elongation - initial elongation),
//!
//! with the end motions d in the axes as drawn and B the consistent geometric stiffness less that
//! of a straight string. Energy EA / (2 L) (N L / EA)^2 + d' K d / 2, with the stiffness K in
//! bending and torsion, gives forces N g + K d with g the gradient of the elongation, and the
//! tangent EA / L g g' + N (B + the chord's rotation) + K. A truss member is exact at any size;
//! a frame member takes rotations as components, for moderate ones, and its chord makes a
//! rotation as a whole cost no tension. (Exact chord: Crisfield, Non-linear Finite Element
//! Analysis of Solids and Structures 1, 1991, chapter 3; with bowing: Oran, Tangent stiffness in
//! plane frames, J. Struct. Div. ASCE 99, 1973; averaged strain: von Karman's, over the length.)

use nalgebra::{Matrix3, Vector3};

use crate::fe::element::{Matrix12, Vector12};
use crate::fe::member::{Frame, Member, pairs};

/// What does not depend on the state.
#[derive(Debug, Clone)]
pub(crate) struct Flexible {
    /// Tension per elongation, end connections included.
    axial: f64,
    frame: Option<Box<Bow>>,
}

#[derive(Debug, Clone)]
struct Bow {
    /// In bending and torsion.
    stiffness: Matrix12,
    /// B above.
    bow: Matrix12,
    /// Motions of the elastic beam's ends from those of the nodes.
    inner: Matrix12,
}

/// A member in a state, in its axes as drawn.
#[derive(Debug, Clone)]
pub(crate) struct Deformed {
    /// With that of temperature.
    pub elongation: f64,
    pub tension: f64,
    /// Forces of the nodes, the tension taken along the axis as drawn.
    pub ends: Vector12,
    /// From the first moved node to the second: unit direction and length.
    chord: Vector3<f64>,
    length: f64,
    motions: Vector12,
    /// Gradient of the elongation.
    gradient: Vector12,
    /// Of the ends of the elastic beam.
    inner: Vector12,
}

impl Flexible {
    pub(crate) fn new(member: &Member) -> Self {
        let Some(frame) = &member.frame else {
            return Self {
                axial: member.ea / member.length,
                frame: None,
            };
        };
        let mut stiffness = frame.stiffness;
        for dof in [0, 6] {
            stiffness.row_mut(dof).fill(0.0);
            stiffness.column_mut(dof).fill(0.0);
        }
        let columns: Vec<Vector12> = (Matrix12::identity().column_iter())
            .map(|unit| frame.connection.inner(&frame.node_to_face(&unit.into())))
            .collect();
        let inner = Matrix12::from_columns(&columns);
        Self {
            axial: frame.stiffness[(6, 6)],
            frame: Some(Box::new(Bow {
                stiffness,
                bow: inner.tr_mul(&(frame.beam.geometric() * inner)) + beside(frame, member.length),
                inner,
            })),
        }
    }

    /// `strain` is the initial axial strain; `fixed_end` the forces of loads and of gradients of
    /// the initial strain, which keep their directions.
    pub(crate) fn deform(
        &self,
        member: &Member,
        displacements: &[f64],
        strain: f64,
        fixed_end: &Vector12,
    ) -> Deformed {
        let motions = member.to_local(displacements);
        let apart = motions.fixed_rows::<3>(6) - motions.fixed_rows::<3>(0);
        let along = apart + Vector3::x() * member.length;
        let length = along.norm();
        let chord = along / length;
        // l - L without a difference of large numbers.
        let mut elongation =
            (2.0 * member.length * apart.x + apart.norm_squared()) / (length + member.length);
        let mut gradient = Vector12::zeros();
        gradient.fixed_rows_mut::<3>(0).copy_from(&-chord);
        gradient.fixed_rows_mut::<3>(6).copy_from(&chord);
        let mut ends = *fixed_end;
        let mut bowed = Vector12::zeros();
        let mut inner = motions;
        if let Some(frame) = &self.frame {
            bowed = frame.bow * motions;
            elongation += 0.5 * motions.dot(&bowed);
            gradient += bowed;
            ends += frame.stiffness * motions;
            inner = frame.inner * motions;
        }
        let tension = self.axial * (elongation - strain * member.length);
        ends += bowed * tension;
        ends[0] -= tension;
        ends[6] += tension;
        Deformed {
            elongation,
            tension,
            ends,
            chord,
            length,
            motions,
            gradient,
            inner,
        }
    }

    /// The tension after a further motion of the ends, by the gradient.
    pub(crate) fn tension_ahead(
        &self,
        member: &Member,
        deformed: &Deformed,
        motion: &[f64],
    ) -> f64 {
        let further = member.to_local(motion).dot(&deformed.gradient);
        deformed.tension + self.axial * further
    }

    /// The tangent stiffness with a tension, entry by entry as `Member::for_each_stiffness` gives
    /// the stiffness.
    pub(crate) fn for_each_tangent(
        &self,
        member: &Member,
        deformed: &Deformed,
        tension: f64,
        mut add: impl FnMut(usize, usize, f64),
    ) {
        let chord = deformed.chord * deformed.chord.transpose();
        let turned = (Matrix3::identity() - chord) * (tension / deformed.length);
        let Some(frame) = &self.frame else {
            let block = chord * self.axial + turned;
            let block = member.axes.tr_mul(&(block * member.axes));
            for (row, column) in pairs(6) {
                let sign = if row / 3 == column / 3 { 1.0 } else { -1.0 };
                add(row, column, sign * block[(row % 3, column % 3)]);
            }
            return;
        };
        let gradient = &deformed.gradient;
        let mut tangent =
            gradient * gradient.transpose() * self.axial + frame.stiffness + frame.bow * tension;
        for (row, column) in [(0, 0), (0, 6), (6, 0), (6, 6)] {
            let sign = if row == column { 1.0 } else { -1.0 };
            let mut block = tangent.fixed_view_mut::<3, 3>(row, column);
            block += turned * sign;
        }
        let global = member.to_global(&tangent);
        for (row, column) in pairs(12) {
            add(row, column, global[(row, column)]);
        }
    }
}

impl Deformed {
    /// Forces of the nodes on the member.
    pub(crate) fn end_forces(&self) -> Vector12 {
        let mut forces = self.ends;
        let turned = (self.chord - Vector3::x()) * self.tension;
        for axis in 0..3 {
            forces[axis] -= turned[axis];
            forces[axis + 6] += turned[axis];
        }
        forces
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.tension.is_finite() && self.end_forces().iter().all(|force| force.is_finite())
    }

    /// Deflection of the axis beside the chord at x, in the local x-y and x-z planes.
    pub(crate) fn bow(&self, member: &Member, x: f64) -> [f64; 2] {
        let Some(frame) = &member.frame else {
            return [0.0; 2];
        };
        let [first, last] = [frame.rigid[0], member.length - frame.rigid[1]];
        let elastic = x.clamp(first, last);
        let share = elastic / member.length;
        // A rigid zone stays straight from its node to its face.
        let zone = if x < first {
            x / first
        } else if x > last {
            (member.length - x) / frame.rigid[1]
        } else {
            1.0
        };
        [0, 1].map(|plane| {
            let bending = &frame.beam.planes[plane];
            let xi = (elastic - first) / frame.beam.length;
            let shape = bending.shape(frame.beam.length, xi).deflection;
            let terms = bending.dofs.iter().zip(shape.iter());
            let deflection: f64 = terms
                .map(|(&(dof, sign), shape)| sign * self.inner[dof] * shape)
                .sum();
            let (near, far) = (self.motions[1 + plane], self.motions[7 + plane]);
            zone * (deflection - near - (far - near) * share)
        })
    }
}

/// Rigid zones that turn shorten the way between the nodes as well; a straight string between
/// these is in the chord already.
fn beside(frame: &Frame, length: f64) -> Matrix12 {
    let mut form = Matrix12::zeros();
    for plane in &frame.beam.planes {
        let [near, turn_near, far, turn_far] = plane.dofs.map(|(dof, _)| dof);
        form[(turn_near, turn_near)] += frame.rigid[0];
        form[(turn_far, turn_far)] += frame.rigid[1];
        for (row, column) in [(near, near), (far, far)] {
            form[(row, column)] -= 1.0 / length;
        }
        for (row, column) in [(near, far), (far, near)] {
            form[(row, column)] += 1.0 / length;
        }
    }
    form
}
