//! Frame members that differ: a few of them beside a structure that is solved.
//!
//! Members of stiffness K + D with ends displaced by u act like those of stiffness K with the
//! forces D u on their nodes taken off.

use nalgebra::{DMatrix, Matrix3, SymmetricEigen};

use super::{Loaded, LoadedPattern, Reanalysis, take};
use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::element::Vector12;
use crate::fe::load::{PatternLoads, fixed_end_forces};
use crate::fe::member::Member;
use crate::fe::model::Model;
use crate::fe::outputs::{Observer, Output, State};
use crate::input::Structure;
use crate::validate::structure::check_structure;

/// Share of a node's largest stiffness against turning that counts as none.
const LOOSE: f64 = 1e-9;

/// What unit forces and moments on the nodes of frame members do.
#[derive(Debug, Clone)]
pub(super) struct EndForces {
    /// `[6 nodes, o]`
    outputs: Vec<f64>,
    /// Of the same nodes, `[6 nodes, 6 nodes]`
    displacements: Vec<f64>,
}

/// Frame members cut out, each with two nodes of its own.
struct Cut {
    model: Model,
}

impl Reanalysis {
    /// Outputs `[p, o]` of a structure of which few frame members differ.
    pub(super) fn with_frames(
        &self,
        loaded: &Loaded,
        other: &Structure,
        frames: &[usize],
    ) -> Result<Vec<f64>> {
        check_structure(other)?;
        let forced = self.end_forces.get_or_init(|| self.under_end_forces());
        let forced = forced.as_ref().map_err(Clone::clone)?;
        let own = frames
            .iter()
            .map(|&at| Ok(self.analysis.model.members[at].clone()));
        let before = Cut::new(own)?;
        let after = Cut::new(frames.iter().map(|&at| Member::new(other, at)))?;
        let ends: Vec<usize> = (frames.iter())
            .flat_map(|&at| self.analysis.model.members[at].nodes)
            .flat_map(|node| {
                let first = 6 * self.nodes.partition_point(|&other| other < node);
                first..first + 6
            })
            .collect();
        let (size, all, width) = (ends.len(), 6 * self.nodes.len(), self.wanted.len());
        let flexibility = DMatrix::from_fn(size, size, |row, column| {
            forced.displacements[ends[column] * all + ends[row]]
        });
        let stiffer = after.stiffness() - before.stiffness();
        let count = loaded.patterns.len();
        let mut more = DMatrix::zeros(size, count);
        let mut moved = DMatrix::zeros(size, count);
        let loads: Vec<CutLoads> = (loaded.patterns.iter())
            .map(|pattern| CutLoads::new(pattern, frames))
            .collect();
        for (column, (own, pattern)) in loads.iter().zip(&loaded.patterns).enumerate() {
            let forces = after.held_forces(own, frames)?;
            let forces = forces.iter().zip(before.held_forces(own, frames)?);
            for (row, (after, before)) in forces.enumerate() {
                more[(row, column)] = after - before;
                moved[(row, column)] = pattern.displacements[ends[row]];
            }
        }
        moved -= &flexibility * &more;
        let matrix = DMatrix::identity(size, size) + flexibility * &stiffer;
        if !matrix.lu().solve_mut(&mut moved) {
            return Err(Error::DependentTerms);
        }
        let taken_off = &stiffer * &moved + more;
        let mut found = loaded.outputs();
        if width == 0 {
            return Ok(found);
        }
        for (column, shown) in found.chunks_exact_mut(width).enumerate() {
            for (row, end) in ends.iter().enumerate() {
                take(
                    shown,
                    taken_off[(row, column)],
                    &forced.outputs[end * width..],
                );
            }
            let displacements: Vec<f64> = moved.column(column).iter().copied().collect();
            let after = after.read(&self.wanted, frames, &loads[column], &displacements)?;
            let before = before.read(&self.wanted, frames, &loads[column], &displacements)?;
            for ((at, after), (_, before)) in after.into_iter().zip(before) {
                shown[at] += after - before;
            }
        }
        Ok(found)
    }

