//! The balance in the positions from which the sliders of its contacts begin.
//!
//! A slider that never moves keeps a traction which the vibration does not determine. It is varied by
//! the position w, measured from where [`Residual::FromRest`] begins. Friction sees differences from
//! its slider alone, `q(u, w) = D w + q(u − w, 0)`. So the contacts answer to the shifted
//! displacements `U' = U − w` by laws that know nothing of w, and
//!
//! `U' = U^stuck + (G₀ D − 1) w + G Q(U')`:
//!
//! sliders act like a static load. Amplitudes follow from `J dU' = (G₀ D − 1) dw`. A slider that slips
//! in both senses, or is pushed to its limit, has `dU' = −dw` there: its start changes nothing.

use super::condensed::Condensed;
use super::evaluation::Evaluated;
use super::solution::{Point, PointStatus};
use super::unknowns::{gather, scatter};
use crate::contact::{Held, Residual};
use crate::fourier::{amplitude, amplitude_gradient, Measure, SampleTable};
use crate::solve::{newton, NewtonSettings, Outcome, System as _};
use crate::structure::Quantity;
use crate::timing::Profile;
use crate::Error;

/// Halvings of the way to other sliders after which there is no motion with them.
const HALVINGS: i32 = 3;
/// Iterations in which a motion is found, or there is none.
const ITERATIONS: usize = 20;
/// Full steps in which a far start leads to a motion: some, those for every contact, and the most.
const LOOK: [usize; 3] = [8, 2, 20];
/// Relative step behind which full steps have come to a motion.
const ARRIVED: f64 = 1e-2;
/// Relative step from which on they are compared with the motions that are known, …
const NEAR: f64 = 5e-2;
/// … and the relative distance at which they come to one of them.
const KNOWN: f64 = 1e-3;
/// Distance from its limit, relative to its range, at which a slider is free to move: derivatives are
/// those inwards.
const INSIDE: f64 = 1e-7;

/// A motion with its sliders.
#[derive(Debug, Clone)]
pub(crate) struct HeldMotion {
    /// Harmonics of the contact displacements.
    pub(crate) u: Vec<f64>,
    /// Positions of the sliders that are held, as the motion has left them; of others from where they
    /// have begun.
    pub(crate) sliders: Vec<f64>,
    /// Range of the sliders that are held, component by component.
    pub(crate) range: Vec<Option<[f64; 2]>>,
    /// Whether the motion has pushed one of them.
    pub(crate) pushed: bool,
    /// Half ranges of the observed DOFs.
    pub(crate) amplitude: Vec<f64>,
    /// Derivative of each in the sliders, inwards where one touches its limit; empty if it was not
    /// asked for.
    pub(crate) slopes: Vec<Vec<f64>>,
}

/// The balance at one frequency in the positions of its sliders.
pub(crate) struct SliderBalance<'a> {
    equations: Condensed<'a>,
    observe: &'a [usize],
    settings: NewtonSettings,
    /// Evaluations and factorisations, after either of which nothing more is tried.
    affordable: [usize; 2],
    /// Whether something was not tried for that.
    pub(crate) cut: bool,
    /// The stuck response where no slider is moved.
    stuck: Vec<f64>,
    /// What every slider adds to it per displacement; empty of components without one.
    shifts: Vec<Vec<f64>>,
}

impl<'a> SliderBalance<'a> {
    /// The balance of a model, with the history of its friction, at a frequency. Its harmonics
    /// have a mean.
    ///
    /// # Errors
    /// As for a solution: a singular static stiffness or an undamped resonance.
    pub(crate) fn new(
        model: Evaluated<'a>,
        table: &'a SampleTable,
        omega: f64,
        settings: NewtonSettings,
        observe: &'a [usize],
        affordable: [usize; 2],
    ) -> Result<Self, Error> {
        let mut equations = Condensed::new(model, table, Residual::FromRest, true);
        equations.set_omega(omega).map_err(|(_, error)| error)?;
        let stuck = equations.stuck_response().to_vec();
        let settings =
            NewtonSettings { max_iterations: ITERATIONS.min(settings.max_iterations), ..settings };
        let shifts = Vec::new();
        let cut = false;
        let mut balance = Self { equations, observe, settings, affordable, cut, stuck, shifts };
        balance.shifts = (0..balance.count()).map(|slider| balance.shift(slider)).collect();
        Ok(balance)
    }

