//! What an observer of the exact flow sees: stretches of the motion, and the events between them.

use super::contact_state::ContactState;
use super::microslip::Turn;
use super::power_series::PowerSeries;
use super::state::State;
use crate::contact::PointState;
use std::sync::Arc;

/// A contact point changes from stick to slip or back, opens or closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Time in the period \[s\].
    pub time: f64,
    /// Contact point.
    pub point: usize,
    /// What it does from now on.
    pub state: PointState,
}

/// A stretch of the motion without events.
#[derive(Debug)]
pub struct FlowSegment<'a> {
    /// Motion as a power series.
    pub series: &'a PowerSeries,
    /// Time at its start \[s\].
    pub start: f64,
    /// Length in τ of the series.
    pub length: f64,
    /// States of the contact points.
    pub regime: &'a Arc<ContactState>,
}

impl FlowSegment<'_> {
    /// Length \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.length / self.series.rate()
    }
}

/// What an observer of the flow sees, in order of time.
#[derive(Debug)]
pub enum FlowEvent<'a> {
    /// A stretch without events.
    Segment(FlowSegment<'a>),
    /// An event, with the velocity [m/s] of all contact points and the contact states before and after.
    Event {
        /// The event.
        event: Event,
        /// Relative velocities at the contacts [m/s].
        speed: &'a [f64],
        /// Before the event.
        before: &'a Arc<ContactState>,
        /// After it.
        after: &'a Arc<ContactState>,
        /// The motion at the event, with the contact states after it.
        state: &'a State,
        /// Of a contact without sliders, by its number, what the event does to its reversals.
        turn: Option<(usize, Turn)>,
    },
}

/// Why a flow ended early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Halt {
    /// The motion has grown out of the range of numbers.
    Unbounded,
    /// Contacts change state without end at one instant.
    Contradiction,
    /// All steps that were granted are taken, or they are too short to come to the end.
    Steps,
    /// The caller has ended the run.
    Interrupted,
}
