//! Natural frequencies and mode shapes: functions, and the classes `ModalReanalysis` and
//! `ModalBatch`.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::Modes;

use crate::arrays::{Held, numbers};
use crate::batch_solver::count as positive;
use crate::exceptions::to_python;
use crate::read::{read_masses, read_structure};

type Vector<'py> = Bound<'py, PyArray1<f64>>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;
/// Eigenvalues, shapes, participation, and the mass that moves.
type Found<'py> = (
    Vector<'py>,
    Bound<'py, PyArray3<f64>>,
    Matrix<'py>,
    Vector<'py>,
);

/// Natural frequencies and mode shapes of a structure, the lowest first.
///
/// Masses move with the shapes in which members deform (consistent), bars along all three axes;
/// what has no mass makes no mode. That none is missed is proved by a count (Sylvester's law).
///
/// Parameters
/// ----------
/// structure : as for `respond`, with n nodes and m members
/// masses : line f64[m] along members [kg/m]; section f64[m, 3], of the section about the local
///     axes, per length [kg m]; nodal f64[n, 6] at the nodes [kg, kg m2]
/// count : of modes that are wanted
///
/// Returns
/// -------
/// f64[c], squares of the circular frequencies [rad2/s2]; f64[c, n, 6], shapes with a modal mass
/// of 1 kg, whose largest motion is positive; f64[c, 3], roots of their effective modal masses along
/// the axes [kg^0.5]; f64[3], the mass that moves along each axis [kg]. There may be fewer modes
/// than are wanted.
///
/// Raises
/// ------
/// InvalidInput, UnstableStructure
#[pyfunction]
pub(crate) fn modes<'py>(
    py: Python<'py>,
    structure: &Bound<'py, PyDict>,
    masses: &Bound<'py, PyDict>,
    count: usize,
) -> PyResult<Found<'py>> {
    read_structure!(model from structure);
    read_masses!(weights from masses);
    let found = py
        .detach(|| rga_core::modes(&model, &weights, count))
        .map_err(|error| to_python(py, error))?;
    given(py, &found, model.coordinates.len())
}

fn given<'py>(py: Python<'py>, found: &Modes, nodes: usize) -> PyResult<Found<'py>> {
    let shape = [found.eigenvalues.len(), nodes, 6];
    Ok((
        PyArray1::from_slice(py, &found.eigenvalues),
        PyArray1::from_slice(py, &found.shapes).reshape(shape)?,
        PyArray1::from_slice(py, &found.participation).reshape([shape[0], 3])?,
        PyArray1::from_slice(py, &found.mass),
    ))
}

/// Energies of elements in modes, by which eigenvalues change.
///
/// The derivative of an eigenvalue by the logarithm of the stiffness of an element is its strain
/// energy; that by the logarithm of a mass is the eigenvalue times its kinetic energy, taken off
/// (Fox and Kapoor, Rates of change of eigenvalues and eigenvectors, AIAA Journal 6, 1968).
///
/// Parameters
/// ----------
/// structure, masses : as for `modes`, with n nodes, m members and s springs
/// shapes : f64[c, n, 6], with a modal mass of 1 kg
///
/// Returns
/// -------
/// f64[c, m + s], twice the strain energy of members, then of springs [J]; f64[c, m + n], twice the
/// kinetic energy at unit circular frequency of members, then of what is on nodes [-].
///
/// Raises
/// ------
/// InvalidInput
#[pyfunction]
pub(crate) fn modal_energies<'py>(
    py: Python<'py>,
    structure: &Bound<'py, PyDict>,
    masses: &Bound<'py, PyDict>,
    shapes: PyReadonlyArray3<'py, f64>,
) -> PyResult<(Matrix<'py>, Matrix<'py>)> {
    read_structure!(model from structure);
    read_masses!(weights from masses);
    let count = shapes.as_array().shape()[0];
    let motions = shapes.as_slice()?;
    let found = py
        .detach(|| rga_core::modal_energies(&model, &weights, motions))
        .map_err(|error| to_python(py, error))?;
    let of_modes = |energies: Vec<f64>| {
        let width = energies.len().checked_div(count).unwrap_or(0);
        PyArray1::from_vec(py, energies).reshape([count, width])
    };
    Ok((of_modes(found.strain)?, of_modes(found.kinetic)?))
}

/// A structure whose modes are known: those of structures near it are found in few steps.
///
/// They are counted as by `modes`, their frequencies as exact, and their shapes to a millionth in
/// the norm of the stiffness. A structure whose unknowns are coupled otherwise is solved by itself.
///
/// Parameters
/// ----------
/// structure, masses : as for `modes`
/// count : of modes that are known
///
/// Raises
/// ------
/// InvalidInput, UnstableStructure
#[pyclass(module = "rga._core", frozen)]
pub struct ModalReanalysis(rga_core::ModalReanalysis);

#[pymethods]
impl ModalReanalysis {
    #[new]
    fn new(
        structure: &Bound<'_, PyDict>,
        masses: &Bound<'_, PyDict>,
        count: usize,
    ) -> PyResult<Self> {
        let py = structure.py();
        read_structure!(model from structure);
        read_masses!(weights from masses);
        py.detach(|| rga_core::ModalReanalysis::new(&model, &weights, count))
            .map(Self)
            .map_err(|error| to_python(py, error))
    }

