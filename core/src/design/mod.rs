//! Design: the peak of a response followed along a parameter of its contacts or its load, the
//! parameter that makes it least, and the highest peaks of disks whose sectors deviate.

mod ascent;
mod bounds;
mod curve;
mod envelope;
mod first_look;
mod global_peak;
mod interpolant;
mod member;
mod mistuned;
mod mode_equations;
mod mode_point;
mod mode_start;
mod nonlinear_mode;
mod optimum;
mod orbit_bounds;
mod patterns;
mod samples;
mod search;

pub use bounds::bound;
pub use curve::{peak_curve, Curve, Peak, Target};
pub use global_peak::{summits, GlobalPeak, PeakQuery, Summits};
pub use mistuned::TunedDisk;
pub use mode_point::{Interaction, ModePoint};
pub use nonlinear_mode::{nonlinear_mode, Amplitudes, ModeEnd, ModeSettings, NonlinearMode};
pub use optimum::{optimum, Optimum};
pub use orbit_bounds::bound_orbits;
pub use patterns::{study, Pattern};
