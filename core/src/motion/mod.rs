//! Motion in time: the exact flow from event to event, and Runge-Kutta for comparison.

mod flow;
mod modal_system;
mod output;
mod polynomial;
mod power_series;
mod runge_kutta;
mod state;
mod transient;
mod transition;

pub use flow::{Arc, Event, Flow, Halt, Passage};
pub use modal_system::{ModalSystem, Regime};
pub(crate) use output::Extremes;
pub(crate) use polynomial::value;
pub use power_series::PowerSeries;
pub use runge_kutta::RungeKutta;
pub use state::State;
pub use transient::{transient, History, Scheme, Trace, TransientSettings};
pub(crate) use transition::{Leg, Transition};
