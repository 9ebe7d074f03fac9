//! What becomes of a free motion: it dies away, settles on a periodic motion, goes on without
//! settling, or grows for ever.

use super::flow::Flow;
use super::flow_event::{FlowEvent, Halt};
use super::modal_system::ModalSystem;
use super::output::Extremes;
use super::pace::FASTEST_EXACT;
use super::phase::{Slipping, Sticking};
use super::returns::Returns;
use super::state::State;
use super::transient::PER_PERIOD;
use super::transition::Transition;
use crate::model::Model;
use crate::Error;
use faer::{Mat, Side};
use std::f64::consts::TAU;

/// Squared stuck frequencies below this share of the highest are rigid-body motion.
const RIGID: f64 = 1e-10;
/// Change of the mean size between the last two quarters of a span, from which the motion counts as
/// growing or falling still.
const DRIFT: f64 = 0.05;
/// Fall of the mean closing error between the last two quarters, from which it is still settling.
const SETTLING: f64 = 0.5;
/// Slow periods over which a motion without period is surveyed at the end.
const SURVEYED: usize = 32;
/// Slow periods between two choices of the section.
const CHOICE: usize = 32;

/// Why a motion was given its class. The numbers are those that results keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// Dies away: no contact slips any more, and the stuck structure is damped.
    Stuck = 0,
    /// Dies away: every motion loses energy.
    Passive = 1,
    /// Settled on a periodic motion.
    Closed = 2,
    /// Neither settled nor changing in size over the second half of the span.
    Aperiodic = 3,
    /// Grows for ever: friction cannot hold the motion at its size.
    Unbounded = 4,
    /// Grew out of the range of numbers.
    Overflow = 5,
    /// Undecided: still settling at the end of the span.
    Settling = 6,
    /// Undecided: still growing at the end of the span.
    Growing = 7,
    /// Undecided: still falling at the end of the span.
    Falling = 8,
    /// Undecided: the motion does not come back.
    Monotone = 9,
    /// Undecided: contacts change state without end at one instant.
    Contradiction = 10,
    /// Undecided: the caller has ended the run.
    Interrupted = 11,
    /// Dies away: next to nothing is left of it about an equilibrium.
    Faded = 12,
    /// Undecided: the steps of the flow are too short to come to the end.
    Crawling = 13,
}

/// What becomes of one start.
#[derive(Debug, Clone)]
pub struct Classification {
    /// Why, and with it what.
    pub reason: Reason,
    /// Stuck mode with the largest share of the kinetic energy at the end; none of a motion that
    /// dies away or is not bounded.
    pub mode: Option<usize>,
    /// Share of the kinetic energy of that mode.
    pub share: f64,
    /// Angular frequency of a settled motion [rad/s]; not-a-number otherwise.
    pub omega: f64,
    /// Half the range of every DOF at the end \[m\].
    pub amplitude: Vec<f64>,
    /// When it was decided \[s\].
    pub time: f64,
    /// State then: displacements, velocities, contact forces.
    pub state: Vec<f64>,
    /// Events met.
    pub events: usize,
}

/// Settings of a classification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClassificationSettings {
    /// Longest motion, in periods of the lowest stuck mode.
    pub periods: usize,
    /// Closing error of a settled motion, relative to its size.
    pub tolerance: f64,
}

/// What becomes of free motions of a model.
pub struct Classifier {
    settings: ClassificationSettings,
    system: ModalSystem,
    slipping: Slipping,
    sticking: Sticking,
    /// The same with contacts that are open at rest.
    at_rest: Option<Sticking>,
    /// Whether every motion loses energy.
    passive: bool,
    /// Stuck modes in coordinates η, one per column.
    modes: Mat<f64>,
    /// Period of the lowest stuck mode \[s\].
    slow: f64,
    /// Frequency of the highest stuck mode [rad/s].
    fast: f64,
}

impl Classifier {
    /// Prepares the classification of motions of a model without forces.
    ///
    /// # Errors
    /// A travelling wave, settings outside their range, a structure without oscillation, an
    /// eigenvalue iteration that fails.
    pub fn new(model: &Model, settings: ClassificationSettings) -> Result<Self, Error> {
        if settings.periods == 0 {
            return Err(Error::value("periods", 0.0, "must be at least 1"));
        }
        if !(settings.tolerance > 0.0 && settings.tolerance < 1.0) {
            return Err(Error::value("tolerance", settings.tolerance, "must lie between 0 and 1"));
        }
        let system = ModalSystem::new(model)?;
        if !system.loads.is_empty() {
            let remedy = "free motions have none; leave the forces out";
            return Err(Error::value("forces", system.loads.len() as f64, remedy));
        }
        let sticking = Sticking::new(&system)?;
        let (squares, modes) = sticking.modes()?;
        let highest = squares.last().copied().unwrap_or(0.0);
        // Beside a mass that is hardly there every true oscillation would pass for rigid motion.
        system.check_pace(model, system.slowest_dof(model), RIGID.powf(-0.5))?;
        let Some(lowest) = squares.iter().copied().find(|w| *w > RIGID * highest) else {
            let remedy = "no motion of the stuck structure oscillates; ground the structure";
            return Err(Error::value("stiffness", highest, remedy));
        };
        system.check_pace(model, lowest.sqrt(), FASTEST_EXACT)?;
        Ok(Self {
            settings,
            slipping: Slipping::new(&system)?,
            passive: is_passive(model),
            at_rest: Sticking::at_rest(&system)?,
            sticking,
            system,
            modes,
            slow: TAU / lowest.sqrt(),
            fast: highest.sqrt(),
        })
    }

