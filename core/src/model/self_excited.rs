//! A family of self-excited models: a structure with friction and the damping `C + r C_neg`, with r
//! or a parameter of its contacts to be followed.

use super::{Body, Model};
use crate::contact::FrictionLaw;
use crate::structure::Destabilised;
use crate::Error;
use faer::{c64, Mat};

/// What the limit cycles are followed in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Scalar {
    /// The factor r of the negative damping.
    Ratio,
    /// A parameter of the laws of some contacts, by its name.
    Law {
        /// Name of the parameter.
        parameter: String,
        /// Positions of the contacts.
        contacts: Vec<usize>,
        /// Whether they multiply their own value by the scalar, or take it.
        factor: bool,
    },
}

/// The negative damping of a model.
#[derive(Debug, Clone)]
pub enum NegativeDamping {
    /// Of a whole structure, N × N [kg/s].
    Whole(Mat<f64>),
    /// Of a sector in a travelling wave, one complex matrix per nodal diameter [kg/s]: the
    /// aerodynamic influence coefficients add `iω r C_neg` to the dynamic stiffness.
    Wave(Vec<Mat<c64>>),
}

/// A self-excited model: without loads, with the damping `C + r C_neg`.
pub struct SelfExcited<'a> {
    model: &'a Model,
    negative: NegativeDamping,
    destabilised: Destabilised,
    ratio: f64,
    scalar: Scalar,
}

impl<'a> SelfExcited<'a> {
    /// A model with its negative damping; `ratio` is r where another scalar is followed.
    ///
    /// # Errors
    /// Laws that are not odd, a ring of sectors, a matrix that does not fit, a contact or
    /// parameter that does not exist.
    pub fn new(
        model: &'a Model,
        negative: NegativeDamping,
        scalar: Scalar,
        ratio: f64,
    ) -> Result<Self, Error> {
        if let Some(index) = model.laws().iter().position(|law| !law.is_odd()) {
            return Err(Error::value(
                format!("contact {}", index + 1),
                f64::NAN,
                "limit cycles need laws whose force reverses with the motion",
            ));
        }
        if model.laws().is_empty() {
            let remedy = "without friction nothing bounds the motion; add a contact";
            return Err(Error::value("contacts", 0.0, remedy));
        }
        let rows = model.ports().rows.as_ref();
        let destabilised = match (&negative, &model.body) {
            (NegativeDamping::Whole(matrix), Body::Whole | Body::Ring(_)) => {
                Destabilised::new(model.structure(), rows, matrix.as_ref())?
            }
            (NegativeDamping::Wave(matrices), Body::Wave { cyclic, next }) => {
                Destabilised::travelling(cyclic, rows, next.as_ref().as_ref(), matrices)?
            }
            (NegativeDamping::Whole(_), _) => {
                return Err(Error::shape(
                    "negative_damping",
                    "one complex matrix per nodal diameter of a travelling wave",
                    "one matrix",
                ));
            }
            (NegativeDamping::Wave(_), _) => {
                return Err(Error::shape("negative_damping", "one matrix", "one per diameter"));
            }
        };
        let family = Self { model, negative, destabilised, ratio, scalar };
        if let Scalar::Law { contacts, parameter, .. } = &family.scalar {
            for &contact in contacts {
                family.parameter_of(contact, parameter)?;
            }
        }
        Ok(family)
    }

    /// The model as it is given.
    #[must_use]
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// What is followed.
    #[must_use]
    pub fn scalar(&self) -> &Scalar {
        &self.scalar
    }

    /// The compliance.
    #[must_use]
    pub fn destabilised(&self) -> &Destabilised {
        &self.destabilised
    }

    /// The negative damping of a whole structure; nothing of a travelling wave, which has no
    /// motion of its own in time.
    #[must_use]
    pub fn negative(&self) -> Option<&Mat<f64>> {
        match &self.negative {
            NegativeDamping::Whole(matrix) => Some(matrix),
            NegativeDamping::Wave(_) => None,
        }
    }

    /// r at a value of the scalar.
    #[must_use]
    pub fn ratio_at(&self, value: f64) -> f64 {
        if self.scalar == Scalar::Ratio {
            value
        } else {
            self.ratio
        }
    }

    /// The friction laws at a value of the scalar.
    ///
    /// # Errors
    /// A value that a law refuses.
    pub fn laws_at(&self, value: f64) -> Result<Vec<Box<dyn FrictionLaw>>, Error> {
        let mut laws: Vec<Box<dyn FrictionLaw>> =
            self.model.laws().iter().map(|law| law.magnified(1.0)).collect();
        if let Scalar::Law { parameter, contacts, factor } = &self.scalar {
            for &contact in contacts {
                let (index, own) = self.parameter_of(contact, parameter)?;
                let new = if *factor { value * own } else { value };
                laws[contact] = laws[contact].with_parameter(index, new)?;
            }
        }
        Ok(laws)
    }

    /// What the scalar changes: positions of contacts and of their parameter, and how fast.
    #[must_use]
    pub fn rates(&self) -> Vec<(usize, usize, f64)> {
        let Scalar::Law { parameter, contacts, factor } = &self.scalar else { return Vec::new() };
        let rate = |&contact: &usize| {
            let (index, own) = self.parameter_of(contact, parameter).ok()?;
            Some((contact, index, if *factor { own } else { 1.0 }))
        };
        contacts.iter().filter_map(rate).collect()
    }

    /// Value of the scalar at which the model is as given; nothing where contacts differ.
    #[must_use]
    pub fn own_value(&self) -> Option<f64> {
        let Scalar::Law { parameter, contacts, factor } = &self.scalar else {
            return Some(self.ratio);
        };
        if *factor {
            return Some(1.0);
        }
        let mut values = contacts
            .iter()
            .filter_map(|&contact| Some(self.parameter_of(contact, parameter).ok()?.1));
        let first = values.next()?;
        values.all(|value| value == first).then_some(first)
    }

    /// Position and value of a parameter of a contact.
    fn parameter_of(&self, contact: usize, name: &str) -> Result<(usize, f64), Error> {
        let Some(law) = self.model.laws().get(contact) else {
            let remedy = format!("the model has {} contacts", self.model.laws().len());
            return Err(Error::value("contacts", contact as f64, &remedy));
        };
        let parameters = law.parameters();
        let found = parameters.iter().position(|(known, _)| *known == name);
        found.map(|index| (index, parameters[index].1)).ok_or_else(|| {
            let known: Vec<&str> = parameters.iter().map(|(known, _)| *known).collect();
            Error::shape(&format!("contact {}: parameter", contact + 1), known.join(" or "), name)
        })
    }
}
