//! Bounds over what friction leaves open: the residual forces of contacts that stick.

mod ascent;
mod orbit;
mod peak;
mod response;

pub use orbit::bound_orbits;
pub(super) use peak::bound_peak;
pub use peak::PeakBounds;
pub use response::bound;
