//! A model under the evaluations of its laws that a balance asks for.

use crate::model::{MarchedLaws, Model};
use crate::Error;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

/// A model as it is evaluated.
#[derive(Clone)]
pub(crate) enum Evaluated<'a> {
    /// As it was given.
    Given(&'a Model),
    /// Made of it: with marched laws, or at another value of what is varied.
    Made(Arc<Model>),
}

impl<'a> From<&'a Model> for Evaluated<'a> {
    fn from(model: &'a Model) -> Self {
        Self::Given(model)
    }
}

impl Deref for Evaluated<'_> {
    type Target = Model;

    fn deref(&self) -> &Model {
        match self {
            Self::Given(model) => model,
            Self::Made(model) => model,
        }
    }
}

/// A model with its laws, or those without a form of their own, marched through every number of samples
/// that has been asked for. All of them share one decomposition.
pub(super) struct Evaluations<'a> {
    model: Evaluated<'a>,
    laws: MarchedLaws,
    marched: BTreeMap<usize, Arc<Model>>,
}

impl<'a> Evaluations<'a> {
    pub(super) fn new(model: Evaluated<'a>, laws: MarchedLaws) -> Self {
        Self { model, laws, marched: BTreeMap::new() }
    }

    /// The model under `samples` per period, or as it was given.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub(super) fn with(&mut self, samples: Option<usize>) -> Result<Evaluated<'a>, Error> {
        let Some(samples) = samples else { return Ok(self.model.clone()) };
        if let Some(known) = self.marched.get(&samples) {
            return Ok(Evaluated::Made(Arc::clone(known)));
        }
        let marched = Arc::new(self.model.marched(samples, self.laws)?);
        self.marched.insert(samples, Arc::clone(&marched));
        Ok(Evaluated::Made(marched))
    }
}
