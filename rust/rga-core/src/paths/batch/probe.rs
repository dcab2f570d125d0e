//! What a system is read off: the stiffness of its elements, and how these answer unit motions
//! and load patterns.

use super::bilinear::Entry;
use super::system::Weights;
use crate::error::Result;
use crate::fe::constraint::Constraints;
use crate::fe::element::Vector12;
use crate::fe::load::{PatternLoads, fixed_end_forces};
use crate::fe::member::Member;
use crate::fe::model::Model;
use crate::fe::outputs::{Observer, Output, Reading, State};
use crate::fe::reduction::Reduction;
use crate::input::Loads;

/// End connections that yield do not scale with their member: it keeps the weight one.
fn weight_of(member: &Member, index: usize, weights: &Weights) -> usize {
    if member.is_proportional() {
        index
    } else {
        weights.one()
    }
}

/// K, entry by entry.
pub(super) fn stiffness(model: &Model, reduction: &Reduction, weights: &Weights) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |weight: usize, row: usize, column: usize, value: f64| {
        if value == 0.0 {
            return;
        }
        for &(row, left) in reduction.entries(row) {
            for &(column, right) in reduction.entries(column) {
                let value = left * value * right;
                entries.push(Entry {
                    weight,
                    row,
                    column,
                    value,
                });
            }
        }
    };
    for (index, member) in model.members.iter().enumerate() {
        let weight = weight_of(member, index, weights);
        member.for_each_stiffness(|row, column, value| add(weight, row, column, value));
    }
    for (index, spring) in model.springs.iter().enumerate() {
        let weight = weights.members + index;
        spring.for_each_stiffness(|row, column, value| add(weight, row, column, value));
    }
    entries
}

/// Elements under unit motions and under the load patterns.
pub(super) struct Probe<'a> {
    model: &'a Model,
    constraints: &'a Constraints,
    reduction: &'a Reduction,
    loads: &'a Loads<'a>,
    weights: Weights,
    member_loads: Vec<PatternLoads>,
    /// With all unknowns at zero, of each pattern.
    base: Vec<Vec<f64>>,
}

impl<'a> Probe<'a> {
    pub(super) fn new(
        model: &'a Model,
        constraints: &'a Constraints,
        reduction: &'a Reduction,
        loads: &'a Loads<'a>,
        weights: Weights,
    ) -> Result<Self> {
        let base = |pattern| {
            let values = constraints.values(loads, pattern)?;
            Ok(constraints.base_displacements(&values))
        };
        Ok(Self {
            model,
            constraints,
            reduction,
            loads,
            weights,
            member_loads: PatternLoads::group(loads, model.members.len()),
            base: (0..loads.pattern_count())
                .map(base)
                .collect::<Result<_>>()?,
        })
    }

    /// Forces on all dofs that balance nothing yet, `add(weight, dof, pattern, force)`: what is
    /// applied, minus what elements take with all unknowns at zero.
    fn unbalanced(&self, mut add: impl FnMut(usize, usize, usize, f64)) -> Result<()> {
        let one = self.weights.one();
        for (pattern, base) in self.base.iter().enumerate() {
            for (dof, &force) in self.loads.forces.row(pattern).iter().enumerate() {
                add(one, dof, pattern, force);
            }
            let strain = self.loads.strain.row(pattern).chunks_exact(3);
            for ((index, member), strain) in self.model.members.iter().enumerate().zip(strain) {
                let elastic = fixed_end_forces(member, index, strain, &[])?;
                let elastic = member.end_forces(base, &elastic);
                let weight = weight_of(member, index, &self.weights);
                member.for_each_force(&elastic, |dof, force| add(weight, dof, pattern, -force));
                let spread = self.member_loads[pattern].of(index);
                if !spread.is_empty() {
                    let fixed = fixed_end_forces(member, index, &[0.0; 3], spread)?;
                    member.for_each_force(&fixed, |dof, force| add(one, dof, pattern, -force));
                }
            }
            for (index, spring) in self.model.springs.iter().enumerate() {
                let weight = self.weights.members + index;
                spring.for_each_force(base, |dof, force| add(weight, dof, pattern, -force));
            }
        }
        Ok(())
    }

    /// On the unknowns, and on rotations that are held.
    pub(super) fn loads(&self) -> Result<(Vec<Entry>, Vec<Entry>)> {
        let mut held = vec![None; self.model.dofs];
        for (row, &dof) in self.reduction.held.iter().enumerate() {
            held[dof] = Some(row);
        }
        let (mut on_unknowns, mut on_held) = (Vec::new(), Vec::new());
        self.unbalanced(|weight, dof, column, force| {
            if force == 0.0 {
                return;
            }
            let entry = |row: usize, value: f64| Entry {
                weight,
                row,
                column,
                value,
            };
            let unknowns = self.reduction.entries(dof).iter();
            on_unknowns.extend(unknowns.map(|&(row, factor)| entry(row, factor * force)));
            on_held.extend(held[dof].map(|row| entry(row, force)));
        })?;
        Ok((on_unknowns, on_held))
    }

    /// S and T.
    pub(super) fn outputs(&self, wanted: &[Output]) -> Result<(Vec<Entry>, Vec<Entry>)> {
        let mut entries = Outputs {
            probe: self,
            row: 0,
            shown: Vec::new(),
            direct: Vec::new(),
        };
        for (row, output) in wanted.iter().enumerate() {
            entries.row = row;
            match output {
                Output::Motion(motion) => {
                    for (dof, factor) in motion.terms() {
                        entries.motion(self.weights.one(), dof, factor);
                    }
                }
                Output::Member(index, reading) => entries.member(*index, reading)?,
                Output::Reaction(first, direction) => entries.reaction(*first, direction)?,
            }
        }
        Ok((entries.shown, entries.direct))
    }
}

