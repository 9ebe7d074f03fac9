//! Python skin of `stickslip-core`: arrays in, arrays out. No mathematics here.

mod arrays;
mod columns;
mod contacts;
mod design;
mod fates;
mod limit_cycles;
mod mistuning;
mod orbits;
mod problem;
mod response;
mod settings;
mod single_harmonic;
mod transient;
mod variation;
mod watch;

use pyo3::prelude::*;

/// The compiled mathematics of stickslip.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("TooFastError", module.py().get_type::<arrays::TooFastError>())?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<response::Solution>()?;
    module.add_function(wrap_pyfunction!(response::forced_response, module)?)?;
    module.add_function(wrap_pyfunction!(response::amplitude, module)?)?;
    module.add_function(wrap_pyfunction!(contacts::contact_force, module)?)?;
    module.add_function(wrap_pyfunction!(contacts::contact_phases, module)?)?;
    module.add_function(wrap_pyfunction!(single_harmonic::single_harmonic, module)?)?;
    module.add_class::<design::Peaks>()?;
    module.add_function(wrap_pyfunction!(design::damper_curve, module)?)?;
    module.add_function(wrap_pyfunction!(design::optimal_damper, module)?)?;
    module.add_function(wrap_pyfunction!(design::sensitivity, module)?)?;
    module.add_class::<mistuning::TunedDisk>()?;
    module.add_function(wrap_pyfunction!(mistuning::summits, module)?)?;
    module.add_function(wrap_pyfunction!(mistuning::mistuning_study, module)?)?;
    module.add_function(wrap_pyfunction!(orbits::exact_response, module)?)?;
    module.add_function(wrap_pyfunction!(orbits::exact_peak, module)?)?;
    module.add_function(wrap_pyfunction!(orbits::orbit_history, module)?)?;
    module.add_class::<fates::Fates>()?;
    module.add_function(wrap_pyfunction!(fates::fates, module)?)?;
    module.add_class::<limit_cycles::LimitCycles>()?;
    module.add_function(wrap_pyfunction!(limit_cycles::limit_cycles, module)?)?;
    module.add_class::<transient::History>()?;
    module.add_function(wrap_pyfunction!(transient::transient, module)?)?;
    Ok(())
}
