//! How wrong a truncated balance is: what its discarded harmonics would still change.
//!
//! The friction force of the solution has harmonics above H that the balance ignores. A Newton step
//! of the balance extended by them says what they would do: pushed through the compliance they move
//! the contacts, which changes the friction force at all harmonics, which moves the contacts again.
//! The change between two values of H, in contrast, says nothing, for the error stays on a plateau
//! until Hω passes the highest stuck natural frequency.
//!
//! A tangent foresees neither that contacts begin to slip, or cease to, nor that the slip of a nearly
//! rigid contact comes to other parts of the period. Where the first step leaves the motion of a contact
//! unexplained, a second one follows, with the tangent there, and the larger change counts. Along a curve what it
//! adds may be known from a point beside (`neighbour.rs`).

use super::condensed::Condensed;
use super::modal_work::{of_step, suits};
use super::ring::RingNewton;
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{norm, System as _};
use crate::structure::Quantity;
use crate::Error;
use faer::c64;

/// The extended balance reaches past the highest stuck natural frequency by this factor, …
const PAST_LAST_MODE: f64 = 1.2;
/// … at least so far beyond the kept harmonics, as a share of them, …
const SHARE: f64 = 0.5;
/// … but not beyond this multiple of them and so many more: what follows is small, …
const FARTHEST: (usize, usize) = (2, 60);
/// … and only as far as its effort stays below that of the solution, though at least so far, in
/// multiples of the harmonics that loads have in common: friction answers loads at 3ω at 9ω, 15ω, …
const LEAST: usize = 2;

/// Newton steps that the solution of a point with slip takes: four to seven, the last ones without a
/// tangent of their own.
const OF_SOLUTION: f64 = 6.0;

/// Effort of an estimate over that of the Newton steps of the solution, both as reckoned, and over that of
/// its compliances and displacements as long as these are the lesser part; else they cost no more than
/// there. Steps do more than is reckoned: measured, an estimate takes 0.1 to 0.9 times as long as a
/// solution from nothing. With less, estimates at low frequencies stop short of the stuck modes, and of
/// the error.
const ALLOWED: f64 = 3.0;
/// The same of a ring, of which nearly all is reckoned.
const ALLOWED_OF_RING: f64 = 1.6;
/// The same of many contacts, whose products with the modes are reckoned as they are.
const ALLOWED_OF_MANY: f64 = 0.25;
/// The same of many nodes that slip or open, of which nearly all is reckoned.
const ALLOWED_OF_NODES: f64 = 0.8;

/// Share of the defect at a contact that a step may leave: where it leaves more, the tangent was not that
/// of the way.
const UNEXPLAINED: f64 = 0.3;

/// The change after the second step counts up to this multiple of that after the first, unless a contact
/// begins or ceases to slip: at nearly rigid contacts that go on slipping it overshoots tenfold.
const TRUSTED: f64 = 2.0;

/// Newton steps of an extended balance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Steps {
    /// One: a second cannot be afforded.
    One,
    /// One, as long as contacts keep their states; two otherwise.
    OneInState,
    /// Two, unless the first explains the motion of all contacts.
    Two,
}

/// The extended balance of a solution. It follows from the model and the solution and not from the
/// way to it: at a frequency by itself all methods and starts estimate alike.
#[derive(Clone, Copy)]
pub(super) struct Extension {
    /// Its highest harmonic.
    pub(super) highest: usize,
    pub(super) steps: Steps,
    /// What its changes count, so that they stand for those of harmonics that it cannot afford as well.
    unseen: f64,
}

