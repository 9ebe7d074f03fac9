//! The coefficients of a power series, each from the ones before: of a motion about a state, and of a small
//! disturbance of it.
//!
//! Forces act on coefficients two powers up: two powers at a time follow from the ones before, and the modes
//! at the contacts are gone through but once for both.

use super::branch_series::{BranchSeries, Pass};
use super::contact_state::ContactState;
use super::damping::Damping;
use super::few_modes::FEW;
use super::microslip::Microslip;
use super::modal_system::{dot, ModalSystem};
use super::polynomial::DEGREE;
use super::power_series::{sum_of_products, PowerSeries, LONGEST_MICROSLIP};
use super::sliding::{Slide, Swing};
use super::state::State;
use pulp::NullaryFnOnce as _;

/// Shortest step where contacts slip little by little, and passes over a step.
const SHORTEST: f64 = 1e-9;
const PASSES: usize = 24;

impl PowerSeries {
    pub(super) fn set_rate(&mut self, system: &ModalSystem, rate: f64) {
        if self.rate == rate {
            return;
        }
        self.rate = rate;
        let squares = self.stiffness.iter_mut().zip(&system.omega_squared);
        squares.for_each(|(own, w)| *own = w / (rate * rate));
        if let Damping::Diagonal(damping) = &system.damping {
            self.damping.iter_mut().zip(damping).for_each(|(own, c)| *own = c / rate);
        }
    }

    /// Expands the motion about a state.
    pub(super) fn expand(
        &mut self,
        system: &ModalSystem,
        regime: &ContactState,
        omega: f64,
        state: &State,
    ) {
        self.slides = Slide::all(system, regime, state, self.slowest);
        let rate = self.slides.iter().map(Slide::rate).fold(self.slowest, f64::max);
        self.set_rate(system, rate);
        let moves = |own: &Microslip| {
            [&state.displacement, &state.velocity]
                .map(|values| dot(system.contact_shape(own.point), values))
        };
        self.branches.clear();
        for (number, own) in system.microslips.iter().enumerate() {
            let [u, speed] = moves(own);
            self.branches.push(BranchSeries::new(own, number, state, [u, speed / rate]));
        }
        if self.branches.is_empty() {
            return self.expand_once(system, regime, omega, state);
        }
        let fresh = usize::from(!self.branches.iter().any(|branch| branch.fresh));
        self.window = self.tried[fresh].min(LONGEST_MICROSLIP);
        while !self.follow_branches(system, regime, omega, state) && self.window > SHORTEST {
            self.window *= 0.5;
            self.branches.iter_mut().for_each(BranchSeries::restart);
        }
        self.tried[fresh] = 2.0 * self.window;
    }

    /// Finds the forces of the contacts without sliders over the window at hand; `false` where it is too long.
    fn follow_branches(
        &mut self,
        system: &ModalSystem,
        regime: &ContactState,
        omega: f64,
        state: &State,
    ) -> bool {
        for _ in 0..PASSES {
            self.expand_once(system, regime, omega, state);
            let (contact, window) = (&self.contact, self.window);
            let passes: Vec<Pass> =
                self.branches.iter_mut().map(|branch| branch.pass(contact, window)).collect();
            if passes.contains(&Pass::Unresolved) {
                return false;
            }
            if passes.iter().all(|pass| *pass == Pass::Settled) {
                return true;
            }
        }
        false
    }

    fn expand_once(
        &mut self,
        system: &ModalSystem,
        regime: &ContactState,
        omega: f64,
        state: &State,
    ) {
        let rate = self.rate;
        self.begin([&state.displacement, &state.velocity, &state.force]);
        // exp(ikω t) in powers of τ: (ikω/ρ)^m / m! times its value at the start.
        let mut loads: Vec<(f64, [f64; 2])> = system
            .loads
            .iter()
            .map(|(order, _)| {
                let (sin, cos) = (*order as f64 * omega * state.time).sin_cos();
                (*order as f64 * omega / rate, [cos, sin])
            })
            .collect();
        self.connect(system, regime);
        self.slides.iter_mut().for_each(Slide::restart);
        if self.modes <= FEW && !self.is_nonlinear() {
            self.expand_few(system, &mut loads);
        } else {
            self.expand_many(system, &mut loads);
        }
    }

