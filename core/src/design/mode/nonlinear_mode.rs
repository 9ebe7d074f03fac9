//! A nonlinear mode from amplitude to amplitude: its frequency, damping and shape.
//!
//! It begins as the linear mode of the structure with its contacts as they are at rest, and is followed
//! by arclength in the logarithm of the amplitude, around the turns that contacts make as they lift off.

use super::branch::Walk;
use super::harmonics::fewest;
use super::quasi_static::quasi_static_mode;
use super::settings::{Corner, ModeEnd, ModeMethod, ModeSettings, NonlinearMode};
use crate::balance::{HarmonicChoice, Progress};
use crate::contact::{ContactLaw, Held, Residual};
use crate::design::held_pool::is_low;
use crate::model::Model;
use crate::timing::Profile;
use crate::Error;
use std::time::Instant;

/// Amplitude, relative to the least one that is asked for, at which a motion leaves the state at rest as it is.
const STILL: f64 = 1e-4;

/// Force \[N\] that no contact holds.
const BEYOND: f64 = 1e100;

/// The nonlinear mode of a model; its loads but static ones are left out.
///
/// # Errors
/// A mode that does not exist, settings outside their range, a rigid-body motion under static loads.
pub fn nonlinear_mode(
    model: &Model,
    settings: &ModeSettings,
    progress: &Progress<'_>,
) -> Result<NonlinearMode, Error> {
    if settings.method == ModeMethod::QuasiStatic {
        return quasi_static_mode(model, settings, progress);
    }
    let start = Instant::now();
    let residuals = residuals_of(model, settings, progress)?;
    let made = if residuals.contains(&Residual::FromRest) {
        crate::balance::with_history(model)?
    } else {
        held_at_rest(model, settings, residuals.clone(), progress)?
    };
    let residual = |(law, given): (&dyn ContactLaw, &Residual)| {
        let held = made.is_some() && keeps_history(law);
        if held {
            Residual::FromRest
        } else {
            *given
        }
    };
    let residuals: Vec<Residual> =
        model.laws().iter().map(AsRef::as_ref).zip(&residuals).map(residual).collect();
    let model = made.as_ref().unwrap_or(model);
    let along = |lowest| followed(model, settings, residuals.clone(), progress, lowest);
    let (mut walk, mut end) = along(0)?;
    let (mut lowest, mut left) = (0, Profile::default());
    // Where a branch winds, a change of harmonics on the way can turn it back or end it. Then it is
    // followed once more, from its start in as many as it has come to.
    while matches!(end, ModeEnd::Returned | ModeEnd::Stalled | ModeEnd::Evaluations)
        && settings.harmonics == HarmonicChoice::Auto
        && walk.truncation.highest > lowest.max(fewest(settings))
    {
        lowest = walk.truncation.highest;
        let (again, its_end) = along(lowest)?;
        let farther = again.reached() > walk.reached();
        let other = if farther { std::mem::replace(&mut walk, again) } else { again };
        let effort = other.truncation.effort();
        left.add(&effort);
        left.estimate += effort.estimate;
        if farther || its_end == ModeEnd::Interrupted {
            end = its_end;
        } else {
            break;
        }
    }
    let end_amplitude = walk.last.map_or(f64::NAN, f64::exp);
    walk.fill_up();
    let half_wave = walk.equations().harmonics().half_wave();
    let mut part = walk.truncation.effort();
    part.add(&left);
    let estimate = part.estimate + left.estimate;
    let mut profile = Profile { total: start.elapsed(), estimate, ..walk.profile };
    profile.add(&part);
    Ok(NonlinearMode {
        points: walk.points,
        linear: [walk.linear.omega, walk.linear.damping / (2.0 * walk.linear.omega)],
        half_wave,
        turns: walk.turns,
        met: walk.met.map(|(log, met)| (log.exp(), met)),
        end,
        end_amplitude,
        profile,
    })
}

