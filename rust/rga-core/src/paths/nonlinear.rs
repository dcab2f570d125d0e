//! Samples in the equilibrium of the deformed structure (C4).
//!
//! Loads do not superpose here: each row takes the sum of its load patterns, and Newton's method
//! finds its equilibrium. The load grows from nothing in levels, so that the state found is the
//! one that the structure reaches. A level is taken where corrections are small beside its step
//! (Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 5.1) and the flexibility to
//! it changes little (the current stiffness parameter of Bergan et al., Solution techniques for
//! non-linear finite element problems, IJNME 12, 1978); most rows need one level. A tangent that
//! is not positive definite on the way means that the structure buckles or snaps through.
//!
//! The tension in the tangent is the one that the step before led to expect, as if tensions were
//! unknowns of their own: the residual is the same, and a slender member that bends far in a step
//! is not stiffened by a stretch that the next step takes back (Magisano, Leonetti and Garcea,
//! Advantages of the mixed format in geometrically nonlinear analysis of beams and shells using
//! solid finite elements, IJNME 109, 2017).

mod load_combination;
mod tangent_placement;

use rga_simd::Array;

use crate::error::{Error, Result};
use crate::fe::constraint::Constraints;
use crate::fe::deformed_member::{Deformed, Flexible};
use crate::fe::element::Vector12;
use crate::fe::equilibrium::Equilibrium;
use crate::fe::load::fixed_end_forces;
use crate::fe::model::Model;
use crate::fe::outputs::{Observer, Output, State, read_outputs};
use crate::fe::reduction::Reduction;
use crate::fe::stability::Solver;
use crate::input::{Loads, Outputs, Structure};
use crate::paths::parallel::in_chunks;
use crate::sparse::ordering::OFTEN;
use crate::validate::arrays::{CheckNumbers, CheckShape};
use crate::validate::loads::check_loads;
use crate::validate::outputs::check_outputs;
use crate::validate::structure::check_structure;
use load_combination::{Combination, Combined};
use tangent_placement::{TangentPlacement, listed};

/// Rows that a thread takes at a time.
const CHUNK: usize = 4;

/// A correction below this part of motions and forces is the last: Newton's method squares it.
const TIGHT: f64 = 1e-10;

/// Corrections that no longer shrink are rounding below this part.
const ROUNDING: f64 = 1e-6;

/// A residual above this part of motions and forces is refused.
const REFUSE: f64 = 1e-9;

/// Largest correction of a level, beside its step.
const LARGEST: f64 = 0.25;

/// Corrections that shrink less than this have come to rounding, or do not converge.
const SHRINKING: f64 = 0.5;

/// Largest ratio of the flexibilities before and after a step.
const CHANGE: f64 = 2.0;

const CORRECTIONS: usize = 12;

/// Smallest step of the load, as a part of it: what is soft until it is tight begins with such.
const SMALLEST_STEP: f64 = 1e-12;

const LEVELS: usize = 1000;

struct Analysis {
    model: Model,
    flexible: Vec<Flexible>,
    constraints: Constraints,
    reduction: Reduction,
    placement: TangentPlacement,
    /// Of the unloaded structure; nothing where it moves freely before it is stretched.
    rest: Option<Solver>,
    /// Analysed, not factorised.
    solver: Solver,
    combination: Combination,
    wanted: Vec<Output>,
    arm: f64,
}

/// What a thread needs for a sample.
struct Scratch {
    solver: Solver,
    load: Combined,
    /// Without that of the axial strain.
    fixed_end: Vec<Vector12>,
    deformed: Vec<Deformed>,
    /// Of each member, in the tangent.
    tensions: Vec<f64>,
    displacements: Vec<f64>,
    /// Applied minus internal forces.
    unbalanced: Vec<f64>,
    /// Of the unknowns.
    residual: Vec<f64>,
    /// Sums of the sizes of all forces on the unknowns, against which a residual counts.
    sizes: Vec<f64>,
}

/// Outputs `[rows, outputs]` in C order; the load of a row is the sum of all patterns times its
/// `coefficients` `[rows, patterns]`.
pub fn respond_nonlinear(
    structure: &Structure,
    loads: &Loads,
    outputs: &Outputs,
    coefficients: Array<f64>,
    threads: usize,
) -> Result<Vec<f64>> {
    check_structure(structure)?;
    check_loads(structure, loads)?;
    check_outputs(structure, outputs)?;
    let rows = coefficients.len();
    coefficients.check_shape("coefficients", &[rows, loads.pattern_count()])?;
    coefficients.check_finite("coefficients")?;
    let analysis = Analysis::new(structure, loads, outputs)?;
    // Without outputs the rows are still solved: one place a row, left empty.
    let width = analysis.wanted.len();
    let place = width.max(1);
    let mut results = vec![0.0; rows * place];
    in_chunks(
        &mut results,
        place,
        CHUNK,
        threads,
        || analysis.scratch(),
        |scratch, own, part| {
            for (row, shown) in own.zip(part.chunks_exact_mut(place)) {
                let read = (analysis.sample(scratch, coefficients.row(row)))
                    .map_err(|error| error.of_row(row))?;
                shown[..width].copy_from_slice(&read);
            }
            Ok(())
        },
    )?;
    results.truncate(rows * width);
    Ok(results)
}

