//! Nonlinear modes: settings in, points along the branch out.

use crate::columns::Columns;
use crate::found::Found;
use crate::problem::Problem;
use crate::settings::{self, get, harmonics};
use crate::watch::found;
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::design::{
    self, Amplitudes, Corner, ModeEnd, ModeMethod, ModeSettings, NonlinearMode,
};
use stickslip_core::Model;

/// A nonlinear mode as columns.
fn branch(found: &NonlinearMode, model: &Model) -> Columns {
    let (dofs, contacts) = (model.compliance().dofs(), model.compliance().contacts());
    let points = || found.points.iter();
    let mut columns = Columns::default();
    columns.responses(points().map(|p| &p.response), dofs, contacts);
    columns.one("amplitude", points().map(|p| p.amplitude));
    columns.one("damping_ratio", points().map(|p| p.damping_ratio));
    columns.one("viscous_ratio", points().map(|p| p.viscous));
    columns.one("force_level", points().map(|p| p.force_level));
    columns.rows("relative_error", 2, f64::NAN, points().map(|p| p.errors));
    let met = |of: fn(&design::Interaction) -> f64| {
        points().map(move |p| p.interaction.as_ref().map_or(f64::NAN, of)).collect::<Vec<_>>()
    };
    let order = points().map(|p| p.interaction.map_or(0, |met| met.order as i64));
    columns.one("resonance_order", order);
    columns.one("resonance_omega", met(|met| met.frequency));
    columns.one("resonance_share", met(|met| met.share));
    columns.one("turns", found.turns.iter().copied());
    columns.one("linear", found.linear);
    let end = match found.end {
        ModeEnd::Range => "range",
        ModeEnd::Returned => "returned",
        ModeEnd::Stalled => "stalled",
        ModeEnd::Points => "points",
        ModeEnd::Evaluations => "evaluations",
        ModeEnd::Interrupted => "interrupted",
    };
    columns.tell("end", (end, found.end_amplitude));
    let met = found.met.map(|(at, met)| (at, met.order, met.frequency, met.share));
    columns.tell("met", met);
    columns.tell("half_wave", found.half_wave);
    columns.tell("interrupted", found.end == ModeEnd::Interrupted);
    columns.effort(&found.profile, ("points", found.points.len()));
    columns
}

/// The nonlinear mode of a model; with friction pushed to a corner of what Coulomb allows, if one is
/// given.
#[pyfunction]
pub fn nonlinear_mode(
    py: Python<'_>,
    problem: &Problem,
    settings: &Bound<'_, PyAny>,
    corner: Option<(usize, f64)>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found> {
    let amplitudes: Vec<f64> = get(settings, "amplitudes")?;
    let amplitudes = match (get::<bool>(settings, "whole")?, amplitudes.as_slice()) {
        (true, &[low, high]) => Amplitudes::Range(low, high),
        _ => Amplitudes::List(amplitudes),
    };
    let settings = ModeSettings {
        method: match get::<String>(settings, "method")?.as_str() {
            "phase-resonance" => ModeMethod::PhaseResonance,
            "quasi-static" => ModeMethod::QuasiStatic,
            _ => ModeMethod::Periodic,
        },
        mode: get(settings, "mode")?,
        amplitudes,
        harmonics: harmonics(get(settings, "fixed_harmonics")?),
        tolerance: get(settings, "tolerance")?,
        max_harmonics: get(settings, "max_harmonics")?,
        residual: settings::residual(&settings.getattr("residual")?)?,
        corner: corner.map(|(number, share)| Corner { number, share }),
        most: get(settings, "max_points")?,
    };
    let [model, own] = [0; 2].map(|_| Arc::clone(&problem.model));
    let mode = found(py, progress, move |look| design::nonlinear_mode(&model, &settings, look))?;
    let told = |mode: &NonlinearMode| (mode.end == ModeEnd::Interrupted, mode.points.len());
    Found::of(mode, told, move |mode| branch(&mode, &own))
}
