//! A member between two nodes: its axes, stiffness and end forces.

use nalgebra::{Matrix3, Vector3};

use crate::error::{Error, Result};
use crate::fe::axes::local_axes;
use crate::fe::connection::Connection;
use crate::fe::element::{Beam, Matrix12, Vector12};
use crate::input::Structure;

#[derive(Debug, Clone)]
pub(crate) struct Member {
    pub nodes: [usize; 2],
    pub length: f64,
    /// Rows x, y, z in global components.
    pub axes: Matrix3<f64>,
    pub ea: f64,
    /// Nothing for a truss member.
    pub frame: Option<Box<Frame>>,
}

/// What bends: [rigid zone] connection, elastic beam, connection [rigid zone].
/// The connections stand at the faces of the rigid zones.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub beam: Beam,
    pub rigid: [f64; 2],
    pub connection: Connection,
    /// One of the connections is neither released nor rigid.
    yields: bool,
    /// Between the nodes, in local axes.
    pub stiffness: Matrix12,
}

impl Member {
    pub(crate) fn new(structure: &Structure, index: usize) -> Result<Self> {
        let ends = structure.ends.row(index);
        let (length, axes) = local_axes(structure, index)
            .ok_or_else(|| Error::invalid(format!("member {index} has no local axes")))?;
        let frame = structure.frame[index].then(|| Box::new(Frame::new(structure, index, length)));
        let member = Self {
            nodes: [ends[0] as usize, ends[1] as usize],
            length,
            axes,
            ea: structure.young[index] * structure.area[index],
            frame,
        };
        let finite = match &member.frame {
            None => (member.ea / length).is_finite(),
            Some(frame) => frame.stiffness.iter().all(|value| value.is_finite()),
        };
        if !finite {
            return Err(Error::invalid(format!(
                "the stiffness of member {index} overflows; check its length, E, G and section"
            )));
        }
        Ok(member)
    }

    /// The stiffness is proportional to that of the bare member.
    pub(crate) fn is_proportional(&self) -> bool {
        !self.frame.as_deref().is_some_and(|frame| frame.yields)
    }

    /// Multiplies the stiffness between the nodes.
    pub(crate) fn stiffen(&mut self, factor: f64) {
        self.ea *= factor;
        if let Some(frame) = &mut self.frame {
            frame.stiffness *= factor;
        }
    }

    /// The global dofs that the member stiffens, and its stiffness there.
    pub(crate) fn for_each_stiffness(&self, mut add: impl FnMut(usize, usize, f64)) {
        match &self.frame {
            None => {
                let x = self.axis();
                let block = x * x.transpose() * (self.ea / self.length);
                for (row, column) in pairs(6) {
                    let (a, b) = (row / 3, column / 3);
                    let sign = if a == b { 1.0 } else { -1.0 };
                    add(
                        6 * self.nodes[a] + row % 3,
                        6 * self.nodes[b] + column % 3,
                        sign * block[(row % 3, column % 3)],
                    );
                }
            }
            Some(frame) => {
                let global = self.to_global(&frame.stiffness);
                for (row, column) in pairs(12) {
                    add(
                        6 * self.nodes[row / 6] + row % 6,
                        6 * self.nodes[column / 6] + column % 6,
                        global[(row, column)],
                    );
                }
            }
        }
    }

    /// Forces of the nodes on the member, local: stiffness times
    /// displacements plus `fixed_end`.
    pub(crate) fn end_forces(&self, displacements: &[f64], fixed_end: &Vector12) -> Vector12 {
        match &self.frame {
            None => {
                let tension = self.ea / self.length * self.elongation(displacements);
                let mut forces = *fixed_end;
                forces[0] -= tension;
                forces[6] += tension;
                forces
            }
            Some(frame) => frame.stiffness * self.to_local(displacements) + fixed_end,
        }
    }

    /// Motions of the two ends, local.
    pub(crate) fn to_local(&self, displacements: &[f64]) -> Vector12 {
        let mut local = Vector12::zeros();
        for block in 0..4 {
            let first = 6 * self.nodes[block / 2] + 3 * (block % 2);
            let global = Vector3::from_column_slice(&displacements[first..first + 3]);
            local
                .fixed_rows_mut::<3>(3 * block)
                .copy_from(&(self.axes * global));
        }
        local
    }

    /// Twice the strain energy of a motion of its ends.
    pub(crate) fn energy(&self, displacements: &[f64]) -> f64 {
        match &self.frame {
            None => self.ea / self.length * self.elongation(displacements).powi(2),
            Some(frame) => {
                let local = self.to_local(displacements);
                local.dot(&(frame.stiffness * local))
            }
        }
    }

