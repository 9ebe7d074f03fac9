//! What is varied.

use crate::balance::Cause;
use crate::contact::{FrictionLaw, Residual};
use crate::model::Model;
use crate::Error;

/// How one number stands for the parameters of several contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Common {
    /// All take it as their value.
    Value,
    /// All multiply their own value by it.
    Factor,
}

/// A family of models with one parameter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Variation {
    /// A parameter of the laws of some contacts.
    Law {
        /// Name of the parameter.
        parameter: String,
        /// Positions of the contacts.
        contacts: Vec<usize>,
        /// What the number means to them.
        common: Common,
    },
    /// A factor on all loads.
    Level,
}

/// A member of the family, in the form it is solved in.
pub(super) struct Member {
    pub(super) model: Model,
    pub(super) residual: Residual,
    /// Displacements of the member over those of the model that is solved.
    pub(super) scale: f64,
    /// Amplitudes change with the parameter as the sum of these shares of their causes.
    pub(super) causes: Vec<(Cause, f64)>,
}

impl Variation {
    /// The member at a value of the parameter.
    ///
    /// A load level λ is solved as the loads as they are against slip forces over λ: friction
    /// knows their ratio alone, and all levels then share one decomposition.
    ///
    /// # Errors
    /// A value that a law refuses, a contact or parameter that does not exist.
    pub(super) fn member(
        &self,
        model: &Model,
        residual: Residual,
        value: f64,
    ) -> Result<Member, Error> {
        match self {
            Self::Level => level(model, residual, value),
            Self::Law { parameter, contacts, common } => {
                let mut laws: Vec<Box<dyn FrictionLaw>> =
                    model.laws().iter().map(|law| law.magnified(1.0)).collect();
                let mut causes = Vec::new();
                for &contact in contacts {
                    let (index, own) = find(model, contact, parameter)?;
                    let share = if *common == Common::Factor { own } else { 1.0 };
                    let new = if *common == Common::Factor { value * own } else { value };
                    laws[contact] = laws[contact].with_parameter(index, new)?;
                    if share.is_finite() {
                        causes.push((Cause::Law { contact, parameter: index }, share));
                    }
                }
                Ok(Member { model: model.with_laws(laws)?, residual, scale: 1.0, causes })
            }
        }
    }

    /// What an amplitude counts at a value of the parameter, and the derivative of that: a peak
    /// per unit of load, for it grows with the load however well the damper works.
    pub(super) fn objective(&self, value: f64, amplitude: f64, slope: f64) -> (f64, f64) {
        match self {
            Self::Level => (amplitude / value, (slope - amplitude / value) / value),
            Self::Law { .. } => (amplitude, slope),
        }
    }
}

fn level(model: &Model, residual: Residual, level: f64) -> Result<Member, Error> {
    if !(level > 0.0 && level.is_finite()) {
        return Err(Error::value("level", level, "must be a finite factor above zero"));
    }
    let laws = model.laws().iter().map(|law| law.magnified(level.recip())).collect();
    let residual = match residual {
        Residual::Value(force) => Residual::Value(force / level),
        other => other,
    };
    // The amplitude is homogeneous of degree one in load and slip forces, so that its derivative
    // in the level is that of the model which is solved.
    let causes = vec![(Cause::Load, 1.0)];
    Ok(Member { model: model.with_laws(laws)?, residual, scale: level, causes })
}

/// Position and value of a named parameter.
fn find(model: &Model, contact: usize, name: &str) -> Result<(usize, f64), Error> {
    let Some(law) = model.laws().get(contact) else {
        let total = format!("the model has {} contacts", model.laws().len());
        return Err(Error::value("contacts", contact as f64, &total));
    };
    let parameters = law.parameters();
    let found = parameters.iter().enumerate().find(|(_, (known, _))| *known == name);
    found.map(|(index, (_, value))| (index, *value)).ok_or_else(|| {
        let known: Vec<&str> = parameters.iter().map(|(known, _)| *known).collect();
        Error::shape(&format!("contact {}: parameter", contact + 1), known.join(" or "), name)
    })
}
