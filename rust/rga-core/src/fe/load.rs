//! Fixed-end forces: what the nodes must do on a loaded member to stay put.

use nalgebra::Vector4;

use crate::error::{DOFS, Error, Result};
use crate::fe::connection::Connection;
use crate::fe::element::{Bending, Vector12};
use crate::fe::member::{Frame, Member};
use crate::input::Loads;

/// Linear from `start` at `from` to `end` at `to`; a point load of size
/// `start` where both places are one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MemberLoad {
    pub axis: usize,
    pub from: f64,
    pub to: f64,
    pub start: f64,
    pub end: f64,
}

/// Abscissae and weights on 0..1, exact to degree 5: cubic shape functions
/// times a linear load need degree 4.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

impl MemberLoad {
    pub(crate) fn is_point(&self) -> bool {
        self.from == self.to
    }

    fn intensity(&self, x: f64) -> f64 {
        self.start + (self.end - self.start) * (x - self.from) / (self.to - self.from)
    }

    /// Point forces (place, size) that stand for the part within low..high,
    /// exactly for weights up to degree 4 in x.
    pub(crate) fn points(&self, low: f64, high: f64) -> impl Iterator<Item = (f64, f64)> + use<> {
        let load = *self;
        let (low, high) = (low.max(load.from), high.min(load.to));
        let width = (high - low).max(0.0);
        GAUSS
            .into_iter()
            .take(if load.is_point() { 1 } else { 3 })
            .map(move |(place, weight)| {
                if load.is_point() {
                    return (load.from, load.start);
                }
                let x = low + place * width;
                (x, weight * width * load.intensity(x))
            })
    }
}

/// The member loads of one pattern, by member.
#[derive(Debug, Clone)]
pub(crate) struct PatternLoads {
    first: Vec<usize>,
    sorted: Vec<MemberLoad>,
}

impl PatternLoads {
    /// One set for each pattern.
    pub(crate) fn group(loads: &Loads, members: usize) -> Vec<Self> {
        let patterns = loads.pattern_count();
        let mut order: Vec<usize> = (0..loads.member_pattern.len()).collect();
        let key = |&at: &usize| (loads.member_pattern.at(at), loads.member_index.at(at));
        order.sort_by_key(key);
        let mut rest = order.as_slice();
        (0..patterns)
            .map(|pattern| {
                let count = rest.partition_point(|at| key(at).0 == pattern);
                let (own, later) = rest.split_at(count);
                rest = later;
                Self {
                    first: (0..=members)
                        .map(|member| own.partition_point(|at| key(at).1 < member))
                        .collect(),
                    sorted: own.iter().map(|&at| member_load(loads, at)).collect(),
                }
            })
            .collect()
    }

    /// The loads on some members, in the order of these.
    pub(crate) fn of_some(&self, members: &[usize]) -> Self {
        let (mut first, mut sorted) = (vec![0], Vec::new());
        for &member in members {
            sorted.extend_from_slice(self.of(member));
            first.push(sorted.len());
        }
        Self { first, sorted }
    }

    pub(crate) fn none(members: usize) -> Self {
        Self {
            first: vec![0; members + 1],
            sorted: Vec::new(),
        }
    }

    /// All patterns as one, and the pattern of each load.
    pub(crate) fn merge(loads: &Loads, members: usize) -> (Self, Vec<usize>) {
        let mut order: Vec<usize> = (0..loads.member_pattern.len()).collect();
        let key = |&at: &usize| (loads.member_index.at(at), loads.member_pattern.at(at));
        order.sort_by_key(key);
        let merged = Self {
            first: (0..=members)
                .map(|member| order.partition_point(|at| key(at).0 < member))
                .collect(),
            sorted: order.iter().map(|&at| member_load(loads, at)).collect(),
        };
        let patterns = order.iter().map(|at| key(at).1).collect();
        (merged, patterns)
    }