    /// The coefficients behind those of a state, in a regime that is connected.
    pub(super) fn expand_many(&mut self, system: &ModalSystem, loads: &mut [(f64, [f64; 2])]) {
        for first in (0..=DEGREE).step_by(2) {
            self.displace_contacts(system, first);
            for power in first..DEGREE.min(first + 1) + 1 {
                self.load_contacts(power);
                for branch in self.branches.iter().filter(|_| power > 0) {
                    let at = branch.point * (DEGREE + 1) + power;
                    self.force[at] = branch.force(power, &self.contact);
                }
                let mut slides = std::mem::take(&mut self.slides);
                for slide in &mut slides {
                    let traction = slide.advance(power, &self.contact);
                    self.set_forces(slide.plane.points, power, traction);
                }
                self.slides = slides;
            }
            self.load_modes(system, first);
            for power in [first, first + 1] {
                self.expand_modes(system, loads, power);
                for (frequency, [re, im]) in &mut *loads {
                    let step = *frequency / (power + 1) as f64;
                    (*re, *im) = (-step * *im, step * *re);
                }
            }
        }
    }

    /// Expands a small disturbance `(η, η', f)` of a motion without that of its loads; `begun` is that of
    /// displacement and force where the branches of the contacts without sliders began.
    pub(super) fn disturb(
        &mut self,
        system: &ModalSystem,
        regime: &ContactState,
        motion: &Self,
        [displacement, velocity, force]: [&[f64]; 3],
        begun: &[[f64; 2]],
    ) {
        self.slides.clear();
        self.branches.clear();
        self.set_rate(system, motion.rate);
        self.begin([displacement, velocity, force]);
        for &point in &system.normals {
            let change = dot(system.contact_shape(point), displacement);
            self.force[point * (DEGREE + 1)] = regime.tangent[(point, point)] * change;
        }
        let moved = |point: usize| dot(system.contact_shape(point), displacement);
        let mut swings: Vec<Swing<'_>> =
            motion.slides.iter().map(|slide| Swing::new(slide, force, moved)).collect();
        self.connect(system, regime);
        for first in (0..=DEGREE).step_by(2) {
            self.displace_contacts(system, first);
            for power in first..DEGREE.min(first + 1) + 1 {
                self.load_contacts(power);
                for (branch, begun) in motion.branches.iter().zip(begun) {
                    let at = branch.point * (DEGREE + 1) + power;
                    self.force[at] = branch.disturbed(power, &self.contact, *begun);
                }
                for swing in &mut swings {
                    let traction = swing.advance(power, &self.contact);
                    self.set_forces(swing.points(), power, traction);
                }
            }
            self.load_modes(system, first);
            self.expand_modes(system, &[], first);
            self.expand_modes(system, &[], first + 1);
        }
    }

    /// The coefficients of a state.
    pub(super) fn begin(&mut self, [displacement, velocity, force]: [&[f64]; 3]) {
        let (n, rate) = (self.modes, self.rate);
        self.modal[..n].copy_from_slice(displacement);
        for (c, v) in self.modal[n..2 * n].iter_mut().zip(velocity) {
            *c = v / rate;
        }
        for (point, f) in force.iter().enumerate() {
            self.force[point * (DEGREE + 1)] = *f;
        }
    }

    fn set_forces(&mut self, points: [usize; 2], power: usize, forces: [f64; 2]) {
        for (point, force) in points.into_iter().zip(forces) {
            self.force[point * (DEGREE + 1) + power] = force;
        }
    }

    /// Modal forces at two powers.
    fn load_modes(&mut self, system: &ModalSystem, first: usize) {
        if first + 2 > DEGREE {
            return;
        }
        self.acting.clear();
        for (point, force) in self.force.chunks_exact(DEGREE + 1).enumerate() {
            let both = [force[first], force[first + 1]];
            if both != [0.0; 2] {
                self.acting.push((point, both));
            }
        }
        system.projection.modal_forces(&self.acting, &mut self.modal_force);
    }

