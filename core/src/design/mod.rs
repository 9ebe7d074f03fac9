//! Damper design: the peak of a response followed along a parameter of its contacts or its load,
//! and the parameter that makes it least.

mod curve;
mod interpolant;
mod optimum;
mod search;
mod variation;

pub use curve::{peak_curve, Curve, Peak, Target};
pub use optimum::{optimum, Optimum};
pub use variation::{Common, Variation};
