//! Harmonics by samples of a period, for laws without closed forms.

mod history;
mod lap_derivative;
mod law;
mod march;
mod rate;
mod repeated;
mod restart;
mod round;
mod samples;
mod step;

pub(super) use law::of_the_law;
pub use law::Aft;
