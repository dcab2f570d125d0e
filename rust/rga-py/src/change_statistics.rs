//! The class `ChangeStatistics`.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyType};
use rga_detect::{Reference, ReferenceArrays, Refusal, STATISTICS};

use crate::arrays::Held;

pyo3::import_exception!(rga.errors, InputError);

/// What `SyncMonitor` is made of.
#[pyclass(module = "rga._core")]
pub struct ChangeStatistics(rga_detect::ChangeStatistics);

#[pymethods]
impl ChangeStatistics {
    #[new]
    fn new(
        reference: &Bound<'_, PyDict>,
        largest: f64,
        thresholds: Vec<f32>,
        rows_kept: usize,
    ) -> PyResult<Self> {
        let entry = |key| Held::<f64>::entry(reference, "reference", key);
        let reference = Reference::new(ReferenceArrays {
            level: entry("level")?.view(),
            weights: entry("weights")?.view(),
            units: entry("units")?.view(),
            offset: entry("offset")?.view(),
            slope: entry("slope")?.view(),
            knots: entry("knots")?.view(),
            bends: entry("bends")?.view(),
            mixing: entry("mixing")?.view(),
            signature: entry("signature")?.view(),
            largest,
        })
        .map_err(refused)?;
        let thresholds: [f32; STATISTICS] = thresholds.try_into().map_err(|_| {
            InputError::new_err((
                "a wrong number of thresholds",
                "thresholds",
                "one a statistic",
            ))
        })?;
        Ok(Self(rga_detect::ChangeStatistics::new(
            reference, thresholds, rows_kept,
        )))
    }

    fn update_many<'py>(
        &mut self,
        rows: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let py = rows.py();
        let held = Held::new(rows, "rows")?;
        let view = held.view();
        let alarms = py.detach(|| self.0.update_many(view)).map_err(refused)?;
        Ok(PyArray1::from_vec(py, alarms))
    }

    fn take_peaks<'py>(&mut self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        PyArray1::from_slice(py, &self.0.take_peaks())
    }

    fn recent<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let values = self.0.recent();
        let rows = values.len() / self.0.sensors();
        PyArray1::from_vec(py, values).reshape([rows, self.0.sensors()])
    }

    /// Row of the stream that the first of these rows is.
    #[getter]
    fn recent_first(&self) -> u64 {
        self.0.recent_first()
    }

    fn begin_again(&mut self) {
        self.0.begin_again();
    }

    #[getter]
    fn rows(&self) -> u64 {
        self.0.rows()
    }

    /// Row of the stream, from 0 on, that raised the alarm that stands, and the number of the
    /// statistic that did.
    #[getter]
    fn alarm(&self) -> Option<(u64, usize)> {
        self.0.alarm().map(|alarm| (alarm.row, alarm.statistic))
    }

    /// The whole state: what `from_bytes` makes of it goes on with the same bits.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0.to_bytes())
    }

    /// The statistics that `to_bytes` stored; InputError for other bytes.
    #[classmethod]
    fn from_bytes(_cls: &Bound<'_, PyType>, state: &[u8]) -> PyResult<Self> {
        rga_detect::ChangeStatistics::from_bytes(state)
            .map(Self)
            .map_err(refused)
    }
}

/// What readings differ by from what those before let expect, to one variance whatever is missing.
#[pyfunction]
pub(crate) fn innovations<'py>(
    deviations: &Bound<'py, PyAny>,
    weights: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let py = deviations.py();
    let rows = Held::<f64>::new(deviations, "deviations")?;
    let held = Held::<f64>::new(weights, "weights")?;
    let (rows, weights) = (rows.view(), held.view());
    let [count, sensors] = rows.shape else {
        let remedy = "their shape must be [n, sensors]";
        return Err(InputError::new_err(("another shape", "deviations", remedy)));
    };
    if weights.shape != [weights.len(), *sensors] {
        let remedy = "their shape must be [order, sensors]";
        return Err(InputError::new_err(("another shape", "weights", remedy)));
    }
    let found = py.detach(|| rga_detect::innovations(rows.values, weights.values, *sensors));
    PyArray1::from_vec(py, found).reshape([*count, *sensors])
}

fn refused(refusal: Refusal) -> PyErr {
    InputError::new_err((refusal.what, refusal.place, refusal.remedy))
}
