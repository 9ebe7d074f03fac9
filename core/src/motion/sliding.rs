//! Contacts that slip in a plane: power series of the traction, and of its derivative.
//!
//! The traction is `t = M e(φ)` with the limit `M = μN`, `e = (cos φ, sin φ)` and `e⊥ = (−sin φ, cos φ)`.
//! Slip goes on while λ > 0:
//!
//! ```text
//! M φ' = k_t u'·e⊥,     λ = k_t u'·e − M'.
//! ```
//!
//! The coefficients follow from the ones before, like those of the motion. A disturbance of the
//! traction is `δt = δM e + q e⊥` with
//!
//! ```text
//! M q' + λ q = M (k_t δu'·e⊥ − φ' δM).
//! ```
//!
//! Where the contact has just closed, M = 0, the traction begins along u' and q with 0: of all solutions
//! the one that is bounded, which the others come to at once. Where the contact is about to open the
//! traction is too small for its direction to matter.

use super::contact_state::ContactState;
use super::modal_system::ModalSystem;
use super::polynomial::{DEGREE, TRUNCATION};
use super::state::State;
use crate::contact::{Bound, PointState, SlipPlane};

/// Limit, relative to what its rounding counts against, at which the direction of the traction has no
/// effect.
const VANISHED: f64 = 1e-12;
/// Unit of time of the series over that in which the traction turns.
const SLOWER: f64 = 3.0;
/// Number of coefficients.
const POWERS: usize = DEGREE + 1;

/// Coefficients of a quantity in τ.
pub(super) type Coefficients = [f64; POWERS];

/// Where a series begins.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Beginning {
    /// In motion.
    Under,
    /// Where the contact has closed: the limit is zero and does not fall.
    Closing,
    /// Where the contact is about to open.
    Opening,
}

/// A contact that slips in a plane, as power series in τ.
#[derive(Debug, Clone)]
pub(super) struct Slide {
    pub(super) plane: SlipPlane,
    /// μ k_n and the point whose force presses, if the limit varies.
    pressing: Option<(f64, usize)>,
    beginning: Beginning,
    /// Of a contact that has closed, the power with which it begins to move in its plane, once that is known.
    order: usize,
    /// What the error of the traction counts against \[N\].
    size: f64,
    /// Rate at which the traction turns or vanishes [1/s].
    rate: f64,
    limit: Coefficients,
    turn: Coefficients,
    along: [Coefficients; 2],
    /// λ; the last coefficient is not known.
    pull: Coefficients,
}

/// Displacement of a point, power after power.
fn of(contact: &[f64], point: usize) -> &[f64] {
    &contact[point * POWERS..(point + 1) * POWERS]
}

/// The unit vector in a direction; of none that of the first axis.
fn unit([x, y]: [f64; 2]) -> [f64; 2] {
    let length = x.hypot(y);
    if length > 0.0 {
        [x / length, y / length]
    } else {
        [1.0, 0.0]
    }
}

/// `Σ_j a_j b_(n−j)` over `j` from `first` to n.
fn product(a: &[f64], b: &[f64], n: usize, first: usize) -> f64 {
    (first..=n).map(|j| a[j] * b[n - j]).sum()
}

/// The same of `a'` and b.
fn slope_product(a: &[f64], b: &[f64], n: usize) -> f64 {
    (0..=n).map(|j| (j + 1) as f64 * a[j + 1] * b[n - j]).sum()
}

/// `Σ_j a_j (n − j + 1) b_(n−j+1)` over `j` from `first` to n: of a and b'.
fn product_of_slope(a: &[f64], b: &[f64], n: usize, first: usize) -> f64 {
    (first..=n).map(|j| a[j] * (n - j + 1) as f64 * b[n - j + 1]).sum()
}

impl Slide {
    /// Those of all contacts that slide; the structure has this highest rate [1/s].
    pub(super) fn all(
        system: &ModalSystem,
        regime: &ContactState,
        state: &State,
        highest: f64,
    ) -> Vec<Self> {
        let slides = |plane: &&SlipPlane| regime.points[plane.points[0]] == PointState::Sliding;
        system
            .planes()
            .iter()
            .filter(slides)
            .map(|plane| Self::new(system, *plane, state, highest))
            .collect()
    }

