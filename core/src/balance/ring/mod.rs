//! Newton steps of rings of sectors, by blocks.

mod answers;
mod newton;
#[cfg(test)]
mod newton_tests;
mod runs;
mod series;

pub(super) use answers::RingAnswers;
pub(super) use newton::RingNewton;
pub(super) use series::RingSeries;
