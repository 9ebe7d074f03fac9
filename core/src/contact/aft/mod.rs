//! Harmonics by samples of a period, for laws without closed forms.

mod law;
mod march;
mod rate;
mod restart;
mod samples;

pub(super) use law::of_the_law;
pub use law::Aft;
