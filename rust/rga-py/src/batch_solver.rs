//! The class `Refactored`.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::{Array, Samples};

use crate::arrays::{Held, directions, numbers};
use crate::exceptions::to_python;
use crate::read::read_problem;

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
/// instructions : one of `instructions()` that samples are solved with; None: the best. Results do
///     not depend on it
///
/// Raises
/// ------
/// InvalidInput
#[pyclass(name = "Refactored", module = "rga._core", frozen)]
pub struct BatchSolver(rga_core::BatchSolver);

#[pymethods]
impl BatchSolver {
    #[new]
    #[pyo3(signature = (structure, loads, outputs, instructions=None))]
    fn new(
        py: Python<'_>,
        structure: &Bound<'_, PyDict>,
        loads: &Bound<'_, PyDict>,
        outputs: &Bound<'_, PyDict>,
        instructions: Option<&str>,
    ) -> PyResult<Self> {
        read_problem!(model, patterns, wanted from structure, loads, outputs);
        py.detach(|| rga_core::BatchSolver::new(&model, &patterns, &wanted, instructions))
            .map(Self)
            .map_err(|error| to_python(py, error))
    }

    /// Outputs of samples.
    ///
    /// Parameters
    /// ----------
    /// factors : f64[n, m + s], on the whole stiffness of each member (EA, GJ, EI and the shear
    ///     stiffness) and of each spring; 0 removes it. Forces of initial strains scale with the
    ///     member. A member whose end connections yield keeps a factor of 1.
    /// coefficients : f64[n, p]; the load of a sample is the sum of coefficients times patterns
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
        let samples = Samples {
            factors: factors.view(),
            coefficients: coefficients.view(),
        };
        let results = py
            .detach(|| self.0.respond(samples, count(threads)))
            .map_err(|error| to_python(py, error))?;
        PyArray1::from_vec(py, results).reshape([samples.factors.len(), self.0.width()])
    }

    /// Derivatives of samples along directions.
    ///
    /// Parameters
    /// ----------
    /// factors, coefficients : as for `respond`
    /// elements : i64[e], numbers of members, and of springs behind all members, whose factors
    ///     change
    /// factor_rates : f64[n, e, c], derivatives of these factors along c directions
    /// coefficient_rates : f64[n, p, c], derivatives of the coefficients
    /// threads : how many share the rows; the results do not depend on it
    ///
    /// Returns
    /// -------
    /// f64[n, o, c]
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableStructure, with the first row that fails as `row`
    #[pyo3(signature = (factors, coefficients, elements, factor_rates, coefficient_rates, threads=1))]
    #[allow(clippy::too_many_arguments)]
    fn differentiate<'py>(
        &self,
        py: Python<'py>,
        factors: &Bound<'py, PyAny>,
        coefficients: &Bound<'py, PyAny>,
        elements: &Bound<'py, PyAny>,
        factor_rates: &Bound<'py, PyAny>,
        coefficient_rates: &Bound<'py, PyAny>,
        threads: i64,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let factors = Held::new(factors, "factors")?;
        let coefficients = Held::new(coefficients, "coefficients")?;
        let samples = Samples {
            factors: factors.view(),
            coefficients: coefficients.view(),
        };
        let elements = numbers(elements, "elements")?;
        let rows = samples.factors.len();
        let patterns = samples.coefficients.shape.get(1).copied().unwrap_or(0);
        let (mut along, of_loads, of_factors) = directions(
            (coefficient_rates, "coefficient_rates", [rows, patterns]),
            (factor_rates, "factor_rates", [rows, elements.len()]),
        )?;
        for (_, element) in &mut along.changes {
            *element = elements[*element];
        }
        let shapes = [[rows, along.loads.len()], [rows, along.changes.len()]];
        let rates = (
            Array::new(&of_loads, &shapes[0]),
            Array::new(&of_factors, &shapes[1]),
        );
        let results = py
            .detach(|| self.0.differentiate(samples, &along, rates, count(threads)))
            .map_err(|error| to_python(py, error))?;
        let shape = [rows, along.count, self.0.width()];
        let found = PyArray1::from_vec(py, results).reshape(shape)?;
        found.permute(Some([0, 2, 1]))
    }

    /// Derivatives of the sum of the outputs times given gradients: the adjoint, one solve a row.
    ///
    /// Parameters
    /// ----------
    /// factors, coefficients : as for `respond`
    /// gradients : f64[n, o]
    /// threads : how many share the rows; the results do not depend on it
    ///
    /// Returns
    /// -------
    /// f64[n, p + m + s], by the coefficients, then by the factors
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableStructure, with the first row that fails as `row`
    #[pyo3(signature = (factors, coefficients, gradients, threads=1))]
    fn pull_back<'py>(
        &self,
        py: Python<'py>,
        factors: &Bound<'py, PyAny>,
        coefficients: &Bound<'py, PyAny>,
        gradients: &Bound<'py, PyAny>,
        threads: i64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let factors = Held::new(factors, "factors")?;
        let coefficients = Held::new(coefficients, "coefficients")?;
        let gradients = Held::new(gradients, "gradients")?;
        let gradients = gradients.view();
        let samples = Samples {
            factors: factors.view(),
            coefficients: coefficients.view(),
        };
        let results = py
            .detach(|| self.0.pull_back(samples, gradients, count(threads)))
            .map_err(|error| to_python(py, error))?;
        let width = self.0.patterns() + self.0.elements();
        PyArray1::from_vec(py, results).reshape([samples.factors.len(), width])
    }
}

/// The core refuses 0 as it would refuse what is negative.
pub(crate) fn count(threads: i64) -> usize {
    usize::try_from(threads).unwrap_or(0)
}