    fn new(system: &ModalSystem, plane: SlipPlane, state: &State, highest: f64) -> Self {
        let [a, b] = plane.points;
        let pressing = match system.bounds[a] {
            Bound::Friction { friction, normal } => {
                Some((friction * system.normal_stiffness(normal), normal))
            }
            _ => None,
        };
        let speed = |point: usize| -> f64 {
            let shape = system.contact_shape(point).iter();
            shape.zip(&state.velocity).map(|(b, v)| b * v).sum()
        };
        let way = [speed(a), speed(b)];
        let growth = pressing.map_or(0.0, |(slope, normal)| slope * speed(normal));
        let drive = plane.stiffness * way[0].hypot(way[1]) + growth.abs();
        let size = system.limit_size(a, &state.displacement) + drive / highest;
        let now = system.limit(a, &state.force);
        let beginning = match now <= VANISHED * size {
            true if pressing.is_some() && growth >= 0.0 => Beginning::Closing,
            true => Beginning::Opening,
            false => Beginning::Under,
        };
        let closing = beginning == Beginning::Closing;
        let traction = [state.force[a], state.force[b]];
        let unit = unit(if traction == [0.0; 2] { way } else { traction });
        let zeros = [0.0; POWERS];
        let start = |value: f64| {
            let mut series = zeros;
            series[0] = value;
            series
        };
        Self {
            plane,
            pressing,
            beginning,
            order: 0,
            size,
            rate: if beginning == Beginning::Under { SLOWER * drive / now } else { 0.0 },
            limit: start(if closing { 0.0 } else { now }),
            turn: zeros,
            along: unit.map(start),
            pull: zeros,
        }
    }

    /// Unit of time that suits the series [1/s].
    pub(super) fn rate(&self) -> f64 {
        self.rate
    }

    /// Forgets the coefficients: the motion is expanded anew.
    pub(super) fn restart(&mut self) {
        self.order = 0;
        self.turn.fill(0.0);
        self.along.iter_mut().for_each(|along| along[1..].fill(0.0));
    }

    /// The traction's coefficients of one power, from those of the displacements up to it.
    pub(super) fn advance(&mut self, power: usize, contact: &[f64]) -> [f64; 2] {
        if power > 0 {
            self.limit[power] =
                self.pressing.map_or(0.0, |(slope, normal)| slope * of(contact, normal)[power]);
            match self.beginning {
                Beginning::Under => {
                    let n = power - 1;
                    let known = product_of_slope(&self.limit, &self.turn, n, 1);
                    let turn = self.across(n, contact) - known;
                    self.turn_on(power, turn / (power as f64 * self.limit[0]));
                }
                Beginning::Closing if self.order == 0 => {
                    let way = self.plane.points.map(|point| of(contact, point)[power]);
                    if way != [0.0; 2] {
                        self.order = power;
                        let [cos, sin] = unit(way);
                        (self.along[0][0], self.along[1][0]) = (cos, sin);
                    }
                }
                // (M_1 n + k_t |u'|) φ_n, as a turn of the first order changes u'·e⊥; of a motion that begins
                // with a higher power m all but φ divided by τ^(m − 1).
                Beginning::Closing => {
                    let n = power - self.order;
                    let known =
                        product_of_slope(&self.limit, &self.turn, power - 1, self.order + 1);
                    self.turn_on(n, 0.0);
                    let turn = self.across(power - 1, contact) - known;
                    let [u, v] = self.plane.points.map(|point| of(contact, point)[self.order]);
                    let drive = self.order as f64 * self.plane.stiffness * u.hypot(v);
                    self.turn_on(n, turn / (n as f64 * self.limit[self.order] + drive));
                }
                Beginning::Opening => {}
            }
            self.pull[power - 1] = self.pull_at(power - 1, contact);
        }
        self.along.each_ref().map(|along| product(&self.limit, along, power, 0))
    }

    /// Coefficient n of `k_t u'·e⊥`.
    fn across(&self, n: usize, contact: &[f64]) -> f64 {
        let [u, v] = self.plane.points.map(|point| of(contact, point));
        let [cos, sin] = &self.along;
        self.plane.stiffness * (slope_product(v, cos, n) - slope_product(u, sin, n))
    }

    /// Coefficient n of λ.
    fn pull_at(&self, n: usize, contact: &[f64]) -> f64 {
        let [u, v] = self.plane.points.map(|point| of(contact, point));
        let [cos, sin] = &self.along;
        self.plane.stiffness * (slope_product(u, cos, n) + slope_product(v, sin, n))
            - (n + 1) as f64 * self.limit[n + 1]
    }

    /// Sets a coefficient of φ, and with it those of e.
    fn turn_on(&mut self, n: usize, turn: f64) {
        self.turn[n] = turn;
        let slope = |along: &Coefficients| slope_product(&self.turn, along, n - 1) / n as f64;
        let [cos, sin] = self.along.each_ref().map(slope);
        (self.along[0][n], self.along[1][n]) = (-sin, cos);
    }

