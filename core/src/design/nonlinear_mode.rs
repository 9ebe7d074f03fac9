//! A nonlinear mode from amplitude to amplitude: its frequency, damping and shape.
//!
//! It begins as the linear mode of the structure with its contacts as they are at rest, and is followed
//! by arclength in the logarithm of the amplitude, around the turns that contacts make as they lift off.

use super::mode_branch::Walk;
use super::mode_point::ModePoint;
use super::quasi_static::quasi_static_mode;
use crate::balance::{HarmonicChoice, Progress};
use crate::contact::{ContactLaw, Residual};
use crate::model::Model;
use crate::timing::Profile;
use crate::Error;
use std::time::Instant;

/// Amplitude, relative to the least one that is asked for, at which a motion leaves the state at rest as it is.
const STILL: f64 = 1e-4;

/// Which amplitudes are wanted [m √kg].
#[derive(Debug, Clone, PartialEq)]
pub enum Amplitudes {
    /// Exactly these, ascending.
    List(Vec<f64>),
    /// All between two.
    Range(f64, f64),
}

/// What a nonlinear mode is taken to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeMethod {
    /// A periodic motion that a damping −ξM feeds (Krack 2015).
    Periodic,
    /// A periodic motion that the forces of the model feed, in quadrature: phase resonance.
    PhaseResonance,
    /// The loop of a load `M φ α` that is raised without inertia (Lacayo and Allen 2019).
    QuasiStatic,
}

/// What is asked of a nonlinear mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSettings {
    /// What it is taken to be.
    pub method: ModeMethod,
    /// Which mode of the structure at rest, from 0.
    pub mode: usize,
    /// Where.
    pub amplitudes: Amplitudes,
    /// Harmonics kept.
    pub harmonics: HarmonicChoice,
    /// Relative error of frequency, damping and shape, for automatic harmonics.
    pub tolerance: f64,
    /// Highest harmonic that automatic ones may reach.
    pub max_harmonics: usize,
    /// Assumed force at mid-range of contacts that never slip.
    pub residual: Residual,
    /// Most points.
    pub most: usize,
}

/// How a branch ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeEnd {
    /// At the largest amplitude.
    Range,
    /// It turned back to small amplitudes.
    Returned,
    /// No point ahead was found.
    Stalled,
    /// As many points as allowed.
    Points,
    /// The caller ended the analysis.
    Interrupted,
}

/// A nonlinear mode.
#[derive(Debug, Clone)]
pub struct NonlinearMode {
    /// Points along the branch, or at the amplitudes given.
    pub points: Vec<ModePoint>,
    /// Frequency [rad/s] and damping ratio at rest.
    pub linear: [f64; 2],
    /// Whether only odd harmonics were solved for.
    pub half_wave: bool,
    /// Amplitudes at which the branch turns.
    pub turns: Vec<f64>,
    /// How it ended, …
    pub end: ModeEnd,
    /// … and at which amplitude.
    pub end_amplitude: f64,
    /// Products with the tangent.
    pub products: usize,
    /// Where the time went.
    pub profile: Profile,
}

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
    let made = match settings.residual {
        Residual::FromRest => crate::balance::with_history(model)?,
        Residual::Centred | Residual::Value(_) => held_at_rest(model, settings, progress)?,
    };
    let residual = |law: &dyn ContactLaw| {
        let held = made.is_some() && keeps_history(law);
        if held {
            Residual::FromRest
        } else {
            settings.residual
        }
    };
    let residuals = model.laws().iter().map(|law| residual(law.as_ref())).collect();
    let mut walk = Walk::new(made.as_ref().unwrap_or(model), settings, residuals, progress)?;
    let (low, _) = walk.bounds();
    let end = match walk.begin(low) {
        Some(z) => walk.follow(z),
        None if walk.equations().is_interrupted() => ModeEnd::Interrupted,
        None => ModeEnd::Stalled,
    };
    let end_amplitude = walk.last.map_or(f64::NAN, f64::exp);
    walk.fill_up();
    let half_wave = walk.equations().harmonics().half_wave();
    let (part, products) = walk.truncation.effort();
    let mut profile = Profile { total: start.elapsed(), estimate: part.estimate, ..walk.profile };
    profile.add(&part);
    Ok(NonlinearMode {
        points: walk.points,
        linear: [walk.linear.omega, walk.linear.damping / (2.0 * walk.linear.omega)],
        half_wave,
        turns: walk.turns,
        end,
        end_amplitude,
        products,
        profile,
    })
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
    progress: &Progress<'_>,
) -> Result<Option<Model>, Error> {
    if !model.laws().iter().any(|law| keeps_history(law.as_ref())) {
        return Ok(None);
    }
    let (harmonics, method) = (HarmonicChoice::Fixed(1), ModeMethod::Periodic);
    let settings = ModeSettings { harmonics, method, ..settings.clone() };
    let residuals = vec![settings.residual; model.laws().len()];
    let mut walk = Walk::new(model, &settings, residuals, progress)?;
    if walk.equations().harmonics().half_wave() {
        return Ok(None);
    }
    let (low, _) = walk.bounds();
    let Some(mut z) = walk.begin(low + STILL.ln()) else { return Ok(None) };
    // Without the motion.
    let size = z.len();
    z[size - 1] = f64::MIN_POSITIVE.sqrt().ln();
    walk.equations().evaluate(&z);
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