    /// The structure under unit forces on the nodes of frame members, and unit moments about the
    /// axes that a member stiffens.
    fn under_end_forces(&self) -> Result<EndForces> {
        let units = self.stiffened();
        let (all, width) = (6 * self.nodes.len(), self.wanted.len());
        let mut found = EndForces {
            outputs: vec![0.0; all * width],
            displacements: vec![0.0; all * all],
        };
        let push = |number: usize, forces: &mut [f64]| {
            let (place, unit) = &units[number];
            let first = 6 * self.nodes[*place];
            forces[first..first + 6].copy_from_slice(unit);
        };
        self.analysis
            .under_forces(units.len(), push, |number, state| {
                let mut read = Vec::with_capacity(width);
                self.analysis.read(&self.wanted, state, &mut read);
                let displacements = self.end_displacements(state);
                let (place, unit) = &units[number];
                for (axis, share) in unit.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                    let row = 6 * place + axis;
                    take(
                        &mut found.outputs[row * width..(row + 1) * width],
                        -share,
                        &read,
                    );
                    take(
                        &mut found.displacements[row * all..(row + 1) * all],
                        -share,
                        &displacements,
                    );
                }
                Ok(())
            })?;
        Ok(found)
    }

    /// Unit forces and moments, as (place among the nodes, six components).
    fn stiffened(&self) -> Vec<(usize, [f64; 6])> {
        let mut turning = vec![Matrix3::<f64>::zeros(); self.nodes.len()];
        for member in &self.analysis.model.members {
            let Some(frame) = &member.frame else { continue };
            let global = member.to_global(&frame.stiffness);
            for (node, first) in member.nodes.into_iter().zip([3, 9]) {
                let place = self.nodes.partition_point(|&other| other < node);
                turning[place] += global.fixed_view::<3, 3>(first, first);
            }
        }
        let mut units = Vec::with_capacity(6 * self.nodes.len());
        for (place, turning) in turning.into_iter().enumerate() {
            for axis in 0..3 {
                units.push((place, std::array::from_fn(|at| f64::from(at == axis))));
            }
            let eigen = SymmetricEigen::new(turning);
            let largest = eigen.eigenvalues.max();
            for (axis, value) in eigen.eigenvectors.column_iter().zip(&eigen.eigenvalues) {
                if *value > LOOSE * largest {
                    units.push((place, [0.0, 0.0, 0.0, axis[0], axis[1], axis[2]]));
                }
            }
        }
        units
    }
}

/// A load pattern on members that are cut out.
struct CutLoads {
    members: PatternLoads,
    strain: Vec<f64>,
}

impl CutLoads {
    fn new(pattern: &LoadedPattern, frames: &[usize]) -> Self {
        let strain = frames
            .iter()
            .flat_map(|at| &pattern.strain[3 * at..3 * at + 3]);
        Self {
            members: pattern.members.of_some(frames),
            strain: strain.copied().collect(),
        }
    }
}

impl Cut {
    fn new(members: impl Iterator<Item = Result<Member>>) -> Result<Self> {
        let own = |(at, member): (usize, Result<Member>)| {
            let nodes = [2 * at, 2 * at + 1];
            member.map(|member| Member { nodes, ..member })
        };
        let members: Vec<Member> = members.enumerate().map(own).collect::<Result<_>>()?;
        Ok(Self {
            model: Model {
                nodes: Vec::new(),
                dofs: 12 * members.len(),
                members,
                springs: Vec::new(),
            },
        })
    }

    /// Forces of the nodes by displacements of the ends, in global axes.
    fn stiffness(&self) -> DMatrix<f64> {
        let mut stiffness = DMatrix::zeros(self.model.dofs, self.model.dofs);
        self.model
            .for_each_stiffness(|row, column, value| stiffness[(row, column)] += value);
        stiffness
    }

    /// Forces of the nodes under loads with ends that do not move, in global axes.
    fn held_forces(&self, loads: &CutLoads, frames: &[usize]) -> Result<Vec<f64>> {
        let still = vec![0.0; self.model.dofs];
        Ok(self
            .model
            .internal_forces(&still, &self.fixed_end(loads, frames)?))
    }

    /// What outputs read of the members, by their numbers.
    fn read(
        &self,
        wanted: &[Output],
        frames: &[usize],
        loads: &CutLoads,
        displacements: &[f64],
    ) -> Result<Vec<(usize, f64)>> {
        let constraints = Constraints::default();
        let observer = Observer::new(&self.model, &constraints, &[]);
        let state = State {
            loads: &loads.members,
            strain: &loads.strain,
            forces: &[],
            fixed_end: self.fixed_end(loads, frames)?,
            displacements: displacements.to_vec(),
            unbalanced: Vec::new(),
            deformed: None,
        };
        let outputs = wanted.iter().enumerate();
        let read = outputs.filter_map(|(at, output)| match output {
            Output::Member(index, reading) => {
                let own = frames.iter().position(|frame| frame == index)?;
                Some((at, observer.member(&state, own, reading)))
            }
            _ => None,
        });
        Ok(read.collect())
    }

    fn fixed_end(&self, loads: &CutLoads, frames: &[usize]) -> Result<Vec<Vector12>> {
        let members = self.model.members.iter().zip(frames).enumerate();
        members
            .map(|(at, (member, &frame))| {
                let strain = &loads.strain[3 * at..3 * at + 3];
                fixed_end_forces(member, frame, strain, loads.members.of(at))
            })
            .collect()
    }
}