impl Extension {
    /// The extended balance at a frequency.
    pub(super) fn new(
        kept: &Harmonics,
        omega: f64,
        model: &Model,
        slipping: usize,
        observed: usize,
    ) -> Self {
        let highest = kept.highest();
        let reach = PAST_LAST_MODE * model.compliance().highest_frequency() / omega;
        let least = LEAST * common_divisor(&model.compliance().forced_harmonics());
        let beyond = highest + least.max((SHARE * highest as f64) as usize);
        let farthest = FARTHEST.0 * highest + FARTHEST.1;
        let wanted = (reach.min(farthest as f64) as usize).max(beyond);
        let effort = Effort { model, half_wave: kept.half_wave(), slipping, observed };
        // The compliances of the kept harmonics are known; all are recovered, after each step.
        let known = effort.orders(highest, [1.0, 0.0]);
        let is_ring = model.compliance().ring().is_some();
        let of_many = effort.is_of_many(highest);
        let coupled = effort.coupled_points() > 1.0;
        let steps = OF_SOLUTION * effort.step(highest);
        let orders = effort.orders(highest, [1.0, 1.0]);
        let affordable = |order: &usize| {
            let share = match (is_ring, coupled && effort.is_of_many(*order), of_many) {
                (true, ..) => ALLOWED_OF_RING,
                (_, true, _) => ALLOWED_OF_NODES,
                (.., true) => ALLOWED_OF_MANY,
                _ => ALLOWED,
            };
            let allowed = share * steps + (share * orders).min(orders.max(steps));
            effort.orders(*order, [1.0, 2.0]) - known + 2.0 * effort.step(*order) <= allowed
        };
        let candidates = (highest + least..=wanted).step_by(least);
        let farthest = candidates.take_while(affordable).last();
        let order = farthest.unwrap_or(highest + least);
        // Friction forces have kinks: their harmonics fall with the square of the order.
        let sum = |to: usize| 1.0 / (highest + least) as f64 - 1.0 / (to + least) as f64;
        let unseen = sum(wanted.max(order)) / sum(order);
        let steps = if farthest.is_some() { Steps::Two } else { Steps::One };
        Self { highest: order, steps, unseen }
    }

    /// Whether a neighbour may tell what its second step adds.
    pub(super) fn has_two(&self) -> bool {
        self.steps == Steps::Two
    }

    /// Without the second step while contacts keep their states.
    pub(super) fn beside(self) -> Self {
        Self { steps: Steps::OneInState, ..self }
    }

    /// The discarded harmonics that it adds, with those between them.
    pub(super) fn discarded(&self, kept: &Harmonics) -> std::ops::Range<usize> {
        kept.highest() + 1..self.highest + 1
    }

    /// Not beyond a harmonic.
    pub(super) fn within(self, resolved: usize) -> Self {
        Self { highest: self.highest.min(resolved), ..self }
    }
}

/// Greatest common divisor of numbers, 1 of none.
fn common_divisor(numbers: &[usize]) -> usize {
    let divisor = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    numbers.iter().copied().fold(0, divisor).max(1)
}

/// About the time of a balance on a common processor \[ns\]; its ratios count.
struct Effort<'a> {
    model: &'a Model,
    half_wave: bool,
    slipping: usize,
    observed: usize,
}

impl Effort<'_> {
    /// Of so many evaluations of compliances and recoveries of displacements up to an order.
    fn orders(&self, highest: usize, [evaluations, recoveries]: [f64; 2]) -> f64 {
        let count = if self.half_wave { highest.div_ceil(2) } else { highest + 1 };
        let [mut receptance, displacement] = self.model.compliance().effort(self.observed);
        if let Some(modes) = self.model.compliance().contact_modes() {
            if self.is_of_many(highest) {
                receptance = modes.effort();
            }
        }
        count as f64 * (evaluations * receptance + recoveries * displacement)
    }

    /// Points of a law that couples several, in the mean over those of all such laws; 1 if there are none.
    fn coupled_points(&self) -> f64 {
        let sizes = || self.model.laws().iter().map(|law| law.displacements() as f64);
        let coupled = || sizes().filter(|size| *size > 1.0);
        let points: f64 = coupled().sum();
        if points > 0.0 {
            coupled().map(|size| size * size).sum::<f64>() / points
        } else {
            1.0
        }
    }

    /// Whether receptances are not formed.
    fn is_of_many(&self, highest: usize) -> bool {
        suits(self.model.compliance(), &Harmonics::new(highest, self.half_wave))
    }

    /// Of a Newton step in the harmonics up to `highest`.
    fn step(&self, highest: usize) -> f64 {
        let slots = if self.half_wave { 2 * highest.div_ceil(2) } else { 2 * highest + 1 } as f64;
        let compliance = self.model.compliance();
        let (contacts, slipping) = (compliance.contacts() as f64, self.slipping as f64);
        // Every law looks for turning points, unless amplitudes alone show that it sticks, as nearly all
        // of a ring do; one that slips integrates and fills its tangent.
        let looks = if compliance.ring().is_some() { slipping } else { contacts };
        let laws = looks * (600.0 + 40.0 * slots)
            + slipping * (600.0 + 80.0 * slots + 2.5 * slots.powi(2));
        let linear = match compliance.ring() {
            Some(ring) => RingNewton::effort(ring, slots, slipping),
            None if self.is_of_many(highest) => {
                of_step(compliance, slots, slipping, self.coupled_points())
            }
            None => 1e3 + 100.0 * slipping * slots + 0.06 * (slipping * slots).powi(3),
        };
        laws + linear
    }
}

