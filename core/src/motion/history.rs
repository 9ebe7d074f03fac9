//! A motion in time as the caller asks for it and has it.

use super::flow_event::{Event, Halt};
use crate::Error;
use std::time::Duration;

/// How time is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scheme {
    /// The exact flow between events.
    Exact,
    /// Classical fourth-order Runge-Kutta with this number of steps per period.
    RungeKutta(usize),
}

/// Settings of a time integration.
#[derive(Debug, Clone, PartialEq)]
pub struct TransientSettings {
    /// Frequency of the excitation, which defines the period [rad/s].
    pub omega: f64,
    /// How time is integrated.
    pub scheme: Scheme,
    /// Number of periods, or the most of them if there is a tolerance.
    pub periods: usize,
    /// Change of the state over a period, relative to the motion, at which it counts as settled.
    pub tolerance: Option<f64>,
    /// Output instants per period.
    pub samples: usize,
    /// Number of periods at the end whose history is kept; all if `None`.
    pub keep: Option<usize>,
}

impl TransientSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_frequency("omega", self.omega)?;
        let steps = match self.scheme {
            Scheme::Exact => 1,
            Scheme::RungeKutta(steps) => steps,
        };
        for (entry, count) in [
            ("periods", self.periods),
            ("samples", self.samples),
            ("steps", steps),
            ("keep", self.keep.unwrap_or(1)),
        ] {
            if count == 0 {
                return Err(Error::value(entry, 0.0, "must be at least 1"));
            }
        }
        match self.tolerance {
            Some(tolerance) if !(tolerance > 0.0 && tolerance < 1.0) => {
                Err(Error::value("tolerance", tolerance, "must lie between 0 and 1"))
            }
            _ => Ok(()),
        }
    }
}

/// Motion of the observed DOFs and the contacts, instant after instant.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Instants \[s\].
    pub time: Vec<f64>,
    /// Displacements of the observed DOFs \[m\].
    pub displacement: Vec<f64>,
    /// Their velocities [m/s].
    pub velocity: Vec<f64>,
    /// Relative displacements at the contacts \[m\].
    pub contact_displacement: Vec<f64>,
    /// Contact forces \[N\].
    pub force: Vec<f64>,
}

/// A motion from a start state.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Time histories of the periods kept.
    pub trace: Trace,
    /// State at the start and after each period: displacements and velocities of all DOFs,
    /// contact forces.
    pub poincare: Vec<Vec<f64>>,
    /// Lowest and highest displacement of each observed DOF, period after period \[m\].
    pub range: Vec<[f64; 2]>,
    /// Change of the state over each period, relative to the largest state at its ends, in the
    /// norm of energy.
    pub change: Vec<f64>,
    /// Events of the periods kept, timed from the start; none from Runge-Kutta.
    pub events: Vec<Event>,
    /// Whether the change has fallen below the tolerance.
    pub settled: bool,
    /// Why the motion was cut short, if it was.
    pub halt: Option<Halt>,
    /// Whether the caller has ended it.
    pub interrupted: bool,
    /// Steps taken.
    pub steps: usize,
    /// Events met.
    pub events_met: usize,
    /// Time taken.
    pub total: Duration,
}