    /// Follows the motion from a start `(x, v, f)` until it is decided, or to the end of the span.
    ///
    /// # Errors
    /// A state that does not fit the model.
    pub fn of(&self, start: &[f64], go_on: &dyn Fn() -> bool) -> Result<Classification, Error> {
        let mut state = State::from_dofs(&self.system, start)?;
        let coordinates = Transition::new(&self.system, TAU / self.slow);
        let ended = || !go_on();
        let mut flow = Flow::new(&self.system, TAU / self.slow).watched(&ended);
        let mut returns = Returns::new(self.shape(0), self.settings.tolerance);
        let (mut section, mut trend) = (usize::MAX, Trend::default());
        let mut period = f64::NAN;
        let mut passed = 0;
        let reason = loop {
            let mut kept = std::iter::once(&self.sticking).chain(&self.at_rest);
            if kept.any(|own| own.keeps(&self.system, &state)) {
                break Reason::Stuck;
            }
            if self.slipping.outgrows(&self.system, &state) {
                break Reason::Unbounded;
            }
            if returns.faded() {
                break if self.passive { Reason::Passive } else { Reason::Faded };
            }
            if let Some(closed) = returns.closed() {
                if self.passive {
                    break Reason::Passive;
                }
                period = closed.period;
                break Reason::Closed;
            }
            if passed == self.settings.periods {
                break if self.passive { Reason::Passive } else { trend.verdict() };
            }
            if !go_on() {
                break Reason::Interrupted;
            }
            let quarter = 4 * passed / self.settings.periods;
            let begin = passed as f64 * self.slow;
            // The section is the coordinate that moves most: its maxima are far from grazing.
            if passed % CHOICE == 0 {
                let mut ahead = state.clone();
                let chosen = match self.survey(&mut ahead, self.slow, go_on) {
                    Ok(survey) => survey.mode().0,
                    Err(_) => section,
                };
                if chosen != section && chosen < self.modes.ncols() {
                    section = chosen;
                    returns = Returns::new(self.shape(section), self.settings.tolerance);
                }
            }
            state.time = 0.0;
            flow.grant(flow.steps + PER_PERIOD);
            let run = flow.run(&mut state, self.slow, &mut |passage| {
                if let FlowEvent::Segment(segment) = passage {
                    returns.follow(
                        &segment,
                        begin,
                        &self.system,
                        &coordinates,
                        &mut |size, error| {
                            trend.add(quarter, size, error);
                        },
                    );
                }
            });
            match run {
                Ok(()) => passed += 1,
                Err(Halt::Unbounded) => break Reason::Overflow,
                Err(Halt::Contradiction) if self.passive => break Reason::Passive,
                Err(Halt::Contradiction) => break Reason::Contradiction,
                Err(Halt::Steps) => break Reason::Crawling,
                Err(Halt::Interrupted) => break Reason::Interrupted,
            }
        };
        let time = passed as f64 * self.slow;
        Ok(self.concluded(reason, period, time, &state, flow.events, go_on))
    }

    /// Surveys the end of a motion.
    fn concluded(
        &self,
        reason: Reason,
        period: f64,
        time: f64,
        state: &State,
        events: usize,
        go_on: &dyn Fn() -> bool,
    ) -> Classification {
        let mut fate = Classification {
            reason,
            mode: None,
            share: f64::NAN,
            omega: TAU / period,
            amplitude: vec![f64::NAN; self.system.modes()],
            time,
            state: state.to_dofs(&self.system),
            events,
        };
        let span = match reason {
            Reason::Closed => period,
            Reason::Stuck | Reason::Passive | Reason::Faded => self.slow,
            Reason::Unbounded | Reason::Overflow | Reason::Contradiction | Reason::Crawling => {
                return fate
            }
            _ => SURVEYED as f64 * self.slow,
        };
        if let Ok(survey) = self.survey(&mut state.clone(), span, go_on) {
            fate.amplitude = survey.range.iter().map(|[low, high]| 0.5 * (high - low)).collect();
            if !matches!(reason, Reason::Stuck | Reason::Passive | Reason::Faded) {
                let (mode, share) = survey.mode();
                (fate.mode, fate.share) = (Some(mode), share);
            }
        }
        fate
    }