    /// The loads of `merged`, each times the coefficient of its pattern.
    pub(crate) fn combine(&mut self, merged: &Self, patterns: &[usize], coefficients: &[f64]) {
        self.sorted.clear();
        self.first.clear();
        self.first.push(0);
        for ends in merged.first.windows(2) {
            let own = ends[0]..ends[1];
            for (load, &pattern) in merged.sorted[own.clone()].iter().zip(&patterns[own]) {
                let coefficient = coefficients[pattern];
                if coefficient != 0.0 {
                    self.sorted.push(MemberLoad {
                        start: load.start * coefficient,
                        end: load.end * coefficient,
                        ..*load
                    });
                }
            }
            self.first.push(self.sorted.len());
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        let finite = |load: &MemberLoad| load.start.is_finite() && load.end.is_finite();
        self.sorted.iter().all(finite)
    }

    pub(crate) fn of(&self, member: usize) -> &[MemberLoad] {
        &self.sorted[self.first[member]..self.first[member + 1]]
    }
}

fn member_load(loads: &Loads, at: usize) -> MemberLoad {
    MemberLoad {
        axis: loads.member_axis.at(at),
        from: loads.member_from[at],
        to: loads.member_to[at],
        start: loads.member_start[at],
        end: loads.member_end[at],
    }
}

/// Local, between the nodes, ends and rigid zones included. `strain` is the
/// initial axial strain and its gradients along local y and z.
pub(crate) fn fixed_end_forces(
    member: &Member,
    index: usize,
    strain: &[f64],
    loads: &[MemberLoad],
) -> Result<Vector12> {
    let Some(frame) = &member.frame else {
        return Ok(truss_forces(member, strain, loads));
    };
    let mut forces = Vector12::zeros();
    if loads.is_empty() && strain == [0.0; 3] {
        return Ok(forces);
    }
    let beam = &frame.beam;
    // Rigid zones, which are of steel too, grow as much as the rest: gussets do.
    let push = beam.ea * strain[0] * (member.length / beam.length);
    forces[0] = push;
    forces[6] = -push;
    for (plane, gradient) in beam.planes.iter().zip(&strain[1..]) {
        let moment = plane.ei * gradient;
        add(&mut forces, plane, Vector4::new(0.0, -moment, 0.0, moment));
    }
    let faces = [frame.rigid[0], member.length - frame.rigid[1]];
    for load in loads {
        if load.is_point() && in_rigid_zone(load.from, frame, member.length) {
            continue;
        }
        for (x, size) in load.points(faces[0], faces[1]) {
            add_point(&mut forces, frame, load.axis, x - faces[0], size);
        }
    }
    pass_on(&frame.connection, &mut forces, index)?;
    if frame.rigid == [0.0; 2] {
        return Ok(forces);
    }
    let mut forces = frame.face_to_node(&forces);
    for load in loads {
        if load.from < faces[0] {
            add_rigid(&mut forces, 0, load, (0.0, faces[0]), 0.0);
        }
        if load.to > faces[1] {
            add_rigid(
                &mut forces,
                6,
                load,
                (faces[1], member.length),
                member.length,
            );
        }
    }
    Ok(forces)
}

/// Without a rigid zone a load at the very end stays on the elastic part, even
/// where rounding put it beyond.
fn in_rigid_zone(x: f64, frame: &Frame, length: f64) -> bool {
    x < frame.rigid[0] || (frame.rigid[1] > 0.0 && x > length - frame.rigid[1])
}

fn pass_on(connection: &Connection, forces: &mut Vector12, index: usize) -> Result<()> {
    connection.pass_on(forces).map_err(|dof| {
        Error::invalid(format!(
            "the loads on member {index} act along its local {}, which connection[{index}] \
             releases so that nothing holds the member there; keep one end connected",
            DOFS[dof % 6]
        ))
    })
}

fn add(forces: &mut Vector12, plane: &Bending, values: Vector4<f64>) {
    for ((dof, sign), value) in plane.dofs.into_iter().zip(values.iter()) {
        forces[dof] += sign * value;
    }
}

fn add_point(forces: &mut Vector12, frame: &Frame, axis: usize, x: f64, size: f64) {
    let length = frame.beam.length;
    let xi = x / length;
    let [xy, xz] = &frame.beam.planes;
    match axis {
        1 => add(forces, xy, xy.shape(length, xi).deflection * -size),
        2 => add(forces, xz, xz.shape(length, xi).deflection * -size),
        // A moment about y turns against the slope dw/dx.
        4 => add(forces, xz, xz.shape(length, xi).rotation * size),
        5 => add(forces, xy, xy.shape(length, xi).rotation * -size),
        _ => {
            forces[axis] -= size * (1.0 - xi);
            forces[axis + 6] -= size * xi;
        }
    }
}

/// A load on a rigid zone goes straight to its node at `origin`.
fn add_rigid(
    forces: &mut Vector12,
    first: usize,
    load: &MemberLoad,
    zone: (f64, f64),
    origin: f64,
) {
    for (x, size) in load.points(zone.0, zone.1) {
        forces[first + load.axis] -= size;
        match load.axis {
            1 => forces[first + 5] -= size * (x - origin),
            2 => forces[first + 4] += size * (x - origin),
            _ => {}
        }
    }
}

/// A truss member shares a load between its nodes by the lever rule.
fn truss_forces(member: &Member, strain: &[f64], loads: &[MemberLoad]) -> Vector12 {
    let mut forces = Vector12::zeros();
    forces[0] = member.ea * strain[0];
    forces[6] = -member.ea * strain[0];
    for load in loads {
        for (x, size) in load.points(0.0, member.length) {
            let (dof, near) = match load.axis {
                4 => (2, size / member.length),
                5 => (1, -size / member.length),
                axis => (axis, size * (1.0 - x / member.length)),
            };
            let far = if load.axis < 3 { size - near } else { -near };
            forces[dof] -= near;
            forces[dof + 6] -= far;
        }
    }
    forces
}
