//! A round of a march, and what happens in it.

use super::rate::FrictionWork;
use super::restart::Restart;
use super::samples::Samples;
use super::step::Step;
use crate::contact::{Aft, ContactLaw, Element, Lap, Repeated, SlipLoad};
use faer::Mat;
use std::ops::Deref;

/// Change of the state over a round, relative to the largest, that counts as none.
pub(super) const PERIODIC: f64 = 1e-13;
/// Rounds that a state from beside takes to repeat itself.
const MOST_ROUNDS: usize = 6;
/// Part of a change that counts as none which the distance of two rounds that have met may be: what slip
/// forgets slowly is many times as far from where it ends as it changes.
const MET: f64 = 1e-2;
/// Change of a state over a round, relative to the largest number, that is rounding.
const ROUNDING: f64 = 1e-15;
/// Share of the change over one round that the next one may have.
const FALLS: f64 = 0.5;

/// One round of states that repeat.
pub(super) struct Round {
    /// States and forces, instant after instant.
    pub(super) state: Vec<f64>,
    pub(super) force: Vec<f64>,
    /// State that it ends with, mirrored under half-wave symmetry.
    pub(super) end: Vec<f64>,
    /// Derivative of that in what it begins with, row by row, of a law that takes rounds at once.
    pub(super) by: Vec<f64>,
    /// The last step in which the force may have departed from the stuck spring's, if there is one.
    pub(super) departure: Option<usize>,
    /// Largest number of the state.
    pub(super) largest: f64,
    /// Rounds marched until the states repeated, by how each has begun.
    pub(super) restarts: Vec<Restart>,
    /// Whether the force has ever departed from the stuck spring's, by slip or otherwise.
    pub(super) slipped: bool,
    /// Whether it changes what it begins with otherwise than a spring does.
    pub(super) moves: bool,
    /// Whether its law takes rounds at once.
    pub(super) at_once: bool,
}

impl Round {
    /// None yet, of a law along samples.
    pub(super) fn new(samples: &Samples, size: usize) -> Self {
        Self {
            state: vec![f64::NAN; samples.count * size],
            force: vec![0.0; samples.displacement.len()],
            end: vec![f64::NAN; size],
            by: vec![0.0; size * size],
            departure: None,
            largest: 0.0,
            restarts: vec![Restart::GoesOn],
            slipped: false,
            moves: false,
            at_once: false,
        }
    }

    /// Whether it ends with the state that it has begun with; what has none has nothing to forget.
    fn repeats(&self) -> bool {
        let begun = &self.state[..self.end.len()];
        !begun.is_empty() && distance(&self.end, begun) <= PERIODIC * self.largest
    }

    /// Where the linearised round would end.
    pub(super) fn fixed_point(&self) -> Option<Restart> {
        let size = self.end.len();
        Restart::at_fixed_point(&Mat::from_fn(size, size, |i, j| self.by[i * size + j]))
    }
}

impl<L: Deref<Target: ContactLaw>> Aft<L> {
    /// Takes a round at once; `false` of a law that goes step by step.
    pub(super) fn lap(
        &self,
        samples: &Samples,
        state: &[f64],
        within: f64,
        round: &mut Round,
    ) -> bool {
        let mut lap = Lap {
            displacement: &samples.displacement,
            sign: samples.sign,
            state,
            states: &mut round.state,
            forces: &mut round.force,
            end: &mut round.end,
            by: &mut round.by,
            departs: false,
            departure: round.departure,
            largest: round.largest,
            within: MET * within,
        };
        if !self.law.lap(&mut lap) {
            return false;
        }
        let moves = lap.departs || lap.departure.is_some();
        (round.departure, round.largest) = (lap.departure, lap.largest);
        (round.at_once, round.moves) = (true, moves);
        round.slipped |= moves;
        true
    }

