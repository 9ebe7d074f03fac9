//! The stability of the points of a forced curve.

use super::period_map::PeriodMap;
use crate::balance::{with_history, Progress, Solution};
use crate::contact::Residual;
use crate::model::Model;
use crate::Error;
use std::sync::Arc;

/// Decides the stability of the points of a curve under the residual assumed by its balance, as far as
/// the map over a period tells it; those of a travelling wave stay undecided.
///
/// # Errors
/// As [`PeriodMap::new`], but for a wave.
pub fn decide_stability(
    model: &Model,
    residual: Residual,
    solution: &mut Solution,
    progress: &Progress<'_>,
) -> Result<(), Error> {
    if model.is_travelling_wave() {
        return Ok(());
    }
    let history = match residual {
        Residual::FromRest => with_history(model)?,
        Residual::Centred | Residual::Value(_) => None,
    };
    let map = PeriodMap::new(history.as_ref().unwrap_or(model))?.assuming(residual);
    for point in &mut solution.points {
        if !progress(1.0) {
            return Ok(());
        }
        let Some(motion) = point.unknowns().filter(|_| point.is_solved()) else { continue };
        let stable =
            map.multipliers(point.omega, motion, None).and_then(|multipliers| multipliers.stable());
        Arc::make_mut(point).stable = stable;
    }
    Ok(())
}