/// Rows of S and T, one after the other.
struct Outputs<'a> {
    probe: &'a Probe<'a>,
    row: usize,
    shown: Vec<Entry>,
    direct: Vec<Entry>,
}

impl Outputs<'_> {
    fn directly(&mut self, weight: usize, column: usize, value: f64) {
        let row = self.row;
        self.direct.push(Entry {
            weight,
            row,
            column,
            value,
        });
    }

    /// `factor` times the displacement of a dof.
    fn motion(&mut self, weight: usize, dof: usize, factor: f64) {
        self.moved(weight, dof, factor);
        for (pattern, base) in self.probe.base.iter().enumerate() {
            self.directly(weight, pattern, factor * base[dof]);
        }
    }

    fn member(&mut self, index: usize, reading: &Reading) -> Result<()> {
        let Probe {
            model,
            constraints,
            loads,
            weights,
            ..
        } = *self.probe;
        let member = &model.members[index];
        let own = weight_of(member, index, &weights);
        // A strain is a force over a stiffness that has the same factor.
        let (elastic, spread) = match reading {
            Reading::Strain(..) if own == index => (weights.one(), weights.inverse(index)),
            Reading::Strain(..) => (weights.one(), weights.one()),
            _ => (own, weights.one()),
        };
        let observer = Observer::new(model, constraints, &[]);
        let unloaded = PatternLoads::none(model.members.len());
        let still = vec![0.0; 3 * model.members.len()];
        let mut state = State {
            loads: &unloaded,
            strain: &still,
            forces: &[],
            fixed_end: vec![Vector12::zeros(); model.members.len()],
            displacements: vec![0.0; model.dofs],
            unbalanced: Vec::new(),
            deformed: None,
        };
        for node in member.nodes {
            for dof in 6 * node..6 * node + 6 {
                state.displacements[dof] = 1.0;
                let value = observer.member(&state, index, reading);
                state.displacements[dof] = 0.0;
                self.motion(elastic, dof, value);
            }
        }
        for pattern in 0..loads.pattern_count() {
            let strain = loads.strain.row(pattern);
            let of_member = &strain[3 * index..3 * index + 3];
            state.strain = strain;
            state.fixed_end[index] = fixed_end_forces(member, index, of_member, &[])?;
            let value = observer.member(&state, index, reading);
            self.directly(elastic, pattern, value);
            let own_loads = &self.probe.member_loads[pattern];
            state.strain = &still;
            state.loads = own_loads;
            state.fixed_end[index] =
                fixed_end_forces(member, index, &[0.0; 3], own_loads.of(index))?;
            let value = observer.member(&state, index, reading);
            self.directly(spread, pattern, value);
            state.loads = &unloaded;
        }
        Ok(())
    }

    /// What supports and springs to the ground take: the internal forces there less what is applied.
    fn reaction(&mut self, first: usize, direction: &[f64; 3]) -> Result<()> {
        let Probe {
            model,
            constraints,
            weights,
            ..
        } = *self.probe;
        let mut share = vec![0.0; model.dofs];
        for (dof, weight) in constraints.support_weights(first, direction) {
            share[dof] = weight;
        }
        for (index, member) in model.members.iter().enumerate() {
            let weight = weight_of(member, index, &weights);
            let dofs = member.nodes.map(|node| 6 * node..6 * node + 6);
            if dofs
                .clone()
                .into_iter()
                .flatten()
                .all(|dof| share[dof] == 0.0)
            {
                continue;
            }
            let mut unit = vec![0.0; model.dofs];
            for dof in dofs.into_iter().flatten() {
                unit[dof] = 1.0;
                let mut value = 0.0;
                let forces = member.end_forces(&unit, &Vector12::zeros());
                member.for_each_force(&forces, |at, force| value += share[at] * force);
                unit[dof] = 0.0;
                self.moved(weight, dof, value);
            }
        }
        for (index, spring) in model.springs.iter().enumerate() {
            let weight = weights.members + index;
            for (dof, factor) in spring.terms() {
                let value: f64 = spring
                    .terms()
                    .map(|(at, sign)| share[at] * sign * spring.stiffness * factor)
                    .sum();
                self.moved(weight, dof, value);
            }
            if spring.other.is_none() && (first..first + 3).contains(&spring.dof) {
                let factor = -direction[spring.dof - first] * spring.stiffness;
                self.motion(weight, spring.dof, factor);
            }
        }
        let row = self.row;
        let direct = &mut self.direct;
        self.probe.unbalanced(|weight, dof, column, force| {
            if force != 0.0 && share[dof] != 0.0 {
                direct.push(Entry {
                    weight,
                    row,
                    column,
                    value: -share[dof] * force,
                });
            }
        })
    }

    /// As `motion`, of the unknowns alone.
    fn moved(&mut self, weight: usize, dof: usize, factor: f64) {
        let row = self.row;
        let unknowns = self.probe.reduction.entries(dof).iter();
        self.shown.extend(unknowns.map(|&(column, part)| Entry {
            weight,
            row,
            column,
            value: factor * part,
        }));
    }
}
