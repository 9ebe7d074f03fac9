//! Motion in time: the exact flow from event to event, and Runge-Kutta for comparison.

mod flow;
mod modal_system;
mod polynomial;
mod power_series;
mod state;
mod transition;

pub use flow::{Arc, Event, Flow, Halt, Passage};
pub use modal_system::{ModalSystem, Regime};
pub(crate) use polynomial::{sign_changes, value};
pub use power_series::PowerSeries;
pub use state::State;
pub(crate) use transition::{Leg, Transition};
