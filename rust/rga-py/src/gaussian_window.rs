//! The class `GaussianWindow`.

use numpy::{PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyType};
use rga_detect::{Refusal, WindowRule};

use crate::arrays::Held;

pyo3::import_exception!(rga.errors, InputError);

/// The paper's rule for a twin out of sync, on a stream: a Gaussian bound for each sensor.
///
/// A value alarms when it exceeds gamma = mean + z * standard deviation (population, 1/window) of
/// the `window` values of its sensor before it. Until there are that many it does not alarm. Each
/// value then enters the window. NaN is a missing value: no alarm, and nothing enters.
///
/// Values are squared gaps in the paper's rule (task T1), and may be of any unit; only a rise
/// alarms. The paper tests against a window that holds the value itself: `inclusive`.
///
/// Decisions are those of exact arithmetic but for the rounding of single values: an outlier that
/// has left the window, or a drop of scale, leaves nothing behind.
///
/// Parameters
/// ----------
/// n_sensors : sensors in a row, 1 or more
/// window : values in the window, 2 or more
/// z : bound in standard deviations, 0 or more; 3 if neither it nor the confidence is given
/// confidence : in place of z, the share of a Gaussian's values that stay below the bound: 0.5 or
///     more, below 1
/// inclusive : the window holds the value under test and the window - 1 before it, and counts as
///     full with it. No value then lies more than sqrt(window - 1) standard deviations above the
///     mean, so that a z from there on never alarms.
/// persistence : (k, n): a sensor alarms when k of its last n tested values exceeded (n <= 64)
/// frozen : a value that exceeds does not enter the window, so that a change is not absorbed
///
/// Raises
/// ------
/// InputError : arguments out of range; rows of another shape; an infinite value, or one beyond
///     1e60, with its row in the stream and its sensor (counted from 0). Nothing of the call has
///     then entered.
///
/// Examples
/// --------
/// >>> from rga.detection import GaussianWindow
/// >>> gaps = GaussianWindow(n_sensors=2, window=4)
/// >>> gaps.update_many([[1, 1], [2, 1], [1, 1], [2, 1]]).any()
/// np.False_
/// >>> gaps.bound
/// array([3., 1.])
/// >>> gaps.update([2.9, 1.1])
/// array([False,  True])
#[pyclass(module = "rga.detection")]
pub struct GaussianWindow(rga_detect::GaussianWindow);

#[pymethods]
impl GaussianWindow {
    #[new]
    #[pyo3(
        signature = (
            n_sensors, window, z=None, *, confidence=None, inclusive=false, persistence=(1, 1),
            frozen=false
        ),
        text_signature = "(n_sensors, window, z=None, *, confidence=None, inclusive=False, \
                          persistence=(1, 1), frozen=False)"
    )]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        n_sensors: i64,
        window: i64,
        z: Option<f64>,
        confidence: Option<f64>,
        inclusive: bool,
        persistence: (i64, i64),
        frozen: bool,
    ) -> PyResult<Self> {
        let rule = WindowRule {
            sensors: n_sensors,
            window,
            z: bound(py, z, confidence)?,
            inclusive,
            persistence,
            frozen,
        };
        rga_detect::GaussianWindow::new(rule)
            .map(Self)
            .map_err(refused)
    }

    /// Alarms bool[n_sensors] of one row float[n_sensors].
    fn update<'py>(&mut self, row: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        let held = floats(row, "row")?;
        let view = held.view();
        let alarms = PyArrayDyn::zeros(row.py(), view.shape, false);
        self.0
            .update(view, alarms.try_readwrite()?.as_slice_mut()?)
            .map_err(refused)?;
        Ok(alarms)
    }

    /// Alarms bool[n, n_sensors] of rows float[n, n_sensors], bit for bit those of `update`.
    fn update_many<'py>(
        &mut self,
        rows: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArrayDyn<bool>>> {
        let py = rows.py();
        let held = floats(rows, "rows")?;
        let view = held.view();
        let alarms = PyArrayDyn::zeros(py, view.shape, false);
        let mut written = alarms.try_readwrite()?;
        let marks = written.as_slice_mut()?;
        py.detach(|| self.0.update_many(view, marks))
            .map_err(refused)?;
        drop(written);
        Ok(alarms)
    }

    /// What the next row must exceed, float[n_sensors] in the unit of the values: gamma, and with
    /// `inclusive` the value that would equal the gamma of the window that holds it (inf: there
    /// is none). NaN until the sensor's window is full.
    #[getter]
    fn bound<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.0.bound())
    }

    /// Rows seen.
    #[getter]
    fn rows(&self) -> u64 {
        self.0.rows()
    }

    /// The whole state: what `from_bytes` makes of it goes on with the same bits.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.to_bytes())
    }

    /// The window that `to_bytes` stored; InputError for other bytes.
    #[classmethod]
    fn from_bytes(_cls: &Bound<'_, PyType>, state: &[u8]) -> PyResult<Self> {
        rga_detect::GaussianWindow::from_bytes(state)
            .map(Self)
            .map_err(refused)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let from_bytes = slf.get_type().getattr("from_bytes")?;
        Ok((from_bytes, (slf.borrow().to_bytes(slf.py()),)))
    }
}

/// z itself, or the quantile of the standard normal distribution.
fn bound(py: Python<'_>, z: Option<f64>, confidence: Option<f64>) -> PyResult<f64> {
    let Some(confidence) = confidence else {
        return Ok(z.unwrap_or(3.0));
    };
    if z.is_some() {
        let remedy = "give one of them";
        return Err(InputError::new_err((
            "z and a confidence are given",
            "confidence",
            remedy,
        )));
    }
    if !(0.5..1.0).contains(&confidence) {
        let remedy = "give a share from 0.5 on and below 1, such as 0.999";
        let what = format!("the confidence is {confidence}");
        return Err(InputError::new_err((what, "confidence", remedy)));
    }
    let normal = py.import("statistics")?.getattr("NormalDist")?.call0()?;
    normal.call_method1("inv_cdf", (confidence,))?.extract()
}

/// Anything that NumPy makes an array of numbers of.
fn floats<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Held<'py, f64>> {
    // No subclass, which may be masked; being exact does not look at the type of the numbers.
    let exact = value.cast_exact::<PyArrayDyn<f64>>().is_ok();
    if exact && value.cast::<PyArrayDyn<f64>>().is_ok() {
        return Held::new(value, name);
    }
    let py = value.py();
    let array = py
        .import("numpy.ma")?
        .call_method1("asarray", (value, "float64"))
        .and_then(|masked| masked.call_method1("filled", (f64::NAN,)))
        .map_err(|error| {
            let remedy = "give an array of numbers, with NaN for a missing value";
            InputError::new_err((error.value(py).to_string(), name.to_owned(), remedy))
        })?;
    Held::new(&array, name)
}

fn refused(refusal: Refusal) -> PyErr {
    InputError::new_err((refusal.what, refusal.place, refusal.remedy))
}