    pub(crate) fn elongation(&self, displacements: &[f64]) -> f64 {
        let at = |node: usize| Vector3::from_column_slice(&displacements[6 * node..6 * node + 3]);
        self.axis().dot(&(at(self.nodes[1]) - at(self.nodes[0])))
    }

    /// Calls `add(dof, force)` for local end forces in global components.
    pub(crate) fn for_each_force(&self, local: &Vector12, mut add: impl FnMut(usize, f64)) {
        // A truss member has no end moments.
        let step = if self.frame.is_some() { 1 } else { 2 };
        for block in (0..4).step_by(step) {
            let global = self.axes.tr_mul(&local.fixed_rows::<3>(3 * block));
            let first = 6 * self.nodes[block / 2] + 3 * (block % 2);
            for (axis, force) in global.iter().enumerate() {
                add(first + axis, *force);
            }
        }
    }

    /// Adds the sizes of local end forces and moments to all dofs that these may act on.
    pub(crate) fn add_sizes(&self, local: &Vector12, total: &mut [f64]) {
        for block in 0..4 {
            let first = 6 * self.nodes[block / 2] + 3 * (block % 2);
            let size = local.fixed_rows::<3>(3 * block).norm();
            for sum in &mut total[first..first + 3] {
                *sum += size;
            }
        }
    }

    fn axis(&self) -> Vector3<f64> {
        self.axes.row(0).transpose()
    }

    pub(crate) fn to_global(&self, local: &Matrix12) -> Matrix12 {
        let mut global = Matrix12::zeros();
        for row in 0..4 {
            for column in 0..4 {
                let block = local.fixed_view::<3, 3>(3 * row, 3 * column);
                let turned = self.axes.tr_mul(&(block * self.axes));
                global
                    .fixed_view_mut::<3, 3>(3 * row, 3 * column)
                    .copy_from(&turned);
            }
        }
        global
    }
}

impl Frame {
    fn new(structure: &Structure, index: usize, length: f64) -> Self {
        let (e, g) = (structure.young[index], structure.shear[index]);
        let shear = |area: f64| {
            if area.is_finite() {
                g * area
            } else {
                f64::INFINITY
            }
        };
        let zones = structure.rigid_end.row(index);
        let rigid = [zones[0], zones[1]];
        let beam = Beam::new(
            length - rigid[0] - rigid[1],
            (e * structure.area[index], g * structure.torsion[index]),
            [
                (
                    e * structure.iz[index],
                    shear(structure.shear_area_y[index]),
                ),
                (
                    e * structure.iy[index],
                    shear(structure.shear_area_z[index]),
                ),
            ],
        );
        let ends = structure.connection.row(index);
        let mut stiffness = beam.stiffness();
        let connection = Connection::condense(&mut stiffness, ends);
        if rigid != [0.0; 2] {
            let arm = rigid_arm(rigid);
            stiffness = arm.tr_mul(&(stiffness * arm));
        }
        Self {
            beam,
            rigid,
            connection,
            yields: ends.iter().any(|&end| end.is_finite() && end > 0.0),
            stiffness,
        }
    }

    /// A form of the motions of the bare beam's ends, as one of the motions of the nodes.
    pub(crate) fn at_nodes(&self, form: &Matrix12) -> Matrix12 {
        if self.connection.is_rigid() && self.rigid == [0.0; 2] {
            return *form;
        }
        let mut behind = Matrix12::identity();
        for mut motions in behind.column_iter_mut() {
            let inner = self.connection.inner(&motions.clone_owned());
            motions.copy_from(&inner);
        }
        let motions = behind * rigid_arm(self.rigid);
        motions.tr_mul(&(form * motions))
    }

    /// Motions of the faces of the rigid zones, from those of the nodes.
    pub(crate) fn node_to_face(&self, motions: &Vector12) -> Vector12 {
        rigid_arm(self.rigid) * motions
    }

    /// Forces at the faces of the rigid zones, moved to the nodes.
    pub(crate) fn face_to_node(&self, forces: &Vector12) -> Vector12 {
        rigid_arm(self.rigid).tr_mul(forces)
    }
}

/// Displacements of the faces of the rigid zones from those of the nodes.
fn rigid_arm(rigid: [f64; 2]) -> Matrix12 {
    let mut arm = Matrix12::identity();
    for (first, reach) in [(0, rigid[0]), (6, -rigid[1])] {
        arm[(first + 1, first + 5)] = reach;
        arm[(first + 2, first + 4)] = -reach;
    }
    arm
}

pub(crate) fn pairs(size: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..size).flat_map(move |row| (0..size).map(move |column| (row, column)))
}
