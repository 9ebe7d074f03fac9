//! Exact periodic orbits by shooting with the exact flow, and their Floquet multipliers: no
//! harmonic is discarded, so that they judge the harmonic balance.

mod periodic;
mod quadrature;
mod rescue;
mod residual;
mod settings;
mod shooting;
mod survey;
mod sweep;

pub use periodic::{Orbit, PeriodicOrbits};
pub use rescue::Rescue;
pub use settings::OrbitSettings;
pub use sweep::{orbit_peak, orbit_sweep, Orbits};
