//! What is varied: one number that stands for parameters of the laws of some contacts, for the level
//! of the loads, or for the ratio of negative damping.

use super::Model;
use crate::contact::ContactLaw;
use crate::Error;

/// How one number stands for the parameters of several contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterMode {
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
        /// Positions of the contacts, each of one of its points or of all that have the parameter.
        contacts: Vec<(usize, Option<usize>)>,
        /// What the number means to them.
        common: ParameterMode,
    },
    /// A factor on the loads that vary; static loads stay as they are.
    Level,
    /// The factor r of the negative damping `C + r C_neg`.
    Ratio,
}

/// A parameter of one law under a variation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Position of the contact.
    pub contact: usize,
    /// Position among the parameters of its law.
    pub parameter: usize,
    /// Value as the model is given.
    pub own: f64,
    /// What the number means to it.
    pub common: ParameterMode,
}

impl Change {
    /// Its value at one of the number. What never slips does so under every factor.
    #[must_use]
    pub fn at(&self, value: f64) -> f64 {
        match self.common {
            ParameterMode::Value => value,
            ParameterMode::Factor if self.own.is_infinite() => self.own,
            ParameterMode::Factor => value * self.own,
        }
    }

    /// Its derivative in the number.
    #[must_use]
    pub fn rate(&self) -> f64 {
        match self.common {
            ParameterMode::Value => 1.0,
            ParameterMode::Factor if self.own.is_infinite() => 0.0,
            ParameterMode::Factor => self.own,
        }
    }
}

impl Variation {
    /// The parameters of the laws of a model that it changes; none of a level or a ratio.
    ///
    /// # Errors
    /// A contact, point or parameter that does not exist, a value for a parameter that is a factor.
    pub fn changes(&self, model: &Model) -> Result<Vec<Change>, Error> {
        let Self::Law { parameter, contacts, common } = self else { return Ok(Vec::new()) };
        let mut changes = Vec::new();
        for &(contact, point) in contacts {
            let Some(law) = model.laws().get(contact) else {
                let remedy = format!("the model has {} contacts", model.laws().len());
                return Err(Error::value("contacts", contact as f64, &remedy));
            };
            let entry = format!("contact {}: parameter", contact + 1);
            let known = law.parameters();
            let here = |at: Option<usize>| point.is_none() || at == point;
            let before = changes.len();
            for (index, one) in known.iter().enumerate() {
                if one.name != parameter || !here(one.point) {
                    continue;
                }
                if one.factor && *common == ParameterMode::Value {
                    return Err(Error::shape(&entry, "a factor on the stiffness D", "a value"));
                }
                let (parameter, own, common) = (index, one.value, *common);
                changes.push(Change { contact, parameter, own, common });
            }
            if changes.len() == before {
                let mut names: Vec<&str> =
                    known.iter().filter(|one| here(one.point)).map(|one| one.name).collect();
                names.dedup();
                return Err(Error::shape(&entry, names.join(" or "), parameter));
            }
        }
        Ok(changes)
    }

    /// The friction laws of a model at a value of the number.
    ///
    /// # Errors
    /// As [`Variation::changes`], or a value that a law refuses.
    pub fn laws(&self, model: &Model, value: f64) -> Result<Vec<Box<dyn ContactLaw>>, Error> {
        let mut laws: Vec<Box<dyn ContactLaw>> =
            model.laws().iter().map(|law| law.with_scaled_forces(1.0)).collect();
        for change in self.changes(model)? {
            let law = &mut laws[change.contact];
            *law = law.with_parameter(change.parameter, change.at(value))?;
        }
        Ok(laws)
    }
}