/// A branch from its start to its end, in no fewer harmonics than `lowest` where they are automatic.
fn followed<'a>(
    model: &'a Model,
    settings: &'a ModeSettings,
    residuals: Vec<Residual>,
    progress: &'a Progress<'a>,
    lowest: usize,
) -> Result<(Walk<'a>, ModeEnd), Error> {
    let mut walk = Walk::new(model, settings, residuals, progress, lowest)?;
    let (low, _) = walk.bounds();
    let end = match walk.begin(low) {
        Some(z) => walk.follow(z),
        None if walk.equations().is_interrupted() => ModeEnd::Interrupted,
        None => ModeEnd::Stalled,
    };
    Ok((walk, end))
}

/// The forces that contacts are assumed to hold, law by law.
fn residuals_of(
    model: &Model,
    settings: &ModeSettings,
    progress: &Progress<'_>,
) -> Result<Vec<Residual>, Error> {
    let laws = model.laws().len();
    let Some(Corner { number, share }) = settings.corner else {
        return Ok(vec![settings.residual; laws]);
    };
    // Forces without a mean leave the half period that does not tell what is held.
    let mut held = vec![Residual::Value(f64::MIN_POSITIVE); laws];
    let mut forces = vec![BEYOND; laws];
    if share < 1.0 {
        let settings = simplest(settings);
        let Some(mut walk) = at_rest(model, &settings, held.clone(), progress)? else {
            return Ok(held);
        };
        for (index, law) in model.laws().iter().enumerate() {
            let of =
                |known: Held| 0.5 * (known.range[1] - known.range[0]) * law.stiffness()[(0, 0)];
            let held = law.held(walk.equations().motion(index)).into_iter().flatten().next();
            forces[index] = share * held.map_or(0.0, of);
        }
    }
    for (law, (held, force)) in held.iter_mut().zip(forces).enumerate() {
        *held = Residual::Value(if is_low(number, law) { -force } else { force });
    }
    Ok(held)
}

/// Whether friction keeps what it had at rest.
fn keeps_history(law: &dyn ContactLaw) -> bool {
    let (displacement, state) = law.beginning();
    law.with_history(&displacement, &state).is_some()
}

/// The model with friction that has its history from the equilibrium about which it vibrates: where a
/// contact slips to one side alone, sliders stay where they are until they are pushed. The assumed
/// residual force is that at rest. Nothing where nothing depends on it.
fn held_at_rest(
    model: &Model,
    settings: &ModeSettings,
    residuals: Vec<Residual>,
    progress: &Progress<'_>,
) -> Result<Option<Model>, Error> {
    if !model.laws().iter().any(|law| keeps_history(law.as_ref())) {
        return Ok(None);
    }
    let settings = simplest(settings);
    let Some(mut walk) = at_rest(model, &settings, residuals, progress)? else { return Ok(None) };
    let equations = walk.equations();
    let slots = equations.harmonics().slots();
    let laws = model.laws().iter().zip(model.points()).enumerate().map(|(index, (law, points))| {
        let means = equations.contact[points.start * slots..points.end * slots].iter();
        let displacement: Vec<f64> = means.step_by(slots).copied().collect();
        let states = law.state_history(equations.motion(index), 2);
        law.with_history(&displacement, &states[..law.state_size()])
            .unwrap_or_else(|| law.with_scaled_forces(1.0))
    });
    model.with_laws(laws.collect()).map(Some)
}

/// The settings with one harmonic.
fn simplest(settings: &ModeSettings) -> ModeSettings {
    let (harmonics, method) = (HarmonicChoice::Fixed(1), ModeMethod::Periodic);
    ModeSettings { harmonics, method, ..settings.clone() }
}

/// The equations at the equilibrium, as evaluated without the motion; nothing if there is none, or
/// nothing has a mean.
fn at_rest<'a>(
    model: &'a Model,
    settings: &'a ModeSettings,
    residuals: Vec<Residual>,
    progress: &'a Progress<'a>,
) -> Result<Option<Walk<'a>>, Error> {
    let mut walk = Walk::new(model, settings, residuals, progress, 0)?;
    if walk.equations().harmonics().half_wave() {
        return Ok(None);
    }
    let (low, _) = walk.bounds();
    let Some(mut z) = walk.begin(low + STILL.ln()) else { return Ok(None) };
    let size = z.len();
    z[size - 1] = f64::MIN_POSITIVE.sqrt().ln();
    walk.equations().evaluate(&z);
    Ok(Some(walk))
}
