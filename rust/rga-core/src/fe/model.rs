//! Members and springs together: the unreduced stiffness.

use crate::error::{Error, Result};
use crate::fe::element::Vector12;
use crate::fe::member::Member;
use crate::input::Structure;

#[derive(Debug, Clone, Copy)]
pub(crate) struct Spring {
    pub dof: usize,
    /// Nothing: the spring goes to ground.
    pub other: Option<usize>,
    pub stiffness: f64,
}

impl Spring {
    pub(crate) fn for_each_stiffness(&self, mut add: impl FnMut(usize, usize, f64)) {
        add(self.dof, self.dof, self.stiffness);
        if let Some(other) = self.other {
            add(other, other, self.stiffness);
            add(self.dof, other, -self.stiffness);
            add(other, self.dof, -self.stiffness);
        }
    }

    /// Forces of the nodes on the spring, `add(dof, force)`.
    pub(crate) fn for_each_force(&self, displacements: &[f64], mut add: impl FnMut(usize, f64)) {
        let terms = self.terms();
        let elongation: f64 = terms.map(|(dof, sign)| sign * displacements[dof]).sum();
        for (dof, sign) in self.terms() {
            add(dof, sign * self.stiffness * elongation);
        }
    }

    /// Its elongation, as (dof, factor).
    pub(crate) fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        let other = self.other.map(|other| (other, -1.0));
        std::iter::once((self.dof, 1.0)).chain(other)
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Model {
    /// Coordinates of the nodes.
    pub nodes: Vec<[f64; 3]>,
    pub members: Vec<Member>,
    pub springs: Vec<Spring>,
    pub dofs: usize,
}

impl Model {
    pub(crate) fn new(structure: &Structure) -> Result<Self> {
        let members = (0..structure.member_count()).map(|index| Member::new(structure, index));
        let springs = (0..structure.spring_node.len()).map(|index| {
            let ends = structure.spring_node.row(index);
            let axis = structure.spring_dof.at(index);
            Spring {
                dof: 6 * ends[0] as usize + axis,
                other: (ends[1] >= 0).then(|| 6 * ends[1] as usize + axis),
                stiffness: structure.spring_stiffness[index],
            }
        });
        Ok(Self {
            nodes: structure.coordinates.values.as_chunks().0.to_vec(),
            members: members.collect::<Result<_>>()?,
            springs: springs.collect(),
            dofs: 6 * structure.node_count(),
        })
    }

    /// The same with a factor on the whole stiffness of each member, then of each spring.
    pub(crate) fn with_factors(&self, factors: &[f64]) -> Self {
        let mut found = self.clone();
        let (of_members, of_springs) = factors.split_at(self.members.len());
        for (member, factor) in found.members.iter_mut().zip(of_members) {
            member.stiffen(*factor);
        }
        for (spring, factor) in found.springs.iter_mut().zip(of_springs) {
            spring.stiffness *= factor;
        }
        found
    }

    /// Calls `add(row, column, value)` for all entries; entries repeat.
    pub(crate) fn for_each_stiffness(&self, mut add: impl FnMut(usize, usize, f64)) {
        for member in &self.members {
            member.for_each_stiffness(&mut add);
        }
        for spring in &self.springs {
            spring.for_each_stiffness(&mut add);
        }
    }

    /// Half the mean length of a member: by it, rotations count as translations.
    pub(crate) fn arm(&self) -> f64 {
        let lengths: f64 = self.members.iter().map(|member| member.length).sum();
        0.5 * lengths / self.members.len().max(1) as f64
    }

    pub(crate) fn diagonal(&self) -> Result<Vec<f64>> {
        let mut diagonal = vec![0.0; self.dofs];
        self.for_each_stiffness(|row, column, value| {
            if row == column {
                diagonal[row] += value;
            }
        });
        match diagonal.iter().position(|value: &f64| !value.is_finite()) {
            None => Ok(diagonal),
            Some(dof) => Err(Error::invalid(format!(
                "the stiffness at node {} overflows; check the members and springs there",
                dof / 6
            ))),
        }
    }

    /// Forces of the nodes on elements without loads, each with a factor on its stiffness.
    pub(crate) fn elastic_forces(
        &self,
        displacements: &[f64],
        factor: impl Fn(usize) -> f64,
    ) -> Vec<f64> {
        let mut total = vec![0.0; self.dofs];
        for (element, member) in self.members.iter().enumerate() {
            let forces = member.end_forces(displacements, &Vector12::zeros());
            let factor = factor(element);
            member.for_each_force(&forces, |dof, force| total[dof] += factor * force);
        }
        for (spring, element) in self.springs.iter().zip(self.members.len()..) {
            let factor = factor(element);
            spring.for_each_force(displacements, |dof, force| total[dof] += factor * force);
        }
        total
    }

    /// Twice the strain energy of a motion, each element with a factor on its stiffness: members
    /// before springs.
    pub(crate) fn energy(&self, displacements: &[f64], factor: impl Fn(usize) -> f64) -> f64 {
        let energies = self.energies(displacements).enumerate();
        energies
            .map(|(element, energy)| factor(element) * energy)
            .sum()
    }

    /// The same of every element.
    pub(crate) fn energies(&self, displacements: &[f64]) -> impl Iterator<Item = f64> {
        let of_members = self
            .members
            .iter()
            .map(|member| member.energy(displacements));
        let of_springs = self.springs.iter().map(|spring| {
            let terms = spring.terms();
            let elongation: f64 = terms.map(|(dof, sign)| sign * displacements[dof]).sum();
            spring.stiffness * elongation * elongation
        });
        of_members.chain(of_springs)
    }

    /// Forces of the nodes on members and springs: K u + fixed-end forces.
    pub(crate) fn internal_forces(
        &self,
        displacements: &[f64],
        fixed_end: &[Vector12],
    ) -> Vec<f64> {
        let ends = self.members.iter().zip(fixed_end);
        let ends = ends.map(|(member, fixed_end)| member.end_forces(displacements, fixed_end));
        self.sum_forces(displacements, ends)
    }

    /// The same from the local end forces of all members.
    pub(crate) fn sum_forces(
        &self,
        displacements: &[f64],
        ends: impl Iterator<Item = Vector12>,
    ) -> Vec<f64> {
        let mut total = vec![0.0; self.dofs];
        for (member, ends) in self.members.iter().zip(ends) {
            if ends.iter().any(|&force| force != 0.0) {
                member.for_each_force(&ends, |dof, force| total[dof] += force);
            }
        }
        for spring in &self.springs {
            spring.for_each_force(displacements, |dof, force| total[dof] += force);
        }
        total
    }
}
