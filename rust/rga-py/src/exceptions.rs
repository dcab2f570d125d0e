//! Errors of the core as Python exceptions.

use pyo3::create_exception;
use pyo3::exceptions::{PyArithmeticError, PyValueError};
use pyo3::prelude::*;
use rga_core::Error;

create_exception!(
    rga._core,
    InvalidInput,
    PyValueError,
    "An array is missing, malformed or out of range; the message names it."
);
create_exception!(
    rga._core,
    UnstableStructure,
    PyArithmeticError,
    "Part of the structure can move freely.\n\n\
     node, dof (0..5 for ux uy uz rx ry rz): what moves most.\n\
     direction: the motion of that node, six numbers of norm 1.\n\
     row: of `Refactored` and `respond_nonlinear`, the row of the sample.\n\
     share: of `respond_nonlinear`, the part of the load that is carried; None where the\n\
     structure can move before it is loaded."
);
create_exception!(
    rga._core,
    DependentTerms,
    PyArithmeticError,
    "The elongations of the members and springs that vary depend on each other, or are prescribed."
);
create_exception!(
    rga._core,
    UnstableSample,
    PyArithmeticError,
    "The stiffnesses of a sample leave no stable structure.\n\nrow: of the sample."
);
create_exception!(
    rga._core,
    NotConverged,
    PyArithmeticError,
    "Friction forces did not settle.\n\nrow: the row of the time series."
);

pub(crate) fn to_python(py: Python<'_>, error: Error) -> PyErr {
    let message = error.to_string();
    raised(py, error, message)
}

fn raised(py: Python<'_>, error: Error, message: String) -> PyErr {
    match error {
        Error::InvalidInput(_) => InvalidInput::new_err(message),
        Error::UnstableStructure {
            node,
            dof,
            direction,
        } => unstable(py, message, (node, dof, direction), None),
        Error::Buckled {
            share,
            node,
            dof,
            direction,
        } => unstable(py, message, (node, dof, direction), Some(share)),
        Error::DependentTerms => DependentTerms::new_err(message),
        Error::UnstableSample { row } => {
            let raised = UnstableSample::new_err(message);
            let set = raised.value(py).setattr("row", row);
            set.err().unwrap_or(raised)
        }
        Error::Row { row, error } => {
            let raised = raised(py, *error, message);
            let set = raised.value(py).setattr("row", row);
            set.err().unwrap_or(raised)
        }
        Error::NotConverged { row } => {
            let raised = NotConverged::new_err(message);
            let set = raised.value(py).setattr("row", row);
            set.err().unwrap_or(raised)
        }
    }
}

fn unstable(
    py: Python<'_>,
    message: String,
    (node, dof, direction): (usize, usize, [f64; 6]),
    share: Option<f64>,
) -> PyErr {
    let raised = UnstableStructure::new_err(message);
    let value = raised.value(py);
    let set = value
        .setattr("node", node)
        .and_then(|()| value.setattr("dof", dof))
        .and_then(|()| value.setattr("direction", direction.to_vec()))
        .and_then(|()| value.setattr("share", share));
    set.err().unwrap_or(raised)
}
