//! The class `Condensation`.

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::{Array, Condensed, Laws, UnitResponses, Varied, pseudo_forces};

use crate::arrays::{Held, directions, numbers};
use crate::exceptions::{InvalidInput, to_python};
use crate::read::read_problem;

type Vector<'py, T> = Bound<'py, PyArray1<T>>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// A structure of which only stiffnesses of some members and springs vary, or none.
///
/// What varies is condensed onto terms of rank one: one for a truss member or a spring, up to six
/// for a frame member, and one for each gauge on that. A term of stiffness k + d and elongation v
/// acts on the structure as it is like one of stiffness k with the pseudo-force d v beside it. A
/// sample costs a factorisation of as many equations as there are terms (Woodbury's identity; Akgun
/// et al., Fast exact linear and non-linear structural reanalysis, IJNME 50, 2001). Forces of
/// temperature and of lack of fit scale with the stiffness of their member; those of loads between
/// its ends do not.
///
/// Parameters
/// ----------
/// structure, loads, outputs : as for `respond`, with p patterns and o outputs
/// members : i64[a], numbers of those that vary, each as a whole; no end of a frame member yields
/// springs : i64[b], numbers of those that vary
/// axial : of frame members too, no more varies than how they resist growing longer
///
/// Raises
/// ------
/// InvalidInput; UnstableStructure; DependentTerms, where elongations are prescribed
#[pyclass(module = "rga._core", frozen)]
pub struct Condensation(pub(crate) rga_core::Condensation);

#[pymethods]
impl Condensation {
    #[new]
    #[pyo3(signature = (structure, loads, outputs, members, springs, axial=false))]
    fn new(
        py: Python<'_>,
        structure: &Bound<'_, PyDict>,
        loads: &Bound<'_, PyDict>,
        outputs: &Bound<'_, PyDict>,
        members: &Bound<'_, PyAny>,
        springs: &Bound<'_, PyAny>,
        axial: bool,
    ) -> PyResult<Self> {
        read_problem!(model, patterns, wanted from structure, loads, outputs);
        let (members, springs) = (numbers(members, "members")?, numbers(springs, "springs")?);
        let varied = Varied {
            members: &members,
            springs: &springs,
            axial,
        };
        py.detach(|| rga_core::Condensation::of(&model, &patterns, &wanted, varied))
            .map(Self)
            .map_err(|error| to_python(py, error))
    }

    /// How many terms there are, r.
    #[getter]
    fn terms(&self) -> usize {
        self.responses().stiffness.len()
    }

