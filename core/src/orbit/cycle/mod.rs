//! Exact limit cycles: their begin, their branch over the negative damping, their stability.

mod begin;
mod branch;
mod limit_cycle;
mod orbits;
mod postprocess;
mod settings;
mod sides;
mod stability;

pub use branch::limit_cycles;
pub use limit_cycle::OrbitCurve;
pub use orbits::CycleOrbits;
pub use settings::{Change, ChangeKind, Cycle, CycleSettings, LimitCycles, Turn};
