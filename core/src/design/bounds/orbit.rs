//! Bounds of exact orbits over the residual tractions that Coulomb allows.
//!
//! Which sliders are extreme is found by the harmonic balance, see [`super::response`]. An exact orbit with
//! those sliders then says how far the vibration goes. Its amplitude is attained, whatever the balance
//! leaves out.

use super::response::{between, tables_of, Found, Search};
use crate::balance::{
    sweep, AmplitudeBounds, ForcedBalance, HeldMotion, Point, Progress, Settings,
};
use crate::design::held_pool::beyond;
use crate::model::Model;
use crate::orbit::{Orbit, OrbitSettings, Orbits, PeriodicOrbits};
use crate::Error;
use std::sync::Arc;

/// How far from their limits, relative to their range, sliders are at the start of an orbit, one after the
/// other until it is found.
const CLEAR: [f64; 3] = [1e-6, 1e-2, 0.2];

/// Adds to orbits the bounds of their amplitudes over all residual tractions. `proved` tells that theory
/// leaves one vibration alone; `search` are the settings of the balance that finds the extreme sliders,
/// under the residual of the orbits.
///
/// # Errors
/// As for the orbits and the balance.
pub fn bound_orbits(
    model: &Model,
    search: Settings,
    observe: &[usize],
    proved: bool,
    (settings, orbits): (OrbitSettings, &mut Orbits),
    progress: &Progress<'_>,
) -> Result<(), Error> {
    let start = std::time::Instant::now();
    let solved = || orbits.points.iter().filter(|orbit| orbit.response.is_solved());
    let search = Settings { residual: settings.residual, ..search };
    let mut exact = PeriodicOrbits::new(model, settings, observe)?.watched(progress);
    let mut bounds: Vec<AmplitudeBounds> = Vec::new();
    if proved || !exact.depends_on_sliders() {
        bounds.extend(solved().map(|orbit| AmplitudeBounds::unique(orbit.half_ranges(), proved)));
    } else {
        let omega: Vec<f64> = solved().map(|orbit| orbit.response.omega).collect();
        let curve = sweep(ForcedBalance::new(model, search, observe)?.watched(progress), &omega)?;
        let tables = tables_of(&curve);
        let mut search = Search::new(model, search, observe, &curve, &tables)?;
        let found = search.along(&curve, Some(&curve.profile), progress)?;
        for ((orbit, point), found) in solved().zip(&curve.points).zip(&found) {
            let known = of_orbit(&mut exact, &search, orbit, point, found)?;
            // What is not found once the search is ended need not be missing.
            if !progress(1.0) {
                break;
            }
            bounds.push(known.unwrap_or_else(|| AmplitudeBounds::not_found(observe.len())));
        }
        orbits.profile.add(&exact.profile);
    }
    let solved = orbits.points.iter_mut().filter(|orbit| orbit.response.is_solved());
    for (orbit, bounds) in solved.zip(bounds) {
        Arc::make_mut(orbit).response.bounds = Some(bounds);
    }
    orbits.profile.total += start.elapsed();
    orbits.interrupted |= !progress(1.0);
    Ok(())
}

/// Bounds of an orbit by those with the sliders of the extreme motions; `None` where one of them was not
/// found.
fn of_orbit(
    exact: &mut PeriodicOrbits<'_>,
    search: &Search<'_>,
    orbit: &Orbit,
    point: &Point,
    found: &Found,
) -> Result<Option<AmplitudeBounds>, Error> {
    let (Some(nominal), Some(mut pool)) = (&found.nominal, search.open(point)?) else {
        return Ok(None);
    };
    let mut others = Vec::new();
    // The motion of the balance itself may have been left by another past than the orbit.
    let own = found.extremes.first().map(|_| nominal);
    for motion in own.into_iter().chain(&found.extremes) {
        let mut sought = CLEAR.iter().map(|clear| {
            let start = pool.balance.seen_point(motion, *clear)?;
            let other = exact.solve_displaced(&start, beyond(motion, &motion.sliders))?;
            Ok(is_alike(&other, motion, nominal).then(|| other.half_ranges()))
        });
        match sought.find_map(Result::transpose) {
            Some(other) => others.push(other?),
            None => return Ok(None),
        }
    }
    let own = orbit.half_ranges();
    let bounds = between(&own, nominal.pushed, others.iter().map(Vec::as_slice));
    Ok(Some(bounds.by_search(found.cut)))
}

/// Whether an orbit leaves the sliders that a motion leaves, and no other ones of the nominal motion.
fn is_alike(orbit: &Orbit, motion: &HeldMotion, nominal: &HeldMotion) -> bool {
    let contacts = orbit.response.contacts.iter().zip(motion.range.iter().zip(&nominal.range));
    let mut same = contacts.map(|(contact, (own, nominal))| match (own, nominal) {
        (Some(_), _) => contact.slip_fraction == 0.0,
        (None, Some(_)) => contact.slip_fraction > 0.0,
        (None, None) => true,
    });
    orbit.response.is_solved() && same.all(|same| same)
}
