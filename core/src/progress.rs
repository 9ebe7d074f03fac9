//! How an analysis tells its caller how far it is, and hears from it whether to go on.

/// Called between points and between Newton iterations with the share of the work done; `false`
/// ends the analysis and keeps what is solved.
pub type Progress<'a> = dyn Fn(f64) -> bool + 'a;