    /// Coordinate of a stuck mode per η.
    fn shape(&self, mode: usize) -> Vec<f64> {
        (0..self.modes.nrows()).map(|j| self.modes[(j, mode)]).collect()
    }

    /// Follows a motion over a span \[s\]: ranges of the DOFs, kinetic energies of the stuck modes.
    fn survey(
        &self,
        state: &mut State,
        span: f64,
        go_on: &dyn Fn() -> bool,
    ) -> Result<Survey, Halt> {
        let n = self.system.modes();
        let ended = || !go_on();
        let granted = PER_PERIOD.saturating_mul((span / self.slow).ceil() as usize);
        let flow = Flow::new(&self.system, TAU / self.slow).watched(&ended);
        let mut flow = flow.granted(granted);
        let shapes: Vec<Vec<f64>> = (0..n).map(|dof| self.system.shape(dof).collect()).collect();
        let mut survey =
            Survey { range: vec![[f64::INFINITY, f64::NEG_INFINITY]; n], kinetic: vec![0.0; n] };
        let mut extremes = Extremes::default();
        // Sixteen samples per period of the fastest mode resolve squares of velocities.
        let samples = (16.0 * span * self.fast / TAU).ceil().max(64.0);
        let instant = span / samples;
        let mut next = 0.0;
        let (mut x, mut v) = (vec![0.0; n], vec![0.0; n]);
        state.time = 0.0;
        flow.run(state, span, &mut |passage| {
            let FlowEvent::Segment(segment) = passage else { return };
            extremes.follow(&segment, &shapes, &mut survey.range);
            let end = segment.start + segment.duration();
            while next < samples && next * instant < end {
                segment.series.motion_at(
                    (next * instant - segment.start) * segment.series.rate(),
                    &mut x,
                    &mut v,
                );
                for (mode, energy) in survey.kinetic.iter_mut().enumerate() {
                    let speed: f64 = (0..n).map(|j| self.modes[(j, mode)] * v[j]).sum();
                    *energy += speed * speed;
                }
                next += 1.0;
            }
        })?;
        Ok(survey)
    }
}

struct Survey {
    range: Vec<[f64; 2]>,
    kinetic: Vec<f64>,
}

impl Survey {
    /// The mode with the most kinetic energy, and its share.
    fn mode(&self) -> (usize, f64) {
        let total: f64 = self.kinetic.iter().sum();
        let most = self.kinetic.iter().enumerate().fold((0, 0.0), |(at, most), (mode, energy)| {
            if *energy > most {
                (mode, *energy)
            } else {
                (at, most)
            }
        });
        (most.0, if total > 0.0 { most.1 / total } else { 0.0 })
    }
}

/// How size and closing error of a motion change from quarter to quarter of the span.
#[derive(Debug, Default)]
struct Trend {
    /// Number of returns, sum of the logarithms of size and of closing error.
    quarters: [(f64, f64, f64); 4],
}

impl Trend {
    fn add(&mut self, quarter: usize, size: f64, error: f64) {
        if let Some(sums) = self.quarters.get_mut(quarter) {
            if size > 0.0 && error.is_finite() {
                sums.0 += 1.0;
                sums.1 += size.ln();
                sums.2 += error.max(f64::MIN_POSITIVE).ln();
            }
        }
    }

    /// What to make of a motion that was not decided within the span.
    fn verdict(&self) -> Reason {
        let [_, _, third, fourth] = self.quarters;
        if third.0 == 0.0 || fourth.0 == 0.0 {
            return Reason::Monotone;
        }
        let size = fourth.1 / fourth.0 - third.1 / third.0;
        let error = fourth.2 / fourth.0 - third.2 / third.0;
        if size > (1.0 + DRIFT).ln() {
            Reason::Growing
        } else if size < -(1.0 + DRIFT).ln() {
            Reason::Falling
        } else if error < SETTLING.ln() {
            Reason::Settling
        } else {
            Reason::Aperiodic
        }
    }
}

/// Whether contacts and the symmetric part of the damping matrix take energy out of every motion.
pub(crate) fn is_passive(model: &Model) -> bool {
    if !model.laws().iter().all(|law| law.is_monotone()) {
        return false;
    }
    let damping = model.structure().damping();
    let symmetric = Mat::from_fn(damping.nrows(), damping.ncols(), |i, j| {
        0.5 * (damping[(i, j)] + damping[(j, i)])
    });
    symmetric.llt(Side::Lower).is_ok()
}
