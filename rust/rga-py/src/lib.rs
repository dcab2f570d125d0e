//! Python binding of the finite-element core and of the detectors: converts and documents.

#![warn(unreachable_pub)]

mod arrays;
mod batch_solver;
mod change_statistics;
mod condensation;
mod exceptions;
mod functions;
mod gaussian_window;
mod modes;
mod read;
mod reanalysis;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::OutputKind;

/// Finite elements for truss and frame bridges.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("InvalidInput", py.get_type::<exceptions::InvalidInput>())?;
    module.add(
        "UnstableStructure",
        py.get_type::<exceptions::UnstableStructure>(),
    )?;
    module.add(
        "DependentTerms",
        py.get_type::<exceptions::DependentTerms>(),
    )?;
    module.add("NotConverged", py.get_type::<exceptions::NotConverged>())?;
    module.add(
        "UnstableSample",
        py.get_type::<exceptions::UnstableSample>(),
    )?;
    module.add("OutputKind", output_kinds(py)?)?;
    module.add_class::<change_statistics::ChangeStatistics>()?;
    module.add_class::<condensation::Condensation>()?;
    module.add_class::<gaussian_window::GaussianWindow>()?;
    module.add_class::<batch_solver::BatchSolver>()?;
    module.add_class::<modes::ModalBatch>()?;
    module.add_class::<modes::ModalReanalysis>()?;
    module.add_class::<reanalysis::Loaded>()?;
    module.add_class::<reanalysis::Reanalysis>()?;
    module.add_class::<reanalysis::StiffnessDifference>()?;
    module.add_function(wrap_pyfunction!(change_statistics::innovations, module)?)?;
    module.add_function(wrap_pyfunction!(functions::count_terms, module)?)?;
    module.add_function(wrap_pyfunction!(functions::instructions, module)?)?;
    module.add_function(wrap_pyfunction!(modes::modal_energies, module)?)?;
    module.add_function(wrap_pyfunction!(modes::modes, module)?)?;
    module.add_function(wrap_pyfunction!(functions::respond, module)?)?;
    module.add_function(wrap_pyfunction!(functions::respond_nonlinear, module)?)?;
    module.add_function(wrap_pyfunction!(functions::slide, module)?)
}

/// Codes of the outputs, as an `enum.IntEnum`.
fn output_kinds(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let codes = OutputKind::ALL.map(|(kind, name)| (name, kind as i64));
    let named = PyDict::new(py);
    named.set_item("module", "rga._core")?;
    let arguments = ("OutputKind", codes.to_vec());
    py.import("enum")?
        .call_method("IntEnum", arguments, Some(&named))
}
