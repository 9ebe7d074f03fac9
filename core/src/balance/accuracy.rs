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
use super::effort::{allowance, Effort};
use super::resonances::{loaded_points, Resonances};
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{norm, System as _};
use crate::structure::Quantity;
use crate::timing::Profile;
use crate::Error;
use faer::c64;
use std::ops::Range;

/// The extended balance reaches past the highest stuck natural frequency by this factor, …
pub(super) const PAST_LAST_MODE: f64 = 1.2;
/// … at least so far beyond the kept harmonics, as a share of them, …
const SHARE: f64 = 0.5;
/// … but not beyond this multiple of them and so many more: what follows is small, …
const FARTHEST: (usize, usize) = (2, 60);
/// … and only as far as its effort stays below that of the solution, though at least so far, in
/// multiples of the harmonics that loads have in common: friction answers loads at 3ω at 9ω, 15ω, …
/// Where these come to all sectors at once, and contacts between sectors do not feel them, the next ones tell.
const LEAST: usize = 2;
/// Share of what it may take that is left to single harmonics beyond it, if they meet modes.
const RESERVED: f64 = 0.5;

/// Newton steps that the solution of a point with slip takes: four to seven, the last ones without a
/// tangent of their own.
const OF_SOLUTION: f64 = 6.0;

/// Share of the defect at a contact that a step may leave: where it leaves more, the tangent was not that
/// of the way.
const UNEXPLAINED: f64 = 0.3;

/// The change after the second step counts up to this multiple of that after the first, unless a contact
/// begins or ceases to slip: at nearly rigid contacts that go on slipping it overshoots tenfold.
const TRUSTED: f64 = 2.0;
/// Of solutions up to this harmonic the first change falls short there by as much, and the geometric mean of both counts
/// if it is more, …
const FEW: usize = 5;
/// … and all changes count so many times, as those of three grids do (Roache 1998).
const CAUTION: f64 = 1.25;

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

/// What an estimate costs, in reckoned nanoseconds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Account {
    /// That of compliances and displacements, with one step.
    first: f64,
    /// That of one more step.
    step: f64,
}

impl Account {
    /// With one step or two.
    pub(super) fn of(&self, two: bool) -> f64 {
        self.first + if two { self.step } else { 0.0 }
    }
}

/// The extended balance of a solution. It follows from the model and the solution and not from the
/// way to it: at a frequency by itself all methods and starts estimate alike.
#[derive(Clone, Copy)]
pub(super) struct Extension {
    /// Its highest harmonic.
    pub(super) highest: usize,
    pub(super) steps: Steps,
    /// What its changes count, so that they stand for those of harmonics that it cannot afford as well.
    pub(super) unseen: f64,
    pub(super) account: Account,
    /// Products that a step may take where the solution takes none: they are few, or too dear.
    pub(super) products: Option<usize>,
    /// Whether its Jacobian is formed in any case.
    pub(super) formed: bool,
    /// Whether receptances are of loads at the points that slip alone, if dense ones are taken.
    pub(super) part: bool,
    /// What single harmonics beyond it that meet modes may take, in reckoned nanoseconds.
    pub(super) single: f64,
}

impl Extension {
    /// The extended balance at a frequency. It takes no more than the Newton steps of a solution from nothing
    /// allow, nor than `credit`. Where few of many contacts slip receptances of these may take less than products.
    pub(super) fn new(effort: &Effort<'_>, kept: &Harmonics, omega: f64, credit: f64) -> Self {
        let of = |own: &Effort<'_>| Self::of([effort, own], kept, omega, credit);
        let found = of(effort);
        // Nodes carry loads without slip.
        if !effort.takes_products(found.highest) || effort.is_of_nodes() {
            return found;
        }
        let formed = of(&effort.formed());
        let [by_products, whole] = [&found, &formed].map(|one| one.account.of(true));
        let reaches = formed.highest.cmp(&found.highest).then(by_products.total_cmp(&whole));
        if reaches.is_gt() {
            formed
        } else {
            found
        }
    }