    /// Modes of a structure near this one, as by `modes`, with the same errors.
    fn modes<'py>(
        &self,
        py: Python<'py>,
        structure: &Bound<'py, PyDict>,
        masses: &Bound<'py, PyDict>,
        count: usize,
    ) -> PyResult<Found<'py>> {
        read_structure!(model from structure);
        read_masses!(weights from masses);
        let found = py
            .detach(|| self.0.modes(&model, &weights, count))
            .map_err(|error| to_python(py, error))?;
        given(py, &found, model.coordinates.len())
    }

    /// Modes of a structure near this one that lie below a square of the circular frequency, and
    /// the next one.
    ///
    /// Parameters
    /// ----------
    /// structure, masses : as for `modes`
    /// square : above zero [rad2/s2]
    /// least, most : at least and at most so many modes
    ///
    /// Returns
    /// -------
    /// as `modes`
    ///
    /// Raises
    /// ------
    /// InvalidInput, UnstableStructure
    fn modes_below<'py>(
        &self,
        py: Python<'py>,
        structure: &Bound<'py, PyDict>,
        masses: &Bound<'py, PyDict>,
        square: f64,
        least: usize,
        most: usize,
    ) -> PyResult<Found<'py>> {
        read_structure!(model from structure);
        read_masses!(weights from masses);
        let found = py
            .detach(|| (self.0).modes_below(&model, &weights, square, (least, most)))
            .map_err(|error| to_python(py, error))?;
        given(py, &found, model.coordinates.len())
    }
}

/// Modes of samples of a structure of which stiffnesses vary, few or all; masses stay.
///
/// Samples are solved together, in the lanes of a processor: block inverse iteration from the modes
/// of the structure, until residuals prove each eigenvalue to a part in 1e9; then all are counted
/// (Sylvester's law). Where up to 32 terms of rank one vary, that is done in a space of few
/// vectors, and residuals and count hold what lies outside too. A sample that is not proved or
/// counted so is solved in the whole, or by itself, as by `ModalReanalysis`.
///
/// Parameters
/// ----------
/// structure, masses : as for `modes`, with m members, s springs and n nodes
/// varied : i64[e], numbers of the members that vary, and of springs behind all members
/// count : of the lowest modes that are wanted, c
/// dofs : i64[d], along which shapes are shown: six times the node and the direction, 0..5
/// instructions : one of `instructions()` that samples are solved with; None: the best. Results do
///     not depend on it
///
/// Raises
/// ------
/// InvalidInput, UnstableStructure
#[pyclass(module = "rga._core", frozen)]
pub struct ModalBatch {
    core: rga_core::ModalBatch,
    shape: [usize; 2],
}

#[pymethods]
impl ModalBatch {
    #[new]
    #[pyo3(signature = (structure, masses, varied, count, dofs, instructions=None))]
    fn new(
        structure: &Bound<'_, PyDict>,
        masses: &Bound<'_, PyDict>,
        varied: &Bound<'_, PyAny>,
        count: usize,
        dofs: &Bound<'_, PyAny>,
        instructions: Option<&str>,
    ) -> PyResult<Self> {
        let py = structure.py();
        read_structure!(model from structure);
        read_masses!(weights from masses);
        let (varied, dofs) = (numbers(varied, "varied")?, numbers(dofs, "dofs")?);
        let make =
            || rga_core::ModalBatch::new(&model, &weights, &varied, count, &dofs, instructions);
        py.detach(make)
            .map(|core| Self {
                core,
                shape: [count, dofs.len()],
            })
            .map_err(|error| to_python(py, error))
    }

    /// Modes of samples.
    ///
    /// Parameters
    /// ----------
    /// factors : f64[k, e], above zero, on the whole stiffness of each member or spring that varies. A member whose end connections yield keeps a factor of 1.
    /// threads : how many share the rows; the results do not depend on it
    ///
    /// Returns
    /// -------
    /// f64[k, c], squares of the circular frequencies [rad2/s2]; f64[k, c, d], shapes along the
    /// dofs with a modal mass of 1 kg, of which the largest motion of all nodes is positive.
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableStructure, with the first row that fails as `row`
    #[pyo3(signature = (factors, threads=1))]
    fn modes<'py>(
        &self,
        py: Python<'py>,
        factors: &Bound<'py, PyAny>,
        threads: i64,
    ) -> PyResult<(Matrix<'py>, Bound<'py, PyArray3<f64>>)> {
        let factors = Held::new(factors, "factors")?;
        let samples = factors.view();
        let found = py
            .detach(|| self.core.modes(samples, positive(threads)))
            .map_err(|error| to_python(py, error))?;
        let (rows, [modes, dofs]) = (samples.len(), self.shape);
        let own = found.chunks_exact(1 + dofs);
        let values: Vec<f64> = own.clone().map(|mode| mode[0]).collect();
        let shapes: Vec<f64> = own.flat_map(|mode| &mode[1..]).copied().collect();
        Ok((
            PyArray1::from_vec(py, values).reshape([rows, modes])?,
            PyArray1::from_vec(py, shapes).reshape([rows, modes, dofs])?,
        ))
    }
}
