//! The functions of `rga._core`.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::{Bearings, Varied};

use crate::arrays::{Held, numbers};
use crate::exceptions::to_python;
use crate::read::{read_outputs, read_problem, read_structure};

type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// Linear static response of a truss or frame structure.
///
/// Dofs of a node are ux uy uz rx ry rz; tension and elongation are positive.
/// Local x runs from a member's first node to its second, z = x cross y.
/// Without local_y, y is global z cross x (horizontal), and global y for a
/// vertical member. Rotations that nothing stiffens are held.
///
/// Parameters
/// ----------
/// structure : n nodes, m members, k inclined supports, s springs, t ties
///     coordinates f64[n, 3]; ends i64[m, 2]; frame bool[m] (False: truss);
///     E, G, A, Iy, Iz, J f64[m] (Iz bends in the local x-y plane);
///     Asy, Asz f64[m] (inf: Euler-Bernoulli, finite: Timoshenko);
///     local_y f64[m, 3] (NaN row: default);
///     connection f64[m, 12] (stiffness in series with each local end dof of a
///     frame member, at the face of its rigid zone: inf rigid, 0 released);
///     rigid_end f64[m, 2] (lengths of rigid zones of frame members);
///     fixed bool[n, 6]; inclined_node i64[k], inclined_direction f64[k, 3]
///     (normalised here; n.u is prescribed); spring_node i64[s, 2] (second -1:
///     ground), spring_dof i64[s], spring_stiffness f64[s];
///     tie_node i64[t, 2], tie_dof i64[t].
/// loads : p patterns, each solved on its own
///     forces f64[p, n, 6]; strain f64[p, m, 3] (initial axial strain, then
///     its gradients along local y and z; a truss has only the first);
///     prescribed f64[p, n, 6] (of fixed dofs); prescribed_inclined f64[p, k];
///     and a flat list of member loads: member_pattern, member_index,
///     member_axis i64[q] (0..2 local forces, 3..5 local moments, these only
///     as point loads), member_from, member_to f64[q] (metres from the first
///     node; equal: a point load of size member_start), member_start,
///     member_end f64[q].
/// outputs : o numbers for each pattern
///     kind, index, other i64[o], vector f64[o, 3], total bool[o]; kind by
///     `OutputKind`: DISPLACEMENT and ROTATION of node index along vector,
///     relative to node other (or -1); STRAIN of member index at vector =
///     (place in 0..1, y, z), total or mechanical; SECTION_FORCE of member
///     index at vector[0], other 0..5 for N, Vy, Vz, T, My, Mz in local axes,
///     of what lies beyond on what lies before; REACTION_FORCE and REACTION_MOMENT on node index along
///     vector, of supports and springs to ground; END_FORCE of the node on
///     member index at local end dof other (0..11). Directions are taken as
///     given, not normalised.
///
/// Returns
/// -------
/// f64[p, o]
///
/// Raises
/// ------
/// InvalidInput, UnstableStructure
#[pyfunction]
pub(crate) fn respond<'py>(
    py: Python<'py>,
    structure: &Bound<'py, PyDict>,
    loads: &Bound<'py, PyDict>,
    outputs: &Bound<'py, PyDict>,
) -> PyResult<Matrix<'py>> {
    read_problem!(model, patterns, wanted from structure, loads, outputs);
    let results = py
        .detach(|| rga_core::respond(&model, &patterns, &wanted))
        .map_err(|error| to_python(py, error))?;
    let shape = [patterns.pattern_count(), wanted.kind.len()];
    PyArray1::from_vec(py, results).reshape(shape)
}

