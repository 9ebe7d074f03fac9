//! The extended balance that tells how wrong a solution is: how far it reaches, and what it may take.

use super::effort::{allowance, Effort};
use super::resonances::Resonances;
use crate::fourier::Harmonics;
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
pub(super) struct Extension<'a> {
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
    /// Changes of the observed DOFs \[m\] of which one that is exceeded says enough, if there are such.
    pub(super) most: &'a [f64],
}

impl<'a> Extension<'a> {
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
        let (orders, steps) = (solution.orders(highest), solution.steps(highest));
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
        let reckoned = |order: usize| {
            let Account { first, step } = account(order);
            first + effort.of_second() * step
        };
        let farthest = |single: f64| {
            let affordable = |order: &usize| reckoned(*order) + single <= budget(*order);
            candidates().take_while(affordable).last()
        };
        // Modes that what it can afford does not reach are met by single harmonics.
        let reserved = |order: usize| {
            let most = (RESERVED * budget(order)).min(budget(first) - reckoned(first));
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
        let left = (budget(order) - reckoned(order)).max(0.0);
        let of_step = effort.step(order) + 0.5 * left;
        let products = effort.products_within(of_step, [highest, order]);
        let (formed, part) = (effort.is_formed(), effort.takes_part());
        let (account, single) = (account(order), if single > 0.0 { left } else { 0.0 });
        Self { highest: order, steps, unseen, account, products, formed, part, single, most: &[] }
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

    /// Up to changes of the observed DOFs of which one that is exceeded says enough.
    pub(super) fn up_to(self, most: &'a [f64]) -> Self {
        Self { most, ..self }
    }

    /// Whether changes say enough.
    pub(super) fn is_exceeded(&self, changes: &[f64]) -> bool {
        changes.iter().zip(self.most).any(|(change, most)| change > most)
    }

    /// Not beyond a harmonic.
    pub(super) fn within(self, resolved: usize) -> Self {
        Self { highest: self.highest.min(resolved), ..self }
    }
}