impl Analysis {
    fn new(structure: &Structure, loads: &Loads, outputs: &Outputs) -> Result<Self> {
        let model = Model::new(structure)?;
        let constraints = Constraints::new(structure);
        let reduction = Reduction::new(&constraints, &model.diagonal()?);
        let (placement, matrix) = TangentPlacement::new(&model, &reduction);
        let places = reduction.places(&model.nodes);
        let solver = Solver::analyse(matrix, Vec::new(), &places, OFTEN)?;
        let mut analysis = Self {
            flexible: model.members.iter().map(Flexible::new).collect(),
            combination: Combination::new(loads, &constraints, model.members.len())?,
            wanted: read_outputs(outputs),
            rest: None,
            arm: model.arm(),
            model,
            constraints,
            reduction,
            placement,
            solver,
        };
        let mut scratch = analysis.scratch()?;
        let still = vec![0.0; analysis.reduction.unknowns.len()];
        let nothing = vec![0.0; loads.pattern_count()];
        analysis.load(&mut scratch, &nothing, &nothing)?;
        if analysis.balance(&mut scratch, &still) {
            scratch.take_tensions();
            if analysis.factorise(&mut scratch) {
                analysis.rest = Some(scratch.solver);
            }
        }
        Ok(analysis)
    }

    fn scratch(&self) -> Result<Scratch> {
        let (dofs, size) = (self.model.dofs, self.reduction.unknowns.len());
        Ok(Scratch {
            solver: self.solver.another()?,
            load: self.combination.room(),
            fixed_end: Vec::new(),
            deformed: Vec::new(),
            tensions: Vec::new(),
            displacements: vec![0.0; dofs],
            unbalanced: Vec::new(),
            residual: vec![0.0; size],
            sizes: Vec::new(),
        })
    }

    fn sample(&self, scratch: &mut Scratch, coefficients: &[f64]) -> Result<Vec<f64>> {
        let unknowns = self.follow(scratch, coefficients)?;
        self.load(scratch, coefficients, coefficients)?;
        let finite = self.balance(scratch, &unknowns);
        let residual = scratch.solver.force_norm(&scratch.residual);
        // Written so that NaN is refused as well.
        if !(finite && residual <= REFUSE * scratch.size(&unknowns)) {
            return Err(Error::invalid(
                "the equilibrium of the deformed structure is not found to 1e-9; check the sizes \
                 of loads and stiffnesses",
            ));
        }
        let state = State {
            loads: &scratch.load.members,
            strain: &scratch.load.strain,
            forces: &scratch.load.forces,
            fixed_end: Vec::new(),
            displacements: scratch.displacements.clone(),
            unbalanced: scratch.unbalanced.clone(),
            deformed: Some(&scratch.deformed),
        };
        let equilibrium = Equilibrium {
            model: &self.model,
            reduction: &self.reduction,
            solver: &scratch.solver,
        };
        equilibrium.check_loose(&state, "the load")?;
        let mut read = Vec::with_capacity(self.wanted.len());
        Observer::new(&self.model, &self.constraints, &self.wanted).read(&state, &mut read);
        match read.iter().position(|value| !value.is_finite()) {
            None => Ok(read),
            Some(at) => Err(Error::invalid(format!(
                "output {at} overflows; check the sizes of loads and stiffnesses"
            ))),
        }
    }

    /// The unknowns under the whole load, reached from none.
    fn follow(&self, scratch: &mut Scratch, coefficients: &[f64]) -> Result<Vec<f64>> {
        let mut unknowns = vec![0.0; self.reduction.unknowns.len()];
        let (mut level, mut step) = (0.0, 1.0);
        for _ in 0..LEVELS {
            if step < SMALLEST_STEP {
                break;
            }
            let next = f64::min(level + step, 1.0);
            match self.advance(scratch, coefficients, (level, next), &unknowns)? {
                Some(found) if next == 1.0 => return Ok(found),
                Some(found) => {
                    unknowns = found;
                    level = next;
                    step *= 2.0;
                }
                None => step = 0.5 * (next - level),
            }
        }
        Err(self.gives_way(scratch, coefficients, level, &unknowns)?)
    }

