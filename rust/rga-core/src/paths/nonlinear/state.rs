//! The loaded structure in a state: forces, residual and tangent.

use super::Analysis;
use super::load_combination::Combined;
use super::tangent_placement::listed;
use crate::error::Result;
use crate::fe::deformed_member::Deformed;
use crate::fe::element::Vector12;
use crate::fe::load::fixed_end_forces;
use crate::fe::stability::Solver;

/// What a thread needs for a sample.
pub(super) struct Scratch {
    pub solver: Solver,
    pub load: Combined,
    /// Without that of the axial strain.
    pub fixed_end: Vec<Vector12>,
    pub deformed: Vec<Deformed>,
    /// Of each member, in the tangent.
    pub tensions: Vec<f64>,
    pub displacements: Vec<f64>,
    /// Applied minus internal forces.
    pub unbalanced: Vec<f64>,
    /// Of the unknowns.
    pub residual: Vec<f64>,
    /// Sums of the sizes of all forces on the unknowns, against which a residual counts.
    pub sizes: Vec<f64>,
}

impl Analysis {
    /// Takes a load: coefficients of forces, and of initial strains and prescribed displacements.
    pub(super) fn load(
        &self,
        scratch: &mut Scratch,
        forces: &[f64],
        strains: &[f64],
    ) -> Result<()> {
        (self.combination).combine(forces, strains, &mut scratch.load)?;
        let Combined {
            strain, members, ..
        } = &scratch.load;
        let fixed_end = (self.model.members.iter().zip(strain.chunks_exact(3)))
            .enumerate()
            .map(|(index, (member, strain))| {
                let gradients = [0.0, strain[1], strain[2]];
                fixed_end_forces(member, index, &gradients, members.of(index))
            });
        scratch.fixed_end = fixed_end.collect::<Result<_>>()?;
        Ok(())
    }

    /// Puts the loaded structure into the state of the unknowns; false where that overflows.
    pub(super) fn balance(&self, scratch: &mut Scratch, unknowns: &[f64]) -> bool {
        let load = &scratch.load;
        scratch.displacements.copy_from_slice(&load.displacements);
        self.reduction.expand(unknowns, &mut scratch.displacements);
        let displacements = &scratch.displacements;
        scratch.deformed.clear();
        let members = self.model.members.iter().zip(&self.flexible);
        for (index, (member, flexible)) in members.enumerate() {
            let (strain, fixed_end) = (load.strain[3 * index], &scratch.fixed_end[index]);
            let deformed = flexible.deform(member, displacements, strain, fixed_end);
            if !deformed.is_finite() {
                return false;
            }
            scratch.deformed.push(deformed);
        }
        let ends: Vec<Vector12> = scratch.deformed.iter().map(Deformed::end_forces).collect();
        let internal = self.model.sum_forces(displacements, ends.iter().copied());
        let applied = load.forces.iter().zip(&internal);
        scratch.unbalanced = applied.map(|(force, internal)| force - internal).collect();
        self.reduction
            .collect(&scratch.unbalanced, &mut scratch.residual);
        let mut sizes: Vec<f64> = load.forces.iter().map(|force| force.abs()).collect();
        for (member, ends) in self.model.members.iter().zip(&ends) {
            member.add_sizes(ends, &mut sizes);
        }
        let own = self.reduction.unknowns.iter().map(|&dof| sizes[dof]);
        scratch.sizes = own.collect();
        true
    }

    /// Takes the tensions of the tangent from what a motion of the unknowns leads to expect.
    pub(super) fn expect(&self, scratch: &mut Scratch, motion: &[f64]) {
        let mut moved = vec![0.0; self.model.dofs];
        self.reduction.expand(motion, &mut moved);
        let members = self.model.members.iter().zip(&self.flexible);
        let states = members.zip(&scratch.deformed);
        scratch.tensions = states
            .map(|((member, flexible), deformed)| flexible.tension_ahead(member, deformed, &moved))
            .collect();
    }

    /// Size of a motion of the unknowns.
    pub(super) fn reach(&self, motion: &[f64]) -> f64 {
        let lever = |dof: usize| if dof % 6 < 3 { 1.0 } else { self.arm };
        let terms = self.reduction.unknowns.iter().zip(motion);
        let squares = terms.map(|(&dof, motion)| (motion * lever(dof)).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// The tangent stiffness; false where it is not positive definite.
    pub(super) fn factorise(&self, scratch: &mut Scratch) -> bool {
        let (members, deformed) = (&self.model.members, &scratch.deformed);
        let tangent = |index: usize| {
            let (flexible, tension) = (&self.flexible[index], scratch.tensions[index]);
            listed(|add| {
                flexible.for_each_tangent(&members[index], &deformed[index], tension, add);
            })
        };
        let values = scratch.solver.values_mut();
        self.placement.fill(&self.model, tangent, values);
        let finite = values.iter().all(|value| value.is_finite());
        finite && scratch.solver.factorise(&self.model, &self.reduction)
    }
}

impl Scratch {
    /// Takes the tensions of the tangent from the state.
    pub(super) fn take_tensions(&mut self) {
        let tensions = self.deformed.iter().map(|member| member.tension);
        self.tensions = tensions.collect();
    }

    /// Of motions and forces, in the scale of the solver.
    pub(super) fn size(&self, unknowns: &[f64]) -> f64 {
        self.solver.motion_norm(unknowns) + self.solver.force_norm(&self.sizes)
    }
}