/// Response in the equilibrium of the deformed structure, row by row.
///
/// Elongations are those of the chords between moved nodes, with the bow of frame members beside
/// them; rotations are components, for moderate ones. The load of a row is the sum of its
/// patterns, grows from nothing, and keeps its directions. Supports, ties and springs act along
/// the axes as drawn.
///
/// Parameters
/// ----------
/// structure, loads, outputs : as for `respond`, with p patterns and o outputs
/// coefficients : f64[n, p]; the load of a row is the sum of coefficients times patterns
/// threads : how many share the rows; the results do not depend on it
///
/// Returns
/// -------
/// f64[n, o]
///
/// Raises
/// ------
/// InvalidInput; UnstableStructure, where a row buckles or snaps through, with its `row` and the
/// `share` of its load that is carried
#[pyfunction]
#[pyo3(signature = (structure, loads, outputs, coefficients, threads=1))]
pub(crate) fn respond_nonlinear<'py>(
    py: Python<'py>,
    structure: &Bound<'py, PyDict>,
    loads: &Bound<'py, PyDict>,
    outputs: &Bound<'py, PyDict>,
    coefficients: &Bound<'py, PyAny>,
    threads: i64,
) -> PyResult<Matrix<'py>> {
    read_problem!(model, patterns, wanted from structure, loads, outputs);
    let coefficients = Held::new(coefficients, "coefficients")?;
    let coefficients = coefficients.view();
    // The core refuses 0 as it would refuse what is negative.
    let threads = usize::try_from(threads).unwrap_or(0);
    let results = py
        .detach(|| rga_core::respond_nonlinear(&model, &patterns, &wanted, coefficients, threads))
        .map_err(|error| to_python(py, error))?;
    let shape = [coefficients.len(), wanted.kind.len()];
    PyArray1::from_vec(py, results).reshape(shape)
}

/// Coulomb friction at b bearings through n_t rows of time, in sequence.
///
/// Displacements are u = free_displacement + flexibility r and normal forces
/// N = max(0, normal_free + normal_influence r), with r the friction forces on
/// the structure. Each row sticks to the place of the row before or slips with
/// abs(r) = mu N against the motion; the first goes on from where a row before it came to rest.
///
/// Parameters
/// ----------
/// free_displacement, normal_free : f64[n_t, b]
/// flexibility, normal_influence : f64[b, b]
/// mu : f64[b]
/// before : f64[2, b], free displacements, then friction forces, in the row before
///
/// Returns
/// -------
/// f64[n_t, b], the friction forces
///
/// Raises
/// ------
/// InvalidInput, NotConverged
#[pyfunction]
pub(crate) fn slide<'py>(
    py: Python<'py>,
    free_displacement: &Bound<'py, PyAny>,
    flexibility: &Bound<'py, PyAny>,
    normal_free: &Bound<'py, PyAny>,
    normal_influence: &Bound<'py, PyAny>,
    mu: &Bound<'py, PyAny>,
    before: &Bound<'py, PyAny>,
) -> PyResult<Matrix<'py>> {
    let free_displacement = Held::new(free_displacement, "free_displacement")?;
    let flexibility = Held::new(flexibility, "flexibility")?;
    let normal_free = Held::new(normal_free, "normal_free")?;
    let normal_influence = Held::new(normal_influence, "normal_influence")?;
    let mu = Held::new(mu, "mu")?;
    let before = Held::new(before, "before")?;
    let bearings = Bearings {
        free_displacement: free_displacement.view(),
        flexibility: flexibility.view(),
        normal_free: normal_free.view(),
        normal_influence: normal_influence.view(),
        mu: mu.view(),
        before: before.view(),
    };
    let friction = py
        .detach(|| rga_core::slide(&bearings))
        .map_err(|error| to_python(py, error))?;
    let shape = [bearings.free_displacement.len(), bearings.mu.len()];
    PyArray1::from_vec(py, friction).reshape(shape)
}

/// How many terms of rank one vary with members and springs: what a `Condensation` would have.
///
/// Parameters
/// ----------
/// structure, outputs : as for `respond`
/// members, springs : i64, numbers of those that vary, as a whole
///
/// Raises
/// ------
/// InvalidInput
#[pyfunction]
pub(crate) fn count_terms(
    structure: &Bound<'_, PyDict>,
    outputs: &Bound<'_, PyDict>,
    members: &Bound<'_, PyAny>,
    springs: &Bound<'_, PyAny>,
) -> PyResult<usize> {
    read_structure!(model from structure);
    read_outputs!(wanted from outputs);
    let varied = Varied {
        members: &numbers(members, "members")?,
        springs: &numbers(springs, "springs")?,
        axial: false,
    };
    rga_core::count_terms(&model, &wanted, varied).map_err(|error| to_python(structure.py(), error))
}

/// Instruction sets of this processor that `Refactored` can solve samples with, the best first.
///
/// Returns
/// -------
/// list[str], of "avx512", "avx2" and "portable" on x86-64
#[pyfunction]
pub(crate) fn instructions() -> Vec<&'static str> {
    rga_core::instructions()
}
