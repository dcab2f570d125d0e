//! Samples by `BatchSolver`, and the same by `respond`.

use rga_core::{Array, BatchSolver, Loads, Result, Samples, respond};

use super::*;

/// Numbers in 0..1, the same in every run.
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    pub fn many(&mut self, count: usize, low: f64, high: f64) -> Vec<f64> {
        (0..count).map(|_| self.between(low, high)).collect()
    }
}

/// `patterns` are one structure under several loads.
pub fn batch_solver(patterns: &[Case], outputs: &[Output]) -> Result<BatchSolver> {
    batch_solver_with(patterns, outputs, None)
}

/// The same with one of `instructions()`.
pub fn batch_solver_with(
    patterns: &[Case],
    outputs: &[Output],
    instructions: Option<&str>,
) -> Result<BatchSolver> {
    fn flat<T: Copy, const N: usize>(rows: impl Iterator<Item = [T; N]>) -> Vec<T> {
        rows.flatten().collect()
    }
    let (p, n, m) = (
        patterns.len(),
        patterns[0].nodes.len(),
        patterns[0].ends.len(),
    );
    let forces = flat(patterns.iter().flat_map(|case| case.forces.iter().copied()));
    let strain = flat(patterns.iter().flat_map(|case| case.strain.iter().copied()));
    let prescribed = flat(
        patterns
            .iter()
            .flat_map(|case| case.prescribed.iter().copied()),
    );
    let inclined: Vec<f64> = (patterns.iter())
        .flat_map(|case| case.inclined.iter().map(|support| support.2))
        .collect();
    let listed: Vec<_> = (patterns.iter().enumerate())
        .flat_map(|(at, case)| case.member_loads.iter().map(move |load| (at as i64, *load)))
        .collect();
    let pattern: Vec<i64> = listed.iter().map(|load| load.0).collect();
    let index: Vec<i64> = listed.iter().map(|load| load.1.0).collect();
    let axis: Vec<i64> = listed.iter().map(|load| load.1.1).collect();
    let from: Vec<f64> = listed.iter().map(|load| load.1.2).collect();
    let to: Vec<f64> = listed.iter().map(|load| load.1.3).collect();
    let start: Vec<f64> = listed.iter().map(|load| load.1.4).collect();
    let end: Vec<f64> = listed.iter().map(|load| load.1.5).collect();
    let (per_dof, per_member) = ([p, n, 6], [p, m, 3]);
    let per_support = [p, patterns[0].inclined.len()];
    let per_load = [listed.len()];
    let loads = Loads {
        forces: Array::new(&forces, &per_dof),
        strain: Array::new(&strain, &per_member),
        prescribed: Array::new(&prescribed, &per_dof),
        prescribed_inclined: Array::new(&inclined, &per_support),
        member_pattern: Array::new(&pattern, &per_load),
        member_index: Array::new(&index, &per_load),
        member_axis: Array::new(&axis, &per_load),
        member_from: Array::new(&from, &per_load),
        member_to: Array::new(&to, &per_load),
        member_start: Array::new(&start, &per_load),
        member_end: Array::new(&end, &per_load),
    };
    patterns[0].lend(outputs, |structure, _, outputs| {
        BatchSolver::new(structure, &loads, outputs, instructions)
    })
}

/// The same by `respond`, with scaled moduli and springs.
pub fn expected(
    patterns: &[Case],
    outputs: &[Output],
    factors: &[f64],
    coefficients: &[f64],
) -> Result<Vec<f64>> {
    let mut sum = patterns[0].clone();
    sum.member_loads.clear();
    for (at, (case, factor)) in patterns.iter().zip(coefficients).enumerate() {
        let keep = if at == 0 { 0.0 } else { 1.0 };
        for (to, from) in [
            (sum.forces.as_flattened_mut(), case.forces.as_flattened()),
            (sum.strain.as_flattened_mut(), case.strain.as_flattened()),
            (
                sum.prescribed.as_flattened_mut(),
                case.prescribed.as_flattened(),
            ),
        ] {
            for (to, from) in to.iter_mut().zip(from) {
                *to = keep * *to + factor * from;
            }
        }
        for (to, from) in sum.inclined.iter_mut().zip(&case.inclined) {
            to.2 = keep * to.2 + factor * from.2;
        }
        for &(member, axis, from, to, start, end) in &case.member_loads {
            let load = (member, axis, from, to, start * factor, end * factor);
            sum.member_loads.push(load);
        }
    }
    let (members, springs) = factors.split_at(sum.ends.len());
    for (spring, factor) in sum.springs.iter_mut().zip(springs) {
        spring.2 *= factor;
    }
    let young: Vec<f64> = members.iter().map(|factor| E * factor).collect();
    let shear: Vec<f64> = members.iter().map(|factor| G * factor).collect();
    sum.lend(outputs, |structure, loads, outputs| {
        let mut scaled = *structure;
        scaled.young.values = &young;
        scaled.shear.values = &shear;
        respond(&scaled, loads, outputs)
    })
}

