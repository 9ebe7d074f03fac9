//! Design: the peak of a response followed along a parameter of its contacts or its load, the
//! parameter that makes it least, and the highest peaks of disks whose sectors deviate.

mod ascent;
mod bounds;
mod curve;
mod envelope;
mod first_look;
mod global_peak;
mod held_pool;
mod interpolant;
mod member;
mod mistuned;
mod mode_assembly;
mod mode_branch;
mod mode_condensed;
mod mode_equations;
mod mode_feed;
mod mode_harmonics;
mod mode_point;
mod mode_preconditioner;
mod mode_settings;
mod mode_start;
mod mode_tangent;
mod nonlinear_mode;
mod optimum;
mod orbit_bounds;
mod patterns;
mod peak_bounds;
mod peak_map;
mod quasi_static;
mod samples;
mod search;
mod slip_onset;
mod upper_branch;

pub use bounds::bound;
pub use curve::{bounded_peak_curve, peak_curve, Curve, Peak, Target};
pub use global_peak::{summits, GlobalPeak, PeakQuery, Summits};
pub use mistuned::TunedDisk;
pub use mode_point::{Interaction, ModePoint};
pub use mode_settings::{Amplitudes, Corner, ModeEnd, ModeMethod, ModeSettings, NonlinearMode};
pub use nonlinear_mode::nonlinear_mode;
pub use optimum::{optimum, Optimum};
pub use orbit_bounds::bound_orbits;
pub use patterns::{study, Pattern};
pub use peak_bounds::PeakBounds;
pub use peak_map::{peak_map, Cell, CellPeak};