    /// The same by an effort of its own, beside that of the solution.
    fn of([solution, effort]: [&Effort<'_>; 2], kept: &Harmonics, omega: f64, credit: f64) -> Self {
        let (highest, compliance) = (kept.highest(), effort.compliance());
        let reach = PAST_LAST_MODE * compliance.highest_frequency() / omega;
        let least = LEAST * effort.common_harmonic();
        // Even harmonics, where there are any, are between.
        let silent = kept.half_wave() && compliance.is_silent(highest + least);
        let first = highest + if silent { 2 * least } else { least };
        let share = (SHARE * highest as f64 / least as f64).ceil() as usize;
        let beyond = first.max(highest + share * least);
        let farthest = FARTHEST.0 * highest + FARTHEST.1;
        let reach = reach.min(farthest as f64);
        let wanted = (reach as usize).max(beyond);
        let (orders, steps) = (solution.orders(highest), OF_SOLUTION * solution.step(highest));
        // The compliances of the kept harmonics are known; all are recovered, after each step.
        let later = effort.with_more_slip();
        let account = |order: usize| {
            let [displacements, compliances] = effort.extended(highest, order);
            let first = compliances + displacements + effort.step(order);
            Account { first, step: displacements + later.step(order) }
        };
        let budget =
            |order: usize| allowance(effort.allowed([highest, order]), steps, orders).min(credit);
        // The first one past it tells what follows.
        let last = wanted.max(reach.ceil() as usize + least - 1);
        let candidates = || (first..=last).step_by(least);
        let farthest = |single: f64| {
            let affordable = |order: &usize| account(*order).of(true) + single <= budget(*order);
            candidates().take_while(affordable).last()
        };
        // Modes that what it can afford does not reach are met by single harmonics.
        let reserved = |order: usize| {
            let most = (RESERVED * budget(order)).min(budget(first) - account(first).of(true));
            Resonances::beyond(order, most, effort, kept, omega).effort
        };
        let all = farthest(0.0);
        let single = all.map_or(0.0, reserved);
        let farthest = if single > 0.0 { farthest(single) } else { all };
        let order = farthest.unwrap_or(first);
        // Friction forces have kinks: their harmonics fall with the square of the order.
        let sum = |to: usize| 1.0 / first as f64 - 1.0 / (to + least) as f64;
        let unseen = sum(wanted.max(order)) / sum(order);
        let steps = if farthest.is_some() { Steps::Two } else { Steps::One };
        // Each of two steps may take half of what is left.
        let left = (budget(order) - account(order).of(true)).max(0.0);
        let of_step = effort.step(order) + 0.5 * left;
        let products = effort.products_within(of_step, [highest, order]);
        let (formed, part) = (effort.is_formed(), effort.takes_part());
        let (account, single) = (account(order), if single > 0.0 { left } else { 0.0 });
        Self { highest: order, steps, unseen, account, products, formed, part, single }
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
    pub(super) fn discarded(&self, kept: &Harmonics) -> Range<usize> {
        kept.highest() + 1..self.highest + 1
    }

    /// Not beyond a harmonic.
    pub(super) fn within(self, resolved: usize) -> Self {
        Self { highest: self.highest.min(resolved), ..self }
    }
}

/// What an extended balance says.
pub(super) struct Estimate {
    /// Sum over all harmonics of the change that it would bring to each observed DOF \[m\]; infinite
    /// where a discarded harmonic meets a resonance that nothing damps.
    pub(super) errors: Vec<f64>,
    /// The same after the first step.
    pub(super) first: Vec<f64>,
    /// Largest change of the motion of a contact, relative to its vibration; of the steps taken together.
    pub(super) contacts: f64,
    /// Whether it makes no contact begin or cease to slip.
    pub(super) keeps_states: bool,
    /// Whether it ended after the first step because of that.
    pub(super) ended_in_state: bool,
    /// Whether it took a second step.
    pub(super) took_two: bool,
}

impl Estimate {
    /// Whether the extended balance led nowhere.
    pub(super) fn is_lost(&self) -> bool {
        !self.contacts.is_finite()
    }

    /// Of the same change of every observed DOF.
    fn of(error: f64, observed: usize) -> Self {
        let errors = vec![error; observed];
        Self {
            first: errors.clone(),
            errors,
            contacts: error,
            keeps_states: error.is_finite(),
            ended_in_state: false,
            took_two: false,
        }
    }
}

/// The estimate of a solution, whose work `profile` is told; `solved` are the equations that were solved, if they
/// are at hand. Nothing if the analysis is to end.
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
    profile: &mut Profile,
) -> Result<Option<Estimate>, Error> {
    let mut extended = Condensed::new(model, table, residual, false);
    if extension.formed {
        extended.densify();
    }
    if let Some(most) = extension.products {
        extended.hold_to_products(most);
    }
    if extension.part {
        extended.answer(loaded_points(model, point));
    }
    extended.watch(interrupted);
    if extended.set_omega_beside(point.omega, solved).is_err() {
        return Ok(Some(Estimate::of(f64::INFINITY, observe.len())));
    }
    if let Some(solved) = solved {
        extended.begin_beside(solved, None);
    }
    let found = of_extended(&mut extended, solution, observe, point, extension);
    profile.work += extended.profile.work;
    found
}

/// The same of extended equations at its frequency.
fn of_extended(
    extended: &mut Condensed<'_>,
    solution: &Unknowns,
    observe: &[usize],
    point: &Point,
    extension: &Extension,
) -> Result<Option<Estimate>, Error> {
    let table = extended.table;
    let begin = solution.recast(table.harmonics());
    let mut x = begin.clone();
    let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    extended.residual(&x, &mut defect);
    let mut found = Estimate::of(0.0, observe.len());
    for last in [false, true] {
        if extended.interrupted() {
            return Ok(None);
        }
        if !extended.solve(&defect, &mut step) {
            let lost = Estimate::of(f64::INFINITY, observe.len());
            return Ok(if extended.interrupted() { None } else { Some(lost) });
        }
        step.iter_mut().for_each(|s| *s = -*s);
        let mut slip_load = extended.slip_load();
        extended.add_tangent_product(&step, &mut slip_load);
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        let changes = changes(extended, &x, &slip_load, observe, point)?;
        found.contacts = contact_change(extended, &begin, &x);
        found.took_two = last;
        if last {
            let [keeps, few] = [found.keeps_states, point.harmonics <= FEW];
            let trusted = |first: f64, second: f64| {
                let between = if few { (first * second).sqrt() } else { 0.0 };
                let most = between.max(TRUSTED * first);
                if keeps {
                    second.min(most)
                } else {
                    second
                }
            };
            let errors = found.errors.iter_mut().zip(changes);
            errors.for_each(|(error, change)| *error = error.max(trusted(*error, change)));
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
        let slipped = slipping(extended);
        let before = by_point(&defect, table);
        extended.residual(&x, &mut defect);
        found.keeps_states = slipped == slipping(extended);
        let mut after = by_point(&defect, table).into_iter().zip(before);
        if after.all(|(after, before)| after <= UNEXPLAINED * before) {
            break;
        }
    }
    let caution = if point.harmonics <= FEW { CAUTION } else { 1.0 };
    let both = found.errors.iter_mut().chain(&mut found.first);
    both.for_each(|error| *error *= caution * extension.unseen);
    found.contacts *= extension.unseen;
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

/// Largest change of the motion of a contact, relative to its vibration.
fn contact_change(extended: &Condensed<'_>, begin: &[f64], x: &[f64]) -> f64 {
    let (slots, offset) = (extended.harmonics().slots(), extended.harmonics().offset());
    let changes = extended.model.points().iter().map(|points| {
        let (mut change, mut vibration) = (0.0_f64, 0.0_f64);
        for point in points.clone() {
            let series = point * slots + offset..(point + 1) * slots;
            let (begin, x) = (&begin[series.clone()], &x[series]);
            vibration += begin.iter().map(|a| a * a).sum::<f64>();
            change += begin.iter().zip(x).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
        }
        if vibration > 0.0 {
            (change / vibration).sqrt()
        } else {
            0.0
        }
    });
    changes.fold(0.0, f64::max)
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
            // In place of `norm`, which guards against squares beyond all numbers and takes five times as long.
            *sum += (observed[dof] - before).norm_sqr().sqrt();
        }
    })?;
    Ok(sums)
}
