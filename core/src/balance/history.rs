//! Friction with the history that it has from static loads.

use super::at_rest::RestStatus;
use super::limit_load::is_carried_away;
use super::settings::Settings;
use super::statics::static_response;
use crate::contact::{ContactLaw, Residual};
use crate::model::Model;
use crate::Error;
use std::sync::Arc;

/// The model with friction that has its history from its static loads; nothing if it has no such
/// loads, no law that keeps it, or no equilibrium under them.
///
/// # Errors
/// As [`static_response`].
pub fn with_history(model: &Model) -> Result<Option<Model>, Error> {
    let loaded = model.compliance().forced_harmonics().contains(&0);
    let keeps =
        |law: &dyn ContactLaw| law.with_history(&law.beginning().0, &law.beginning().1).is_some();
    if !loaded || !model.laws().iter().any(|law| keeps(law.as_ref())) {
        return Ok(None);
    }
    // Where nothing carries the whole load, raising it takes many steps to where contacts let go.
    if is_carried_away(model) {
        return Ok(None);
    }
    let at_rest = static_response(model, &[], &|_| true)?;
    if at_rest.status != RestStatus::Converged {
        return Ok(None);
    }
    let laws = model.laws().iter().zip(model.points()).zip(&at_rest.states);
    let laws = laws.map(|((law, points), state)| {
        let displacement = &at_rest.contact_displacement[points.clone()];
        law.with_history(displacement, state).unwrap_or_else(|| law.with_scaled_forces(1.0))
    });
    model.with_laws(laws.collect()).map(Some)
}

/// The history that a balance with these settings starts from, if any.
///
/// # Errors
/// As [`with_history`].
pub(crate) fn history_of(model: &Model, settings: &Settings) -> Result<Option<Arc<Model>>, Error> {
    match settings.residual {
        Residual::FromRest => Ok(with_history(model)?.map(Arc::new)),
        Residual::Centred | Residual::Value(_) => Ok(None),
    }
}
