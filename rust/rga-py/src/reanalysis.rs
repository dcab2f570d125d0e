//! The class `Reanalysis`, and what goes through it.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::numbers;
use crate::condensation::Condensation;
use crate::exceptions::{InvalidInput, to_python};
use crate::read::{read_loads, read_outputs, read_structure};

type Matrix<'py> = Bound<'py, PyArray2<f64>>;
/// Numbers of members, and what belongs to each of them.
type Rates<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray3<f64>>);

/// A structure solved once: further loads, and a few stiffnesses that differ, cost little more.
///
/// What unit pseudo-forces at every truss member and spring do is known from one factorisation,
/// and what they do along frame members with springs at their ends. Structures that differ in few
/// terms cost a system of as many equations, and those that differ in a few frame members one of
/// twelve each (`Condensation` has the source).
///
/// Parameters
/// ----------
/// structure, outputs : as for `respond`; they are kept, and must not be changed afterwards
///
/// Raises
/// ------
/// InvalidInput, UnstableStructure
#[pyclass(module = "rga._core", frozen)]
pub struct Reanalysis {
    core: rga_core::Reanalysis,
    structure: Py<PyDict>,
    outputs: Py<PyDict>,
}

/// What p load patterns with coefficient one do to the structure of a `Reanalysis`.
#[pyclass(module = "rga._core", frozen)]
pub struct Loaded {
    core: rga_core::Loaded,
    width: usize,
}

/// Where the stiffness of a structure differs from that of a `Reanalysis`.
#[pyclass(module = "rga._core", frozen)]
pub struct StiffnessDifference(rga_core::StiffnessDifference);

#[pymethods]
impl Reanalysis {
    #[new]
    fn new(structure: &Bound<'_, PyDict>, outputs: &Bound<'_, PyDict>) -> PyResult<Self> {
        let py = structure.py();
        read_structure!(model from structure);
        read_outputs!(wanted from outputs);
        let core = py
            .detach(|| rga_core::Reanalysis::new(&model, &wanted))
            .map_err(|error| to_python(py, error))?;
        Ok(Self {
            core,
            structure: structure.clone().unbind(),
            outputs: outputs.clone().unbind(),
        })
    }

    /// The structure under loads, as for `respond`; InvalidInput for loads that the core refuses.
    fn under(&self, py: Python<'_>, loads: &Bound<'_, PyDict>) -> PyResult<Loaded> {
        let structure = self.structure.bind(py);
        read_structure!(model from structure);
        read_loads!(patterns from loads);
        let core = py
            .detach(|| self.core.under(&model, &patterns))
            .map_err(|error| to_python(py, error))?;
        Ok(Loaded {
            core,
            width: self.core.outputs(),
        })
    }

    /// Where stiffnesses differ; None where more than few stiffnesses do.
    ///
    /// Parameters
    /// ----------
    /// structure, outputs : of the other, as for `respond`
    fn differing(
        &self,
        py: Python<'_>,
        structure: &Bound<'_, PyDict>,
        outputs: &Bound<'_, PyDict>,
    ) -> PyResult<Option<StiffnessDifference>> {
        let (own, own_outputs) = (self.structure.bind(py), self.outputs.bind(py));
        read_structure!(model from own);
        read_outputs!(wanted from own_outputs);
        read_structure!(other from structure);
        read_outputs!(others from outputs);
        let found = rga_core::StiffnessDifference::between((&model, &wanted), (&other, &others));
        Ok(found.map(StiffnessDifference))
    }

    /// Outputs of a structure near this one under loads.
    ///
    /// Parameters
    /// ----------
    /// loaded : this structure under p load patterns
    /// structure : the other, as for `respond`
    /// difference : of `differing`
    ///
    /// Returns
    /// -------
    /// f64[p, o]
    ///
    /// Raises
    /// ------
    /// InvalidInput; DependentTerms, where the other structure can move
    fn changed<'py>(
        &self,
        py: Python<'py>,
        loaded: &Loaded,
        structure: &Bound<'py, PyDict>,
        difference: &StiffnessDifference,
    ) -> PyResult<Matrix<'py>> {
        read_structure!(other from structure);
        let found = py
            .detach(|| self.core.changed(&loaded.core, &other, &difference.0))
            .map_err(|error| to_python(py, error))?;
        PyArray1::from_vec(py, found).reshape([loaded.core.len(), self.core.outputs()])
    }

    /// The structure under loads condensed along members and onto springs.
    ///
    /// Parameters
    /// ----------
    /// loaded : this structure under load patterns
    /// members, springs : i64, their numbers
    ///
    /// Returns
    /// -------
    /// Condensation; None for frame members without springs at their ends
    fn onto(
        &self,
        loaded: &Loaded,
        members: &Bound<'_, PyAny>,
        springs: &Bound<'_, PyAny>,
    ) -> PyResult<Option<Condensation>> {
        let (members, springs) = (numbers(members, "members")?, numbers(springs, "springs")?);
        let found = self.core.onto(&loaded.core, &members, &springs);
        Ok(found.map(|responses| Condensation(rga_core::Condensation::new(responses))))
    }

    /// Derivatives of the outputs by the logarithm of EA, of truss members and of frame members
    /// with springs at their ends.
    ///
    /// Returns
    /// -------
    /// numbers of these members i64[k], and f64[k, p, o]
    fn rates<'py>(&self, py: Python<'py>, loaded: &Loaded) -> PyResult<Rates<'py>> {
        let (members, rates) = self.core.rates(&loaded.core);
        let shape = [members.len(), loaded.core.len(), self.core.outputs()];
        let members = members.iter().map(|&member| member as i64);
        let rates = PyArray1::from_vec(py, rates).reshape(shape)?;
        Ok((PyArray1::from_iter(py, members), rates))
    }
}

#[pymethods]
impl Loaded {
    /// Outputs, f64[p, o].
    #[getter]
    fn outputs<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        PyArray1::from_vec(py, self.core.outputs()).reshape([self.core.len(), self.width])
    }

    /// This, then another of the same structure: patterns of both by their places, in any order.
    ///
    /// Parameters
    /// ----------
    /// other : None for none
    /// places : of the patterns wanted; those of `other` come behind the own ones
    ///
    /// Raises
    /// ------
    /// InvalidInput, for a place that does not exist
    #[pyo3(signature = (other, places))]
    fn choose(&self, other: Option<&Self>, places: Vec<usize>) -> PyResult<Self> {
        let first = self.core.len();
        let places: Vec<(usize, usize)> = places
            .into_iter()
            .map(|place| match place.checked_sub(first) {
                Some(place) => (1, place),
                None => (0, place),
            })
            .collect();
        let parts: Vec<&rga_core::Loaded> = std::iter::once(self)
            .chain(other)
            .map(|part| &part.core)
            .collect();
        let core = rga_core::Loaded::choose(&parts, &places)
            .ok_or_else(|| InvalidInput::new_err("places name a pattern that does not exist"))?;
        Ok(Self {
            core,
            width: self.width,
        })
    }
}

#[pymethods]
impl StiffnessDifference {
    /// Whether anything differs.
    fn __bool__(&self) -> bool {
        !self.0.is_empty()
    }
}