/// What an extended balance says.
pub(super) struct Estimate {
    /// Sum over all harmonics of the change that it would bring to each observed DOF \[m\]; infinite
    /// where a discarded harmonic meets a resonance that nothing damps.
    pub(super) errors: Vec<f64>,
    /// The same after the first step.
    pub(super) first: Vec<f64>,
    /// Whether it makes no contact begin or cease to slip.
    pub(super) keeps_states: bool,
    /// Whether it ended after the first step because of that.
    pub(super) ended_in_state: bool,
}

/// The estimate of a solution; `solved` are the equations that were solved, if they are at hand. Nothing
/// if the analysis is to end.
#[allow(clippy::too_many_arguments)]
pub(super) fn estimate(
    model: &Model,
    table: &SampleTable,
    residual: Residual,
    solution: &Unknowns,
    observe: &[usize],
    point: &Point,
    solved: Option<&Condensed<'_>>,
    extension: &Extension,
    interrupted: &dyn Fn() -> bool,
) -> Result<Option<Estimate>, Error> {
    let [zero, infinite] = [0.0, f64::INFINITY].map(|error| vec![error; observe.len()]);
    let infinite = Ok(Some(Estimate {
        first: infinite.clone(),
        errors: infinite,
        keeps_states: false,
        ended_in_state: false,
    }));
    let mut extended = Condensed::new(model, table, residual, false);
    extended.watch(interrupted);
    if extended.set_omega_beside(point.omega, solved).is_err() {
        return infinite;
    }
    let mut x = solution.recast(table.harmonics());
    let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    extended.residual(&x, &mut defect);
    let mut found =
        Estimate { errors: zero.clone(), first: zero, keeps_states: true, ended_in_state: false };
    for last in [false, true] {
        if extended.interrupted() {
            return Ok(None);
        }
        if !extended.solve(&defect, &mut step) {
            return infinite;
        }
        step.iter_mut().for_each(|s| *s = -*s);
        let mut slip_load = extended.slip_load();
        extended.add_tangent_product(&step, &mut slip_load);
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        let changes = changes(&extended, &x, &slip_load, observe, point)?;
        if last {
            let trusted = if found.keeps_states { TRUSTED } else { f64::INFINITY };
            let errors = found.errors.iter_mut().zip(changes);
            errors.for_each(|(error, change)| *error = error.max(change.min(trusted * *error)));
            break;
        }
        (found.first, found.errors) = (changes.clone(), changes);
        match extension.steps {
            Steps::One => break,
            Steps::OneInState => {
                found.ended_in_state = extended.keeps_states(&x);
                if found.ended_in_state {
                    break;
                }
            }
            Steps::Two => {}
        }
        let slipped = slipping(&extended);
        let before = by_point(&defect, table);
        extended.residual(&x, &mut defect);
        found.keeps_states = slipped == slipping(&extended);
        let mut after = by_point(&defect, table).into_iter().zip(before);
        if after.all(|(after, before)| after <= UNEXPLAINED * before) {
            break;
        }
    }
    let all = found.errors.iter_mut().chain(&mut found.first);
    all.for_each(|error| *error *= extension.unseen);
    Ok(Some(found))
}

/// Which contacts slip where the tangents are known.
fn slipping(extended: &Condensed<'_>) -> Vec<bool> {
    extended.loads.iter().map(|load| load.active).collect()
}

/// Sizes of the series of all points.
fn by_point(series: &[f64], table: &SampleTable) -> Vec<f64> {
    series.chunks_exact(table.harmonics().slots()).map(norm).collect()
}

/// Sum over all harmonics of how far each observed DOF is from a point in the extended balance.
fn changes(
    extended: &Condensed<'_>,
    x: &[f64],
    slip_load: &[f64],
    observe: &[usize],
    point: &Point,
) -> Result<Vec<f64>, Error> {
    let mut sums = vec![0.0; observe.len()];
    let orders = point.harmonics + 1;
    extended.displacements(Quantity::Whole, [x, slip_load], observe, |order, observed, _, _| {
        for (dof, sum) in sums.iter_mut().enumerate() {
            let before = if order < orders {
                point.displacement[dof * orders + order]
            } else {
                c64::new(0.0, 0.0)
            };
            *sum += (observed[dof] - before).norm();
        }
    })?;
    Ok(sums)
}
