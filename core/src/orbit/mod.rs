//! Exact periodic orbits by shooting with the exact flow, and their Floquet multipliers: no
//! harmonic is discarded, so that they judge the harmonic balance.

mod closed;
mod curve_stability;
mod cycle_begin;
mod cycle_branch;
mod cycle_orbits;
mod cycles;
mod drift;
mod fundamental_matrix;
mod later_begin;
mod limit_cycle;
mod linear_path;
mod loop_memory;
mod multipliers;
mod orbit_postprocess;
mod period_map;
mod periodic;
mod plan;
mod price;
mod quadrature;
mod remembered_turns;
mod rescue;
mod residual;
mod rotation;
mod segments;
mod settings;
mod shooting;
mod sides;
mod sliders;
mod stability;
mod start;
mod survey;
mod sweep;

pub use closed::Orbit;
pub use curve_stability::decide_stability;
pub use cycle_branch::limit_cycles;
pub use cycle_orbits::CycleOrbits;
pub use cycles::{Change, ChangeKind, Cycle, CycleSettings, LimitCycles, Turn};
pub use limit_cycle::OrbitCurve;
pub use period_map::{Multipliers, PeriodMap};
pub use periodic::PeriodicOrbits;
pub use rescue::OrbitInitialGuess;
pub use rotation::Rotation;
pub use settings::OrbitSettings;
pub use sweep::{orbit_peak, orbit_sweep, Orbits};
