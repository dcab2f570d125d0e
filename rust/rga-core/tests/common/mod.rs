//! Small structures for the tests: owned arrays, lent to the core.
#![allow(dead_code, reason = "each test file uses its part")]

pub mod grid;
pub mod masses;
pub mod samples;
pub mod swinging;

use rga_core::{Array, Loads, OutputKind, Outputs, Result, Structure, respond};

pub const E: f64 = 2.1e11;
pub const G: f64 = 8.1e10;
pub const AREA: f64 = 8e-3;
pub const IZ: f64 = 1.2e-4;
pub const IY: f64 = 4e-5;
pub const TORSION: f64 = 1e-6;

pub const DISPLACEMENT: i64 = OutputKind::Displacement as i64;
pub const ROTATION: i64 = OutputKind::Rotation as i64;
pub const STRAIN: i64 = OutputKind::Strain as i64;
pub const SECTION_FORCE: i64 = OutputKind::SectionForce as i64;
pub const REACTION: i64 = OutputKind::ReactionForce as i64;
pub const MOMENT: i64 = OutputKind::ReactionMoment as i64;
pub const END_FORCE: i64 = OutputKind::EndForce as i64;

/// One load pattern on members of one section.
#[derive(Clone, Default)]
pub struct Case {
    pub nodes: Vec<[f64; 3]>,
    pub ends: Vec<[i64; 2]>,
    pub frame: Vec<bool>,
    pub shear_area: f64,
    pub connection: Vec<[f64; 12]>,
    pub rigid_end: Vec<[f64; 2]>,
    pub fixed: Vec<[bool; 6]>,
    pub inclined: Vec<(i64, [f64; 3], f64)>,
    pub springs: Vec<([i64; 2], i64, f64)>,
    pub ties: Vec<([i64; 2], i64)>,
    pub forces: Vec<[f64; 6]>,
    pub strain: Vec<[f64; 3]>,
    pub prescribed: Vec<[f64; 6]>,
    /// (member, axis, from, to, start, end)
    pub member_loads: Vec<(i64, i64, f64, f64, f64, f64)>,
}

/// (kind, index, other, vector)
pub type Output = (i64, i64, i64, [f64; 3]);

impl Case {
    pub fn new(nodes: &[[f64; 3]], members: &[([i64; 2], bool)]) -> Self {
        let (n, m) = (nodes.len(), members.len());
        Self {
            nodes: nodes.to_vec(),
            ends: members.iter().map(|member| member.0).collect(),
            frame: members.iter().map(|member| member.1).collect(),
            shear_area: f64::INFINITY,
            connection: vec![[f64::INFINITY; 12]; m],
            rigid_end: vec![[0.0; 2]; m],
            fixed: vec![[false; 6]; n],
            forces: vec![[0.0; 6]; n],
            strain: vec![[0.0; 3]; m],
            prescribed: vec![[0.0; 6]; n],
            ..Self::default()
        }
    }

    /// A frame member from the origin along x.
    pub fn beam(length: f64) -> Self {
        Self::new(&[[0.0; 3], [length, 0.0, 0.0]], &[([0, 1], true)])
    }

    pub fn fix(mut self, node: usize, dofs: &[usize]) -> Self {
        for &dof in dofs {
            self.fixed[node][dof] = true;
        }
        self
    }

    pub fn connect(mut self, member: usize, dof: usize, stiffness: f64) -> Self {
        self.connection[member][dof] = stiffness;
        self
    }

    pub fn force(mut self, node: usize, dof: usize, size: f64) -> Self {
        self.forces[node][dof] += size;
        self
    }

    pub fn uniform(mut self, member: i64, axis: i64, length: f64, size: f64) -> Self {
        self.member_loads
            .push((member, axis, 0.0, length, size, size));
        self
    }

    pub fn point(mut self, member: i64, axis: i64, x: f64, size: f64) -> Self {
        self.member_loads.push((member, axis, x, x, size, 0.0));
        self
    }

    pub fn solve(&self, outputs: &[Output]) -> Result<Vec<f64>> {
        self.lend(outputs, respond)
    }