    /// Work done so far.
    pub(crate) fn profile(&self) -> &Profile {
        &self.equations.profile
    }

    fn is_spent(&mut self) -> bool {
        let Profile { evaluations, factorisations, .. } = *self.profile();
        let spent = evaluations >= self.affordable[0] || factorisations >= self.affordable[1];
        self.cut |= spent;
        spent
    }

    /// Number of components, each of which may have a slider.
    fn count(&self) -> usize {
        self.equations.model.compliance().contacts()
    }

    fn slots(&self) -> usize {
        self.equations.harmonics().slots()
    }

    /// `(G₀ D − 1) e` of a component.
    fn shift(&self, slider: usize) -> Vec<f64> {
        let slots = self.slots();
        let load = self.spring_load(slider);
        let mut shift = vec![0.0; self.stuck.len()];
        self.equations.add_response(&load, &mut shift);
        shift[slider * slots] -= 1.0;
        shift
    }

    /// `D e`: the constant force of a slider that is displaced by one.
    fn spring_load(&self, slider: usize) -> Vec<f64> {
        let slots = self.slots();
        let mut load = vec![0.0; self.stuck.len()];
        let stiffness = self.equations.model.contact_stiffness();
        let own = self.equations.model.points().iter().find(|points| points.contains(&slider));
        for i in own.cloned().unwrap_or_default() {
            load[i * slots] = stiffness[(i, slider)];
        }
        load
    }

    /// The motion of a point under an assumed residual, by its sliders.
    pub(crate) fn of_point(&mut self, point: &Point, residual: Residual) -> Option<HeldMotion> {
        let u = point.unknowns()?.recast(self.equations.harmonics());
        self.equations.residual = residual;
        let held = self.held(&u);
        self.equations.residual = Residual::FromRest;
        let zero = vec![0.0; self.count()];
        let mut motion = HeldMotion::new(&zero, &held, u);
        self.begin_at(&motion.sliders);
        self.measure(&mut motion, true)?;
        motion.amplitude = point.half_ranges();
        Some(motion)
    }

    fn held(&self, x: &[f64]) -> Vec<Option<Held>> {
        let laws = self.equations.model.laws().iter().enumerate();
        laws.flat_map(|(index, law)| law.held(self.equations.motion(index, x))).collect()
    }

    /// The motion with its sliders begun at `sliders`, from the displacements `start`, or else from those
    /// without slip; `None` if it is not found.
    pub(crate) fn solve(
        &mut self,
        sliders: &[f64],
        start: Option<&[f64]>,
        slopes: bool,
    ) -> Option<HeldMotion> {
        if self.is_spent() {
            return None;
        }
        self.begin_at(sliders);
        let mut x = match start {
            Some(u) => self.seen(u, sliders),
            None => self.equations.stuck.clone(),
        };
        if newton(&mut self.equations, &mut x, self.settings).outcome != Outcome::Converged {
            return None;
        }
        let held = self.held(&x);
        let back: Vec<f64> = sliders.iter().map(|w| -w).collect();
        let mut motion = HeldMotion::new(sliders, &held, self.seen(&x, &back));
        self.measure(&mut motion, slopes)?;
        Some(motion)
    }

    /// [`Self::solve`] from a start that is far from any motion, by full Newton steps: every one leads to
    /// the motion of the states that the contacts have had at the last one. `None` where they come to
    /// one that is `known`, or to none.
    pub(crate) fn look(
        &mut self,
        sliders: &[f64],
        start: &[f64],
        known: &[HeldMotion],
    ) -> Option<HeldMotion> {
        if self.is_spent() {
            return None;
        }
        self.begin_at(sliders);
        let mut x = self.seen(start, sliders);
        let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        let [some, each, most] = LOOK;
        for _ in 0..most.min(some + each * self.equations.model.laws().len()) {
            self.equations.residual(&x, &mut defect);
            if !self.equations.solve(&defect, &mut step) {
                return None;
            }
            x.iter_mut().zip(&step).for_each(|(x, s)| *x -= s);
            let size = self.vibration(&x);
            let relative = self.vibration(&step) / size;
            let comes_to = |other: &HeldMotion| {
                let apart: Vec<f64> = x.iter().zip(&other.u).map(|(a, b)| a - b).collect();
                self.vibration(&apart) < KNOWN * size
            };
            if relative < NEAR && known.iter().any(comes_to) {
                return None;
            }
            if relative < ARRIVED {
                let back: Vec<f64> = sliders.iter().map(|w| -w).collect();
                let start = self.seen(&x, &back);
                return self.solve(sliders, Some(&start), true);
            }
        }
        None
    }

