//! Quasi-static modes (Festjens, Chevallier and Dion 2013; Lacayo and Allen 2019): a load `M φ α` of the
//! shape of a linear mode is raised without inertia, on top of the static loads.
//!
//! With the modal displacement q that the first loading reaches, the frequency is that of the secant,
//! `ω² = α/q`. The load then goes to −α and back; the loop that closes loses D, and the damping ratio is
//! that of the structure and `D/(2π ω² q²)`.

use super::branch::Walk;
use super::point::ModePoint;
use super::settings::{Amplitudes, ModeEnd, ModeSettings, NonlinearMode};
use crate::balance::{slip_load, Level, Loading, Point, PointStatus, Progress, RestStatus};
use crate::contact::PointSummary;
use crate::model::{ModalBasis, Model};
use crate::timing::Profile;
use crate::Error;
use faer::{c64, Mat};
use std::time::Instant;

/// Amplitudes per decade of a range.
const PER_DECADE: f64 = 20.0;
/// Times that the way from one end of a loop to the other is halved at most.
const DEEPEST: usize = 30;
/// Accuracy of the amplitude, and of a loop that closes.
const ACCURACY: f64 = 1e-10;
/// Accuracy of the work on a part of a loop, relative to load times displacement.
const WORK: f64 = 1e-12;
/// Loadings until the amplitude is met.
const TRIALS: usize = 60;
/// Laps until the loop closes.
const LAPS: usize = 4;

/// The quasi-static mode of a model.
///
/// # Errors
/// As [`crate::design::nonlinear_mode()`]; a rigid-body motion that the mode would load.
pub(super) fn quasi_static_mode(
    model: &Model,
    settings: &ModeSettings,
    progress: &Progress<'_>,
) -> Result<NonlinearMode, Error> {
    let start = Instant::now();
    let residuals = vec![settings.residual; model.laws().len()];
    let mut walk = Walk::new(model, settings, residuals, progress, 0)?;
    let amplitudes = wanted(&settings.amplitudes);
    let linear = [walk.linear.omega, walk.linear.damping / (2.0 * walk.linear.omega)];
    let shape: Vec<f64> = walk.linear.shape.iter().map(|s| s.re).collect();
    let damping = walk.linear.damping;
    let mut mode = ModalLoading::new(model, walk.equations().basis(0), shape, damping)?;
    let (mut points, mut end, mut last) = (Vec::new(), ModeEnd::Range, f64::NAN);
    for (number, amplitude) in amplitudes.iter().copied().enumerate() {
        if !progress(number as f64 / amplitudes.len() as f64) {
            end = ModeEnd::Interrupted;
            break;
        }
        let Some(point) = mode.point(amplitude) else {
            end = ModeEnd::Stalled;
            break;
        };
        last = amplitude;
        points.push(point);
    }
    if matches!(settings.amplitudes, Amplitudes::List(_)) {
        let (dofs, contacts) = (model.compliance().dofs(), model.compliance().contacts());
        let rest = amplitudes.iter().skip(points.len());
        points.extend(rest.map(|a| ModePoint::missing(dofs, contacts, *a)).collect::<Vec<_>>());
    }
    Ok(NonlinearMode {
        points,
        linear,
        half_wave: false,
        turns: Vec::new(),
        met: None,
        end,
        end_amplitude: last,
        profile: Profile { total: start.elapsed(), ..Profile::default() },
    })
}

/// The amplitudes that are computed.
fn wanted(amplitudes: &Amplitudes) -> Vec<f64> {
    match amplitudes {
        Amplitudes::List(values) => values.clone(),
        Amplitudes::Range(low, high) => {
            let decades = (high / low).log10();
            let count = (PER_DECADE * decades).ceil().max(1.0);
            (0..=count as usize).map(|i| low * (high / low).powf(i as f64 / count)).collect()
        }
    }
}

/// A model under its static loads and a load along a mode.
struct ModalLoading<'a> {
    model: &'a Model,
    basis: &'a ModalBasis,
    /// The mode in those of the stuck structure.
    shape: Vec<f64>,
    damping: f64,
    loading: Loading<'a>,
    /// Displacements of the stuck contacts under the static loads, and under `M φ`.
    stuck: [Vec<f64>; 2],
    /// The state at rest and its modal displacements.
    rest: (Level, Vec<f64>),
    /// Load, displacement and state that the first loading has reached.
    first: (f64, f64, Level),
}

