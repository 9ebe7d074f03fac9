//! Limit cycles: negative damping and settings in, cycles along a branch out.

use crate::arrays::{is_half_wave, matrices, matrix, series, Array2, Array3};
use crate::columns::Columns;
use crate::found::Found;
use crate::problem::Problem;
use crate::settings::{self, get, harmonics};
use crate::watch::{found, whole};
use numpy::{Complex64, PyArray1};
use pyo3::prelude::*;
use std::sync::Arc;
use stickslip_core::balance::Unknowns;
use stickslip_core::fourier::Harmonics;
use stickslip_core::model::{NegativeDamping, Variation};
use stickslip_core::orbit::{self, CycleSettings, PeriodMap};
use stickslip_core::solve::End;
use stickslip_core::Model;

/// Limit cycles along a branch.
fn branch(found: &orbit::LimitCycles, model: &Model) -> Columns {
    let (dofs, contacts) = (model.compliance().dofs(), model.compliance().contacts());
    let states = model.states();
    let cycles = || found.cycles.iter();
    let mut columns = Columns::default();
    columns.responses(cycles().map(|c| &c.response), dofs, contacts);
    columns.one("value", cycles().map(|c| c.value));
    columns.one("ratio", cycles().map(|c| c.ratio));
    columns.one("slipping", cycles().map(|c| c.slipping));
    columns.one("closed", cycles().map(|c| c.closed));
    columns.ranges(dofs, cycles().map(|c| c.range.as_slice()));
    columns.numbers("state", states, cycles().map(|c| c.state.as_slice()));
    let multipliers = cycles().map(|c| (c.multipliers.as_slice(), c.neutral));
    columns.multipliers(states.saturating_sub(1), multipliers);
    let turn = found.limit.map_or([f64::NAN; 2], |turn| [turn.value, turn.omega]);
    columns.one("turn", turn);
    columns.rows("folds", 2, f64::NAN, found.folds.iter().map(|turn| [turn.value, turn.omega]));
    let changes = || found.changes.iter();
    columns.rows("change", 2, f64::NAN, changes().map(|c| [c.value, c.omega]));
    columns.one("change_after", changes().map(|c| c.after as i64));
    columns.one("change_kind", changes().map(|c| c.kind as i64));
    let unstable = changes().map(|c| [c.unstable.0 as i64, c.unstable.1 as i64]);
    columns.rows("change_unstable", 2, 0, unstable);
    let end = |end| match end {
        End::Range => "range",
        End::Condition => "unbounded",
        End::Points => "points",
        End::Stalled => "stalled",
        End::Returned => "returned",
        End::Interrupted => "interrupted",
    };
    // How either side ended, and at which value.
    let ends = found.ends.iter().zip(found.end_values).map(|(one, value)| (end(*one), value));
    columns.tell("ends", ends.collect::<Vec<_>>());
    // r at which the stuck mode loses its damping, and its natural frequency.
    columns.tell("onset", (found.onset, found.stuck_omega));
    columns.tell("phase_dof", found.phase_dof);
    columns.tell("jumps", found.jumps);
    columns.tell("interrupted", found.interrupted);
    columns.effort(&found.profile, ("iterations", 0));
    columns
}

/// Negative damping: one matrix, or complex ones by nodal diameter of a travelling wave.
fn negative(given: &Bound<'_, PyAny>, proportional: bool) -> PyResult<NegativeDamping> {
    if let Ok(array) = given.extract::<Array2<'_, f64>>() {
        let whole = matrix(&array);
        return Ok(if proportional {
            NegativeDamping::Proportional(whole)
        } else {
            NegativeDamping::Whole(whole)
        });
    }
    Ok(NegativeDamping::Wave(matrices(&given.extract::<Array3<'_, Complex64>>()?)))
}

/// Limit cycles of a mode along what is varied, the ratio if nothing is; `proportional` says that a
/// law made the negative damping, one that couples none of the modes without contacts.
#[pyfunction]
pub fn limit_cycles(
    py: Python<'_>,
    problem: &Problem,
    negative_damping: &Bound<'_, PyAny>,
    proportional: bool,
    variation: Option<&Bound<'_, PyAny>>,
    settings: &Bound<'_, PyAny>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found> {
    let negative = negative(negative_damping, proportional)?;
    let variation = variation.map_or(Ok(Variation::Ratio), settings::variation)?;
    let ratio = get(settings, "ratio")?;
    let fixed: Option<usize> = get(settings, "fixed_harmonics")?;
    let max_harmonics = get(settings, "max_harmonics")?;
    let settings = CycleSettings {
        mode: get(settings, "mode")?,
        values: get(settings, "values")?,
        range: get(settings, "span")?,
        exact: get::<String>(settings, "method")? == "exact",
        harmonics: harmonics(fixed),
        max_harmonics,
        tolerance: get(settings, "tolerance")?,
        reported: fixed.unwrap_or(max_harmonics),
        stability: get(settings, "stability")?,
        most: get(settings, "max_points")?,
    };
    let [model, own] = [0; 2].map(|_| Arc::clone(&problem.model));
    let cycles = found(py, progress, move |look| {
        orbit::limit_cycles(&model, &negative, &variation, ratio, &settings, look)
    })?;
    let told = |found: &orbit::LimitCycles| (found.interrupted, found.cycles.len());
    Found::of(cycles, told, move |found| branch(&found, &own))
}

/// Floquet multipliers over a period of a motion given by its contact displacements `(points, H+1)`,
/// by falling modulus and with the error of the largest; nothing where contacts do not repeat what
/// they do or touch their limit. The stiffness has a further part `circulatory`, of any symmetry.
#[pyfunction]
pub fn period_multipliers<'py>(
    py: Python<'py>,
    problem: &Problem,
    circulatory: Array2<'py, f64>,
    omega: f64,
    displacement: Array2<'py, Complex64>,
    tolerance: f64,
) -> PyResult<Option<(Bound<'py, PyArray1<Complex64>>, f64)>> {
    let view = displacement.as_array();
    let (points, orders) = (view.nrows(), view.ncols());
    let odd = problem.model.laws().iter().all(|law| law.is_odd());
    let half_wave = odd && (0..points).all(|n| is_half_wave(orders, |k| view[[n, k]]));
    let harmonics = Harmonics::new(orders - 1, half_wave);
    let values: Vec<f64> = (0..points).flat_map(|n| series(&harmonics, |k| view[[n, k]])).collect();
    let motion = Unknowns::new(harmonics, values);
    let (stiffness, model) = (matrix(&circulatory), Arc::clone(&problem.model));
    let found = whole(py, move |_| {
        let map = PeriodMap::new(&model)?.with_circulatory(stiffness.as_ref());
        Ok(map.multipliers(omega, &motion, Some(tolerance)).filter(|found| !found.touches))
    })?;
    Ok(found.map(|found| {
        let values = found.values.iter().map(|one| Complex64::new(one.re, one.im)).collect();
        (PyArray1::from_vec(py, values), found.error)
    }))
}
