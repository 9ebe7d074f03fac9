//! Balances of one model, each of which a piece of a curve is followed with.

use super::rescue::OrbitInitialGuess;
use crate::balance::{
    history_of, keep_instead, ForcedBalance, Kept, Point, Progress, Settings, MUCH,
};
use crate::model::Model;
use crate::Error;
use std::sync::Arc;

/// What the balances of all pieces of a forced response begin with.
pub struct Balances<'a> {
    pub(super) model: &'a Model,
    pub(super) settings: Settings,
    observe: &'a [usize],
    driving: &'a [usize],
    kept: &'a Kept<Point>,
    /// The model with the friction that static loads leave.
    history: Option<Arc<Model>>,
    /// Operations from which a range is cut into pieces.
    pub(super) much: f64,
}

impl<'a> Balances<'a> {
    /// Of a model with displacements at the DOFs `observe`, of which those at the positions `driving` are
    /// followed; points are put into `kept` as they are solved.
    ///
    /// # Errors
    /// As [`ForcedBalance::new`].
    pub fn new(
        model: &'a Model,
        settings: Settings,
        (observe, driving): (&'a [usize], &'a [usize]),
        kept: &'a Kept<Point>,
    ) -> Result<Self, Error> {
        let history = history_of(model, &settings)?;
        Ok(Self { model, settings, observe, driving, kept, history, much: MUCH })
    }

    /// Has ranges cut into pieces from another number of operations on, which are some billions otherwise.
    #[must_use]
    pub fn cut_from(mut self, operations: f64) -> Self {
        self.much = operations;
        self
    }

    /// Keeps these points and no others.
    pub(super) fn keep_only(&self, points: &[Arc<Point>]) {
        keep_instead(Some(self.kept), points);
    }

    /// Does some work with a balance that keeps its points.
    ///
    /// # Errors
    /// As the work, or [`ForcedBalance::new`].
    pub fn with<T>(
        &self,
        look: &Progress<'_>,
        work: impl FnOnce(ForcedBalance<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.made(look, Some(self.kept), work)
    }

    /// Does some work with a balance whose points are not kept: they are not the next ones of the curve.
    ///
    /// # Errors
    /// As [`Balances::with`].
    pub(super) fn lent<T>(
        &self,
        look: &Progress<'_>,
        work: impl FnOnce(ForcedBalance<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        self.made(look, None, work)
    }

    fn made<T>(
        &self,
        look: &Progress<'_>,
        kept: Option<&Kept<Point>>,
        work: impl FnOnce(ForcedBalance<'_>) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let orbits = OrbitInitialGuess::new(self.model, self.settings.residual, self.observe, look);
        let known = self.history.clone();
        let balance =
            ForcedBalance::with_known_history(self.model, known, self.settings, self.observe)?
                .watched(look)
                .rescued(&orbits)
                .driven_by(self.driving)
                .with_further_branches();
        work(match kept {
            Some(kept) => balance.keeping(kept),
            None => balance,
        })
    }
}
