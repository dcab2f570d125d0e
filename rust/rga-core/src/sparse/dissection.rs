//! Nested dissection by place: a fill-reducing order for large structures.
//!
//! A region is cut where few unknowns part two halves; these come last, and each half is cut again
//! (George, Nested dissection of a regular finite element mesh, SIAM J. Numer. Anal. 10, 1973).
//! Structures tell their places, so that a cut is a plane through the middle: the best of thirteen,
//! across the axes and across diagonals.

use crate::sparse::graph::Graph;
use crate::sparse::minimum_degree::minimum_degree;

/// Regions of so few unknowns are ordered by minimum degree.
const SMALL: usize = 200;

/// Normals of the planes: all that do not differ in sign alone.
const NORMALS: [[f64; 3]; 13] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Places of which the middle is taken.
const SAMPLE: usize = 1000;

/// In lengths of members: places that are this close are on one side of a plane.
const CLOSE: f64 = 1e-6;

/// Region of unknowns that parted others.
const PARTED: u32 = u32::MAX;

struct Dissection<'a> {
    graph: &'a Graph,
    /// In lengths of members along each axis, so that bays and storeys of any size are cubes.
    places: Vec<[f64; 3]>,
    /// Of each unknown, and the number of regions so far.
    region: Vec<u32>,
    regions: u32,
    /// Of each unknown, a bit for each plane: whether it is above, and whether its neighbours are
    /// on the other side.
    above: Vec<u16>,
    across: Vec<u16>,
    /// Of each unknown in a small region.
    number: Vec<usize>,
}

/// The unknowns in the order of their elimination; nothing where memory does not suffice.
pub(crate) fn dissect(graph: &Graph, places: &[[f64; 3]]) -> Option<Vec<usize>> {
    let size = graph.size();
    let mut dissection = Dissection {
        graph,
        places: in_members(graph, places),
        region: vec![0; size],
        regions: 1,
        above: vec![0; size],
        across: vec![0; size],
        number: vec![0; size],
    };
    let mut order: Vec<usize> = (0..size).collect();
    dissection.order(&mut order, 0)?;
    Some(order)
}

/// Places over the mean length of what couples them along each axis.
fn in_members(graph: &Graph, places: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut lengths = [0.0; 3];
    let mut squares = [0.0; 3];
    for (at, place) in places.iter().enumerate() {
        for neighbour in graph.neighbours(at) {
            for axis in 0..3 {
                let length = (places[neighbour][axis] - place[axis]).abs();
                lengths[axis] += length;
                squares[axis] += length * length;
            }
        }
    }
    // What couples nothing along an axis does not count towards its mean.
    let scale = |axis: usize| {
        if squares[axis] > 0.0 {
            lengths[axis] / squares[axis]
        } else {
            0.0
        }
    };
    let scales = [0, 1, 2].map(scale);
    let scaled = |place: &[f64; 3]| [0, 1, 2].map(|axis| place[axis] * scales[axis]);
    places.iter().map(scaled).collect()
}