impl<'a> ModalLoading<'a> {
    fn new(
        model: &'a Model,
        basis: &'a ModalBasis,
        shape: Vec<f64>,
        damping: f64,
    ) -> Result<Self, Error> {
        let lowest = basis.squared.iter().copied().fold(f64::INFINITY, f64::min);
        if lowest <= 1e-14 * basis.squared.last().copied().unwrap_or(0.0) {
            return Err(Error::SingularStiffness { lowest: lowest.max(0.0).sqrt() });
        }
        let mut loading = Loading::new(model)?;
        loading.raise(&|_| true);
        let moved = Mat::from_fn(shape.len(), 1, |j, _| shape[j] / basis.squared[j]);
        let moved = basis.contacts.times(moved.as_ref());
        let stuck = [loading.stuck(), (0..moved.nrows()).map(|i| moved[(i, 0)]).collect()];
        let rest = loading.level.clone();
        let mut mode = Self {
            model,
            basis,
            shape,
            damping,
            loading,
            stuck,
            rest: (rest.clone(), Vec::new()),
            first: (0.0, 0.0, rest.clone()),
        };
        mode.rest.1 = mode.modal(0.0, &rest);
        Ok(mode)
    }

    /// Modal displacements in the stuck modes under the static loads and α.
    fn modal(&self, load: f64, level: &Level) -> Vec<f64> {
        let slip = slip_load(self.model, level);
        let slip = Mat::from_fn(slip.len(), 1, |i, _| slip[i]);
        let force = self.basis.contacts.adjoint_times(slip.as_ref());
        let of = |j: usize| self.basis.load[j] + load * self.shape[j] + force[(j, 0)];
        (0..self.shape.len()).map(|j| of(j) / self.basis.squared[j]).collect()
    }

    /// Displacement along the mode from rest.
    fn along(&self, load: f64, level: &Level) -> f64 {
        let modal = self.modal(load, level);
        (0..modal.len()).map(|j| self.shape[j] * (modal[j] - self.rest.1[j])).sum()
    }

    /// Goes from a level under one load to another load.
    fn go(&mut self, from: (f64, &Level), to: f64) -> Option<Level> {
        let [fixed, unit] = &self.stuck;
        let base = fixed.iter().zip(unit).map(|(u, by)| u + from.0 * by).collect();
        let by = unit.iter().map(|by| (to - from.0) * by).collect();
        self.loading.add(from.1, base, by);
        let status = self.loading.raise(&|_| true);
        (status == RestStatus::Converged).then(|| self.loading.level.clone())
    }

    /// The first loading up to an amplitude, by secants from the one before.
    fn load_up(&mut self, amplitude: f64) -> Option<(f64, Level)> {
        let start = self.first.clone();
        let stiffness = if start.1 > 0.0 {
            start.0 / start.1
        } else {
            (0..self.shape.len())
                .map(|j| self.shape[j].powi(2) / self.basis.squared[j])
                .sum::<f64>()
                .recip()
        };
        let (mut low, mut high) = ((start.0, start.1 - amplitude), None::<(f64, f64)>);
        let mut load = start.0 + stiffness * (amplitude - start.1);
        for _ in 0..TRIALS {
            let level = self.go((start.0, &start.2), load)?;
            let miss = self.along(load, &level) - amplitude;
            if miss.abs() <= ACCURACY * amplitude {
                self.first = (load, amplitude, level.clone());
                return Some((load, level));
            }
            if miss < 0.0 {
                low = (load, miss);
            } else {
                high = Some((load, miss));
            }
            let (up, above) = high.unwrap_or((load + stiffness * miss.abs(), f64::NAN));
            let secant = low.0 - low.1 * (up - low.0) / (above - low.1);
            let inner = 0.01 * (up - low.0);
            load = match high {
                None => up,
                // Where the curve bends a secant alone would creep.
                Some(_)
                    if !(secant > low.0 + inner && secant < up - inner)
                        && above.abs() > 1e-6 * amplitude =>
                {
                    0.5 * (low.0 + up)
                }
                Some(_) => secant,
            };
        }
        None
    }

    /// The mode at an amplitude; nothing if the structure does not carry the load.
    fn point(&mut self, amplitude: f64) -> Option<ModePoint> {
        let (load, top) = self.load_up(amplitude)?;
        let (mut from, mut loop_) = (top.clone(), Loop::new(self.model.compliance().contacts()));
        for _ in 0..LAPS {
            loop_ = Loop::new(self.model.compliance().contacts());
            let mut level = from.clone();
            let ends = [load, -load, load];
            for pair in ends.windows(2) {
                let middle = 0.5 * (pair[0] + pair[1]);
                let half = self.go((pair[0], &level), middle)?;
                let end = self.go((middle, &half), pair[1])?;
                let levels = [(pair[0], &level), (middle, &half), (pair[1], &end)];
                self.way(levels, WORK * load * amplitude, DEEPEST, &mut loop_)?;
                level = end;
            }
            let (before, after) = (self.along(load, &from), self.along(load, &level));
            from = level;
            if (after - before).abs() <= 1e2 * ACCURACY * amplitude {
                break;
            }
        }
        let squared = load / amplitude;
        let omega = squared.sqrt();
        let lost = loop_.lost / (std::f64::consts::TAU * squared * amplitude * amplitude);
        let viscous = 0.5 * self.damping / omega;
        Some(ModePoint {
            response: self.response(omega, (load, &top), &loop_.work),
            amplitude,
            damping_ratio: viscous + lost,
            viscous,
            ..ModePoint::missing(0, 0, amplitude)
        })
    }

