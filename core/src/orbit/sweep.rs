//! Exact orbits over frequency, and their true maximum.

use super::closed::Orbit;
use super::periodic::PeriodicOrbits;
use super::pieces::pieces;
use crate::balance::{check_frequencies, over_frequencies, PointStatus};
use crate::fourier::Measure;
use crate::motion::{ModalSystem, State, Transition};
use crate::parallel::in_parts;
use crate::solve::{brent, extrapolated, LOOK_BACK};
use crate::timing::Profile;
use crate::Error;
use std::iter;
use std::sync::Arc;
use std::time::Instant;

/// Relative distance in frequency up to which a neighbour is the better start.
const NEIGHBOUR: f64 = 0.05;

/// Exact orbits over frequency.
#[derive(Debug, Clone)]
pub struct Orbits {
    /// In the order of the sweep; of one that was ended early those that were computed, or else the
    /// first, which says so.
    pub points: Vec<Arc<Orbit>>,
    /// Whether the orbits are half-wave symmetric.
    pub half_wave: bool,
    /// Whether the analysis was ended before its last point.
    pub interrupted: bool,
    /// Where the time went; `evaluations` are steps of the flow, `factorisations` transition
    /// matrices, `homotopies` points at which the motion itself had to be followed.
    pub profile: Profile,
}

/// Finds the orbits at the frequencies `omega` [rad/s], in their order. Where one motion alone is possible
/// pieces of the sweep are worked on at the same time, the same pieces with any number of threads.
///
/// # Errors
/// A frequency that is not positive, or as [`PeriodicOrbits::solve`].
pub fn orbit_sweep(orbits: PeriodicOrbits<'_>, omega: &[f64]) -> Result<Orbits, Error> {
    let start = Instant::now();
    check_frequencies(omega)?;
    let (plan, kept) = (&orbits.plan, orbits.kept);
    let pieces =
        if plan.unique { pieces(omega.len()) } else { iter::once(0..omega.len()).collect() };
    let found = in_parts(pieces.len(), orbits.progress, |piece, progress| {
        if !progress(0.0) {
            return Ok(None);
        }
        let mut own = plan.clone().orbits(progress);
        let system = Arc::clone(&plan.system);
        let omega = &omega[pieces[piece].clone()];
        let found = over_frequencies(
            &mut own,
            omega,
            kept,
            PeriodicOrbits::report,
            |orbits, points, frequency| {
                let orbit =
                    orbits.solve(frequency, predict(&system, points, frequency).as_ref())?;
                Ok(Some(orbit).filter(|orbit| orbit.response.status != PointStatus::NotComputed))
            },
        );
        found.map(|(points, interrupted)| Some((points, interrupted, own.profile)))
    });
    let (mut points, mut interrupted, mut profile) = (Vec::new(), false, Profile::default());
    for piece in found {
        let Some((own, ended, spent)) = piece? else {
            interrupted = true;
            break;
        };
        // A curve that was ended early has no gap.
        if !interrupted {
            points.extend(own);
        }
        interrupted |= ended;
        profile.add_whole(&spent);
    }
    if points.is_empty() {
        let empty = |&first| Arc::new(orbits.empty(first, PointStatus::NotComputed));
        points.extend(omega.first().map(empty));
    }
    Ok(Orbits {
        points,
        half_wave: orbits.half_wave(),
        interrupted,
        profile: Profile { total: start.elapsed(), ..profile },
    })
}

/// What the last orbits lead to; nothing where the last one is far away.
fn predict(system: &ModalSystem, points: &[Arc<Orbit>], omega: f64) -> Option<State> {
    let last = points.last()?;
    let start = last.start()?;
    if (omega - last.response.omega).abs() > NEIGHBOUR * omega {
        return None;
    }
    // In coordinates that are energies, errors of all of them count alike.
    let coordinates = Transition::new(system, omega);
    let own =
        |orbit: &Arc<Orbit>| Some((orbit.response.omega, coordinates.coordinates(orbit.start()?)));
    let known: Vec<_> = points.iter().rev().take(LOOK_BACK).map_while(own).collect();
    let (moved, _) = coordinates.state(&extrapolated(&known, omega)?);
    let State { displacement, velocity, force, .. } = moved;
    Some(State { displacement, velocity, force, ..start.clone() })
}

/// Maximises the exact amplitude of one DOF over `[low, high]` [rad/s] from `guess`. Returns the
/// frequency and the amplitude, minus infinity if no orbit is found in the bracket.
///
/// # Errors
/// As [`orbit_sweep`]; a bracket that is not ordered.
pub fn orbit_peak(
    mut orbits: PeriodicOrbits<'_>,
    measure: Measure,
    [low, guess, high]: [f64; 3],
) -> Result<(f64, f64), Error> {
    Error::check_frequency("peak: lower bound", low)?;
    Error::check_frequency("peak: upper bound", high)?;
    if !(low <= guess && guess <= high) {
        return Err(Error::value("peak: guess", guess, "must lie between its bounds"));
    }
    orbits.report_up_to(1);
    let mut start: Option<(f64, State)> = None;
    let mut height = |omega: f64| -> Result<f64, Error> {
        let near = start.as_ref().filter(|(at, _)| (omega - at).abs() <= NEIGHBOUR * omega);
        let orbit = orbits.solve(omega, near.map(|(_, state)| state))?;
        let Some(state) = orbit.start() else { return Ok(f64::NEG_INFINITY) };
        start = Some((omega, state.clone()));
        let [lowest, highest] = orbit.range[0];
        Ok(match measure {
            Measure::HalfRange => 0.5 * (highest - lowest),
            Measure::Max => highest.max(-lowest),
            Measure::Fundamental => orbit.response.displacement[1].norm(),
        })
    };
    brent(low, guess, high, &mut height)
}
