//! The class `Condensed`.

use numpy::{PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use rga_core::{Array, Directions};

use crate::arrays::{Held, pairs};
use crate::exceptions::{InvalidInput, to_python};

/// Samples of a structure of which few stiffnesses vary, or none.
///
/// A term that varies, a truss member or a spring of stiffness k + d and elongation v, adds the
/// pseudo-force w = d v to the structure as it is: (H + diag(d)) v = H V q and y = Y q - C w.
///
/// Parameters
/// ----------
/// loaded : f64[p, o], outputs under each of p unit loads (Y transposed)
/// driven : f64[p, r], H V transposed, V the elongations of r terms under the unit loads
/// stiffness : f64[r, r], H, the inverse of the elongations under unit pseudo-forces
/// influence : f64[r, o], outputs under unit pseudo-forces (C transposed)
///
/// Raises
/// ------
/// InvalidInput
#[pyclass(module = "rga._core", frozen)]
pub struct Condensed(rga_core::Condensed);

#[pymethods]
impl Condensed {
    #[new]
    fn new(
        loaded: &Bound<'_, PyAny>,
        driven: &Bound<'_, PyAny>,
        stiffness: &Bound<'_, PyAny>,
        influence: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let py = loaded.py();
        let loaded = Held::new(loaded, "loaded")?;
        let driven = Held::new(driven, "driven")?;
        let stiffness = Held::new(stiffness, "stiffness")?;
        let influence = Held::new(influence, "influence")?;
        let [patterns, outputs] = pair(loaded.view(), "loaded")?;
        let [terms, _] = pair(stiffness.view(), "stiffness")?;
        rga_core::Condensed::new(
            [patterns, terms, outputs],
            loaded.view().values,
            driven.view().values,
            stiffness.view().values,
            influence.view().values,
        )
        .map(Self)
        .map_err(|error| to_python(py, error))
    }

    /// Outputs of samples.
    ///
    /// Parameters
    /// ----------
    /// coefficients : f64[n, p], of the loads (q)
    /// changes : f64[n, r], of the stiffness of each term (d)
    /// threads : how many share the rows; the results do not depend on it
    /// out : f64[n, o] in C order to write to; left out, a new array
    ///
    /// Returns
    /// -------
    /// f64[n, o]
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableSample, with the row
    #[pyo3(signature = (coefficients, changes, threads=1, out=None))]
    fn respond<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        changes: &Bound<'py, PyAny>,
        threads: usize,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let coefficients = Held::new(coefficients, "coefficients")?;
        let changes = Held::new(changes, "changes")?;
        let (q, d) = (coefficients.view(), changes.view());
        let rows = self.rows(q, d)?;
        let shape = [rows, self.0.outputs];
        // Memory from NumPy: it asks for huge pages where that pays.
        let shown = out.unwrap_or_else(|| PyArray2::zeros(py, shape, false));
        if shown.shape() != shape || !shown.is_c_contiguous() {
            return Err(InvalidInput::new_err(format!(
                "out must be [{rows}, {}] in C order",
                self.0.outputs
            )));
        }
        let mut held = shown.try_readwrite().map_err(|_| busy())?;
        let results = held.as_slice_mut()?;
        py.detach(|| self.0.respond(q.values, d.values, results, threads))
            .map_err(|error| to_python(py, error))?;
        drop(held);
        Ok(shown)
    }

    /// Derivatives of samples along directions.
    ///
    /// Parameters
    /// ----------
    /// coefficients, changes : as for `respond`
    /// count : number of directions c
    /// loads : i64[k, 2], pairs of a direction and a load whose coefficient it changes
    /// coefficient_rates : f64[n, k], how fast
    /// terms : i64[l, 2], pairs of a direction and a term whose stiffness it changes
    /// change_rates : f64[n, l], how fast
    /// threads : how many share the rows; the results do not depend on it
    ///
    /// Returns
    /// -------
    /// f64[n, c, o]
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableSample, with the row
    #[pyo3(signature = (
        coefficients, changes, count, loads, coefficient_rates, terms, change_rates, threads=1
    ))]
    #[allow(clippy::too_many_arguments)]
    fn differentiate<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        changes: &Bound<'py, PyAny>,
        count: usize,
        loads: &Bound<'py, PyAny>,
        coefficient_rates: &Bound<'py, PyAny>,
        terms: &Bound<'py, PyAny>,
        change_rates: &Bound<'py, PyAny>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let coefficients = Held::new(coefficients, "coefficients")?;
        let changes = Held::new(changes, "changes")?;
        let coefficient_rates = Held::new(coefficient_rates, "coefficient_rates")?;
        let change_rates = Held::new(change_rates, "change_rates")?;
        let (q, d) = (coefficients.view(), changes.view());
        let rates = (coefficient_rates.view().values, change_rates.view().values);
        let directions = Directions {
            count,
            loads: pairs(loads, "loads")?,
            changes: pairs(terms, "terms")?,
        };
        let rows = self.rows(q, d)?;
        let shown = PyArray3::zeros(py, [rows, count, self.0.outputs], false);
        let mut held = shown.try_readwrite().map_err(|_| busy())?;
        let results = held.as_slice_mut()?;
        py.detach(|| {
            let core = &self.0;
            core.differentiate(q.values, d.values, &directions, rates, results, threads)
        })
        .map_err(|error| to_python(py, error))?;
        drop(held);
        Ok(shown)
    }

    /// Derivatives of the sum of the outputs times given gradients: the adjoint of `respond`.
    ///
    /// Parameters
    /// ----------
    /// coefficients, changes : as for `respond`
    /// gradients : f64[n, o]
    /// threads : how many share the rows; the results do not depend on it
    ///
    /// Returns
    /// -------
    /// f64[n, p + r], by the coefficients, then by the changes
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableSample, with the row
    #[pyo3(signature = (coefficients, changes, gradients, threads=1))]
    fn pull_back<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        changes: &Bound<'py, PyAny>,
        gradients: &Bound<'py, PyAny>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let coefficients = Held::new(coefficients, "coefficients")?;
        let changes = Held::new(changes, "changes")?;
        let gradients = Held::new(gradients, "gradients")?;
        let (q, d) = (coefficients.view(), changes.view());
        let g = gradients.view().values;
        let rows = self.rows(q, d)?;
        let found = PyArray2::zeros(py, [rows, self.0.patterns + self.0.terms], false);
        let mut held = found.try_readwrite().map_err(|_| busy())?;
        let results = held.as_slice_mut()?;
        py.detach(|| self.0.pull_back(q.values, d.values, g, results, threads))
            .map_err(|error| to_python(py, error))?;
        drop(held);
        Ok(found)
    }
}

impl Condensed {
    /// Both arrays have as many rows, and the columns of this structure.
    fn rows(&self, coefficients: Array<'_, f64>, changes: Array<'_, f64>) -> PyResult<usize> {
        let [rows, patterns] = pair(coefficients, "coefficients")?;
        let [also, terms] = pair(changes, "changes")?;
        if (patterns, terms, rows) == (self.0.patterns, self.0.terms, also) {
            return Ok(rows);
        }
        Err(InvalidInput::new_err(format!(
            "coefficients are [{rows}, {patterns}] and changes [{also}, {terms}]; they must be \
             [n, {}] and [n, {}]",
            self.0.patterns, self.0.terms
        )))
    }
}

fn busy() -> PyErr {
    InvalidInput::new_err("out is in use, or must not be written to")
}

fn pair(array: Array<'_, f64>, name: &str) -> PyResult<[usize; 2]> {
    array
        .shape
        .try_into()
        .map_err(|_| InvalidInput::new_err(format!("{name} must have two axes")))
}
