//! The exact flow: power series from event to event.
//!
//! A point that sticks begins to slip where its force reaches its limit; a point that slips sticks
//! where its slip velocity vanishes. A contact opens where its normal force vanishes. Where it closes
//! friction begins without force: it sticks if its force grows more slowly than its limit, and else
//! slips. A traction in a plane reaches its limit by its length, and slides until its slip velocity
//! vanishes. All of these are zeros of polynomials, located to rounding.

use super::contact_state::ContactState;
use super::flow_event::{Event, FlowEvent, FlowSegment, Halt};
use super::microslip::Turn;
use super::modal_system::{dot, ModalSystem};
use super::polynomial::{reach_of, DEGREE};
use super::power_series::PowerSeries;
use super::state::State;
use crate::contact::{Bound, PointState};
use std::sync::Arc;

/// Steps between two questions whether to end.
const LOOK: usize = 32;
/// Steps that tell how long the others are: what makes a few of them short, as contact that closes, is passed by then.
const TELLING: usize = 1 << 14;
/// Changes of state at one instant after which the states are contradictory.
const CHANGES: usize = 8;
/// Way of a contact without sliders, relative to its displacement, at which rounding makes it turn.
const RESTING: f64 = 1e-8;
/// Share of a step that is no step.
const INSTANT: f64 = 1e-13;

/// What a contact point is to do next.
pub(super) enum Next {
    /// Change its state at once.
    Now(PointState),
    /// Change its state at τ.
    At(f64, PointState),
    /// Go on to the end of the window.
    Stay,
}

/// The flow of a model excited at one frequency.
pub struct Flow<'a> {
    pub(super) system: &'a ModalSystem,
    omega: f64,
    pub(super) series: PowerSeries,
    pub(super) scratch: Vec<f64>,
    /// Powers of the length of the step at hand, and behind them the same times their orders.
    pub(super) powers: Vec<f64>,
    interrupted: Option<&'a dyn Fn() -> bool>,
    granted: usize,
    /// What other work has cost, in steps.
    charged: usize,
    /// Whether its steps were found to be too short to come to an end.
    crawls: bool,
    /// Steps taken since the start.
    pub steps: usize,
    /// Events met since the start.
    pub events: usize,
}

impl<'a> Flow<'a> {
    /// The flow of a system at a frequency [rad/s].
    #[must_use]
    pub fn new(system: &'a ModalSystem, omega: f64) -> Self {
        let series = PowerSeries::new(system, omega);
        Self {
            system,
            omega,
            series,
            scratch: Vec::new(),
            powers: vec![0.0; 2 * (DEGREE + 1)],
            interrupted: None,
            granted: usize::MAX,
            charged: 0,
            crawls: false,
            steps: 0,
            events: 0,
        }
    }

    /// Has the flow ask between its steps whether to end.
    #[must_use]
    pub fn watched(mut self, interrupted: &'a dyn Fn() -> bool) -> Self {
        self.interrupted = Some(interrupted);
        self
    }

    /// Grants a number of steps in all.
    #[must_use]
    pub fn granted(mut self, steps: usize) -> Self {
        self.grant(steps);
        self
    }

    /// As [`Flow::granted`].
    pub(crate) fn grant(&mut self, steps: usize) {
        self.granted = steps;
        self.crawls = false;
    }

    /// Takes off the steps that are granted what other work costs.
    pub(crate) fn charge(&mut self, steps: usize) {
        self.charged += steps;
    }

    /// Steps that are taken, and what counts as such.
    pub(crate) fn taken(&self) -> usize {
        self.steps + self.charged
    }

    /// Whether all steps that were granted are taken, or would be without coming to an end.
    #[must_use]
    pub fn is_spent(&self) -> bool {
        self.crawls || self.taken() >= self.granted
    }

    /// Whether the steps from a time on, so many as tell, would not come to another time within those that are left,
    /// and back again: an orbit is followed once to be found, and once to be read.
    fn is_slow(&self, since: f64, [now, until]: [f64; 2]) -> bool {
        let wanted = 2.0 * TELLING as f64 * (until - now) / (now - since);
        self.granted < usize::MAX && wanted > self.granted.saturating_sub(self.taken()) as f64
    }

