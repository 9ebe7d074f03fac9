//! Points of a balance whose harmonics are those of the exact orbit: where stiff contacts or low
//! frequencies ask for so many that the balance equations would cost more.

use super::forced::ForcedBalance;
use super::price::{Price, TRIFLE};
use super::scale::OF_HARMONICS;
use super::settings::{Resolution, HIGHEST_ORDER};
use super::solution::{Point, PointStatus};
use super::unknowns::Unknowns;
use crate::contact::Motion;
use crate::fourier::Harmonics;
use faer::c64;

/// Changes of state of a contact per period: two stops, and slip in both directions.
const USUAL_EVENTS: usize = 4;
/// Operations of an orbit that nobody waits for, some minutes.
const LONGEST_WAIT: f64 = 1e11;

impl ForcedBalance<'_> {
    /// The point that ends the climb at a solution for which `more` harmonics would be too dear:
    /// the exact orbit, or the solution as it is.
    pub(super) fn instead_of(&mut self, more: Resolution, solved: &Point) -> Option<Point> {
        let slipping = self.nonlinear_points(solved);
        let price = self.price(slipping);
        let (balance, affordable) = (price.of(more.harmonics), price.affordable());
        if more.harmonics <= solved.harmonics || balance <= TRIFLE {
            return None;
        }
        self.orbit_below(solved, balance.min(affordable)).or_else(|| {
            let status = PointStatus::EffortLimit;
            (balance > affordable).then(|| Point { status, ..solved.clone() })
        })
    }

    /// The exact orbit where automatic harmonics have come to their limit.
    pub(super) fn orbit_beyond(&mut self, solved: &Point, limit: PointStatus) -> Option<Point> {
        let most = self.price(solved.contacts.len()).affordable();
        (limit == PointStatus::HarmonicsLimit).then(|| self.orbit_below(solved, most)).flatten()
    }

    /// Whether harmonics up to `order` are worth a homotopy: where they are chosen, a solution of fewer
    /// or an exact orbit may be had for less.
    pub(super) fn is_worth_a_homotopy(&self, order: usize) -> bool {
        let price = self.price(self.model.compliance().contacts());
        !self.control.only_harmonics_climb() || price.allows_homotopy(order)
    }

    /// Whether a homotopy in harmonics up to `order` with all contacts in slip ends before anybody waits for it.
    pub(super) fn has_short_homotopies(&self, order: usize) -> bool {
        self.price(self.model.compliance().contacts()).ends_homotopy(order)
    }

    /// The exact orbit with harmonics up to `order` as a start, if it is affordable: where harmonics
    /// are chosen, beside what they cost, and in any case for someone who waits.
    pub(super) fn orbit_to_start_from(&self, omega: f64, order: usize) -> Option<Point> {
        let contacts = self.model.compliance().contacts();
        let orbits = self.rescue?;
        let price = orbits.price(omega, USUAL_EVENTS * contacts, order)?;
        let chosen = self.control.only_harmonics_climb();
        if price > LONGEST_WAIT || (chosen && price > self.price(contacts).affordable()) {
            return None;
        }
        orbits.orbit(omega, order)
    }

    pub(super) fn price(&self, slipping: usize) -> Price<'_> {
        let lowest = self.control.lowest_order();
        Price { model: &self.model, half_wave: self.half_wave(), slipping, lowest }
    }

    /// The exact orbit, if it costs less than `most` operations with the events of a solution. Where
    /// laws are not monotone it may be another motion than that of the solution.
    pub(super) fn orbit_below(&mut self, solved: &Point, most: f64) -> Option<Point> {
        let wanted = self.control.only_harmonics_climb() && self.model.is_monotone();
        let orbits = self.rescue.filter(|_| wanted)?;
        let events = self.events(solved);
        let price = orbits.price(solved.omega, events, self.orbit_order())?;
        if price > most {
            return None;
        }
        self.point_of_orbit(solved.omega, solved.harmonics)
    }

    /// Changes of contact states per period in a solution.
    fn events(&mut self, solved: &Point) -> usize {
        let Some(unknowns) = &solved.unknowns else { return 0 };
        let table = self.table(unknowns.harmonics.highest());
        let slots = unknowns.harmonics.slots();
        let laws = self.model.laws().iter().zip(self.model.points());
        laws.map(|(law, points)| {
            let displacement = &unknowns.values[points.start * slots..points.end * slots];
            let residual = self.settings.residual;
            law.phases(Motion { table: &table, displacement, residual }).len().saturating_sub(1)
        })
        .sum()
    }

    /// Harmonics of an orbit that judge those which are kept.
    fn orbit_order(&self) -> usize {
        (2 * self.settings.max_harmonics).min(HIGHEST_ORDER)
    }

    /// The point of the exact orbit, with at least the harmonics `least` and as many as the
    /// tolerance asks for; `None` if there is no orbit.
    fn point_of_orbit(&mut self, omega: f64, least: usize) -> Option<Point> {
        let orbit = self.rescue?.orbit(omega, self.orbit_order())?;
        let mut truncated = None;
        for order in self.control.orders_from(least) {
            let mut point = truncate(&orbit, order, self.half_wave());
            self.scale.include(&point);
            let errors = point.error_estimate.iter().copied();
            let error = self.scale.relative(&point, OF_HARMONICS, errors);
            let enough = error <= self.settings.tolerance;
            if !enough {
                point.status = PointStatus::HarmonicsLimit;
            }
            truncated = Some(point);
            if enough {
                break;
            }
        }
        self.profile.orbits += usize::from(truncated.is_some());
        truncated
    }
}

/// An orbit with its harmonics up to `order`, and what those above are.
fn truncate(orbit: &Point, order: usize, half_wave: bool) -> Point {
    let all = orbit.harmonics + 1;
    let kept = |series: &[c64]| -> Vec<c64> {
        series.chunks_exact(all).flat_map(|row| row[..=order].iter().copied()).collect()
    };
    let size = |series: &[c64]| series.iter().map(|x| x.norm()).sum::<f64>();
    // Slip loads fall with the square of the order and compliances do not grow beyond the last
    // mode: all harmonics above the highest one known move a DOF less than the octave below it.
    let left = |row: &[c64]| size(&row[order + 1..]) + size(&row[all / 2..]);
    let harmonics = Harmonics::new(order, half_wave);
    let contact_displacement = kept(&orbit.contact_displacement);
    let mut values = vec![0.0; harmonics.slots() * orbit.contacts.len()];
    let series = contact_displacement.chunks_exact(order + 1);
    for (amplitudes, series) in series.zip(values.chunks_exact_mut(harmonics.slots())) {
        harmonics.write_series(amplitudes, series);
    }
    let error_estimate: Vec<f64> = orbit.displacement.chunks_exact(all).map(left).collect();
    Point {
        harmonics: order,
        displacement: kept(&orbit.displacement),
        contact_force: kept(&orbit.contact_force),
        contact_displacement,
        sampling_error: vec![0.0; error_estimate.len()],
        error_estimate,
        unknowns: Some(Unknowns { harmonics, values }),
        ..orbit.clone()
    }
}
