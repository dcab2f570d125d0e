//! The class `Refactored`.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Held;
use crate::exceptions::to_python;
use crate::read::{read, read_problem};

/// Samples of a structure of which every stiffness may vary.
///
/// Checks, supports and ties, the pattern of the matrix and its symbolic analysis are done once;
/// each sample is factorised anew. The dicts are those of `respond`, and are not kept.
///
/// Parameters
/// ----------
/// structure : m members, s springs, with the stiffnesses of a factor of 1
/// loads : p patterns, of which each sample takes a sum
/// outputs : o numbers for each sample
///
/// Raises
/// ------
/// InvalidInput
#[pyclass(module = "rga._core", frozen)]
pub struct Refactored(rga_core::Refactored);

#[pymethods]
impl Refactored {
    #[new]
    fn new(
        py: Python<'_>,
        structure: &Bound<'_, PyDict>,
        loads: &Bound<'_, PyDict>,
        outputs: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        read_problem!(model, patterns, wanted from structure, loads, outputs);
        py.detach(|| rga_core::Refactored::new(&model, &patterns, &wanted))
            .map(Self)
            .map_err(|error| to_python(py, error))
    }

    /// Outputs of samples.
    ///
    /// Parameters
    /// ----------
    /// factors : f64[n, m + s], on the whole stiffness of each member (EA, GJ, EI and the shear
    ///     stiffness, not its end connections) and of each spring; 0 removes it
    /// coefficients : f64[n, p]; the load of a sample is the sum of coefficients times patterns.
    ///     Forces of initial strains scale with the member.
    /// threads : how many share the rows; the results do not depend on it
    ///
    /// Returns
    /// -------
    /// f64[n, o]
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableStructure, with the first row that fails as `row`
    #[pyo3(signature = (factors, coefficients, threads=1))]
    fn respond<'py>(
        &self,
        py: Python<'py>,
        factors: &Bound<'py, PyAny>,
        coefficients: &Bound<'py, PyAny>,
        threads: i64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let factors = Held::new(factors, "factors")?;
        let coefficients = Held::new(coefficients, "coefficients")?;
        let (factors, coefficients) = (factors.view(), coefficients.view());
        // The core refuses 0 as it would refuse what is negative.
        let threads = usize::try_from(threads).unwrap_or(0);
        let results = py
            .detach(|| self.0.respond(factors, coefficients, threads))
            .map_err(|error| to_python(py, error))?;
        PyArray1::from_vec(py, results).reshape([factors.len(), self.0.width()])
    }
}
