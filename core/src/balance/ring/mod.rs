//! Newton steps of rings of sectors, by blocks.

mod answers;
mod newton;
mod series;

pub(super) use answers::RingAnswers;
pub(super) use newton::RingNewton;
pub(super) use series::RingSeries;
