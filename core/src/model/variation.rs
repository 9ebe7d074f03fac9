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
    /// A factor on all loads.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balance::Settings;
    use crate::contact::{Jenkins, StructuralDamper};
    use crate::design::{peak_curve, Target};
    use crate::fourier::Measure;
    use crate::model::{Contact, FlutterModel, NegativeDamping};
    use crate::structure::Structure;
    use faer::{mat, Mat};

    /// A Jenkins element, then a damper of two points with the limits 2 and infinity.
    fn model() -> Model {
        let unit = mat![[1.0, 0.0], [0.0, 1.0]];
        let structure = Structure::new(unit.as_ref(), unit.as_ref(), unit.as_ref()).unwrap();
        let spring = mat![[3.0, -3.0], [-3.0, 3.0]];
        let contacts = vec![
            Contact {
                law: Box::new(Jenkins::new(5.0, 0.5).unwrap()),
                rows: Mat::from_fn(1, 2, |_, j| if j == 0 { 1.0 } else { 0.0 }),
            },
            Contact {
                law: Box::new(
                    StructuralDamper::new(spring.as_ref(), &[2.0, f64::INFINITY]).unwrap(),
                ),
                rows: unit,
            },
        ];
        Model::new(structure, contacts, Vec::new()).unwrap()
    }

    fn law(
        parameter: &str,
        contacts: &[(usize, Option<usize>)],
        common: ParameterMode,
    ) -> Variation {
        Variation::Law { parameter: parameter.to_owned(), contacts: contacts.to_vec(), common }
    }

    fn values(variation: &Variation, value: f64) -> Vec<f64> {
        let laws = variation.laws(&model(), value).unwrap();
        laws.iter().flat_map(|law| law.parameters()).map(|one| one.value).collect()
    }

    #[test]
    fn contacts_and_points_take_values_and_factors() {
        let all = [(0, None), (1, None)];
        // k and F of the first, then both limits and the factor on D of the second.
        let given = vec![5.0, 0.5, 2.0, f64::INFINITY, 1.0];
        assert_eq!(values(&Variation::Level, 3.0), given);
        assert_eq!(values(&Variation::Ratio, 3.0), given);
        let factor = values(&law("slip_force", &all, ParameterMode::Factor), 3.0);
        assert_eq!(factor, vec![5.0, 1.5, 6.0, f64::INFINITY, 1.0]);
        // What never slips does so without friction, too: 0 times infinity is no number.
        let none = values(&law("slip_force", &all, ParameterMode::Factor), 0.0);
        assert_eq!(none, vec![5.0, 0.0, 0.0, f64::INFINITY, 1.0]);
        let value =
            values(&law("slip_force", &[(0, None), (1, Some(0))], ParameterMode::Value), 3.0);
        assert_eq!(value, vec![5.0, 3.0, 3.0, f64::INFINITY, 1.0]);
        let stiffness = values(&law("stiffness", &all, ParameterMode::Factor), 3.0);
        assert_eq!(stiffness, vec![15.0, 0.5, 2.0, f64::INFINITY, 3.0]);

        let changes = law("slip_force", &all, ParameterMode::Factor).changes(&model()).unwrap();
        let rates: Vec<f64> = changes.iter().map(Change::rate).collect();
        assert_eq!(rates, vec![0.5, 2.0, 0.0]);
    }

    #[test]
    fn what_a_model_does_not_have_is_refused() {
        for (variation, part) in [
            (law("stiffness", &[(1, None)], ParameterMode::Value), "contact 2: parameter"),
            (law("stiffness", &[(1, Some(0))], ParameterMode::Factor), "slip_force"),
            (law("slip_force", &[(1, Some(2))], ParameterMode::Value), "contact 2"),
            (law("mass", &[(0, None)], ParameterMode::Value), "stiffness or slip_force"),
            (law("slip_force", &[(2, None)], ParameterMode::Value), "2 contacts"),
        ] {
            let message = variation.changes(&model()).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }

    #[test]
    fn every_analysis_refuses_what_it_does_not_vary() {
        let target = Target { dof: 0, measure: Measure::HalfRange, span: (0.5, 2.0) };
        let settings = Settings::default();
        let curve = peak_curve(&model(), settings, &Variation::Ratio, &[1.0], &target, &|_| true);
        assert!(curve.unwrap_err().to_string().contains("limit cycles"));
        let negative = NegativeDamping::Whole(mat![[-1.0, 0.0], [0.0, -1.0]]);
        let model = model();
        let cycles = FlutterModel::new(&model, negative, Variation::Level, 1.0);
        assert!(cycles.err().is_some_and(|error| error.to_string().contains("no loads")));
    }
}
