//! Design: the peak of a response followed along a parameter of its contacts or its load, the
//! parameter that makes it least, and the highest peaks of disks whose sectors deviate.

mod bounds;
mod curve;
mod held_pool;
mod member;
mod mistuned;
mod mode;
mod optimum;
mod patterns;
mod peak;
mod peak_map;

pub use bounds::{bound, bound_orbits, PeakBounds};
pub use curve::{bounded_peak_curve, peak_curve, Curve, Peak, Target};
pub use mistuned::TunedDisk;
pub use mode::{
    nonlinear_mode, Amplitudes, Corner, Interaction, ModeEnd, ModeMethod, ModePoint, ModeSettings,
    NonlinearMode,
};
pub use optimum::{optimum, Optimum};
pub use patterns::{study, Pattern};
pub use peak::{summits, GlobalPeak, PeakQuery, Summits};
pub use peak_map::{peak_map, Cell, CellPeak};
