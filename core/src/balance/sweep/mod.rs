//! Curves over the frequency: given points, ranges with adaptive steps, branches that fold.

mod adaptive;
mod beside;
mod branch;
mod branches;
mod continuity;
mod course;
mod finer;
mod fold;
mod forced_curve;
mod further;
mod given;
mod join;
mod load_curve;
mod resolution_change;
mod seams;
mod stops;
mod turns;

pub use adaptive::sweep_range;
pub(crate) use adaptive::{check_range, seam, smooth_piece};
pub(crate) use branch::branch_piece;
pub(crate) use course::Course;
pub use given::sweep;
pub(super) use given::sweep_with;
pub(crate) use given::{check_frequencies, over_frequencies};
pub(crate) use join::{join_branches, join_smooth, Piece};
pub(crate) use seams::seams;
