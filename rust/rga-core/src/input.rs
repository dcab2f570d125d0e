//! The arrays that describe a structure, its loads and the wanted outputs.

use rga_simd::Array;

/// n nodes, m members, k inclined supports, s springs, t ties.
#[derive(Debug, Clone, Copy)]
pub struct Structure<'a> {
    /// `[n, 3]`
    pub coordinates: Array<'a, f64>,
    /// `[m, 2]` first and second node
    pub ends: Array<'a, i64>,
    /// `[m]` true: bends; false: a truss member, axial only
    pub frame: Array<'a, bool>,
    /// `[m]` Young's modulus E
    pub young: Array<'a, f64>,
    /// `[m]` shear modulus G
    pub shear: Array<'a, f64>,
    /// `[m]` A
    pub area: Array<'a, f64>,
    /// `[m]` bends in the local x-z plane
    pub iy: Array<'a, f64>,
    /// `[m]` bends in the local x-y plane
    pub iz: Array<'a, f64>,
    /// `[m]` J
    pub torsion: Array<'a, f64>,
    /// `[m]` infinite: Euler-Bernoulli; finite: Timoshenko
    pub shear_area_y: Array<'a, f64>,
    pub shear_area_z: Array<'a, f64>,
    /// `[m, 3]` a row of NaN takes the default axes
    pub local_y: Array<'a, f64>,
    /// `[m, 12]` stiffness in series with each local end dof
    pub connection: Array<'a, f64>,
    /// `[m, 2]` lengths of the rigid zones
    pub rigid_end: Array<'a, f64>,
    /// `[n, 6]`
    pub fixed: Array<'a, bool>,
    /// `[k]`
    pub inclined_node: Array<'a, i64>,
    /// `[k, 3]` n of n.u = value
    pub inclined_direction: Array<'a, f64>,
    /// `[s, 2]` the second is -1 for ground
    pub spring_node: Array<'a, i64>,
    /// `[s]`
    pub spring_dof: Array<'a, i64>,
    /// `[s]`
    pub spring_stiffness: Array<'a, f64>,
    /// `[t, 2]`
    pub tie_node: Array<'a, i64>,
    /// `[t]`
    pub tie_dof: Array<'a, i64>,
}

impl Structure<'_> {
    pub(crate) fn node_count(&self) -> usize {
        self.coordinates.len()
    }

    pub(crate) fn member_count(&self) -> usize {
        self.ends.len()
    }
}

/// What a structure weighs in motion.
#[derive(Debug, Clone, Copy)]
pub struct Masses<'a> {
    /// `[m]` along a member
    pub line: Array<'a, f64>,
    /// `[m, 3]` of the section about the local axes, per length
    pub section: Array<'a, f64>,
    /// `[n, 6]` at the nodes: of motions along the global axes and of rotations about them
    pub nodal: Array<'a, f64>,
}

/// p patterns, each solved on its own; q member loads.
#[derive(Debug, Clone, Copy)]
pub struct Loads<'a> {
    /// `[p, n, 6]`
    pub forces: Array<'a, f64>,
    /// `[p, m, 3]` initial axial strain and its local gradients d/dy, d/dz
    pub strain: Array<'a, f64>,
    /// `[p, n, 6]` displacement of fixed dofs
    pub prescribed: Array<'a, f64>,
    /// `[p, k]`
    pub prescribed_inclined: Array<'a, f64>,
    /// `[q]`
    pub member_pattern: Array<'a, i64>,
    pub member_index: Array<'a, i64>,
    /// 0..2 local forces, 3..5 local moments
    pub member_axis: Array<'a, i64>,
    /// metres from the first node; from == to is a point load
    pub member_from: Array<'a, f64>,
    pub member_to: Array<'a, f64>,
    /// value at `from` and at `to`
    pub member_start: Array<'a, f64>,
    pub member_end: Array<'a, f64>,
}

impl Loads<'_> {
    pub fn pattern_count(&self) -> usize {
        self.forces.len()
    }
}

/// o outputs, each one number a pattern.
#[derive(Debug, Clone, Copy)]
pub struct Outputs<'a> {
    /// `[o]` codes of `OutputKind`
    pub kind: Array<'a, i64>,
    /// `[o]` node or member
    pub index: Array<'a, i64>,
    /// `[o]` reference node, component of a section force or local end dof, else -1
    pub other: Array<'a, i64>,
    /// `[o, 3]`
    pub vector: Array<'a, f64>,
    /// `[o]` strain with (true) or without the initial strain
    pub total: Array<'a, bool>,
}

impl Outputs<'_> {
    /// Of checked outputs.
    pub(crate) fn kinds(&self) -> impl Iterator<Item = OutputKind> {
        let codes = self.kind.values.iter();
        codes.filter_map(|&code| OutputKind::of(code))
    }
}

/// What an output is. Its code is the number that stands for it in arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i64)]
pub enum OutputKind {
    /// Of a node along a direction, relative to another.
    Displacement,
    Rotation,
    /// Of a member at (place in 0..1, y, z).
    Strain,
    /// Of a member at a place in 0..1: N, Vy, Vz, T, My or Mz.
    SectionForce,
    /// Of supports and springs to ground, on a node along a direction.
    ReactionForce,
    ReactionMoment,
    /// Of the node on a member, at a local end dof.
    EndForce,
}

impl OutputKind {
    /// In the order of their codes, with their names.
    pub const ALL: [(Self, &'static str); 7] = [
        (Self::Displacement, "DISPLACEMENT"),
        (Self::Rotation, "ROTATION"),
        (Self::Strain, "STRAIN"),
        (Self::SectionForce, "SECTION_FORCE"),
        (Self::ReactionForce, "REACTION_FORCE"),
        (Self::ReactionMoment, "REACTION_MOMENT"),
        (Self::EndForce, "END_FORCE"),
    ];

    /// The kind with a code; None where there is none.
    pub(crate) fn of(code: i64) -> Option<Self> {
        let at = usize::try_from(code).ok()?;
        Self::ALL.get(at).map(|(kind, _)| *kind)
    }

    /// It reads a member, not a node.
    pub(crate) fn reads_member(self) -> bool {
        matches!(self, Self::Strain | Self::SectionForce | Self::EndForce)
    }
}
