//! The members of a family of models, in the form in which their peaks are found.

use crate::balance::Cause;
use crate::contact::Residual;
use crate::model::{Model, Variation};
use crate::Error;

/// A member of the family, in the form it is solved in.
pub(super) struct Member {
    pub(super) model: Model,
    pub(super) residual: Residual,
    /// Displacements of the member over those of the model that is solved.
    pub(super) scale: f64,
    /// Amplitudes change with the parameter as the sum of these shares of their causes.
    pub(super) causes: Vec<(Cause, f64)>,
}

impl Member {
    /// The member at a value of the parameter.
    ///
    /// A load level λ without static loads is solved as the loads as they are against slip forces over λ:
    /// friction knows their ratio alone, and all levels then share one decomposition.
    ///
    /// # Errors
    /// A value that a law refuses, a contact or parameter that does not exist, a ratio of negative
    /// damping.
    pub(super) fn new(
        variation: &Variation,
        model: &Model,
        residual: Residual,
        value: f64,
    ) -> Result<Self, Error> {
        match variation {
            Variation::Level => level(model, residual, value),
            Variation::Ratio => Err(Error::value(
                "ratio",
                value,
                "is followed by limit cycles; vary the level or a parameter of contacts",
            )),
            Variation::Law { .. } => {
                let laws = variation.laws(model, value)?;
                let changes = variation.changes(model)?.into_iter();
                // What never slips does not change under a factor.
                let causes = changes.filter(|change| change.rate() != 0.0).map(|change| {
                    let (contact, parameter) = (change.contact, change.parameter);
                    (Cause::Law { contact, parameter }, change.rate())
                });
                let causes = causes.collect();
                Ok(Self { model: model.with_laws(laws)?, residual, scale: 1.0, causes })
            }
        }
    }
}

/// What an amplitude counts at a value of the parameter, and the derivative of that: over the level
/// a peak per unit of load, for it grows with the load however well the damper works.
pub(super) fn objective(
    variation: &Variation,
    value: f64,
    amplitude: f64,
    slope: f64,
) -> (f64, f64) {
    match variation {
        Variation::Level => (amplitude / value, (slope - amplitude / value) / value),
        Variation::Law { .. } | Variation::Ratio => (amplitude, slope),
    }
}

fn level(model: &Model, residual: Residual, level: f64) -> Result<Member, Error> {
    if !(level > 0.0 && level.is_finite()) {
        return Err(Error::value("level", level, "must be a finite factor above zero"));
    }
    if model.compliance().forced_harmonics().contains(&0) {
        let causes = vec![(Cause::Load, level.recip())];
        return Ok(Member { model: model.excited(level)?, residual, scale: 1.0, causes });
    }
    let laws = model.laws().iter().map(|law| law.with_scaled_forces(level.recip())).collect();
    let residual = match residual {
        Residual::Value(force) => Residual::Value(force / level),
        other => other,
    };
    // The amplitude is homogeneous of degree one in load and slip forces, so that its derivative
    // in the level is that of the model which is solved.
    let causes = vec![(Cause::Load, 1.0)];
    Ok(Member { model: model.with_laws(laws)?, residual, scale: level, causes })
}
