//! The highest peak of a response over a range of frequencies.

mod envelope;
mod first_look;
mod global_peak;
mod interpolant;
mod kinks;
mod overlay;
mod samples;
mod search;
mod slip_onset;
mod upper_branch;

pub(super) use global_peak::{
    are_torn, climbed, PeakSearch, Reached, OF_CURVE, OF_LEAST, OF_STUDY,
};
pub use global_peak::{summits, GlobalPeak, PeakQuery, Summits};
pub(super) use interpolant::Knot;
pub(super) use samples::{predicted, Sample};
