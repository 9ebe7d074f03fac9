//! Exact periodic orbits by shooting with the exact flow, and their Floquet multipliers: no
//! harmonic is discarded, so that they judge the harmonic balance.

mod balances;
mod beside;
mod closed;
mod closing;
mod curve_stability;
mod cycle;
mod drift;
mod first_state;
mod fundamental_matrix;
mod later_begin;
mod linear_path;
mod loop_memory;
mod multipliers;
mod period_map;
mod periodic;
mod pieces;
mod plan;
mod planar_sliders;
mod price;
mod range;
mod reading;
mod remembered_turns;
mod rescue;
mod residual;
mod rotation;
mod segments;
mod settings;
mod settled;
mod shooting;
mod sliders;
mod start;
mod survey;
mod sweep;

pub use balances::Balances;
pub use closed::Orbit;
pub use curve_stability::decide_stability;
pub use cycle::{
    limit_cycles, Change, ChangeKind, Cycle, CycleOrbits, CycleSettings, LimitCycles, OrbitCurve,
    Turn,
};
pub use period_map::{Multipliers, PeriodMap};
pub use periodic::PeriodicOrbits;
pub use pieces::sweep_in_pieces;
pub use range::sweep_range_in_pieces;
pub use rescue::OrbitInitialGuess;
pub use rotation::Rotation;
pub use settings::OrbitSettings;
pub use sweep::{orbit_peak, orbit_sweep, Orbits};
