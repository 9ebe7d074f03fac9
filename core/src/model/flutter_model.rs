//! A family of self-excited models: a structure with friction and the damping `C + r C_neg`, in r or
//! in a parameter of its contacts.

use super::body::Body;
use super::{stiffness_of, Change, Model, ParameterMode, Variation};
use crate::contact::{ContactLaw, Residual};
use crate::structure::{FlutterCompliance, HarmonicLoad, Ports};
use crate::Error;
use faer::{c64, Mat};
use std::sync::Arc;

/// The negative damping of a model.
#[derive(Debug, Clone)]
pub enum NegativeDamping {
    /// Of a whole structure, N × N [kg/s].
    Whole(Mat<f64>),
    /// The same, made by a law that couples no modes without contacts.
    Proportional(Mat<f64>),
    /// Of a sector in a travelling wave, one complex matrix per nodal diameter [kg/s]: the
    /// aerodynamic influence coefficients add `iω r C_neg` to the dynamic stiffness.
    Wave(Vec<Mat<c64>>),
}

/// A self-excited model with the damping `C + r C_neg`: without loads, but for static ones where the
/// state at rest decides what contacts do.
pub struct FlutterModel<'a> {
    model: &'a Model,
    negative: NegativeDamping,
    compliance: FlutterCompliance,
    /// Static loads that stay.
    loads: Vec<HarmonicLoad>,
    symmetric: bool,
    ratio: f64,
    variation: Variation,
    changes: Vec<Change>,
}

impl<'a> FlutterModel<'a> {
    /// A model with its negative damping; `ratio` is r where a parameter of contacts is varied.
    ///
    /// # Errors
    /// A matrix that does not fit, a contact or parameter that does not exist, a level: limit cycles
    /// bear no loads that vary; a parameter of contacts whose friction remembers static loads.
    pub fn new(
        model: &'a Model,
        negative: NegativeDamping,
        variation: Variation,
        ratio: f64,
    ) -> Result<Self, Error> {
        if model.laws().is_empty() {
            let remedy = "without friction nothing bounds the motion; add a contact";
            return Err(Error::value("contacts", 0.0, remedy));
        }
        let rows = model.ports().rows.as_ref();
        let compliance = match (&negative, &model.body) {
            (
                NegativeDamping::Whole(matrix) | NegativeDamping::Proportional(matrix),
                Body::Whole | Body::Ring(_),
            ) => {
                let law = matches!(negative, NegativeDamping::Proportional(_));
                FlutterCompliance::new(model.structure(), rows, matrix.as_ref(), law)?
            }
            (NegativeDamping::Wave(matrices), Body::Wave { cyclic, next }) => {
                FlutterCompliance::travelling(cyclic, rows, next.as_ref().as_ref(), matrices)?
            }
            (NegativeDamping::Whole(_) | NegativeDamping::Proportional(_), _) => {
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
        if variation == Variation::Level {
            let remedy = "limit cycles bear no loads; vary r or a parameter of contacts";
            return Err(Error::value("level", ratio, remedy));
        }
        let changes = variation.changes(model)?;
        let symmetric = !model.is_biased();
        let loads = if symmetric { Vec::new() } else { static_loads(model) };
        if !changes.is_empty() && !loads.is_empty() {
            let remedy = "what friction keeps of static loads changes with it; follow r";
            return Err(Error::value("contacts", changes[0].own, remedy));
        }
        let compliance = if symmetric { compliance } else { compliance.with_means(loads.clone()) };
        Ok(Self { model, negative, compliance, loads, symmetric, ratio, variation, changes })
    }

    /// Whether its motions have half-wave symmetry: odd laws that no static load holds off their middle.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    /// The residual traction that is assumed.
    #[must_use]
    pub fn residual(&self) -> Residual {
        if self.loads.is_empty() {
            Residual::Centred
        } else {
            Residual::FromRest
        }
    }

    /// The model as it is given.
    #[must_use]
    pub fn model(&self) -> &'a Model {
        self.model
    }

    /// What is varied.
    #[must_use]
    pub fn variation(&self) -> &Variation {
        &self.variation
    }

    /// The compliance.
    #[must_use]
    pub fn compliance(&self) -> &FlutterCompliance {
        &self.compliance
    }

    /// The negative damping of a whole structure; nothing of a travelling wave, which has no
    /// motion of its own in time.
    #[must_use]
    pub fn negative(&self) -> Option<&Mat<f64>> {
        match &self.negative {
            NegativeDamping::Whole(matrix) | NegativeDamping::Proportional(matrix) => Some(matrix),
            NegativeDamping::Wave(_) => None,
        }
    }

    /// r at a value of the number that is varied.
    #[must_use]
    pub fn ratio_at(&self, value: f64) -> f64 {
        if self.variation == Variation::Ratio {
            value
        } else {
            self.ratio
        }
    }

    /// The friction laws at a value of the number that is varied.
    ///
    /// # Errors
    /// A value that a law refuses.
    pub fn laws_at(&self, value: f64) -> Result<Vec<Box<dyn ContactLaw>>, Error> {
        self.variation.laws(self.model, value)
    }

    /// The model without loads but static ones at a value of the number that is varied.
    ///
    /// # Errors
    /// A value that a law refuses.
    pub fn at(&self, value: f64) -> Result<Model, Error> {
        let (given, laws) = (self.model, self.laws_at(value)?);
        let stiffness = stiffness_of(&laws);
        let ports = Ports {
            rows: given.ports.rows.clone(),
            stiffness: stiffness.clone(),
            loads: self.loads.clone(),
        };
        Ok(Model {
            structure: Arc::clone(&given.structure),
            ports: Arc::new(ports),
            laws,
            points: given.points.clone(),
            compliance: self.compliance.at(self.ratio_at(value), stiffness.into_full()),
            modal_base: self.compliance.name(),
            body: given.body.clone(),
            states: Arc::clone(&given.states),
        })
    }

    /// The parameters of the laws that it changes; none of the ratio.
    #[must_use]
    pub fn changes(&self) -> &[Change] {
        &self.changes
    }

    /// Value at which the model is as given; nothing where contacts differ.
    #[must_use]
    pub fn own_value(&self) -> Option<f64> {
        if self.variation == Variation::Ratio {
            return Some(self.ratio);
        }
        let first = self.changes.first()?;
        if first.common == ParameterMode::Factor {
            return Some(1.0);
        }
        self.changes.iter().all(|change| change.own == first.own).then_some(first.own)
    }
}

/// The static loads of a model.
pub(super) fn static_loads(model: &Model) -> Vec<HarmonicLoad> {
    let acts = |load: &&HarmonicLoad| {
        load.harmonic == 0 && load.amplitude.iter().any(|force| force.norm() > 0.0)
    };
    model.ports().loads.iter().filter(acts).cloned().collect()
}
