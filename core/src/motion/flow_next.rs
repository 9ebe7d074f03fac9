//! What a contact point does next along a step of the flow.

use super::contact_state::ContactState;
use super::flow::{Flow, Next};
use super::polynomial::{first_zero, reach_of, DEGREE};
use super::power_series::sum_of_products;
use super::sliding::Slide;
use crate::contact::{Bound, PointState, SlipPlane};
use crate::solve::size;

/// Leading coefficient, relative to the largest, that counts as zero: a point is at its limit.
const AT_LIMIT: f64 = 1e-14;
/// The same for the next coefficients of a point that is at its limit.
const AT_REST: f64 = 1e-9;
/// Highest power that a margin may begin with: the square of one that loads make, which begin as sines.
const LEADING: usize = 8;

impl Flow<'_> {
    /// What a point does within `length` of τ, and whether it can begin the step as it is.
    pub(super) fn next(
        &mut self,
        regime: &ContactState,
        point: usize,
        natural: f64,
        length: f64,
    ) -> Next {
        let state = regime.points[point];
        if let Some(plane) = self.system.plane_of(point).copied() {
            return match state {
                _ if plane.points[0] != point || self.system.limits()[point] == 0.0 => Next::Stay,
                PointState::Open => Next::Stay,
                PointState::Stuck => self.begins_to_slide(plane, natural, length),
                _ => self.ends_to_slide(plane, natural, length),
            };
        }
        if let Bound::Backbone(_) = self.system.bounds[point] {
            return self.turns(point, state, natural, length);
        }
        let (constant, friction) = match self.system.bounds[point] {
            Bound::Constant(limit) if limit > 0.0 && limit.is_finite() => (limit, None),
            Bound::Friction { friction, normal } if state != PointState::Open => {
                (friction * self.system.balanced(normal), Some((friction, normal)))
            }
            Bound::Unilateral { stiffness, .. } if stiffness > 0.0 => {
                return self.opens_or_closes(state, point, natural, length);
            }
            _ => return Next::Stay,
        };
        if state != PointState::Stuck {
            if self.slips_on(regime, point, state.sign()) {
                return Next::Stay;
            }
            self.fill_slip_velocity(regime, point, state.sign(), natural);
            return self.comes_to_rest(natural, length);
        }
        let force = self.series.force(point);
        if friction.is_none()
            && size(&force[1..], &self.powers[1..=DEGREE]) < constant - force[0].abs()
        {
            return Next::Stay;
        }
        let (mut limit, mut size, mut reach) = (constant, constant, reach_of(force, length));
        if let Some((friction, normal)) = friction {
            let pressing = self.series.force(normal);
            limit += friction * pressing[0];
            reach += friction * reach_of(pressing, length);
            size = self.system.limit_size(point, self.series.displacement());
        }
        if reach < limit - force[0].abs() {
            return Next::Stay;
        }
        let mut first = Next::Stay;
        let mut window = length;
        for side in [1.0, -1.0] {
            self.fill_margin(point, side, constant, friction);
            rescale(&mut self.scratch, natural);
            match self.leaves(window / natural, size) {
                Some(0.0) => return Next::Now(PointState::slipping(side)),
                Some(share) => {
                    window = share * natural;
                    first = Next::At(window, PointState::slipping(side));
                }
                None => {}
            }
        }
        first
    }

    /// Whether a contact without sliders turns round, or goes on along another formula.
    fn turns(&mut self, point: usize, state: PointState, natural: f64, length: f64) -> Next {
        let sign = state.sign();
        let (mut first, mut window) = (Next::Stay, length);
        for [target, near] in self.series.targets(self.system, point) {
            self.scratch.clear();
            self.scratch.extend(self.series.contact(point).iter().map(|u| -sign * u));
            self.scratch[0] += sign * target;
            if self.scratch[0] <= near {
                return Next::Now(state);
            }
            rescale(&mut self.scratch, window);
            if let Some(share) = first_zero(&self.scratch) {
                window *= share;
                first = Next::At(window, state);
            }
        }
        self.scratch.clear();
        let speed = self.series.contact(point)[1..].iter().enumerate();
        self.scratch.extend(speed.map(|(n, u)| sign * (n + 1) as f64 * u));
        if self.series.branches().iter().any(|own| own.point == point && own.begins()) {
            self.scratch[0] = 0.0;
        }
        rescale(&mut self.scratch, natural);
        let to = state.mirrored();
        if self.scratch[0] < -AT_REST * self.scratch[1..].iter().map(|a| a.abs()).sum::<f64>() {
            return Next::Now(to);
        }
        match self.leaves(window / natural, 0.0) {
            Some(0.0) => Next::Now(to),
            Some(share) => Next::At(share * natural, to),
            None => first,
        }
    }

    /// Whether the velocity of a point that slips by itself changes by less than itself along the step.
    fn slips_on(&self, regime: &ContactState, point: usize, sign: f64) -> bool {
        if self.system.together_with(point).len() != 1 {
            return false;
        }
        let rate = sign * regime.slip_rate[(point, point)];
        let (powers, slopes) = self.powers.split_at(DEGREE + 1);
        let u = self.series.contact(point);
        rate * u[1] * powers[1] > rate.abs() * size(&u[2..], &slopes[2..])
    }

    /// Whether the slip velocity at hand vanishes.
    fn comes_to_rest(&mut self, natural: f64, length: f64) -> Next {
        // Another point's onset of slip turns it back at once.
        if self.scratch[0] < -AT_REST * self.scratch[1..].iter().map(|a| a.abs()).sum::<f64>() {
            return Next::Now(PointState::Stuck);
        }
        match self.leaves(length / natural, 0.0) {
            Some(0.0) => Next::Now(PointState::Stuck),
            Some(share) => Next::At(share * natural, PointState::Stuck),
            None => Next::Stay,
        }
    }

    /// Whether the traction in a plane comes to its limit: `M² − |t|²` vanishes.
    fn begins_to_slide(&mut self, plane: SlipPlane, natural: f64, length: f64) -> Next {
        let [a, b] = plane.points;
        let [t, s] = plane.points.map(|point| self.series.force(point));
        let limit = self.series.limit(self.system, a);
        let now = t[0].hypot(s[0]);
        let reach = reach_of(t, length) + reach_of(s, length) + reach_of(&limit, length);
        if reach < limit[0] - now {
            return Next::Stay;
        }
        self.series.fill_room(plane, &limit, &mut self.scratch);
        rescale(&mut self.scratch, natural);
        let size = limit[0] * self.system.limit_size(b, self.series.displacement());
        match self.leaves(length / natural, size) {
            Some(0.0) => Next::Now(PointState::Sliding),
            Some(share) => Next::At(share * natural, PointState::Sliding),
            None => Next::Stay,
        }
    }

    /// Whether a contact that slides in a plane comes to rest.
    fn ends_to_slide(&mut self, plane: SlipPlane, natural: f64, length: f64) -> Next {
        let own = |slide: &Slide| slide.plane == plane;
        let Some(slide) = self.series.slides().iter().position(own) else { return Next::Stay };
        self.series.fill_pull(slide, &mut self.scratch);
        rescale(&mut self.scratch, natural);
        self.comes_to_rest(natural, length)
    }

    /// Slip velocity in the direction of slip, on the unit interval.
    fn fill_slip_velocity(&mut self, regime: &ContactState, point: usize, sign: f64, natural: f64) {
        self.scratch.clear();
        self.scratch.resize(DEGREE, 0.0);
        let rates: Vec<(usize, f64)> = self
            .system
            .together_with(point)
            .map(|other| (other, sign * regime.slip_rate[(point, other)]))
            .filter(|(_, rate)| *rate != 0.0)
            .collect();
        for (n, a) in self.scratch.iter_mut().enumerate() {
            let parts =
                rates.iter().map(|&(other, rate)| (rate, self.series.contact(other)[n + 1]));
            *a = (n + 1) as f64 * sum_of_products(parts);
        }
        rescale(&mut self.scratch, natural);
    }

    /// Whether a normal force vanishes, or comes back.
    fn opens_or_closes(
        &mut self,
        state: PointState,
        point: usize,
        natural: f64,
        length: f64,
    ) -> Next {
        let (side, to) = match state {
            PointState::Open => (-1.0, PointState::Stuck),
            _ => (1.0, PointState::Open),
        };
        let stiffness = side * self.system.normal_stiffness(point);
        self.scratch.clear();
        self.scratch.extend(self.series.contact(point).iter().map(|u| stiffness * u));
        self.scratch[0] = side * self.system.pressing(point, self.series.displacement());
        rescale(&mut self.scratch, natural);
        let size = self.system.normal_size(point, self.series.displacement());
        match self.leaves(length / natural, size) {
            Some(0.0) => Next::Now(to),
            Some(share) => Next::At(share * natural, to),
            None => Next::Stay,
        }
    }

    /// Distance of the force from its limit on one side.
    fn fill_margin(
        &mut self,
        point: usize,
        side: f64,
        constant: f64,
        friction: Option<(f64, usize)>,
    ) {
        self.scratch.clear();
        self.scratch.extend(self.series.force(point).iter().map(|f| -side * f));
        self.scratch[0] += constant;
        if let Some((friction, normal)) = friction {
            let pressing = self.series.force(normal);
            self.scratch.iter_mut().zip(pressing).for_each(|(a, f)| *a += friction * f);
        }
    }

    /// First zero of the polynomial at hand up to `share` of the unit interval: 0 if it is at zero
    /// and falls. `scale` is what its value counts against.
    fn leaves(&mut self, share: f64, scale: f64) -> Option<f64> {
        let a = &mut self.scratch;
        let sum = |a: &[f64]| a.iter().map(|a| a.abs()).sum::<f64>();
        let mut from = 0;
        if a[0] <= AT_LIMIT * scale.max(sum(&a[1..])) {
            from = 1;
            while from < LEADING && a[from].abs() <= AT_REST * sum(&a[from + 1..]) {
                from += 1;
            }
            if a[from] <= 0.0 {
                // Nothing moves: the point may stay as it is.
                return if sum(&a[from..]) == 0.0 { None } else { Some(0.0) };
            }
        }
        let a = &mut a[from..];
        rescale(a, share);
        first_zero(a).map(|x| x * share)
    }
}

/// `Σ a_n (length x)ⁿ`.
pub(super) fn rescale(a: &mut [f64], length: f64) {
    let mut scale = 1.0;
    for a in a {
        *a *= scale;
        scale *= length;
    }
}
