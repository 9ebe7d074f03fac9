//! What the orbits of a system share, in all threads that seek some of them.

use super::periodic::PeriodicOrbits;
use super::quadrature::Quadrature;
use super::rotation::Rotation;
use super::settings::OrbitSettings;
use super::shooting::STEPS;
use crate::balance::{with_history, Progress};
use crate::contact::Residual;
use crate::model::Model;
use crate::motion::{is_passive, ModalSystem};
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;

/// How orbits are prepared.
#[derive(Clone)]
pub(super) struct Plan<'a> {
    pub(super) model: &'a Model,
    /// The model with friction that has its history, where it is asked for.
    pub(super) with_history: Option<Arc<Model>>,
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
        let system = Arc::new(ModalSystem::new(with_history.as_deref().unwrap_or(model))?);
        Error::check_dofs(observe, system.modes())?;
        Ok(Self {
            model,
            with_history,
            system,
            settings,
            observe,
            half_wave: model.is_symmetric() && settings.residual.is_symmetric(),
            unique: is_passive(model),
            rotation: None,
            granted: STEPS,
        })
    }

    /// Orbits that tell `progress` how far they are.
    pub(super) fn orbits(self, progress: &'a Progress<'a>) -> PeriodicOrbits<'a> {
        PeriodicOrbits {
            everywhere: (0..self.system.modes()).collect(),
            plan: self,
            sliders: Vec::new(),
            quadrature: Quadrature::default(),
            progress,
            kept: None,
            share: 0.0,
            profile: Profile::default(),
        }
    }
}
