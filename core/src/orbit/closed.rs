//! An exact periodic orbit, and how all that it tells is read off once it has closed.

use super::residual::shifted;
use super::settings::OrbitSettings;
use super::shooting::Shooting;
use super::survey::Survey;
use crate::balance::Point;
use crate::motion::{Event, Quadrature, State};
use faer::c64;
use std::f64::consts::TAU;

/// Friction work, relative to that of the limit over the range of the motion, that is none.
const TOUCHED: f64 = 1e-9;

/// An exact periodic orbit.
#[derive(Debug, Clone)]
pub struct Orbit {
    /// Harmonics, status, slip and friction work, as of a harmonic balance.
    pub response: Point,
    /// Lowest and highest displacement of each observed DOF \[m\].
    pub range: Vec<[f64; 2]>,
    /// State at the start of the period: displacements and velocities of all DOFs, contact forces.
    pub state: Vec<f64>,
    /// Floquet multipliers over the full period, the neutral ones first, then by falling modulus.
    pub multipliers: Vec<c64>,
    /// Number of neutral multipliers, of exactly 1: a contact that never slips keeps its mean force,
    /// and a structure that nothing holds stays or drifts where it is pushed.
    pub neutral: usize,
    /// Work of the external forces per period \[J\].
    pub work: f64,
    /// Work lost to viscous damping per period \[J\].
    pub viscous: f64,
    /// Events of the period, in order of time.
    pub events: Vec<Event>,
    pub(super) start: Option<State>,
}

impl Orbit {
    /// Half ranges of the observed DOFs \[m\].
    #[must_use]
    pub fn half_ranges(&self) -> Vec<f64> {
        self.range.iter().map(|[low, high]| 0.5 * (high - low)).collect()
    }

    /// State at the start of the period, for a neighbouring frequency to start from.
    #[must_use]
    pub fn start(&self) -> Option<&State> {
        self.start.as_ref()
    }

    /// Passes along the orbit that should close at the unknowns `y` and reads everything off it; also whether a
    /// contact in a plane touches its limit.
    pub(super) fn read(
        mut self,
        shooting: &mut Shooting<'_>,
        y: &[f64],
        settings: &OrbitSettings,
        observe: &[usize],
        quadrature: &mut Quadrature,
    ) -> (Self, bool) {
        let (system, half_wave) = (shooting.coordinates.system(), shooting.half_wave);
        let omega = self.response.omega;
        let span = TAU / omega * if half_wave { 0.5 } else { 1.0 };
        let rotates = shooting.rotates();
        let mut state = shooting.state(y);
        let mut touches = false;
        for pass in 0..2 {
            self.state = state.to_dofs(system);
            self.start = Some(state.clone());
            let highest = settings.harmonics;
            let mut survey = Survey::new(system, omega, half_wave, highest, observe, quadrature);
            let first = state.clone();
            // The last step of Newton's method is not looked at before: where the flow does not run to the end
            // here, nothing closes, and what was read is dropped.
            if pass == 0 && !rotates {
                let _ = shooting.observed_image(y, Some(&mut |passage| survey.include(passage)));
            } else {
                let _ = shooting.flow.run(&mut state, span, &mut |passage| {
                    survey.include(&passage);
                });
            }
            survey.finish();
            let observed = observe.len();
            // One that Newton's method has pushed to its limit touches it for an instant.
            let still = |i: usize| {
                let (own, limit) = (&survey.contacts[i], system.limits()[i]);
                let [low, high] = survey.range[observed + i];
                own.slip_fraction == 0.0 || own.dissipation.abs() <= TOUCHED * limit * (high - low)
            };
            let neutral: Vec<usize> = (0..system.points())
                .filter(|&i| still(i) && system.limits()[i] > 0.0)
                // Where these begin to load says what they hold.
                .filter(|&i| !system.is_microslip(i))
                .collect();
            let range = &survey.range[observed..];
            let middle: Vec<f64> = range.iter().map(|r| 0.5 * (r[0] + r[1])).collect();
            let half: Vec<f64> = range.iter().map(|r| 0.5 * (r[1] - r[0])).collect();
            let residual = settings.residual;
            let moved = (pass == 0 && !half_wave)
                .then(|| shifted(system, residual, &neutral, &middle, &half, &first))
                .flatten();
            if let Some(moved) = moved {
                state = moved;
                continue;
            }
            survey.write(&mut self.response);
            self.range = survey.range[..observed].to_vec();
            (self.work, self.viscous) = (survey.work, survey.viscous);
            self.events = std::mem::take(&mut survey.events);
            touches = survey.touches();
            break;
        }
        (self, touches)
    }
}

/// Displacement error of the observed DOFs that the closing error leaves \[m\].
pub(super) fn left_error(shooting: &Shooting<'_>, observe: &[usize], left: &[f64]) -> Vec<f64> {
    let system = shooting.coordinates.system();
    let (error, _) = shooting.coordinates.state(left);
    observe
        .iter()
        .map(|&dof| {
            let parts = system.shape(dof).zip(&error.displacement);
            parts.map(|(shape, x)| (shape * x).abs()).sum()
        })
        .collect()
}