impl Dissection<'_> {
    /// Puts the unknowns of a region in order.
    fn order(&mut self, own: &mut [usize], region: u32) -> Option<()> {
        let halves = if own.len() > SMALL {
            self.cut(own, region)
        } else {
            None
        };
        let Some([below, above]) = halves else {
            return self.order_small(own, region);
        };
        let (below, rest) = own.split_at_mut(below);
        let (above, between) = rest.split_at_mut(above);
        for &mut at in between {
            self.region[at] = PARTED;
        }
        for half in [below, above] {
            let region = self.regions;
            self.regions += 1;
            for &mut at in half.iter_mut() {
                self.region[at] = region;
            }
            self.order(half, region)?;
        }
        Some(())
    }

    /// Sorts the unknowns of a region into those below, those above and those between; the
    /// numbers of the first two. Nothing where no plane parts the region.
    fn cut(&mut self, own: &mut [usize], region: u32) -> Option<[usize; 2]> {
        let levels = self.middles(own);
        let mut sizes = [[0; 2]; NORMALS.len()];
        for &at in own.iter() {
            let mut above = 0;
            for plane in 0..NORMALS.len() {
                let side = usize::from(self.height(at, plane) > levels[plane]);
                above |= (side as u16) << plane;
                sizes[plane][side] += 1;
            }
            self.above[at] = above;
        }
        let mut faces = [[0; 2]; NORMALS.len()];
        for &at in own.iter() {
            let above = self.above[at];
            let within = self.graph.neighbours(at);
            let within = within.filter(|&neighbour| self.region[neighbour] == region);
            let across = within.fold(0, |bits, neighbour| bits | (above ^ self.above[neighbour]));
            self.across[at] = across;
            for plane in bits(across) {
                faces[plane][usize::from(above >> plane & 1)] += 1;
            }
        }
        let (plane, side) = best(&sizes, &faces)?;
        let part = |at: usize| match usize::from(self.above[at] >> plane & 1) {
            own if own == side && self.across[at] >> plane & 1 == 1 => 2,
            own => own,
        };
        let mut parts: [Vec<usize>; 3] = Default::default();
        for &at in own.iter() {
            parts[part(at)].push(at);
        }
        own.copy_from_slice(&parts.concat());
        Some([parts[0].len(), parts[1].len()])
    }

    /// Of each plane, a height that no unknown has, near the middle of the region.
    fn middles(&self, own: &[usize]) -> [f64; NORMALS.len()] {
        let step = own.len().div_ceil(SAMPLE);
        std::array::from_fn(|plane| {
            let sample = own.iter().step_by(step);
            let mut heights: Vec<f64> = sample.map(|&at| self.height(at, plane)).collect();
            let half = heights.len() / 2;
            let (_, &mut middle, _) = heights.select_nth_unstable_by(half, f64::total_cmp);
            let uneven = |level: &f64| {
                let below = heights.iter().filter(|&height| height < level);
                below.count().abs_diff(half)
            };
            let (below, above) = (middle - CLOSE, middle + CLOSE);
            if uneven(&below) < uneven(&above) {
                below
            } else {
                above
            }
        })
    }

    fn height(&self, at: usize, plane: usize) -> f64 {
        let (place, normal) = (self.places[at], NORMALS[plane]);
        place[0] * normal[0] + place[1] * normal[1] + place[2] * normal[2]
    }

    fn order_small(&mut self, own: &mut [usize], region: u32) -> Option<()> {
        for (number, &at) in own.iter().enumerate() {
            self.number[at] = number;
        }
        let mut first = vec![0];
        let mut rows = Vec::new();
        for &at in own.iter() {
            let within = self.graph.neighbours(at);
            let within = within.filter(|&neighbour| self.region[neighbour] == region);
            rows.extend(within.map(|neighbour| self.number[neighbour]));
            first.push(rows.len());
        }
        let (order, _) = minimum_degree(&first, &rows)?;
        let sorted: Vec<usize> = order.iter().map(|&number| own[number]).collect();
        own.copy_from_slice(&sorted);
        Some(())
    }
}

/// The plane with the smallest face beside the halves that it parts, and the side of that face.
fn best(sizes: &[[usize; 2]], faces: &[[usize; 2]]) -> Option<(usize, usize)> {
    let mut best = None;
    let mut least = f64::INFINITY;
    for (plane, (sizes, faces)) in sizes.iter().zip(faces).enumerate() {
        for side in [0, 1] {
            let halves = (sizes[side] - faces[side]) as f64 * sizes[1 - side] as f64;
            // A face of nothing does not make any halves the best.
            let cost = (faces[side] as f64).max(0.5) / halves;
            if cost < least {
                least = cost;
                best = Some((plane, side));
            }
        }
    }
    best
}

/// The numbers of the bits that are set.
fn bits(mut set: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        lowest
    })
}
