//! Bounds of exact orbits over the residual tractions that Coulomb allows.
//!
//! Which sliders are extreme is found by the harmonic balance, see [`super::bounds`]. An exact orbit with
//! those sliders then says how far the vibration goes. Its amplitude is attained, whatever the balance
//! leaves out.

use super::bounds::{between, beyond, tables_of, Found, Search};
use crate::balance::{sweep, AmplitudeBounds, ForcedBalance, Point, Progress, Settings};
use crate::model::Model;
use crate::orbit::{Orbit, OrbitSettings, Orbits, PeriodicOrbits};
use crate::Error;
use std::sync::Arc;

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
        let found = search.along(&curve, progress)?;
        for ((orbit, point), found) in solved().zip(&curve.points).zip(&found) {
            if !progress(1.0) {
                break;
            }
            let known = of_orbit(&mut exact, &search, orbit, point, found)?;
            bounds.push(known.unwrap_or_else(|| AmplitudeBounds::not_found(observe.len())));
        }
        orbits.profile.add(&exact.profile);
    }
    let solved = orbits.points.iter_mut().filter(|orbit| orbit.response.is_solved());
    for (orbit, bounds) in solved.zip(bounds) {
        Arc::make_mut(orbit).response.bounds = Some(bounds);
    }
    orbits.profile.total += start.elapsed();
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
    let (Some(nominal), Some(mut here)) = (&found.nominal, search.open(point)?) else {
        return Ok(None);
    };
    let mut others = Vec::new();
    for motion in &found.extremes {
        let start = here.balance.seen_point(motion)?;
        let other = exact.solve_displaced(&start, beyond(motion, &motion.sliders))?;
        let keeps = |slider: usize| other.response.contacts[slider].slip_fraction == 0.0;
        if !(other.response.is_solved() && motion.held().all(|(slider, _)| keeps(slider))) {
            return Ok(None);
        }
        others.push(other.half_ranges());
    }
    let own = orbit.half_ranges();
    Ok(Some(between(&own, nominal.pushed, others.iter().map(Vec::as_slice))))
}