    /// What `work` makes of the case.
    pub fn lend<T>(
        &self,
        outputs: &[Output],
        work: impl FnOnce(&Structure, &Loads, &Outputs) -> T,
    ) -> T {
        let (n, m) = (self.nodes.len(), self.ends.len());
        let (k, s, t) = (self.inclined.len(), self.springs.len(), self.ties.len());
        let (q, o) = (self.member_loads.len(), outputs.len());
        let shape_n_3 = [n, 3];
        let shape_m_2 = [m, 2];
        let per_member = [m];
        let shape_m_3 = [m, 3];
        let shape_m_12 = [m, 12];
        let shape_n_6 = [n, 6];
        let per_inclined = [k];
        let shape_k_3 = [k, 3];
        let shape_s_2 = [s, 2];
        let per_spring = [s];
        let shape_t_2 = [t, 2];
        let per_tie = [t];
        let shape_1_n_6 = [1, n, 6];
        let shape_1_m_3 = [1, m, 3];
        let shape_1_k = [1, k];
        let per_load = [q];
        let per_output = [o];
        let shape_o_3 = [o, 3];
        let constant = |value: f64| vec![value; m];
        let (young, shear, area) = (constant(E), constant(G), constant(AREA));
        let (iy, iz, torsion) = (constant(IY), constant(IZ), constant(TORSION));
        let shear_area = constant(self.shear_area);
        let default_axes = vec![f64::NAN; 3 * m];
        let inclined_node: Vec<i64> = self.inclined.iter().map(|support| support.0).collect();
        let inclined_direction: Vec<f64> = self.inclined.iter().flat_map(|held| held.1).collect();
        let inclined_value: Vec<f64> = self.inclined.iter().map(|support| support.2).collect();
        let spring_node: Vec<i64> = self.springs.iter().flat_map(|spring| spring.0).collect();
        let spring_dof: Vec<i64> = self.springs.iter().map(|spring| spring.1).collect();
        let spring_stiffness: Vec<f64> = self.springs.iter().map(|spring| spring.2).collect();
        let tie_node: Vec<i64> = self.ties.iter().flat_map(|tie| tie.0).collect();
        let tie_dof: Vec<i64> = self.ties.iter().map(|tie| tie.1).collect();
        let structure = Structure {
            coordinates: Array::new(self.nodes.as_flattened(), &shape_n_3),
            ends: Array::new(self.ends.as_flattened(), &shape_m_2),
            frame: Array::new(&self.frame, &per_member),
            young: Array::new(&young, &per_member),
            shear: Array::new(&shear, &per_member),
            area: Array::new(&area, &per_member),
            iy: Array::new(&iy, &per_member),
            iz: Array::new(&iz, &per_member),
            torsion: Array::new(&torsion, &per_member),
            shear_area_y: Array::new(&shear_area, &per_member),
            shear_area_z: Array::new(&shear_area, &per_member),
            local_y: Array::new(&default_axes, &shape_m_3),
            connection: Array::new(self.connection.as_flattened(), &shape_m_12),
            rigid_end: Array::new(self.rigid_end.as_flattened(), &shape_m_2),
            fixed: Array::new(self.fixed.as_flattened(), &shape_n_6),
            inclined_node: Array::new(&inclined_node, &per_inclined),
            inclined_direction: Array::new(&inclined_direction, &shape_k_3),
            spring_node: Array::new(&spring_node, &shape_s_2),
            spring_dof: Array::new(&spring_dof, &per_spring),
            spring_stiffness: Array::new(&spring_stiffness, &per_spring),
            tie_node: Array::new(&tie_node, &shape_t_2),
            tie_dof: Array::new(&tie_dof, &per_tie),
        };
        let pattern = vec![0; q];
        let index: Vec<i64> = self.member_loads.iter().map(|load| load.0).collect();
        let axis: Vec<i64> = self.member_loads.iter().map(|load| load.1).collect();
        let from: Vec<f64> = self.member_loads.iter().map(|load| load.2).collect();
        let to: Vec<f64> = self.member_loads.iter().map(|load| load.3).collect();
        let start: Vec<f64> = self.member_loads.iter().map(|load| load.4).collect();
        let end: Vec<f64> = self.member_loads.iter().map(|load| load.5).collect();
        let loads = Loads {
            forces: Array::new(self.forces.as_flattened(), &shape_1_n_6),
            strain: Array::new(self.strain.as_flattened(), &shape_1_m_3),
            prescribed: Array::new(self.prescribed.as_flattened(), &shape_1_n_6),
            prescribed_inclined: Array::new(&inclined_value, &shape_1_k),
            member_pattern: Array::new(&pattern, &per_load),
            member_index: Array::new(&index, &per_load),
            member_axis: Array::new(&axis, &per_load),
            member_from: Array::new(&from, &per_load),
            member_to: Array::new(&to, &per_load),
            member_start: Array::new(&start, &per_load),
            member_end: Array::new(&end, &per_load),
        };
        let kind: Vec<i64> = outputs.iter().map(|output| output.0).collect();
        let place: Vec<i64> = outputs.iter().map(|output| output.1).collect();
        let other: Vec<i64> = outputs.iter().map(|output| output.2).collect();
        let vector: Vec<f64> = outputs.iter().flat_map(|output| output.3).collect();
        let total = vec![false; o];
        let outputs = Outputs {
            kind: Array::new(&kind, &per_output),
            index: Array::new(&place, &per_output),
            other: Array::new(&other, &per_output),
            vector: Array::new(&vector, &shape_o_3),
            total: Array::new(&total, &per_output),
        };
        work(&structure, &loads, &outputs)
    }
}

/// Heights of the first nodes, and axial forces in the middle of the first members.
pub fn heights_and_forces(count: i64) -> Vec<Output> {
    let pair = |index| {
        [
            at(DISPLACEMENT, index, 2),
            (SECTION_FORCE, index, 0, [0.5, 0.0, 0.0]),
        ]
    };
    (0..count).flat_map(pair).collect()
}

/// A node's motion or reaction along a global axis.
pub fn at(kind: i64, node: i64, axis: usize) -> Output {
    let mut vector = [0.0; 3];
    vector[axis] = 1.0;
    (kind, node, -1, vector)
}

pub fn end_force(member: i64, dof: i64) -> Output {
    (END_FORCE, member, dof, [0.0; 3])
}

pub fn close(value: f64, expected: f64) {
    let miss = (value - expected).abs();
    assert!(
        miss <= 1e-9 * expected.abs() + 1e-12,
        "{value} instead of {expected}"
    );
}
