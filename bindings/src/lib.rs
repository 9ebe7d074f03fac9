//! Python skin of `stickslip-core`: arrays in, arrays out. No mathematics here.

mod arrays;
mod design;
mod problem;
mod response;
mod watch;

use pyo3::prelude::*;

/// The compiled mathematics of stickslip.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<problem::Problem>()?;
    module.add_class::<response::Solution>()?;
    module.add_function(wrap_pyfunction!(response::forced_response, module)?)?;
    module.add_function(wrap_pyfunction!(response::peak, module)?)?;
    module.add_function(wrap_pyfunction!(response::amplitude, module)?)?;
    module.add_function(wrap_pyfunction!(response::contact_force, module)?)?;
    module.add_class::<design::Peaks>()?;
    module.add_function(wrap_pyfunction!(design::damper_curve, module)?)?;
    module.add_function(wrap_pyfunction!(design::optimal_damper, module)?)?;
    module.add_function(wrap_pyfunction!(design::sensitivity, module)?)?;
    Ok(())
}
