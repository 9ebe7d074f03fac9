//! Stretches of a motion in which the equations are linear, and what the events at their ends do to its
//! derivative.

use super::contact_state::ContactState;
use super::flow_event::{Event, FlowEvent};
use super::microslip::Turn;
use super::modal_system::ModalSystem;
use super::power_series::PowerSeries;
use super::state::State;
use crate::contact::PointState;
use std::sync::Arc;

/// A stretch of the motion in one regime, and what ends it.
#[derive(Debug, Clone)]
pub(crate) struct LinearPhase {
    pub(super) regime: Arc<ContactState>,
    /// Duration \[s\].
    pub(super) duration: f64,
    pub(super) onset: Option<Onset>,
    /// Of a stretch in which contacts slide in a plane, its series and its length in τ.
    pub(super) slide: Option<(PowerSeries, f64)>,
    /// What happens at its end to the reversals of contacts without sliders, by their numbers.
    pub(super) turns: Vec<(usize, Turn)>,
    /// The event at its end, of systems whose motions are followed beside others.
    pub(super) crossing: Option<Crossing>,
}

/// An event, with the motion at it and the regime behind it.
#[derive(Debug, Clone)]
pub(super) struct Crossing {
    pub(super) event: Event,
    pub(super) state: State,
    pub(super) after: Arc<ContactState>,
}

/// What an event at a point does to the derivative of the forces.
#[derive(Debug, Clone)]
pub(super) struct Onset {
    pub(super) point: usize,
    /// Derivative of what passes zero in the modal displacements; empty if there is none. Of a
    /// point that begins to slip the force of the point comes to it.
    pub(super) slope: Vec<f64>,
    /// Rate of what passes zero [N/s].
    pub(super) rate: f64,
    /// Jump of all forces per change of what passes zero.
    pub(super) jump: Vec<f64>,
    /// Points of which no force remains.
    pub(super) released: Vec<usize>,
}

impl LinearPhase {
    /// Adds what an observer of the flow sees to the phases so far.
    pub(crate) fn record(phases: &mut Vec<Self>, system: &ModalSystem, passage: &FlowEvent<'_>) {
        match passage {
            FlowEvent::Segment(segment) => match phases.last_mut() {
                Some(phase)
                    if phase.onset.is_none()
                        && phase.slide.is_none()
                        && phase.turns.is_empty()
                        && !segment.series.is_nonlinear()
                        && phase.regime.points == segment.regime.points =>
                {
                    phase.duration += segment.duration();
                }
                _ => phases.push(Self {
                    regime: Arc::clone(segment.regime),
                    duration: segment.duration(),
                    onset: None,
                    slide: segment
                        .series
                        .is_nonlinear()
                        .then(|| (segment.series.clone(), segment.length)),
                    turns: Vec::new(),
                    crossing: None,
                }),
            },
            FlowEvent::Event { before, turn: Some(turn), .. } => match phases.last_mut() {
                Some(phase) => phase.turns.push(*turn),
                None => phases.push(Self {
                    regime: Arc::clone(before),
                    duration: 0.0,
                    onset: None,
                    slide: None,
                    turns: vec![*turn],
                    crossing: None,
                }),
            },
            // Changes before the first segment find the states to begin with.
            FlowEvent::Event { .. } if phases.is_empty() => {}
            // That of a point by which another one has changed, too.
            FlowEvent::Event { before, after, .. } if before.points == after.points => {}
            // What slides in a plane says itself what remains of a disturbance, and nothing jumps where
            // it comes to rest.
            FlowEvent::Event { event, .. } if system.plane_of(event.point).is_some() => {}
            FlowEvent::Event { event, speed, before, after, state, .. } => {
                if let Some(phase) = phases.last_mut().filter(|_| system.is_followed_beside()) {
                    let first = phase.crossing.is_none() && phase.regime.points == before.points;
                    phase.crossing = first.then(|| Crossing {
                        event: *event,
                        state: (*state).clone(),
                        after: Arc::clone(after),
                    });
                }
                let rate = |regime: &ContactState, i: usize| regime.tangent.times(i, speed);
                let jumps = (0..speed.len()).map(|i| rate(after, i) - rate(before, i));
                let last = phases.last_mut();
                let opens = system.normal_stiffness(event.point) > 0.0;
                if event.state == PointState::Stuck && !opens {
                    // Ordinarily the rates do not jump here; at the onset of slip of a coupled
                    // point they do.
                    if let Some(onset) = last.and_then(|phase| phase.onset.as_mut()) {
                        if onset.rate != 0.0 {
                            let own = onset.rate;
                            onset.jump.iter_mut().zip(jumps).for_each(|(to, by)| *to += by / own);
                        }
                    }
                    return;
                }
                let onset = Some(if opens {
                    Onset::of_normal(system, event, speed, jumps)
                } else {
                    Onset::of_slip(system, event, speed, before)
                });
                match last {
                    Some(phase)
                        if phase.onset.is_none() && phase.regime.points == before.points =>
                    {
                        phase.onset = onset;
                    }
                    _ => {
                        let regime = Arc::clone(before);
                        let (slide, turns) = (None, Vec::new());
                        let crossing = None;
                        phases.push(Self { regime, duration: 0.0, onset, slide, turns, crossing });
                    }
                }
            }
        }
    }

    /// Whether time passes in it, and disturbances follow linear equations of one kind.
    pub(crate) fn is_linear(&self) -> bool {
        self.slide.is_none() && self.duration > 0.0
    }

    /// Whether it is one of these contact states.
    pub(crate) fn begins_as(&self, points: &[PointState]) -> bool {
        self.regime.points == points
    }

    /// Whether a point slips in it.
    pub(crate) fn slips(&self, point: usize) -> bool {
        self.regime.points[point] != PointState::Stuck
            || self.onset.as_ref().is_some_and(|onset| onset.point == point)
    }
}

impl Onset {
    /// The jump while other points keep their states: what the point's force exceeds its limit by is
    /// taken out of all.
    fn of_slip(system: &ModalSystem, event: &Event, speed: &[f64], before: &ContactState) -> Self {
        let (point, sign) = (event.point, event.state.sign());
        let [own, limit] = system.loading(before, point, speed);
        let rate = own - sign * limit;
        let slope = system.limit_slope(point).iter().map(|slope| -sign * slope).collect();
        let own = before.tangent[(point, point)];
        let jump = (0..before.points.len())
            .map(|i| match i {
                i if i == point => -1.0,
                i if own > 0.0 => -before.tangent[(i, point)] / own,
                _ => 0.0,
            })
            .collect();
        Self { point, slope, rate, jump, released: Vec::new() }
    }

    /// The jump where a normal force vanishes or comes back.
    fn of_normal(
        system: &ModalSystem,
        event: &Event,
        speed: &[f64],
        jumps: impl Iterator<Item = f64>,
    ) -> Self {
        let point = event.point;
        let stiffness = system.normal_stiffness(point);
        let rate = stiffness * speed[point];
        let slope = system.contact_shape(point).iter().map(|b| stiffness * b).collect();
        let jump = jumps.map(|by| if rate == 0.0 { 0.0 } else { by / rate }).collect();
        let opens = event.state == PointState::Open;
        let released = system.pressed_by(point).filter(|_| opens).collect();
        Self { point, slope, rate, jump, released }
    }
}