    /// Norm of all but the mean.
    fn vibration(&self, x: &[f64]) -> f64 {
        let of_components = x.chunks_exact(self.slots());
        of_components.flat_map(|own| &own[1..]).map(|x| x * x).sum::<f64>().sqrt()
    }

    /// The response without slip.
    pub(crate) fn stuck_response(&self) -> &[f64] {
        &self.stuck
    }

    /// The last component of every contact: the normal one of those that have one.
    pub(crate) fn last_components(&self) -> impl Iterator<Item = usize> + '_ {
        self.equations.model.points().iter().map(|points| points.end - 1)
    }

    /// Displacements as they are seen from sliders.
    fn seen(&self, u: &[f64], sliders: &[f64]) -> Vec<f64> {
        let mut seen = u.to_vec();
        seen.iter_mut().step_by(self.slots()).zip(sliders).for_each(|(u, w)| *u -= w);
        seen
    }

    /// [`Self::solve`] from another motion, in shorter steps where one does not lead there.
    pub(crate) fn follow(&mut self, from: &HeldMotion, sliders: &[f64]) -> Option<HeldMotion> {
        (0..HALVINGS).find_map(|halvings| {
            let steps = 1 << halvings;
            let mut u = from.u.clone();
            let mut found = None;
            for step in 1..=steps {
                let share = f64::from(step) / f64::from(steps);
                let ends = from.sliders.iter().zip(sliders);
                let at: Vec<f64> = ends.map(|(a, b)| a + share * (b - a)).collect();
                found = Some(self.solve(&at, Some(&u), step == steps)?);
                u.clone_from(&found.as_ref()?.u);
            }
            found
        })
    }

    fn begin_at(&mut self, sliders: &[f64]) {
        self.equations.stuck.clone_from(&self.stuck);
        for (w, shift) in sliders.iter().zip(&self.shifts).filter(|(w, _)| **w != 0.0) {
            self.equations.stuck.iter_mut().zip(shift).for_each(|(stuck, by)| *stuck += w * by);
        }
    }

    /// Amplitudes and, if wanted, their derivatives.
    fn measure(&mut self, motion: &mut HeldMotion, slopes: bool) -> Option<()> {
        let slots = self.slots();
        let mut x = self.seen(&motion.u, &motion.sliders);
        let mut ignored = vec![0.0; x.len()];
        if slopes {
            x = self.seen(&motion.u, &motion.inside(INSIDE));
            self.equations.residual(&x, &mut ignored);
        }
        // Harmonics from the first on depend on differences from the sliders alone.
        let series = self.series(Quantity::Whole, &x, &self.equations.slip_load()).ok()?;
        let table = self.equations.table;
        let of_dof = series.chunks_exact(slots);
        motion.amplitude =
            of_dof.clone().map(|series| amplitude(table, series, Measure::HalfRange)).collect();
        if !slopes {
            return Some(());
        }
        let gradients: Vec<Vec<f64>> =
            of_dof.map(|series| amplitude_gradient(table, series, Measure::HalfRange)).collect();
        motion.slopes = vec![vec![0.0; self.count()]; self.observe.len()];
        for slider in (0..self.count()).filter(|slider| motion.range[*slider].is_some()) {
            let mut rate = vec![0.0; x.len()];
            if !self.equations.solve(&self.shifts[slider].clone(), &mut rate) {
                return None;
            }
            let mut slip_rate = vec![0.0; x.len()];
            self.equations.add_tangent_product(&rate, &mut slip_rate);
            let rates = self.series(Quantity::OfSlip, &rate, &slip_rate).ok()?;
            for (dof, gradient) in gradients.iter().enumerate() {
                let rate = &rates[dof * slots..(dof + 1) * slots];
                // The mean, which the sliders move as well, is no part of a half range.
                motion.slopes[dof][slider] =
                    gradient[1..].iter().zip(&rate[1..]).map(|(g, r)| g * r).sum();
            }
        }
        Some(())
    }

    /// A motion as a point: the displacements of all DOFs as they are, those of the contacts as they
    /// are seen from sliders by a share of their range clear of its limits: there the flow is smooth. By [`Residual::FromRest`] the laws answer to these as
    /// they do to the motion.
    ///
    /// # Errors
    /// As for a solution.
    pub(crate) fn seen_point(&mut self, motion: &HeldMotion, clear: f64) -> Result<Point, Error> {
        let x = self.seen(&motion.u, &motion.inside(clear));
        self.equations.residual(&x, &mut vec![0.0; x.len()]);
        let mut slip_load = self.equations.slip_load();
        for (slider, w) in motion.sliders.iter().enumerate() {
            let load = self.spring_load(slider);
            slip_load.iter_mut().zip(load).for_each(|(slip, by)| *slip += w * by);
        }
        let harmonics = self.equations.harmonics();
        let (orders, omega) = (harmonics.highest() + 1, self.equations.omega);
        let everywhere: Vec<usize> = (0..self.equations.model.compliance().dofs()).collect();
        let sizes = (everywhere.len() * orders, self.count() * orders);
        let mut point = Point::empty(omega, PointStatus::Converged, sizes.0, sizes.1);
        point.harmonics = harmonics.highest();
        let moved = &mut point.displacement;
        let all = [&motion.u[..], &slip_load];
        self.equations.displacements(
            Quantity::Whole,
            all,
            &everywhere,
            |order, values, _, _| {
                values.iter().enumerate().for_each(|(dof, x)| moved[dof * orders + order] = *x);
            },
        )?;
        let mut values = Vec::new();
        for order in harmonics.orders() {
            gather(harmonics, order, &x, &mut values);
            let seen = values.iter().enumerate();
            seen.for_each(|(i, u)| point.contact_displacement[i * orders + order] = *u);
        }
        Ok(point)
    }

    /// Series of the observed DOFs.
    fn series(&self, quantity: Quantity, x: &[f64], slip_load: &[f64]) -> Result<Vec<f64>, Error> {
        let harmonics = self.equations.harmonics();
        let mut series = vec![0.0; self.observe.len() * harmonics.slots()];
        self.equations.displacements(
            quantity,
            [x, slip_load],
            self.observe,
            |order, values, _, _| {
                scatter(harmonics, order, values, &mut series);
            },
        )?;
        Ok(series)
    }
}