    /// Moves a state on to the time `until` \[s\].
    ///
    /// # Errors
    /// The motion becomes unbounded, contacts do not settle on a state, the steps are spent, or the
    /// caller ends the run.
    pub fn run(
        &mut self,
        state: &mut State,
        until: f64,
        observe: &mut dyn FnMut(FlowEvent<'_>),
    ) -> Result<(), Halt> {
        let mut regime = Arc::new(ContactState::new(self.system, &state.points));
        let (mut changes, most) = (0, CHANGES * self.system.points());
        let mut mark = (self.steps, state.time);
        while state.time < until {
            if !state.is_bounded() {
                return Err(Halt::Unbounded);
            }
            if self.steps - mark.0 >= TELLING {
                self.crawls |= self.is_slow(mark.1, [state.time, until]);
                mark = (self.steps, state.time);
            }
            if self.is_spent() {
                return Err(Halt::Steps);
            }
            if self.steps % LOOK == 0 && self.interrupted.is_some_and(|ask| ask()) {
                return Err(Halt::Interrupted);
            }
            self.series.expand(self.system, &regime, self.omega, state);
            self.steps += 1;
            let natural = self.series.reach();
            self.measure(natural);
            let rest = (until - state.time) * self.series.rate();
            let last = natural >= rest;
            let mut length = natural.min(rest);
            let mut change = None;
            for point in 0..self.system.points() {
                match self.next(&regime, point, natural, length) {
                    Next::Stay => {}
                    // Which branch it is on no longer counts.
                    Next::Now(_) if changes == most && self.rests(point, natural) => {}
                    Next::Now(to) => {
                        (length, change) = (0.0, Some((point, to)));
                        break;
                    }
                    Next::At(tau, to) => (length, change) = (tau, Some((point, to))),
                }
            }
            if length <= 0.0 && change.is_none() {
                // Coefficients whose squares are no numbers have no step.
                let known = self.series.is_bounded();
                return Err(if known { Halt::Steps } else { Halt::Unbounded });
            }
            if length > 0.0 {
                changes = if length > INSTANT * natural { 0 } else { changes };
                let start = state.time;
                observe(FlowEvent::Segment(FlowSegment {
                    series: &self.series,
                    start,
                    length,
                    regime: &regime,
                }));
                self.move_on(state, length);
                if last && change.is_none() {
                    state.time = until;
                }
            }
            let Some((point, to)) = change else { continue };
            changes += 1;
            if changes > most {
                return Err(Halt::Contradiction);
            }
            let speed = self.system.contact_displacement(&state.velocity);
            let turn = self.turn(state, point, to);
            if turn.is_none() {
                self.change(state, &speed, point, to);
            }
            let after = Arc::new(regime.changed(self.system, &state.points));
            // Friction comes and goes with the normal force.
            let mut before = &regime;
            for point in self.changed_with(point) {
                self.events += 1;
                observe(FlowEvent::Event {
                    event: Event { time: state.time, point, state: state.points[point] },
                    speed: &speed,
                    before,
                    after: &after,
                    state,
                    turn,
                });
                before = &after;
            }
            regime = after;
        }
        Ok(())
    }

    /// Prepares bounds on how far polynomials move over a length.
    fn measure(&mut self, length: f64) {
        let mut power = 1.0;
        let (powers, slopes) = self.powers.split_at_mut(DEGREE + 1);
        for (order, (own, slope)) in powers.iter_mut().zip(slopes).enumerate() {
            (*own, *slope) = (power, order as f64 * power);
            power *= length;
        }
    }

    /// Whether a contact without sliders moves within a length by no more than rounding.
    fn rests(&self, point: usize, length: f64) -> bool {
        let u = self.series.contact(point);
        let is_own = self.system.microslips.iter().any(|own| own.point == point);
        is_own && reach_of(u, length) <= RESTING * u[0].abs()
    }

    fn move_on(&self, state: &mut State, length: f64) {
        self.series.state_at(length, self.system, state.parts());
        state.press(self.system);
        state.time += length / self.series.rate();
        for (own, reversals) in self.system.microslips.iter().zip(&state.reversals) {
            let u = dot(self.system.contact_shape(own.point), &state.displacement);
            let sign = state.points[own.point].sign();
            state.force[own.point] = reversals.force(own, sign, u);
        }
    }

    /// A contact without sliders turns round, closes a loop, or passes a break of its backbone.
    fn turn(&self, state: &mut State, point: usize, to: PointState) -> Option<(usize, Turn)> {
        let number = self.system.microslips.iter().position(|own| own.point == point)?;
        let own = &self.system.microslips[number];
        let u = dot(self.system.contact_shape(point), &state.displacement);
        let (sign, reversals) = (state.points[point].sign(), &mut state.reversals[number]);
        if to == state.points[point] {
            return Some((number, reversals.close(sign, u)));
        }
        state.points[point] = to;
        Some((number, reversals.reverse(own, sign, u)))
    }

    /// The points that change with one.
    fn changed_with(&self, point: usize) -> Vec<usize> {
        match self.system.plane_of(point) {
            Some(plane) => plane.points.to_vec(),
            None => std::iter::once(point).chain(self.system.pressed_by(point)).collect(),
        }
    }

    /// Changes the state of a point, at its limit, and of those whose friction it presses.
    fn change(&self, state: &mut State, speed: &[f64], point: usize, to: PointState) {
        let system = self.system;
        let side = if to == PointState::Stuck { state.force[point] } else { to.sign() };
        if let Some(plane) = system.plane_of(point) {
            plane.points.iter().for_each(|&i| state.points[i] = to);
            return system.lengthen(plane, &mut state.force);
        }
        state.points[point] = to;
        if !matches!(system.bounds[point], Bound::Unilateral { .. }) {
            state.force[point] = system.limit(point, &state.force).copysign(side);
            return;
        }
        state.force[point] = -system.balanced(point);
        for friction in system.pressed_by(point) {
            state.force[friction] = 0.0;
            state.points[friction] = to;
        }
        if to == PointState::Open {
            return;
        }
        let stuck = ContactState::new(system, &state.points);
        for friction in system.pressed_by(point) {
            let [own, limit] = system.loading(&stuck, friction, speed);
            if let Some(plane) = system.plane_of(friction) {
                let [u, v] = plane.points.map(|i| system.loading(&stuck, i, speed)[0]);
                if u.hypot(v) >= limit {
                    state.points[friction] = PointState::Sliding;
                }
            } else if own.abs() >= limit {
                state.points[friction] = PointState::slipping(own);
            }
        }
    }
}
