//! What the orbits of a system share, in all threads that seek some of them.

use super::rotation::Rotation;
use super::settings::OrbitSettings;
use super::shooting::STEPS;
use crate::balance::{is_carried_away, is_let_go, with_history};
use crate::contact::Residual;
use crate::model::Model;
use crate::motion::{is_passive, ModalSystem};
use crate::Error;
use std::sync::{Arc, OnceLock};

/// How orbits are prepared.
#[derive(Clone)]
pub(super) struct Plan<'a> {
    pub(super) model: &'a Model,
    /// The model with friction that has its history, where it is asked for.
    pub(super) with_history: Option<Arc<Model>>,
    /// Whether static loads carry a body away that contacts alone hold.
    pub(super) carried_away: bool,
    /// Whether they let go of it, once it is asked for.
    let_go: Arc<OnceLock<bool>>,
    pub(super) system: Arc<ModalSystem>,
    pub(super) settings: OrbitSettings,
    pub(super) observe: &'a [usize],
    pub(super) half_wave: bool,
    /// Whether one motion alone is possible.
    pub(super) unique: bool,
    pub(super) rotation: Option<Rotation>,
    /// Steps of the flow that an orbit is granted.
    pub(super) granted: usize,
}

impl<'a> Plan<'a> {
    pub(super) fn new(
        model: &'a Model,
        settings: OrbitSettings,
        observe: &'a [usize],
    ) -> Result<Self, Error> {
        settings.check()?;
        let with_history = match settings.residual {
            Residual::FromRest => with_history(model)?.map(Arc::new),
            Residual::Centred | Residual::Value(_) => None,
        };
        let unsupported = settings.residual == Residual::FromRest && with_history.is_none();
        let system = Arc::new(ModalSystem::new(with_history.as_deref().unwrap_or(model))?);
        Error::check_dofs(observe, system.modes())?;
        Ok(Self {
            model,
            with_history,
            carried_away: unsupported && is_carried_away(model),
            let_go: Arc::default(),
            system,
            settings,
            observe,
            half_wave: model.is_symmetric() && settings.residual.is_symmetric(),
            unique: is_passive(model),
            rotation: None,
            granted: STEPS,
        })
    }

    /// Whether static loads, raised from rest, let go of a body that contacts alone hold.
    pub(super) fn is_let_go(&self) -> bool {
        let from_rest = self.settings.residual == Residual::FromRest;
        let asked = from_rest && self.with_history.is_none();
        asked && *self.let_go.get_or_init(|| is_let_go(self.model))
    }
}
