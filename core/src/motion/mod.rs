//! Motion in time: the exact flow from event to event, Runge-Kutta for comparison, and what becomes
//! of free motions.

mod basin;
mod bodies;
mod bounds;
mod branch_series;
mod classification;
mod damping;
mod expansion;
mod exponential;
mod flow;
mod flow_event;
mod flow_next;
mod history;
mod linear_phase;
mod loop_disturbance;
mod microslip;
mod modal_system;
mod output;
mod phase;
mod polynomial;
mod power_series;
mod projection;
mod propagator;
mod returns;
mod rigid;
mod runge_kutta;
mod sliding;
mod state;
mod transient;
mod transition;

pub use basin::fates;
pub use classification::{Classification, ClassificationSettings, Classifier, Reason};
pub use flow::Flow;
pub use flow_event::{Event, FlowEvent, FlowSegment, Halt};
pub use history::{History, Scheme, Trace, TransientSettings};
pub(crate) use linear_phase::LinearPhase;
pub(crate) use loop_disturbance::LoopDisturbance;
pub(crate) use microslip::Microslip;
pub use microslip::{Reversals, Turn};
pub use modal_system::{ContactState, ModalSystem};
pub(crate) use output::Extremes;
pub use power_series::PowerSeries;
pub use runge_kutta::RungeKutta;
pub use state::State;
pub use transient::transient;
pub(crate) use transition::Transition;