impl HeldMotion {
    /// A motion whose sliders have begun at `sliders` and are held as they say.
    fn new(sliders: &[f64], held: &[Option<Held>], u: Vec<f64>) -> Self {
        let both = || sliders.iter().zip(held);
        let moved = |(w, held): (&f64, &Option<Held>)| w + held.map_or(0.0, |held| held.position);
        let range = |(w, held): (&f64, &Option<Held>)| held.map(|held| held.range.map(|r| w + r));
        Self {
            u,
            sliders: both().map(moved).collect(),
            range: both().map(range).collect(),
            pushed: held.iter().flatten().any(|held| held.pushed),
            amplitude: Vec::new(),
            slopes: Vec::new(),
        }
    }

    /// Positions of the sliders, those that are held by a share nearer to the middle of their range.
    fn inside(&self, share: f64) -> Vec<f64> {
        let inside = |(w, range): (&f64, &Option<[f64; 2]>)| match range {
            Some([low, high]) => w + share * (0.5 * (low + high) - w),
            None => *w,
        };
        self.sliders.iter().zip(&self.range).map(inside).collect()
    }

    /// The sliders that are held, by component, with their ranges.
    pub(crate) fn held(&self) -> impl Iterator<Item = (usize, [f64; 2])> + '_ {
        let own = self.range.iter().enumerate();
        own.filter_map(|(slider, range)| Some((slider, (*range)?)))
    }
}
