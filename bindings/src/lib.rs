//! Python skin of `stickslip-core`: arrays in, arrays out. No mathematics here.

// Arguments of Python functions have names.
#![allow(clippy::too_many_arguments)]

mod arrays;
mod columns;
mod contacts;
mod design;
mod fates;
mod found;
mod limit_cycles;
mod mistuning;
mod modes;
mod orbits;
mod problem;
mod python_law;
mod response;
mod settings;
mod sparse;
mod statics;
mod transient;
mod watch;

/// The compiled mathematics of stickslip.
#[pyo3::pymodule]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::{
        arrays::TooFastError,
        contacts::{contact_force, contact_phases},
        design::{damper_curve, optimal_damper, peak_map, sensitivity},
        fates::fates,
        found::Found,
        limit_cycles::{limit_cycles, period_multipliers},
        mistuning::{mistuning_study, summits, TunedDisk},
        modes::nonlinear_mode,
        orbits::{exact_peak, exact_response, orbit_history},
        problem::Problem,
        response::{amplitude, forced_response, single_harmonic},
        sparse::SparseCholesky,
        statics::static_response,
        transient::transient,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