    /// λ with all powers that its factors give.
    pub(super) fn fill_pull(&self, contact: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.resize(2 * DEGREE, 0.0);
        for (point, along) in self.plane.points.iter().zip(&self.along) {
            let u = of(contact, *point);
            for (j, u) in u.iter().enumerate().skip(1) {
                let slope = self.plane.stiffness * j as f64 * u;
                out[j - 1..j + DEGREE].iter_mut().zip(along).for_each(|(sum, e)| *sum += slope * e);
            }
        }
        for (j, limit) in self.limit.iter().enumerate().skip(1) {
            out[j - 1] -= j as f64 * limit;
        }
    }

    /// Length in τ over which the truncated traction is exact to rounding.
    pub(super) fn reach(&self, force: &[f64]) -> f64 {
        let mut reach = f64::INFINITY;
        let first = if self.order > 1 { self.order } else { 0 };
        let begun = self.plane.points.map(|point| of(force, point)[first]);
        // From rest nothing but the traction itself is there to count against.
        let size = if first == 0 { self.size } else { begun[0].hypot(begun[1]) };
        for point in self.plane.points {
            let force = of(force, point);
            for last in [DEGREE - 2, DEGREE - 1, DEGREE] {
                if last > first
                    && force[last] != 0.0
                    && size > 0.0
                    && self.beginning != Beginning::Opening
                {
                    let ratio = 10.0 * TRUNCATION * size / force[last].abs();
                    reach = reach.min(ratio.powf(1.0 / (last - first) as f64));
                }
            }
        }
        reach
    }
}

/// A small disturbance of a contact that slides.
pub(super) struct Swing<'a> {
    slide: &'a Slide,
    limit: Coefficients,
    /// q and `k_t δu'·e⊥ − φ' δM`.
    across: Coefficients,
    drive: Coefficients,
}

impl<'a> Swing<'a> {
    /// What small changes of the forces and of the displacements of the points begin: of the traction
    /// along itself there is but that of its limit.
    pub(super) fn new(slide: &'a Slide, force: &[f64], moved: impl Fn(usize) -> f64) -> Self {
        let zeros = [0.0; POWERS];
        let mut swing = Self { slide, limit: zeros, across: zeros, drive: zeros };
        swing.limit[0] = slide.pressing.map_or(0.0, |(slope, normal)| slope * moved(normal));
        if slide.beginning != Beginning::Closing {
            let [x, y] = slide.plane.points.map(|point| force[point]);
            let [cos, sin] = slide.along.map(|along| along[0]);
            swing.across[0] = y * cos - x * sin;
        }
        swing
    }

    /// The points of the contact.
    pub(super) fn points(&self) -> [usize; 2] {
        self.slide.plane.points
    }

    /// Coefficients of the change of the traction of one power.
    pub(super) fn advance(&mut self, power: usize, contact: &[f64]) -> [f64; 2] {
        let Slide { plane, pressing, beginning, order, limit, turn, pull, .. } = self.slide;
        let [cos, sin] = &self.slide.along;
        if power > 0 {
            self.limit[power] =
                pressing.map_or(0.0, |(slope, normal)| slope * of(contact, normal)[power]);
            let n = power - 1;
            let [u, v] = plane.points.map(|point| of(contact, point));
            self.drive[n] = plane.stiffness * (slope_product(v, cos, n) - slope_product(u, sin, n))
                - slope_product(turn, &self.limit, n);
            match beginning {
                Beginning::Under => {
                    let known = product_of_slope(limit, &self.across, n, 1)
                        + product(pull, &self.across, n, 0);
                    let driven = product(limit, &self.drive, n, 0);
                    self.across[power] = (driven - known) / (power as f64 * limit[0]);
                }
                Beginning::Closing if *order > 0 && n + order <= DEGREE => {
                    let last = n + order;
                    let known = product_of_slope(limit, &self.across, last, order + 1)
                        + product(pull, &self.across, last, *order);
                    let driven = product(limit, &self.drive, last, *order);
                    let pivot = power as f64 * limit[*order] + pull[order - 1];
                    self.across[power] = (driven - known) / pivot;
                }
                Beginning::Closing | Beginning::Opening => {}
            }
        }
        let [across, along] = [&self.across, &self.limit];
        [
            product(along, cos, power, 0) - product(across, sin, power, 0),
            product(along, sin, power, 0) + product(across, cos, power, 0),
        ]
    }
}
