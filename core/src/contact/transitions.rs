//! Where, and whether, the points of a massless elastic damper change their state.
//!
//! Between two angles of a grid the forces of stuck points and the slip of the others are
//! trigonometric series: a limit or a standstill is bracketed by their values and slopes at both
//! ends, and located by Newton's method.

use super::jets::Jet;
use super::periodic_march::{March, AT_LIMIT};
use super::PointState;

/// Rate, relative to the sum of its parts, below which it counts as zero.
const AT_REST: f64 = 1e-10;
/// Steps of a root search: Newton's method needs a handful, bisection 50.
const STEPS: usize = 60;

impl March<'_> {
    /// Whether a point cannot go on as it is: at its limit with the force growing, or slipping
    /// against its force.
    pub(super) fn contradicts(&self, jet: &Jet, force: &[f64], i: usize) -> bool {
        let limit = self.law.limits[i];
        if !(limit > 0.0 && limit.is_finite()) {
            return false;
        }
        let set = &self.sets[self.here.set].reduced;
        let (matrix, sign) = match self.here.states[i] {
            PointState::Stuck if force[i].abs() < limit => return false,
            PointState::Stuck => (&set.tangent, force[i].signum()),
            state => (&set.slip_rate, -state.sign()),
        };
        // Where contacts share a DOF the parts of a rate may cancel: what is left then is none.
        let (mut size, mut rate) = ([0.0; 2], [0.0; 2]);
        for (j, (slope, curvature)) in jet.slope().iter().zip(jet.curvature()).enumerate() {
            let part = sign * matrix[(i, j)];
            rate[0] += part * slope;
            rate[1] += part * curvature;
            // At a standstill the curvature says what the rounding of the angle is worth.
            size[0] += (part * slope).abs() + (part * curvature).abs();
            size[1] += (part * curvature).abs();
        }
        rate[0] > AT_REST * size[0]
            || (rate[0] >= -AT_REST * size[0] && rate[1] > AT_REST * size[1])
    }

    /// First angle in a cell of the grid at which a point changes its state, and the point; of all but
    /// one that is left alone.
    pub(super) fn next_transition(
        &self,
        from: &Jet,
        to: &Jet,
        alone: Option<usize>,
    ) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        for i in 0..self.law.limits.len() {
            let limit = self.law.limits[i];
            if !(limit > 0.0 && limit.is_finite()) || alone == Some(i) {
                continue;
            }
            let theta = match self.here.states[i] {
                PointState::Stuck => self.reaches_limit(from, to, i, limit),
                state => self.stands_still(from, to, i, state.sign()),
            };
            if let Some(theta) = theta.filter(|theta| first.is_none_or(|(least, _)| *theta < least))
            {
                first = Some((theta, i));
            }
        }
        first
    }

    /// Where the force of a stuck point leaves its limits.
    fn reaches_limit(&self, from: &Jet, to: &Jet, i: usize, limit: f64) -> Option<f64> {
        let force = |jet: &Jet| self.tangent_row(i, jet.value()) - self.here.offset[i];
        let rate = |jet: &Jet| self.tangent_row(i, jet.slope());
        let (start, end) = (force(from), force(to));
        let most = limit + self.at_limit[i];
        let series = self.own_series(&self.sets[self.here.set].force, i);
        let offset = self.here.offset[i];
        let value = |theta: f64| {
            let jet = self.harmonics.jet(series, theta);
            [jet[0] - offset, jet[1]]
        };
        let crossing = |until: f64, sign: f64| {
            root([from.theta, until], &|theta| {
                let [f, slope] = value(theta);
                [limit - sign * f, -sign * slope]
            })
        };
        let (fall, rise) = (rate(from), rate(to));
        if end.abs() > most {
            return Some(crossing(to.theta, end.signum()));
        }
        // A turning point between the two may lie beyond the limit.
        let reach = 0.5 * (to.theta - from.theta) * fall.abs().max(rise.abs());
        if fall * rise >= 0.0 || start.abs().max(end.abs()) + reach <= limit {
            return None;
        }
        let top = root([from.theta, to.theta], &|theta| {
            let jet = self.harmonics.jet(series, theta);
            [fall.signum() * jet[1], fall.signum() * jet[2]]
        });
        let [highest, _] = value(top);
        (highest.abs() > most).then(|| crossing(top, highest.signum()))
    }

    /// Where the slip of a point comes to rest.
    fn stands_still(&self, from: &Jet, to: &Jet, i: usize, sign: f64) -> Option<f64> {
        let set = &self.sets[self.here.set];
        let along = |of: &[f64]| sign * set.slip_of(i, of);
        let (start, end) = (along(from.slope()), along(to.slope()));
        let series = self.own_series(&self.sets[self.here.set].slip, i);
        let slope = |theta: f64| {
            let jet = self.harmonics.jet(series, theta);
            [sign * jet[1], sign * jet[2]]
        };
        let parts = to.slope().iter().enumerate();
        let size: f64 = parts.map(|(j, x)| (set.reduced.slip_rate[(i, j)] * x).abs()).sum();
        if end < -AT_REST * size {
            return Some(root([from.theta, to.theta], &slope));
        }
        // The slip may come to rest and go on between the two.
        let (fall, rise) = (along(from.curvature()), along(to.curvature()));
        let reach = 0.5 * (to.theta - from.theta) * fall.abs().max(rise.abs());
        if !(fall < 0.0 && rise > 0.0) || start.min(end) >= reach {
            return None;
        }
        let (mut low, mut high) = (from.theta, to.theta);
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            if slope(middle)[1] < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let size = along(from.slope()).abs() + reach;
        (slope(low)[0] < -AT_LIMIT * size).then(|| root([from.theta, low], &slope))
    }

    fn own_series<'b>(&self, all: &'b [f64], i: usize) -> &'b [f64] {
        let slots = self.harmonics.slots();
        &all[i * slots..(i + 1) * slots]
    }
}

/// Zero of a function that falls from its first to its second angle, with its slope: Newton's
/// method kept inside the bracket.
pub(super) fn root([mut low, mut high]: [f64; 2], of: &dyn Fn(f64) -> [f64; 2]) -> f64 {
    let mut theta = 0.5 * (low + high);
    for _ in 0..STEPS {
        let [value, slope] = of(theta);
        let rounding = 4.0 * f64::EPSILON * (1.0 + theta);
        if (value / slope).abs() <= rounding {
            break;
        }
        if value > 0.0 {
            low = theta;
        } else {
            high = theta;
        }
        let newton = theta - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let moved = (next - theta).abs();
        theta = next;
        if moved <= rounding {
            break;
        }
    }
    theta
}
