//! The motion between two events as a power series in time, exact to rounding.
//!
//! Between events the equations are linear but for contacts that slide in a plane, and each coefficient
//! of the series follows from the ones before. The series needs no decomposition per set of sticking
//! contacts and has no defective cases. Events are the zeros of the polynomials that displacements and
//! forces are.

use super::branch_series::BranchSeries;
use super::modal_system::{dot, ModalSystem};
use super::polynomial::{self, DEGREE, TRUNCATION};
use super::sliding::Slide;
use crate::contact::{Bound, SlipPlane};
use crate::solve::multiply;
use faer::{Accum, Mat, MatRef};

/// Longest step in units of the fastest rate: beyond it rounding errors of fast modes would grow.
const LONGEST: f64 = 12.0;
/// The same where contacts slide: disturbances, which may be faster than the motion, take the same steps.
const LONGEST_SLIDING: f64 = 4.0;

/// The same where contacts slip little by little, and the first step behind a reversal that is tried.
pub(super) const LONGEST_MICROSLIP: f64 = 3.0;
const FRESH: f64 = 1e-2;

/// Sum relative to its parts that is rounding.
const CANCELLED: f64 = 1e-14;

/// Power series of modes, contact displacements and contact forces about the start of a step, in
/// the time `τ = ρ (t − t_start)`.
#[derive(Debug, Clone)]
pub struct PowerSeries {
    pub(super) modes: usize,
    /// ρ [1/s], and what it is unless a contact that slides is faster.
    pub(super) rate: f64,
    pub(super) slowest: f64,
    /// η, power after power.
    pub(super) modal: Vec<f64>,
    /// u and f, contact point after contact point.
    pub(super) contact: Vec<f64>,
    pub(super) force: Vec<f64>,
    /// Ω²/ρ² and, if diagonal, damping over ρ.
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
    /// Contacts that slide in a plane.
    pub(super) slides: Vec<Slide>,
    /// Contacts without sliders, …
    pub(super) branches: Vec<BranchSeries>,
    /// … the length of τ over which their forces hold, and the first ones to try: behind a reversal, and else.
    pub(super) window: f64,
    pub(super) tried: [f64; 2],
    /// Displacements of two powers.
    pub(super) displaced: [Vec<f64>; 2],
    /// Points whose forces have coefficients of these, and what they are for the modes.
    pub(super) acting: Vec<(usize, [f64; 2])>,
    pub(super) modal_force: [Vec<f64>; 2],
    /// Which forces follow which displacements, with which factors, force after force.
    pub(super) springs: Vec<(usize, usize, f64)>,
}

/// A motion at many instants, one column each: modal displacements and velocities, contact velocities and
/// contact forces. Stretch after stretch takes the same room.
#[derive(Debug)]
pub(crate) struct Values {
    /// Powers of the instants, and their derivatives.
    powers: Mat<f64>,
    slopes: Mat<f64>,
    pub(crate) displacement: Mat<f64>,
    pub(crate) velocity: Mat<f64>,
    pub(crate) speed: Mat<f64>,
    pub(crate) force: Mat<f64>,
}

impl Default for Values {
    fn default() -> Self {
        let [powers, slopes, displacement, velocity, speed, force] = [(); 6].map(|()| Mat::new());
        Self { powers, slopes, displacement, velocity, speed, force }
    }
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
            displaced: [Vec::new(), Vec::new()],
            acting: Vec::new(),
            modal_force: [Vec::new(), Vec::new()],
            springs: Vec::new(),
        };
        series.set_rate(system, rate);
        series
    }

    /// Units of τ per second.
    pub(crate) fn rate(&self) -> f64 {
        self.rate
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

    /// Whether the squares of all coefficients are numbers.
    pub(super) fn is_bounded(&self) -> bool {
        dot(&self.modal, &self.modal).is_finite()
    }

    /// Whether the equations are not linear along the step.
    pub(crate) fn is_nonlinear(&self) -> bool {
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

    /// Writes the motion at many instants of a length of τ, given by the powers of their shares of it.
    pub(crate) fn write_values(&self, shares: &Mat<f64>, length: f64, values: &mut Values) {
        let (count, points) = (shares.ncols(), self.force.len() / (DEGREE + 1));
        let Values { powers, slopes, displacement, velocity, speed, force } = values;
        for (matrix, rows) in [
            (powers, DEGREE + 1),
            (slopes, DEGREE + 1),
            (displacement, self.modes),
            (velocity, self.modes),
            (speed, points),
            (force, points),
        ] {
            matrix.resize_with(rows, count, |_, _| 0.0);
        }
        let Values { powers, slopes, displacement, velocity, speed, force } = values;
        let (mut lengths, mut rates) = ([1.0; DEGREE + 1], [0.0; DEGREE]);
        for n in 1..=DEGREE {
            lengths[n] = length * lengths[n - 1];
            rates[n - 1] = self.rate * n as f64;
        }
        for j in 0..count {
            let (power, slope) = (powers.col_as_slice_mut(j), slopes.col_as_slice_mut(j));
            let parts = power.iter_mut().zip(shares.col_as_slice(j)).zip(&lengths);
            parts.for_each(|((power, share), length)| *power = share * length);
            slope[0] = 0.0;
            let parts = slope[1..].iter_mut().zip(&*power).zip(&rates);
            parts.for_each(|((slope, power), rate)| *slope = rate * power);
        }
        let modal = MatRef::from_column_major_slice(&self.modal, self.modes, DEGREE + 1);
        let [contacts, forces] = [&self.contact, &self.force]
            .map(|all| MatRef::from_column_major_slice(all, DEGREE + 1, points).transpose());
        for (to, coefficients, by) in [
            (displacement, modal, &*powers),
            (velocity, modal, &*slopes),
            (speed, contacts, slopes),
            (force, forces, powers),
        ] {
            multiply(to.as_mut(), Accum::Replace, coefficients, by.as_ref(), 1.0);
        }
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

    /// Writes the coefficients of `Σ_j shape_j η_j`.
    pub(super) fn write_projection(&self, shape: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.extend(
            self.modal.chunks_exact(self.modes).map(|powers| crate::solve::dot(shape, powers)),
        );
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
