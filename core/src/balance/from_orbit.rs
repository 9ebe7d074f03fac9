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
/// How many times its price an orbit counts where laws are not monotone: a balance of its own leads to its start,
/// and it may be another motion.
const ASTRAY: f64 = 10.0;
/// An estimate is above a fifth of the error but at one point of a thousand.
const CAUTION: f64 = 5.0;
/// Newton's method that has lost its way takes at least so many times what it usually does.
const OF_LOST: f64 = 6.0;
/// Operations of the matrices of any orbit, over the third power of the degrees of freedom.
const OF_MATRICES: f64 = 200.0;
/// Operations of an orbit that nobody waits for, some minutes.
const LONGEST_WAIT: f64 = 1e11;

impl ForcedBalance<'_> {
    /// The point that ends the climb at a solution for which `more` harmonics would be too dear:
    /// the exact orbit, or the solution as it is.
    pub(super) fn instead_of(&mut self, more: Resolution, solved: &Point) -> Option<Point> {
        let [balance, affordable] = self.prices_of(more, solved)?;
        self.orbit_below(solved, balance.min(affordable)).or_else(|| {
            let status = PointStatus::EffortLimit;
            (balance > affordable).then(|| Point { status, ..solved.clone() })
        })
    }

    /// Whether `more` harmonics than those of a solution would be too dear.
    pub(super) fn is_too_dear(&self, more: Resolution, solved: &Point) -> bool {
        self.prices_of(more, solved).is_some_and(|[balance, affordable]| balance > affordable)
    }

    /// What `more` harmonics than those of a solution cost, and what they may; nothing if they are a trifle.
    fn prices_of(&self, more: Resolution, solved: &Point) -> Option<[f64; 2]> {
        let price = self.price(self.nonlinear_points(solved));
        let (balance, affordable) = (price.of(more.harmonics), price.affordable());
        let climbs = more.harmonics > solved.harmonics && balance > TRIFLE;
        climbs.then_some([balance, affordable])
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
    pub(super) fn orbit_to_start_from(&mut self, omega: f64, order: usize) -> Option<Point> {
        let contacts = self.model.compliance().contacts();
        let orbits = self.rescue?;
        let price = orbits.price(omega, USUAL_EVENTS * contacts, order)?;
        let chosen = self.control.only_harmonics_climb();
        if price > LONGEST_WAIT || (chosen && price > self.price(contacts).affordable()) {
            return None;
        }
        self.charged(|| orbits.orbit(omega, order))
    }

    /// Whether an orbit costs less than the steps with harmonics up to `order` that lost their way.
    pub(super) fn favours_orbit(&self, omega: f64, order: usize) -> bool {
        let contacts = self.model.compliance().contacts();
        let most = OF_LOST * self.price(contacts).of(order);
        let least = OF_MATRICES * (self.model.compliance().dofs() as f64).powi(3);
        let price = || self.rescue?.price(omega, USUAL_EVENTS * contacts, order);
        // Orbits of many degrees of freedom would take long to prepare.
        self.may_begin_with_orbit(order) && least <= most && price().is_some_and(|own| own <= most)
    }

    /// Contact displacements up to `highest` of a motion that settles in time, where no homotopy leads on.
    pub(super) fn settled_motion(&mut self, omega: f64, highest: usize) -> Option<Vec<c64>> {
        let orbits = self.rescue.filter(|_| !self.is_monotone())?;
        self.charged(|| orbits.settled(omega, highest))
    }

    /// Whether some body walks at a frequency.
    pub(super) fn walks(&mut self, omega: f64) -> bool {
        self.rescue.is_some_and(|orbits| self.charged(|| orbits.walks(omega)))
    }

    /// What a search for an orbit gives, within what is left of the work of the point, and on its account.
    fn charged<T>(&mut self, search: impl FnOnce() -> T) -> T {
        let Some(orbits) = self.rescue else { return search() };
        orbits.allow(self.left());
        let before = orbits.work();
        let found = search();
        let searched = orbits.work() - before;
        self.profile.work += searched;
        self.account.searched += searched;
        found
    }

    pub(super) fn price(&self, slipping: usize) -> Price<'_> {
        let lowest = self.control.lowest_order();
        Price { model: &self.model, half_wave: self.half_wave(), slipping, lowest }
    }

    /// The exact orbit, if it costs less than `most` operations with the events of a solution. Where
    /// laws are not monotone it has to be the motion of a solution; where there is none it is a motion as good as
    /// any other, unless it is one of many by what its contacts keep.
    pub(super) fn orbit_below(&mut self, solved: &Point, most: f64) -> Option<Point> {
        let orbits = self.rescue.filter(|_| self.control.only_harmonics_climb())?;
        let events = self.events(solved);
        let price = orbits.price(solved.omega, events, self.orbit_order())?;
        let of = solved.unknowns().filter(|_| solved.is_solved() && !self.model.is_monotone());
        let share = if of.is_some() { ASTRAY } else { 1.0 };
        if share * price > most {
            return None;
        }
        let order = self.orbit_order();
        let orbit = self.charged(|| match of {
            Some(motion) => orbits.orbit_of(motion, solved.omega, order),
            None => orbits.orbit(solved.omega, order),
        })?;
        let suits = match of {
            _ if self.model.is_monotone() => true,
            Some(_) => self.is_same_motion(solved, &orbit),
            None => !orbits.is_one_of_many(solved.omega),
        };
        suits.then(|| self.point_of_orbit(&orbit, solved.harmonics)).flatten()
    }

    /// Whether an orbit is the motion of a solution, as closely as its error estimate says or the tolerance asks; not
    /// if the error is not known.
    fn is_same_motion(&self, solved: &Point, orbit: &Point) -> bool {
        let (own, all) = (solved.harmonics + 1, orbit.harmonics + 1);
        let rows = solved.displacement.chunks_exact(own).zip(orbit.displacement.chunks_exact(all));
        let apart = rows.map(|(x, y)| x.iter().zip(y).skip(1).map(|(x, y)| (x - y).norm()).sum());
        let apart = self.scale.relative(solved, OF_HARMONICS, apart);
        let estimate = solved.error_estimate.iter().copied();
        let error = self.scale.relative(solved, OF_HARMONICS, estimate);
        error.is_finite() && apart <= CAUTION * error.max(self.settings.tolerance)
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

    /// The point of an exact orbit, with at least the harmonics `least` and as many as the
    /// tolerance asks for.
    fn point_of_orbit(&mut self, orbit: &Point, least: usize) -> Option<Point> {
        let mut truncated = None;
        for order in self.control.orders_from(least) {
            let mut point = truncate(orbit, order, self.half_wave());
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
    let rows = orbit.displacement.chunks_exact(all).zip(&orbit.error_estimate);
    let error_estimate: Vec<f64> = rows.map(|(row, unseen)| left(row) + unseen).collect();
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::balance::settings::Settings;
    use crate::contact::Cubic;
    use crate::model::{Contact, Model};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{mat, Mat};

    /// An orbit twice as large is another motion, also where the error of the solution is not known.
    #[test]
    fn an_error_that_is_not_known_makes_no_orbit_the_same_motion() {
        let one = mat![[1.0]];
        let structure = Structure::new(one.as_ref(), mat![[0.1]].as_ref(), one.as_ref());
        let row = Mat::from_fn(1, 1, |_, _| 1.0);
        let contacts = vec![Contact { law: Box::new(Cubic::new(0.3).unwrap()), rows: row }];
        let loads = vec![HarmonicLoad { harmonic: 1, amplitude: vec![c64::new(0.2, 0.0)] }];
        let model = Model::new(structure.unwrap(), contacts, loads).unwrap();
        let mut balance = ForcedBalance::new(&model, Settings::default(), &[0]).unwrap();
        let mut point = balance.solve(0.7, None).unwrap();
        let mut other = point.clone();
        other.displacement.iter_mut().for_each(|x| *x *= 2.0);
        assert!(balance.is_same_motion(&point, &point) && !balance.is_same_motion(&point, &other));
        point.error_estimate = vec![f64::NAN];
        assert!(!balance.is_same_motion(&point, &other));
    }
}