/// Boxes in a row, of crooked members.
pub fn bridge(bays: i64, frame: bool) -> Case {
    let mut random = Random(5);
    let section = [[0.0, 0.0], [0.0, 2.5], [3.0, 0.0], [3.0, 2.5]];
    let nodes: Vec<[f64; 3]> = (0..=bays)
        .flat_map(|bay| section.map(|[y, z]| [3.0 * bay as f64, y, z]))
        .map(|node| node.map(|place| place + random.between(-0.2, 0.2)))
        .collect();
    let within = [[0, 1], [0, 2], [1, 3], [2, 3], [0, 3]];
    let onward = [
        [0, 4],
        [1, 5],
        [2, 6],
        [3, 7],
        [0, 5],
        [2, 7],
        [0, 6],
        [1, 7],
        [1, 4],
        [3, 6],
    ];
    let mut members = Vec::new();
    for bay in 0..=bays {
        for pair in within.iter().chain(onward.iter().filter(|_| bay < bays)) {
            members.push((pair.map(|corner| 4 * bay + corner), frame));
        }
    }
    let last = 4 * bays as usize;
    Case::new(&nodes, &members)
        .fix(0, &[0, 1, 2])
        .fix(2, &[0, 2])
        .fix(last, &[1, 2])
        .fix(last + 2, &[2])
}

/// Every kind of load on its own.
pub fn with_loads(case: &Case) -> Vec<Case> {
    let mut random = Random(7);
    let forced = (0..case.nodes.len()).fold(case.clone(), |case, node| {
        case.force(node, 2, random.between(-2e4, 0.0))
            .force(node, 0, random.between(-1e3, 1e3))
    });
    let mut warm = case.clone();
    for (strain, frame) in warm.strain.iter_mut().zip(&case.frame) {
        let gradient = if *frame { 1e-4 } else { 0.0 };
        *strain = [random.between(0.0, 3e-4), gradient, -gradient];
    }
    let mut settled = case.clone();
    settled.prescribed[0][2] = -4e-3;
    settled.prescribed[2][0] = 2e-3;
    for support in &mut settled.inclined {
        support.2 = 3e-3;
    }
    let loaded = case
        .clone()
        .uniform(3, 2, 1.5, -3e3)
        .point(3, 1, 0.8, 2e3)
        .uniform(6, 1, 2.0, 1e3);
    vec![forced, warm, settled, loaded]
}

pub fn all_outputs(case: &Case) -> Vec<Output> {
    let mut outputs = Vec::new();
    for node in 0..case.nodes.len() as i64 {
        outputs.extend((0..3).map(|axis| at(DISPLACEMENT, node, axis)));
        outputs.extend((0..3).map(|axis| at(ROTATION, node, axis)));
        outputs.extend((0..3).map(|axis| at(REACTION, node, axis)));
        outputs.extend((0..3).map(|axis| at(MOMENT, node, axis)));
    }
    for member in 0..case.ends.len() as i64 {
        outputs.push((STRAIN, member, -1, [0.3, 0.0, 0.0]));
        outputs.push((SECTION_FORCE, member, 0, [0.6, 0.0, 0.0]));
        outputs.extend([0, 1, 2].map(|dof| end_force(member, dof)));
    }
    outputs
}

pub fn run(
    batch: &BatchSolver,
    factors: &[f64],
    coefficients: &[f64],
    rows: usize,
    threads: usize,
) -> Result<Vec<f64>> {
    // What is too long or too short is lent as it is.
    let shape =
        |values: &[f64], width: usize| [rows, values.len().checked_div(rows).unwrap_or(width)];
    let of_factors = shape(factors, batch.elements());
    let of_coefficients = shape(coefficients, batch.patterns());
    let samples = Samples {
        factors: Array::new(factors, &of_factors),
        coefficients: Array::new(coefficients, &of_coefficients),
    };
    batch.respond(samples, threads)
}
