//! The state at rest that limit cycles under static loads, or of laws that are not odd, swing about:
//! where a branch of them begins.
//!
//! Small motions are linear there: contacts stick, slide or are open as they are at rest. The limit
//! cycle begins at the amplitude at which the first one leaves that state.

use super::balance::CycleBalance;
use crate::balance::condensed::Condensed;
use crate::balance::evaluation::Evaluated;
use crate::contact::{Motion, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::FlutterModel;
use crate::solve::{across, newton, norm, NewtonSettings, Outcome, System};
use crate::structure::StuckMode;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};
use std::sync::Arc;

/// Newton's method for the equilibrium.
const AT_REST: NewtonSettings = NewtonSettings { tolerance: 1e-12, max_iterations: 60 };
/// Harmonics of the motions by which the contacts are asked when they leave their state.
const HARMONICS: usize = 7;
/// Deviation from the linear force, relative to it, that counts.
const LEAVES: f64 = 1e-6;
/// Decades that amplitudes are looked for in, either way from where the search begins.
const DECADES: i32 = 40;
/// Halvings of the decade in which the contacts leave their state.
const HALVINGS: usize = 40;
/// Amplitudes beyond that, relative to it, at which a first motion is looked for: those first at which
/// receptances are far from their resonance, …
const BEYOND: [f64; 11] = [0.1, 0.3, 0.03, 0.01, 0.7, 1.5, 3e-3, 1e-3, 3e-4, 4.0, 1e-4];
/// … among ratios r that are as close to the one asked for, relative to it, as this.
const CLOSE: f64 = 5e-3;
/// Part of that motion along which Newton's method may not change it.
const STEP: f64 = 0.1;

/// Contact displacements at rest, and what contacts lack there of their stuck stiffness.
#[derive(Debug, Clone)]
pub(super) struct Equilibrium {
    displacement: Vec<f64>,
    softening: Mat<f64>,
}

/// The equations of the mean displacements alone.
struct Means<'a> {
    equations: Condensed<'a>,
    slots: usize,
    slopes: Mat<f64>,
}

impl Means<'_> {
    fn spread(&self, means: &[f64]) -> Vec<f64> {
        let mut u = vec![0.0; means.len() * self.slots];
        u.iter_mut().step_by(self.slots).zip(means).for_each(|(u, mean)| *u = *mean);
        u
    }

    /// Takes full steps to the solution; whether they lead there: they may go around between states of
    /// the contacts.
    fn settle(&mut self, x: &mut [f64]) -> bool {
        let (mut left, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        for _ in 0..AT_REST.max_iterations {
            self.residual(x, &mut left);
            if !self.solve(&left, &mut step) {
                return false;
            }
            x.iter_mut().zip(&step).for_each(|(x, step)| *x -= step);
            if norm(&step) <= AT_REST.tolerance * norm(x) {
                return true;
            }
        }
        false
    }
}

impl System for Means<'_> {
    fn size(&self) -> usize {
        self.slopes.nrows()
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        self.value(x, out);
        let (whole, slots) = (self.equations.assemble_all(), self.slots);
        self.slopes = Mat::from_fn(x.len(), x.len(), |i, j| whole[(i * slots, j * slots)]);
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        let u = self.spread(x);
        let mut left = vec![0.0; u.len()];
        self.equations.residual(&u, &mut left);
        out.iter_mut().zip(left.iter().step_by(self.slots)).for_each(|(out, left)| *out = *left);
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        let mut solved = Mat::from_fn(rhs.len(), 1, |i, _| rhs[i]);
        self.slopes.partial_piv_lu().solve_in_place(&mut solved);
        step.iter_mut().enumerate().for_each(|(i, step)| *step = solved[(i, 0)]);
        norm(step).is_finite()
    }
}

impl Equilibrium {
    /// The state at rest at a value of what is followed, by Newton's method from where the contacts
    /// begin, damped if need be; nothing if it finds no equilibrium.
    pub(super) fn new(family: &FlutterModel<'_>, value: f64, omega: f64) -> Option<Self> {
        let table = SampleTable::new(Harmonics::new(1, false));
        let (slots, slot) = (table.harmonics().slots(), table.harmonics().slot(1)?);
        let model = Arc::new(family.at(value).ok()?);
        let mut displacement: Vec<f64> =
            model.laws().iter().flat_map(|law| law.beginning().0).collect();
        let points = displacement.len();
        let mut equations = Condensed::new(Evaluated::Made(model), &table, family.residual(), true);
        equations.set_omega(omega).ok()?;
        let mut means = Means { equations, slots, slopes: Mat::zeros(points, points) };
        let begun = displacement.clone();
        if !means.settle(&mut displacement) {
            displacement = begun;
            let damped = newton(&mut means, &mut displacement, AT_REST);
            if damped.outcome != Outcome::Converged {
                return None;
            }
        }
        means.value(&displacement, &mut vec![0.0; points]);
        let equations = means.equations;
        let mut softening = Mat::zeros(points, points);
        for (load, own) in equations.loads.iter().zip(equations.model.points()) {
            let size = own.len() * slots;
            for i in (0..own.len()).filter(|_| load.active) {
                for j in 0..own.len() {
                    softening[(own.start + i, own.start + j)] =
                        load.tangent[(i * slots + slot) * size + j * slots + slot];
                }
            }
        }
        Some(Self { displacement, softening })
    }