    /// Adds the work on a way to a loop, by Simpson's rule in halves until they agree with the whole.
    fn way(
        &mut self,
        [from, middle, to]: [(f64, &Level); 3],
        least: f64,
        deepest: usize,
        loop_: &mut Loop,
    ) -> Option<()> {
        let between = |a: f64, b: f64| 0.5 * (a + b);
        let (first, second) = (between(from.0, middle.0), between(middle.0, to.0));
        let left = self.go(from, first)?;
        let right = self.go(middle, second)?;
        let halves = [[from, (first, &left), middle], [middle, (second, &right), to]];
        let whole = Loop::of(self, [from, middle, to]);
        let both = halves.map(|half| Loop::of(self, half));
        if deepest == 0 || whole.apart(&both) <= least {
            both.iter().for_each(|part| loop_.add(part));
            return Some(());
        }
        for half in halves {
            self.way(half, least, deepest - 1, loop_)?;
        }
        Some(())
    }

    /// The state at rest as mean, and the first loading as fundamental.
    fn response(&self, omega: f64, (load, top): (f64, &Level), work: &[f64]) -> Point {
        let (dofs, contacts) = (self.model.compliance().dofs(), top.u.len());
        let mut response = Point::empty(omega, PointStatus::Converged, dofs, contacts);
        response.keep(1);
        let (rest, modal) = (&self.rest.1, self.modal(load, top));
        for dof in 0..dofs {
            for (j, (rest, modal)) in rest.iter().zip(&modal).enumerate() {
                let shape = self.basis.shapes[(dof, j)];
                response.displacement[2 * dof] += shape * rest;
                response.displacement[2 * dof + 1] += shape * (modal - rest);
            }
        }
        for i in 0..contacts {
            let of =
                |rest: &[f64], top: &[f64]| [rest[i], top[i] - rest[i]].map(|x| c64::new(x, 0.0));
            response.contact_displacement[2 * i..2 * i + 2]
                .copy_from_slice(&of(&self.rest.0.u, &top.u));
            response.contact_force[2 * i..2 * i + 2]
                .copy_from_slice(&of(&self.rest.0.force, &top.force));
            response.contacts[i] = PointSummary { slip_fraction: f64::NAN, dissipation: work[i] };
        }
        response.residual = 0.0;
        response.error_estimate = vec![f64::NAN; dofs];
        response.sampling_error = vec![0.0; dofs];
        response
    }
}

/// What a loop loses: in all, and at every contact \[J\].
struct Loop {
    lost: f64,
    work: Vec<f64>,
}

impl Loop {
    fn new(contacts: usize) -> Self {
        Self { lost: 0.0, work: vec![0.0; contacts] }
    }

    /// The work on the way through three levels.
    fn of(mode: &ModalLoading<'_>, levels: [(f64, &Level); 3]) -> Self {
        let q = levels.map(|(load, level)| mode.along(load, level));
        let lost = simpson(levels.map(|(load, _)| load), q);
        let at = |i: usize| {
            simpson(levels.map(|(_, level)| level.force[i]), levels.map(|(_, level)| level.u[i]))
        };
        Self { lost, work: (0..levels[0].1.u.len()).map(at).collect() }
    }

    fn add(&mut self, part: &Self) {
        self.lost += part.lost;
        self.work.iter_mut().zip(&part.work).for_each(|(work, part)| *work += part);
    }

    /// Largest difference from the sum of two parts.
    fn apart(&self, parts: &[Self; 2]) -> f64 {
        let works =
            (0..self.work.len()).map(|i| self.work[i] - parts[0].work[i] - parts[1].work[i]);
        let all = std::iter::once(self.lost - parts[0].lost - parts[1].lost).chain(works);
        all.fold(0.0, |most, by| most.max(by.abs()))
    }
}

/// `∫ f du` through three points at equal distances on the way.
fn simpson(f: [f64; 3], u: [f64; 3]) -> f64 {
    let rates =
        [-3.0 * u[0] + 4.0 * u[1] - u[2], 4.0 * (u[2] - u[0]), u[0] - 4.0 * u[1] + 3.0 * u[2]];
    f.iter().zip(rates).map(|(f, rate)| f * rate).sum::<f64>() / 6.0
}