    /// From the equilibrium at one level of the load to that at the next, or nothing where that
    /// is too far.
    fn advance(
        &self,
        scratch: &mut Scratch,
        coefficients: &[f64],
        (level, next): (f64, f64),
        from: &[f64],
    ) -> Result<Option<Vec<f64>>> {
        let at_rest = level == 0.0;
        if !at_rest {
            self.load_part(scratch, coefficients, level)?;
            if !self.balance(scratch, from) {
                return Ok(None);
            }
            scratch.take_tensions();
            if !self.factorise(scratch) {
                return Ok(None);
            }
        }
        self.load_part(scratch, coefficients, next)?;
        if !self.balance(scratch, from) {
            return Ok(None);
        }
        scratch.take_tensions();
        let mut step = scratch.residual.clone();
        match &self.rest {
            Some(rest) if at_rest => rest.solve(&mut step)?,
            // What only its tension holds is held by that of this level.
            None if at_rest && !self.factorise(scratch) => return Ok(None),
            _ => scratch.solver.solve(&mut step)?,
        }
        let increment = scratch.residual.clone();
        let flexibility = dot(&step, &increment);
        let mut unknowns = from.to_vec();
        let mut correction = step.clone();
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.expect(scratch, &correction);
            unknowns = sum(&unknowns, &correction);
            if !self.balance(scratch, &unknowns) || !self.factorise(scratch) {
                return Ok(None);
            }
            correction.copy_from_slice(&scratch.residual);
            scratch.solver.solve(&mut correction)?;
            let (change, size) = (
                scratch.solver.motion_norm(&correction),
                scratch.size(&unknowns),
            );
            let settled = change > SHRINKING * before && change <= ROUNDING * size;
            if change <= TIGHT * size || settled {
                let mut after = increment.clone();
                scratch.solver.solve(&mut after)?;
                let after = dot(&after, &increment);
                let steady = after <= CHANGE * flexibility && flexibility <= CHANGE * after;
                return Ok(steady.then(|| sum(&unknowns, &correction)));
            }
            if self.reach(&correction) > LARGEST * self.reach(&step) {
                return Ok(None);
            }
            before = change;
        }
        Ok(None)
    }

    /// The error for a load that is carried up to a level only.
    fn gives_way(
        &self,
        scratch: &mut Scratch,
        coefficients: &[f64],
        level: f64,
        unknowns: &[f64],
    ) -> Result<Error> {
        self.load_part(scratch, coefficients, level)?;
        self.balance(scratch, unknowns);
        scratch.take_tensions();
        self.factorise(scratch);
        let named = scratch.solver.unstable(&self.model, &self.reduction);
        Ok(match named {
            Error::UnstableStructure {
                node,
                dof,
                direction,
            } if self.rest.is_some() || level > 0.0 => Error::Buckled {
                share: self.shares(level)[0],
                node,
                dof,
                direction,
            },
            other => other,
        })
    }

    fn load_part(&self, scratch: &mut Scratch, coefficients: &[f64], level: f64) -> Result<()> {
        let part =
            |share: f64| -> Vec<f64> { coefficients.iter().map(|value| share * value).collect() };
        let [forces, strains] = self.shares(level).map(part);
        self.load(scratch, &forces, &strains)
    }

    /// Of forces, and of initial strains and prescribed displacements: together, but the latter
    /// before where only tension holds the structure.
    fn shares(&self, level: f64) -> [f64; 2] {
        match &self.rest {
            Some(_) => [level, level],
            None => [(2.0 * level - 1.0).max(0.0), (2.0 * level).min(1.0)],
        }
    }

    fn load(&self, scratch: &mut Scratch, forces: &[f64], strains: &[f64]) -> Result<()> {
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
    fn balance(&self, scratch: &mut Scratch, unknowns: &[f64]) -> bool {
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
    fn expect(&self, scratch: &mut Scratch, motion: &[f64]) {
        let mut moved = vec![0.0; self.model.dofs];
        self.reduction.expand(motion, &mut moved);
        let members = self.model.members.iter().zip(&self.flexible);
        let states = members.zip(&scratch.deformed);
        scratch.tensions = states
            .map(|((member, flexible), deformed)| flexible.tension_ahead(member, deformed, &moved))
            .collect();
    }

    /// Size of a motion of the unknowns.
    fn reach(&self, motion: &[f64]) -> f64 {
        let lever = |dof: usize| if dof % 6 < 3 { 1.0 } else { self.arm };
        let terms = self.reduction.unknowns.iter().zip(motion);
        let squares = terms.map(|(&dof, motion)| (motion * lever(dof)).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// The tangent stiffness; false where it is not positive definite.
    fn factorise(&self, scratch: &mut Scratch) -> bool {
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
    fn take_tensions(&mut self) {
        let tensions = self.deformed.iter().map(|member| member.tension);
        self.tensions = tensions.collect();
    }

    /// Of motions and forces, in the scale of the solver.
    fn size(&self, unknowns: &[f64]) -> f64 {
        self.solver.motion_norm(unknowns) + self.solver.force_norm(&self.sizes)
    }
}

fn sum(left: &[f64], right: &[f64]) -> Vec<f64> {
    left.iter().zip(right).map(|(a, b)| a + b).collect()
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(a, b)| a * b).sum()
}