    /// Marches from a state that a motion beside has repeated, by Newton's method to one that this motion
    /// repeats. Nothing where it does not slip: what it repeats then depends on the begin of the march.
    pub(super) fn resume(&self, samples: &Samples, from: &Repeated) -> Option<Round> {
        let mut round = Round::new(samples, self.law.state_size());
        let (mut state, mut last_change) = (from.state.clone(), f64::INFINITY);
        for _ in 0..MOST_ROUNDS {
            if state.len() != round.end.len() || !self.lap(samples, &state, from.within, &mut round)
            {
                return None;
            }
            let fixed_point = round.fixed_point().filter(|_| round.departure.is_some())?;
            let change = distance(&round.end, &state);
            let before = state;
            state = round.end.clone();
            fixed_point.apply(&mut state, &before);
            let repeats = change <= ROUNDING * round.largest
                || distance(&state, &before) <= from.within * round.largest;
            if repeats {
                return Some(round);
            }
            if change > FALLS * last_change {
                return None;
            }
            last_change = change;
        }
        None
    }

    /// Writes the slip load of a round that repeats, and its tangent, if that is asked for: `false` if the
    /// round does not tell it, as it depends on the start of the march.
    pub(super) fn write(
        &self,
        samples: &Samples,
        round: &Round,
        [tangent, resumed]: [bool; 2],
        slots: usize,
        out: &mut SlipLoad,
    ) -> bool {
        let (count, stiffness) = (self.law.displacements(), self.law.stiffness());
        let begun = &round.state[..self.law.state_size()];
        // What the round makes of its begin takes as long as so many coefficients; all rounds may take less.
        let few = round.end.len() <= (round.restarts.len() - 1) * count * slots;
        let repeats = round.at_once || (few && round.repeats());
        let forgets = resumed || (round.departure.is_some() && repeats);
        let mut told = !tangent;
        if tangent && forgets {
            out.make_room(true);
            told = self.differentiate_repeated(samples, &round.state, slots, &mut out.tangent);
            out.derived = 1;
            if !told {
                out.tangent.fill(0.0);
            }
        }
        if !told && resumed {
            return false;
        }
        if told && round.at_once && (resumed || (tangent && forgets)) {
            out.repeated = Some(Repeated { state: begun.to_vec(), within: PERIODIC });
        }
        out.active = true;
        let mut taken = vec![0.0; samples.count];
        for (i, series) in out.value.chunks_exact_mut(slots).enumerate() {
            let held: Vec<f64> = (0..count).map(|j| stiffness[(i, j)]).collect();
            let instants = samples.displacement.chunks_exact(count);
            let forces = round.force.iter().skip(i).step_by(count);
            for ((taken, u), force) in taken.iter_mut().zip(instants).zip(forces) {
                let stuck: f64 = held.iter().zip(u).map(|(k, u)| k * u).sum();
                *taken = stuck - force;
            }
            samples.project(&taken, series);
        }
        told
    }

    /// Share of every displacement in slip, and its friction work, over a round that repeats.
    pub(super) fn account(&self, samples: &Samples, round: &Round) -> [Vec<f64>; 2] {
        let count = self.law.displacements();
        let couples = |element: &Element| element.law.planes().is_empty();
        let coupled = self.law.elements().is_some_and(|elements| elements.iter().all(couples));
        let friction = FrictionWork::new(self.law.stiffness(), coupled);
        let mut step = Step::first(samples, round.state[..self.law.state_size()].to_vec());
        let (mut slipping, mut work) = (vec![0.0; count], vec![0.0; count]);
        let (mut before, mut du) = (vec![0.0; count], vec![0.0; count]);
        for n in 1..=samples.count {
            before.copy_from_slice(&round.force[(n - 1) * count..n * count]);
            self.advance(samples, n, &mut step, true);
            let ends = step.after.iter().zip(samples.at(n - 1));
            du.iter_mut().zip(ends).for_each(|(du, (after, before))| *du = after - before);
            let shares = &step.jacobian.slipping;
            slipping.iter_mut().zip(shares).for_each(|(sum, share)| *sum += share);
            friction.add(&before, &step.force, &du, shares, &mut work);
        }
        [slipping, work]
    }
}

/// Largest difference of two states.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
