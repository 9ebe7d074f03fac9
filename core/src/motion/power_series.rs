//! The motion between two events as a power series in time, exact to rounding.
//!
//! Between events the equations are linear but for contacts that slide in a plane, and each coefficient
//! of the series follows from the ones before. The series needs no decomposition per set of sticking contacts, has no defective
//! cases, and hands displacements and forces over as polynomials whose zeros are the events.

use super::branch_series::{BranchSeries, Pass};
use super::damping::Damping;
use super::microslip::Microslip;
use super::modal_system::{dot, ContactState, ModalSystem};
use super::polynomial::{self, DEGREE, TRUNCATION};
use super::sliding::{Slide, Swing};
use super::state::State;
use crate::contact::{Bound, SlipPlane};

/// Longest step in units of the fastest rate: beyond it rounding errors of fast modes would grow.
const LONGEST: f64 = 12.0;
/// The same where contacts slide: disturbances, which may be faster than the motion, take the same steps.
const LONGEST_SLIDING: f64 = 4.0;

/// The same where contacts slip little by little, first step behind a reversal that is tried, the shortest one, and
/// passes over a step.
const LONGEST_MICROSLIP: f64 = 3.0;
const FRESH: f64 = 1e-2;
const SHORTEST: f64 = 1e-9;
const PASSES: usize = 24;

/// Sum relative to its parts that is rounding.
const CANCELLED: f64 = 1e-14;

/// Power series of modes, contact displacements and contact forces about the start of a step, in
/// the time `τ = ρ (t − t_start)`.
#[derive(Debug, Clone)]
pub struct PowerSeries {
    modes: usize,
    /// ρ [1/s], and what it is unless a contact that slides is faster.
    rate: f64,
    slowest: f64,
    /// η, power after power.
    modal: Vec<f64>,
    /// u and f, contact point after contact point.
    contact: Vec<f64>,
    force: Vec<f64>,
    /// Ω²/ρ² and, if diagonal, damping over ρ.
    stiffness: Vec<f64>,
    damping: Vec<f64>,
    /// Contacts that slide in a plane.
    slides: Vec<Slide>,
    /// Contacts without sliders, …
    branches: Vec<BranchSeries>,
    /// … the length of τ over which their forces hold, and the first ones to try: behind a reversal, and else.
    window: f64,
    tried: [f64; 2],
}

impl PowerSeries {
    pub(super) fn new(system: &ModalSystem, omega: f64) -> Self {
        let rate = system.rate(omega);
        let (modes, points) = (system.modes(), system.points());
        let mut series = Self {
            modes,
            rate: f64::NAN,
            slowest: rate,
            modal: vec![0.0; modes * (DEGREE + 1)],
            contact: vec![0.0; points * (DEGREE + 1)],
            force: vec![0.0; points * (DEGREE + 1)],
            stiffness: vec![0.0; modes],
            damping: vec![0.0; if system.is_diagonally_damped() { modes } else { 0 }],
            slides: Vec::new(),
            branches: Vec::new(),
            window: LONGEST,
            tried: [FRESH, LONGEST_MICROSLIP],
        };
        series.set_rate(system, rate);
        series
    }