    /// Of the terms in the structure as it is, f64[r]: EA / L of a truss member, E of the terms of
    /// a frame member, of a spring its own.
    #[getter]
    fn stiffness<'py>(&self, py: Python<'py>) -> Vector<'py, f64> {
        PyArray1::from_slice(py, &self.responses().stiffness)
    }

    /// Place of each term among the members, then springs, that vary, i64[r].
    #[getter]
    fn element<'py>(&self, py: Python<'py>) -> Vector<'py, i64> {
        let places = self.responses().element.iter().map(|&place| place as i64);
        PyArray1::from_iter(py, places)
    }

    /// Outputs under unit loads, f64[p, o].
    #[getter]
    fn loaded<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let found = self.responses();
        matrix(py, &found.loaded, found.patterns, found.outputs)
    }

    /// Elongations of the terms under unit loads, f64[p, r].
    #[getter]
    fn stretched<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let found = self.responses();
        matrix(py, &found.stretched, found.patterns, self.terms())
    }

    /// Outputs under unit pseudo-forces, f64[r, o].
    #[getter]
    fn influence<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let found = self.responses();
        matrix(py, &found.influence, self.terms(), found.outputs)
    }

    /// Elongations under unit pseudo-forces, f64[r, r].
    #[getter]
    fn unit<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        matrix(py, &self.responses().unit, self.terms(), self.terms())
    }

    /// Outputs of samples.
    ///
    /// Parameters
    /// ----------
    /// coefficients : f64[n, p], of the loads
    /// stiffness : f64[n, a + b], of each member and spring that varies, members first: EA / L of a
    ///     truss member, E of a frame member, of a spring its own
    /// threads : how many share the rows; the results do not depend on it
    /// out : f64[n, o] in C order to write to; left out, a new array
    ///
    /// Returns
    /// -------
    /// f64[n, o]
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableSample, with the row; DependentTerms, where the elongations of the
    /// terms depend on each other
    #[pyo3(signature = (coefficients, stiffness, threads=1, out=None))]
    fn respond<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        stiffness: &Bound<'py, PyAny>,
        threads: usize,
        out: Option<Matrix<'py>>,
    ) -> PyResult<Matrix<'py>> {
        let samples = self.samples(py)?;
        let coefficients = Held::new(coefficients, "coefficients")?;
        let stiffness = Held::new(stiffness, "stiffness")?;
        let (q, k) = (coefficients.view(), stiffness.view());
        let rows = self.rows(q, k)?;
        let shape = [rows, samples.outputs];
        // Memory from NumPy: it asks for huge pages where that pays.
        let shown = out.unwrap_or_else(|| PyArray2::zeros(py, shape, false));
        if shown.shape() != shape || !shown.is_c_contiguous() {
            return Err(InvalidInput::new_err(format!(
                "out must be [{rows}, {}] in C order",
                samples.outputs
            )));
        }
        let mut held = shown.try_readwrite().map_err(|_| busy())?;
        let results = held.as_slice_mut()?;
        py.detach(|| samples.respond(q.values, k.values, results, threads))
            .map_err(|error| to_python(py, error))?;
        drop(held);
        Ok(shown)
    }

    /// Pseudo-forces beside the terms where each has a law: members and springs with play or
    /// slack. Elongations follow from `stretched` and `unit`, outputs from `loaded` and `influence`.
    ///
    /// Parameters
    /// ----------
    /// coefficients : f64[n, p], of the loads
    /// size : f64[n, r], a term carries nothing up to this elongation, a play down to its negative
    /// stiffness : f64[n, r], beyond; not below that in the structure
    /// rod : bool[r], a term carries tension alone
    ///
    /// Returns
    /// -------
    /// f64[n, r]
    ///
    /// Raises
    /// ------
    /// InvalidInput; UnstableSample, with the row that nothing holds
    fn pseudo_forces<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        size: &Bound<'py, PyAny>,
        stiffness: &Bound<'py, PyAny>,
        rod: &Bound<'py, PyAny>,
    ) -> PyResult<Matrix<'py>> {
        let coefficients = Held::<f64>::new(coefficients, "coefficients")?;
        let size = Held::<f64>::new(size, "size")?;
        let stiffness = Held::<f64>::new(stiffness, "stiffness")?;
        let rod = Held::<bool>::new(rod, "rod")?;
        let q = coefficients.view();
        let [rows, _] = pair(q, "coefficients")?;
        let laws = Laws {
            size: size.view().values,
            stiffness: stiffness.view().values,
            rod: rod.view().values,
        };
        let found = py
            .detach(|| pseudo_forces(self.responses(), q.values, laws))
            .map_err(|error| to_python(py, error))?;
        matrix(py, &found, rows, self.terms())
    }

    /// Derivatives of samples along directions.
    ///
    /// Parameters
    /// ----------
    /// coefficients, stiffness, threads : as for `respond`
    /// coefficient_rates : f64[n, p, c], derivatives of the coefficients along c directions
    /// stiffness_rates : f64[n, a + b, c], derivatives of the stiffnesses
    ///
    /// Returns
    /// -------
    /// f64[n, o, c]
    ///
    /// Raises
    /// ------
    /// As `respond`.
    #[pyo3(signature = (
        coefficients, stiffness, coefficient_rates, stiffness_rates, threads=1
    ))]
    fn differentiate<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        stiffness: &Bound<'py, PyAny>,
        coefficient_rates: &Bound<'py, PyAny>,
        stiffness_rates: &Bound<'py, PyAny>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let samples = self.samples(py)?;
        let coefficients = Held::new(coefficients, "coefficients")?;
        let stiffness = Held::new(stiffness, "stiffness")?;
        let (q, k) = (coefficients.view(), stiffness.view());
        let rows = self.rows(q, k)?;
        let (along, of_q, of_k) = directions(
            (
                coefficient_rates,
                "coefficient_rates",
                [rows, samples.patterns],
            ),
            (stiffness_rates, "stiffness_rates", [rows, samples.elements]),
        )?;
        let shown = PyArray3::zeros(py, [rows, along.count, samples.outputs], false);
        let mut held = shown.try_readwrite().map_err(|_| busy())?;
        let results = held.as_slice_mut()?;
        let rates = (&of_q[..], &of_k[..]);
        py.detach(|| samples.differentiate(q.values, k.values, &along, rates, results, threads))
            .map_err(|error| to_python(py, error))?;
        drop(held);
        shown.permute(Some([0, 2, 1]))
    }

    /// Derivatives of the sum of the outputs times given gradients: the adjoint of `respond`.
    ///
    /// Parameters
    /// ----------
    /// coefficients, stiffness, threads : as for `respond`
    /// gradients : f64[n, o]
    ///
    /// Returns
    /// -------
    /// f64[n, p + a + b], by the coefficients, then by the stiffnesses
    ///
    /// Raises
    /// ------
    /// As `respond`.
    #[pyo3(signature = (coefficients, stiffness, gradients, threads=1))]
    fn pull_back<'py>(
        &self,
        py: Python<'py>,
        coefficients: &Bound<'py, PyAny>,
        stiffness: &Bound<'py, PyAny>,
        gradients: &Bound<'py, PyAny>,
        threads: usize,
    ) -> PyResult<Matrix<'py>> {
        let samples = self.samples(py)?;
        let coefficients = Held::new(coefficients, "coefficients")?;
        let stiffness = Held::new(stiffness, "stiffness")?;
        let gradients = Held::new(gradients, "gradients")?;
        let (q, k) = (coefficients.view(), stiffness.view());
        let g = gradients.view().values;
        let rows = self.rows(q, k)?;
        let found = PyArray2::zeros(py, [rows, samples.patterns + samples.elements], false);
        let mut held = found.try_readwrite().map_err(|_| busy())?;
        let results = held.as_slice_mut()?;
        py.detach(|| samples.pull_back(q.values, k.values, g, results, threads))
            .map_err(|error| to_python(py, error))?;
        drop(held);
        Ok(found)
    }
}

impl Condensation {
    fn responses(&self) -> &UnitResponses {
        &self.0.responses
    }

    fn samples(&self, py: Python<'_>) -> PyResult<&Condensed> {
        self.0.samples().map_err(|error| to_python(py, error))
    }

    /// Both arrays have as many rows, and the columns of this structure.
    fn rows(&self, coefficients: Array<'_, f64>, stiffness: Array<'_, f64>) -> PyResult<usize> {
        let [rows, patterns] = pair(coefficients, "coefficients")?;
        let [also, elements] = pair(stiffness, "stiffness")?;
        let expected = (self.responses().patterns, self.responses().elements);
        if (patterns, elements) == expected && rows == also {
            return Ok(rows);
        }
        Err(InvalidInput::new_err(format!(
            "coefficients are [{rows}, {patterns}] and stiffness [{also}, {elements}]; they must \
             be [n, {}] and [n, {}]",
            expected.0, expected.1
        )))
    }
}

fn matrix<'py>(
    py: Python<'py>,
    values: &[f64],
    rows: usize,
    columns: usize,
) -> PyResult<Matrix<'py>> {
    PyArray1::from_slice(py, values).reshape([rows, columns])
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
