//! A curve between two points with slopes, through the inverse square of its height.
//!
//! Near a resonance 1/A² is close to a parabola in ω, however narrow the resonance is, so that a
//! cubic through its values and slopes sees a peak from afar.

/// A point of a curve with its slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    pub(crate) at: f64,
    pub(crate) height: f64,
    pub(crate) slope: f64,
}

/// Share of the way from one point to another that the mean of their slopes misses at a kink.
const KINK: f64 = 0.25;

impl Knot {
    /// How high a curve between two points may be if it keeps the slope with which it leaves either, or rises
    /// above the higher one by as much as the mean of their slopes misses.
    pub(super) fn kinked([left, right]: [Self; 2]) -> f64 {
        let width = right.at - left.at;
        let (up, down) = (left.slope.max(0.0), right.slope.min(0.0));
        let persisting = (left.height + width * up).max(right.height - width * down);
        persisting.max(left.height.max(right.height) + Self::missed([left, right]))
    }

    /// What the mean of the slopes of two points misses of the way from one to the other.
    fn missed([left, right]: [Self; 2]) -> f64 {
        let expected = 0.5 * (right.at - left.at) * (left.slope + right.slope);
        (right.height - left.height - expected).abs()
    }

    /// Whether the mean of the slopes of two points does not lead from one to the other: the curve between them
    /// is far from a parabola.
    pub(super) fn has_kink([left, right]: [Self; 2]) -> bool {
        Self::missed([left, right]) > KINK * (right.height - left.height).abs()
    }
}

/// Heights below this share of the reference count as much.
const FLOOR: f64 = 1e-9;
/// Places at which an interpolant is looked at.
const LOOKS: usize = 32;

/// The cubic of 1/A² between two points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interpolant {
    /// Coefficients of `t⁰ … t³`, t from 0 to 1, and the same from the right end: near a narrow
    /// resonance at one end those of the other cancel.
    cubics: [[f64; 4]; 2],
    reference: f64,
}

impl Interpolant {
    /// Between two points; heights are measured against `reference`.
    pub(super) fn new(left: Knot, right: Knot, reference: f64) -> Self {
        let width = right.at - left.at;
        let inverse = |knot: Knot| {
            let height = (knot.height / reference).max(FLOOR);
            let value = height.powi(-2);
            (value, -2.0 * width * knot.slope / reference * value / height)
        };
        let ((g, dg), (h, dh)) = (inverse(left), inverse(right));
        let cubic = |[g, dg]: [f64; 2], [h, dh]: [f64; 2]| {
            [g, dg, 3.0 * (h - g) - 2.0 * dg - dh, 2.0 * (g - h) + dg + dh]
        };
        let cubics = [cubic([g, dg], [h, dh]), cubic([h, -dh], [g, -dg])];
        Self { cubics, reference }
    }

    /// Where and how high a curve may be that keeps the slope with which it leaves an end for half the
    /// interval, or, if it rises from both ends or against the way to the other, for twice of it: what
    /// friction cuts off is broader than a resonance, or has a kink, and then the top of a parabola
    /// through both ends is the better place to look.
    pub(super) fn tangent(left: Knot, right: Knot) -> (f64, f64) {
        let rises = |near: Knot, far: Knot| (far.at - near.at) * near.slope;
        let (up, down) = (rises(left, right), rises(right, left));
        let (first, last) = (left.height, right.height);
        let against =
            (up > 0.0 && down < 0.0 && last < first) || (up < 0.0 && down > 0.0 && first < last);
        let hides = against || up.min(down) > 0.0;
        let part = if hides { 2.0 } else { 0.5 };
        let from = |near: Knot, far: Knot| {
            let rise = rises(near, far);
            let share = 0.5 * rise / (near.height + rise - far.height);
            if rise > 0.0 && (0.0..1.0).contains(&share) {
                (share, near.height + part * rise)
            } else {
                (0.5, 0.0)
            }
        };
        let (one, (share, height)) = (from(left, right), from(right, left));
        if one.1 >= height {
            one
        } else {
            (1.0 - share, height)
        }
    }

    /// Height at the share `t` of the interval; infinite where the cubic has no sense.
    pub(super) fn height(&self, t: f64) -> f64 {
        if t <= 0.5 {
            self.height_from(0, t)
        } else {
            self.height_from(1, 1.0 - t)
        }
    }

    /// Height at a distance from the left or the right end.
    fn height_from(&self, end: usize, t: f64) -> f64 {
        let [a, b, c, d] = self.cubics[end];
        let value = a + t * (b + t * (c + t * d));
        if value > 0.0 {
            self.reference / value.sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Share of the interval at which the height has its maximum between the ends, if it has one.
    pub(super) fn top(&self) -> Option<f64> {
        self.top_from(0)
    }

    /// Its distance from the left or the right end.
    fn top_from(&self, end: usize) -> Option<f64> {
        let [_, b, c, d] = self.cubics[end];
        // The minimum of the cubic: the root of b + 2 c t + 3 d t² at which it rises away from the
        // maximum; seen from the other end the same root.
        let discriminant = c * c - 3.0 * b * d;
        if discriminant < 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let t = if c >= 0.0 { -b / (c + root) } else { (root - c) / (3.0 * d) };
        (t > 0.0 && t < 1.0).then_some(t)
    }

    /// Share and height of the largest value that the curve may have between its ends if the
    /// interpolant errs by the share `error` at most, in the middle.
    pub(super) fn promise(&self, error: f64) -> (f64, f64) {
        let most = |t: f64| 1.0 + 16.0 * error * (t * (1.0 - t)).powi(2);
        let even = (1..LOOKS).map(|i| i as f64 / LOOKS as f64).map(|t| (t, self.height(t)));
        let left = self.top_from(0).filter(|t| *t <= 0.5).map(|t| (t, self.height_from(0, t)));
        let right = self.top_from(1).filter(|t| *t < 0.5);
        let right = right.map(|t| (1.0 - t, self.height_from(1, t)));
        even.chain(left)
            .chain(right)
            .map(|(t, height)| (t, height * most(t)))
            .fold((0.5, 0.0), |best, look| if look.1 > best.1 { look } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_resonance_is_seen_from_afar() {
        let (natural, damping) = (1.3, 1e-4);
        let knot = |w: f64| {
            let (real, imaginary) = (natural * natural - w * w, damping * w);
            let height = (real * real + imaginary * imaginary).sqrt().recip();
            let rate = -2.0 * w * real + damping * damping * w;
            Knot { at: w, height, slope: -rate * height.powi(3) }
        };
        let (left, right) = (knot(1.2), knot(1.37));
        let t = Interpolant::new(left, right, left.height).top().unwrap();
        let at = left.at + t * (right.at - left.at);
        assert!((at - natural).abs() < 2e-3, "{at}");
        // From there two more looks find it.
        let middle = knot(at);
        let (a, b) = if middle.slope > 0.0 { (middle, right) } else { (left, middle) };
        let t = Interpolant::new(a, b, a.height).top().unwrap();
        assert!((a.at + t * (b.at - a.at) - natural).abs() < 1e-4);
    }

    #[test]
    fn a_rise_from_the_far_higher_end_is_seen() {
        let knot = |at: f64, height: f64, slope: f64| Knot { at, height, slope };
        let left = knot(139.7759545558, 4.207571e-9, 6.667e-9);
        let right = knot(140.3784662742, 1.840719e-3, -1.199e-1);
        assert!(Interpolant::new(left, right, right.height).promise(0.0).1 > right.height);
        let (share, height) = Interpolant::tangent(left, right);
        assert!(share > 0.5 && share < 1.0 && height > right.height);
    }
}