    fn set_rate(&mut self, system: &ModalSystem, rate: f64) {
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

    /// Units of τ per second.
    pub(crate) fn rate(&self) -> f64 {
        self.rate
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
        for power in 0..=DEGREE {
            self.expand_contacts(system, regime, power);
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
            self.expand_modes(system, &loads, power);
            for (frequency, [re, im]) in &mut loads {
                let step = *frequency / (power + 1) as f64;
                (*re, *im) = (-step * *im, step * *re);
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
        for power in 0..=DEGREE {
            self.expand_contacts(system, regime, power);
            for (branch, begun) in motion.branches.iter().zip(begun) {
                let at = branch.point * (DEGREE + 1) + power;
                self.force[at] = branch.disturbed(power, &self.contact, *begun);
            }
            for swing in &mut swings {
                let traction = swing.advance(power, &self.contact);
                self.set_forces(swing.points(), power, traction);
            }
            self.expand_modes(system, &[], power);
        }
    }

    /// The coefficients of a state.
    fn begin(&mut self, [displacement, velocity, force]: [&[f64]; 3]) {
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

    /// Coefficients of η two powers up.
    fn expand_modes(&mut self, system: &ModalSystem, loads: &[(f64, [f64; 2])], power: usize) {
        let (n, rate) = (self.modes, self.rate);
        if power + 2 > DEGREE {
            return;
        }
        let (known, rest) = self.modal.split_at_mut((power + 2) * n);
        let next = &mut rest[..n];
        let (here, ahead) = (&known[power * n..(power + 1) * n], &known[(power + 1) * n..]);
        next.fill(0.0);
        for ((_, load), (_, [re, im])) in system.loads.iter().zip(loads) {
            for (next, p) in next.iter_mut().zip(load) {
                *next += p.re * re - p.im * im;
            }
        }
        for point in 0..system.points() {
            let f = self.force[point * (DEGREE + 1) + power];
            if f != 0.0 {
                for (next, b) in next.iter_mut().zip(system.contact_shape(point)) {
                    *next -= b * f;
                }
            }
        }
        let order = (power + 1) as f64;
        let share = 1.0 / (order * (order + 1.0));
        if let Damping::Full(damping) = &system.damping {
            for (j, v) in ahead.iter().enumerate() {
                for (i, next) in next.iter_mut().enumerate() {
                    *next -= rate * order * damping[(i, j)] * v;
                }
            }
            for ((next, x), w) in next.iter_mut().zip(here).zip(&self.stiffness) {
                *next = share * (*next / (rate * rate) - w * x);
            }
        } else {
            for j in 0..n {
                next[j] = share
                    * (next[j] / (rate * rate)
                        - self.stiffness[j] * here[j]
                        - order * self.damping[j] * ahead[j]);
            }
        }
    }

    /// Coefficients of u and f at one power.
    fn expand_contacts(&mut self, system: &ModalSystem, regime: &ContactState, power: usize) {
        let modal = &self.modal[power * self.modes..(power + 1) * self.modes];
        for point in (0..system.points()).filter(|point| system.is_felt(*point)) {
            self.contact[point * (DEGREE + 1) + power] = dot(system.contact_shape(point), modal);
        }
        if power == 0 {
            return;
        }
        for body in system.bodies() {
            for i in body.points.clone() {
                let own = body.points.clone();
                let parts =
                    own.map(|j| (regime.tangent[(i, j)], self.contact[j * (DEGREE + 1) + power]));
                self.force[i * (DEGREE + 1) + power] = sum_of_products(parts);
            }
        }
    }

    /// Length in τ over which the truncated series is exact to rounding.
    pub(super) fn reach(&self) -> f64 {
        let size = |power: usize| {
            let c = &self.modal[power * self.modes..(power + 1) * self.modes];
            dot(c, c).sqrt()
        };
        let mut reach = LONGEST;
        // The last two powers: in undamped motion every other one may vanish.
        for last in [DEGREE - 1, DEGREE] {
            let tail = size(last);
            if tail == 0.0 {
                continue;
            }
            let longest = (1..=4)
                .map(|power| (power, size(power)))
                .filter(|(_, size)| *size > 0.0)
                .map(|(power, size)| (TRUNCATION * size / tail).powf(1.0 / (last - power) as f64))
                .fold(0.0, f64::max);
            reach = reach.min(longest);
        }
        let most = if self.slides.is_empty() { reach } else { reach.min(LONGEST_SLIDING) };
        let most = if self.branches.is_empty() { most } else { most.min(self.window) };
        self.slides.iter().map(|slide| slide.reach(&self.force)).fold(most, f64::min)
    }

    /// Whether the equations are not linear along the step.
    pub(super) fn is_nonlinear(&self) -> bool {
        !self.slides.is_empty() || !self.branches.is_empty()
    }

    /// The contacts without sliders.
    pub(crate) fn branches(&self) -> &[BranchSeries] {
        &self.branches
    }

    /// Displacements at which a contact without sliders goes on by another formula, each with a distance
    /// that is rounding.
    pub(super) fn targets(&self, system: &ModalSystem, point: usize) -> Vec<[f64; 2]> {
        let branch = self.branches.iter().find(|branch| branch.point == point);
        branch.map_or(Vec::new(), |branch| branch.targets(&system.microslips[branch.number]))
    }

    /// The contacts that slide in a plane.
    pub(super) fn slides(&self) -> &[Slide] {
        &self.slides
    }

    /// λ of a contact that slides, with all its powers.
    pub(super) fn fill_pull(&self, slide: usize, out: &mut Vec<f64>) {
        self.slides[slide].fill_pull(&self.contact, out);
    }

    /// Coefficients of the slip limit of a point.
    pub(crate) fn limit(&self, system: &ModalSystem, point: usize) -> Vec<f64> {
        let Bound::Friction { friction, normal } = system.bounds[point] else {
            let mut series = vec![0.0; DEGREE + 1];
            series[0] = system.limits()[point];
            return series;
        };
        let mut series: Vec<f64> = self.force(normal).to_vec();
        series[0] += system.balanced(normal);
        series.iter_mut().for_each(|a| *a *= friction);
        series
    }

    /// `M² − |t|²` of a traction in a plane under this limit M.
    pub(crate) fn fill_room(&self, plane: SlipPlane, limit: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.resize(2 * DEGREE + 1, 0.0);
        let [t, s] = plane.points.map(|point| self.force(point));
        for (series, sign) in [(limit, 1.0), (t, -1.0), (s, -1.0)] {
            for (j, a) in series.iter().enumerate() {
                let (a, to) = (sign * a, &mut out[j..]);
                to.iter_mut().zip(series).for_each(|(sum, b)| *sum += a * b);
            }
        }
    }

    /// Modal displacements and velocities [1/s] at τ.
    pub fn motion_at(&self, tau: f64, displacement: &mut [f64], velocity: &mut [f64]) {
        let n = self.modes;
        displacement.fill(0.0);
        velocity.fill(0.0);
        for power in (0..=DEGREE).rev() {
            let c = &self.modal[power * n..(power + 1) * n];
            for ((x, v), c) in displacement.iter_mut().zip(velocity.iter_mut()).zip(c) {
                *v = *v * tau + *x;
                *x = *x * tau + c;
            }
        }
        velocity.iter_mut().for_each(|v| *v *= self.rate);
    }

    /// Coefficients of the force of a contact point.
    pub(crate) fn force(&self, point: usize) -> &[f64] {
        &self.force[point * (DEGREE + 1)..(point + 1) * (DEGREE + 1)]
    }

    /// Coefficients of the relative displacement of a contact point.
    pub(crate) fn contact(&self, point: usize) -> &[f64] {
        &self.contact[point * (DEGREE + 1)..(point + 1) * (DEGREE + 1)]
    }

    /// Force of a contact point at τ \[N\].
    pub(crate) fn force_at(&self, point: usize, tau: f64) -> f64 {
        polynomial::value(self.force(point), tau)
    }

    /// [`PowerSeries::motion_at`] with the contact forces, kept within their bounds.
    pub(crate) fn state_at(&self, tau: f64, system: &ModalSystem, [x, v, f]: [&mut [f64]; 3]) {
        self.motion_at(tau, x, v);
        for (point, force) in f.iter_mut().enumerate() {
            *force = self.force_at(point, tau);
        }
        system.confine(f);
    }

    /// Modal displacements at the start.
    pub(super) fn displacement(&self) -> &[f64] {
        &self.modal[..self.modes]
    }

    /// Writes the coefficients of `Σ_j shape_j η_j` over the window `[0, length]` of τ, scaled to
    /// the unit interval.
    pub(crate) fn project(
        &self,
        shape: impl Iterator<Item = f64> + Clone,
        length: f64,
        out: &mut Vec<f64>,
    ) {
        out.clear();
        let mut scale = 1.0;
        for coefficients in self.modal.chunks_exact(self.modes) {
            let sum: f64 = shape.clone().zip(coefficients).map(|(s, c)| s * c).sum();
            out.push(scale * sum);
            scale *= length;
        }
    }
}

/// Sum of products, 0 where they cancel up to rounding: coupled points that share a DOF have rates
/// that vanish identically.
pub(super) fn sum_of_products(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut size) = (0.0, 0.0_f64);
    for (a, b) in pairs.filter(|(a, _)| *a != 0.0) {
        sum += a * b;
        size += (a * b).abs();
    }
    if sum.abs() <= CANCELLED * size {
        0.0
    } else {
        sum
    }
}
