//! Curves over the frequency: given points, ranges with adaptive steps, branches that fold.

mod adaptive;
mod branch;
mod branches;
mod continuity;
mod forced_curve;
mod further;
mod given;
mod load_curve;
mod stops;
mod turns;

pub use adaptive::sweep_range;
pub use given::sweep;
pub(super) use given::sweep_with;
pub(crate) use given::{check_bracket, check_frequencies, over_frequencies};
