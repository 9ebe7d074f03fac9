//! Self-excited balance: the frequency is unknown, the phase is free.

mod balance;
mod point;
mod rest;
mod start;

pub(crate) use balance::oscillation;
pub use balance::CycleBalance;
pub use start::Onset;