    /// Coefficients of η two powers up.
    fn expand_modes(&mut self, system: &ModalSystem, loads: &[(f64, [f64; 2])], power: usize) {
        let (n, rate) = (self.modes, self.rate);
        if power + 2 > DEGREE {
            return;
        }
        let (known, rest) = self.modal.split_at_mut((power + 2) * n);
        let next = &mut rest[..n];
        let (here, ahead) = (&known[power * n..(power + 1) * n], &known[(power + 1) * n..]);
        let (order, square) = ((power + 1) as f64, rate * rate);
        let share = 1.0 / (order * (order + 1.0));
        next.fill(0.0);
        for ((_, load), (_, [re, im])) in system.loads.iter().zip(loads) {
            for (next, p) in next.iter_mut().zip(load) {
                *next += p.re * re - p.im * im;
            }
        }
        let forces = &self.modal_force[power % 2];
        next.iter_mut().zip(forces).for_each(|(next, force)| *next -= force);
        if let Damping::Full(damping) = &system.damping {
            for (j, v) in ahead.iter().enumerate() {
                for (i, next) in next.iter_mut().enumerate() {
                    *next -= rate * order * damping[(i, j)] * v;
                }
            }
            for ((next, x), w) in next.iter_mut().zip(here).zip(&self.stiffness) {
                *next = share * (*next / square - w * x);
            }
            return;
        }
        let own = Recurrence {
            next,
            here,
            ahead,
            stiffness: &self.stiffness,
            damping: &self.damping,
            factors: [share, square, order],
        };
        if n < FEW {
            return own.call();
        }
        pulp::Arch::new().dispatch(own);
    }

    /// Finds out which forces follow which displacements; all others stay as they are.
    pub(super) fn connect(&mut self, system: &ModalSystem, regime: &ContactState) {
        self.springs.clear();
        for body in system.bodies() {
            for i in body.points.clone() {
                let known = self.springs.len();
                let own = body.points.clone().map(|j| (i, j, regime.tangent[(i, j)]));
                self.springs.extend(own.filter(|(_, _, k)| *k != 0.0));
                if self.springs.len() == known {
                    self.force[i * (DEGREE + 1) + 1..(i + 1) * (DEGREE + 1)].fill(0.0);
                }
            }
        }
    }

    /// Coefficients of u at two powers.
    fn displace_contacts(&mut self, system: &ModalSystem, first: usize) {
        let last = DEGREE.min(first + 1);
        let own = |power: usize| &self.modal[power * self.modes..(power + 1) * self.modes];
        system.projection.displacements([own(first), own(last)], &mut self.displaced);
        let points = self.contact.chunks_exact_mut(DEGREE + 1).enumerate();
        for (point, series) in points.filter(|(point, _)| system.is_felt(*point)) {
            for (power, displaced) in [first, last].into_iter().zip(&self.displaced) {
                series[power] = displaced[point];
            }
        }
    }

    /// Coefficients of the forces that follow displacements, at one power.
    pub(super) fn load_contacts(&mut self, power: usize) {
        if power == 0 {
            return;
        }
        for own in self.springs.chunk_by(|one, next| one.0 == next.0) {
            if let [(i, j, k)] = own {
                self.force[i * (DEGREE + 1) + power] = k * self.contact[j * (DEGREE + 1) + power];
                continue;
            }
            let parts = own.iter().map(|(_, j, k)| (*k, self.contact[j * (DEGREE + 1) + power]));
            self.force[own[0].0 * (DEGREE + 1) + power] = sum_of_products(parts);
        }
    }
}

/// The next coefficients of modes that are damped by themselves, from their loads. A closure would be no part
/// of what vector instructions are chosen for.
struct Recurrence<'a> {
    next: &'a mut [f64],
    here: &'a [f64],
    ahead: &'a [f64],
    stiffness: &'a [f64],
    damping: &'a [f64],
    factors: [f64; 3],
}

impl pulp::NullaryFnOnce for Recurrence<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let [share, square, order] = self.factors;
        let own = self.stiffness.iter().zip(self.damping);
        let known = self.here.iter().zip(self.ahead);
        for ((next, (x, v)), (w, c)) in self.next.iter_mut().zip(known).zip(own) {
            *next = share * (*next / square - w * x - order * c * v);
        }
    }
}