    /// Stiffness of the contacts in small motions about the state at rest, of stuck ones D.
    pub(super) fn stiffness(&self, stuck: &Mat<f64>) -> Mat<f64> {
        let softening = &self.softening;
        stuck - faer::Scale(0.5) * (softening + softening.transpose())
    }

    /// Contact displacements about the state at rest: a mode of an amplitude.
    fn motion(&self, harmonics: &Harmonics, mode: &StuckMode, amplitude: f64) -> Vec<f64> {
        let slots = harmonics.slots();
        let mut out = vec![0.0; self.displacement.len() * slots];
        let Some(slot) = harmonics.slot(1) else { return out };
        for (i, own) in out.chunks_exact_mut(slots).enumerate() {
            let u = amplitude * mode.contact[i];
            own[0] = self.displacement[i];
            (own[slot], own[slot + 1]) = (u.re, -u.im);
        }
        out
    }

    /// What the contacts' forces in a motion lack of the linear ones, in the fundamental.
    fn excess(
        &self,
        family: &FlutterModel<'_>,
        value: f64,
        table: &SampleTable,
        mode: &StuckMode,
        amplitude: f64,
    ) -> Option<Vec<c64>> {
        let harmonics = table.harmonics();
        let (slots, slot) = (harmonics.slots(), harmonics.slot(1)?);
        let u = self.motion(harmonics, mode, amplitude);
        let mut out = Vec::with_capacity(self.displacement.len());
        let mut load = SlipLoad::default();
        for (law, points) in family.laws_at(value).ok()?.iter().zip(family.model().points()) {
            let displacement = &u[points.start * slots..points.end * slots];
            let residual = family.residual();
            law.slip_load(Motion { table, displacement, residual }, false, &mut load);
            out.extend(
                load.value.chunks_exact(slots).map(|own| c64::new(own[slot], -own[slot + 1])),
            );
        }
        let linear = &self.softening + self.softening.transpose();
        for (i, own) in out.iter_mut().enumerate() {
            for (j, u) in mode.contact.iter().enumerate() {
                *own -= 0.5 * amplitude * linear[(i, j)] * u;
            }
        }
        Some(out)
    }

    /// Modal amplitude at which the first contact leaves the state that it has at rest; nothing if none
    /// does, or at once. `force` is the largest contact force per modal amplitude.
    pub(super) fn reach(
        &self,
        family: &FlutterModel<'_>,
        value: f64,
        mode: &StuckMode,
        force: f64,
    ) -> Option<f64> {
        let table = SampleTable::new(Harmonics::new(HARMONICS, false));
        let leaves = |amplitude: f64| {
            let excess = self.excess(family, value, &table, mode, amplitude);
            excess
                .is_some_and(|excess| excess.iter().any(|q| q.norm() > LEAVES * amplitude * force))
        };
        let moved = mode.contact.iter().map(|u| u.norm()).fold(0.0, f64::max);
        let first = norm(&self.displacement).max(1e-6) / moved;
        let way = if leaves(first) { 0.1 } else { 10.0_f64 };
        let inside = way > 1.0;
        let mut decades = (1..DECADES).map(|decade| first * way.powi(decade));
        let beyond = decades.find(|amplitude| leaves(*amplitude) == inside)?;
        let [mut low, mut high] =
            if inside { [beyond / way, beyond] } else { [beyond, beyond / way] };
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if leaves(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }

    /// A limit cycle beyond the `amplitude` at which contacts leave their state at rest, as near to the
    /// ratio r as may be: by the balance of the work in the fundamental, then by Newton's method at an
    /// amplitude. Unknowns of [`CycleBalance`]; nothing if it finds none.
    pub(super) fn first_point(
        &self,
        family: &FlutterModel<'_>,
        table: &SampleTable,
        mode: &StuckMode,
        [amplitude, ratio]: [f64; 2],
        interrupted: &dyn Fn() -> bool,
    ) -> Option<Vec<f64>> {
        let guess = |beyond: &f64| {
            let amplitude = (1.0 + beyond) * amplitude;
            let excess = self.excess(family, 1.0, table, mode, amplitude)?;
            let work: c64 = mode.contact.iter().zip(&excess).map(|(u, q)| u.conj() * q).sum();
            let work = work / amplitude;
            let omega = (mode.omega * mode.omega - work.re).max(0.0).sqrt();
            Some([amplitude, omega, (work.im / omega - mode.damping) / mode.negative])
        };
        let mut guesses: Vec<[f64; 3]> = BEYOND.iter().filter_map(guess).collect();
        let off = |guess: &[f64; 3]| (guess[2] - ratio).abs().max(CLOSE * ratio);
        guesses.sort_by(|a, b| off(a).total_cmp(&off(b)));
        guesses.into_iter().find_map(|[amplitude, omega, ratio]| {
            if interrupted() {
                return None;
            }
            let mut guess = self.motion(table.harmonics(), mode, amplitude);
            guess.extend([omega, ratio]);
            // The amplitude is held by what comes before it.
            let mut before = self.motion(table.harmonics(), mode, (1.0 - STEP) * amplitude);
            before.extend([omega, ratio]);
            let mut curve = CycleBalance::new(family, table, &guess, interrupted);
            let z = across(&mut curve, &before, &guess, 1.0)?;
            let near = z[z.len() - 2] / mode.omega;
            ((0.5..2.0).contains(&near) && z[z.len() - 1].is_finite()).then_some(z)
        })
    }
}
