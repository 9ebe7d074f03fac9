//! The harmonics a series keeps and the layout of its real coefficients.

/// The set of harmonics kept in a balance.
///
/// Either all harmonics `0..=H`, or the odd ones alone when the motion has half-wave symmetry
/// `x(t + T/2) = −x(t)`. The real coefficients of a series are stored as `[a_0,] a_k, b_k, …`
/// with `x(θ) = a_0 + Σ a_k cos kθ + b_k sin kθ`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Harmonics {
    highest: usize,
    half_wave: bool,
    oscillating: Vec<usize>,
}

impl Harmonics {
    /// Harmonics up to `highest`, odd ones alone if `half_wave`.
    #[must_use]
    pub fn new(highest: usize, half_wave: bool) -> Self {
        let step = if half_wave { 2 } else { 1 };
        Self { highest, half_wave, oscillating: (1..=highest).step_by(step).collect() }
    }

    /// The highest harmonic H that was asked for.
    #[must_use]
    pub fn highest(&self) -> usize {
        self.highest
    }

    /// Whether only odd harmonics are kept.
    #[must_use]
    pub fn half_wave(&self) -> bool {
        self.half_wave
    }

    /// The orders k ≥ 1, ascending.
    #[must_use]
    pub fn oscillating(&self) -> &[usize] {
        &self.oscillating
    }

    /// The orders with the mean, if kept, first.
    pub fn orders(&self) -> impl Iterator<Item = usize> + '_ {
        self.has_mean().then_some(0).into_iter().chain(self.oscillating.iter().copied())
    }

    /// Whether the mean (k = 0) is an unknown.
    #[must_use]
    pub fn has_mean(&self) -> bool {
        !self.half_wave
    }

    /// Number of real coefficients of one series.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.offset() + 2 * self.oscillating.len()
    }

    /// Position of the first cosine coefficient.
    #[must_use]
    pub fn offset(&self) -> usize {
        usize::from(self.has_mean())
    }

    /// Position of `a_k`; `b_k` follows it. `None` when the harmonic is not kept.
    #[must_use]
    pub fn slot(&self, order: usize) -> Option<usize> {
        if order == 0 {
            return self.has_mean().then_some(0);
        }
        if order > self.highest || (self.half_wave && order % 2 == 0) {
            return None;
        }
        let index = if self.half_wave { (order - 1) / 2 } else { order - 1 };
        Some(self.offset() + 2 * index)
    }

    /// Share of the period over which a motion must be followed: the rest is its mirror image.
    #[must_use]
    pub fn span(&self) -> f64 {
        if self.half_wave {
            std::f64::consts::PI
        } else {
            std::f64::consts::TAU
        }
    }

    /// The mean of a series.
    #[must_use]
    pub fn mean(&self, series: &[f64]) -> f64 {
        if self.has_mean() {
            series[0]
        } else {
            0.0
        }
    }

    /// Halves the means of series, one after the other: by the quadrature of their harmonics they are
    /// integrals over the period, not twice those.
    pub(crate) fn halve_means(&self, series: &mut [f64]) {
        if self.has_mean() {
            series.iter_mut().step_by(self.slots()).for_each(|mean| *mean *= 0.5);
        }
    }

    /// Modulus of the fundamental.
    #[must_use]
    pub fn fundamental(&self, series: &[f64]) -> f64 {
        let first = self.offset();
        series[first].hypot(series[first + 1])
    }

    /// Writes amplitudes X_0, X_1, … as real coefficients; those that are not kept are left out.
    pub fn write_series(&self, amplitudes: &[faer::c64], series: &mut [f64]) {
        for order in self.orders() {
            let (Some(amplitude), Some(slot)) = (amplitudes.get(order), self.slot(order)) else {
                continue;
            };
            series[slot] = amplitude.re;
            if order > 0 {
                series[slot + 1] = -amplitude.im;
            }
        }
    }

    /// Value and first two derivatives of a series at the angle `theta`.
    #[must_use]
    pub fn jet(&self, series: &[f64], theta: f64) -> [f64; 3] {
        let [jet] = self.jets([series], theta);
        jet
    }

    /// Values and first two derivatives of series at the angle `theta`.
    #[must_use]
    pub fn jets<const N: usize>(&self, series: [&[f64]; N], theta: f64) -> [[f64; 3]; N] {
        let mut jets = series.map(|series| [self.mean(series), 0.0, 0.0]);
        // A series of fewer harmonics than are kept ends with zeros.
        let last = series.iter().filter_map(|series| series.iter().rposition(|x| *x != 0.0)).max();
        let count = last.map_or(0, |last| (last + 2).saturating_sub(self.offset()) / 2);
        self.rotate(theta, count, |order, cos, sin, slot| {
            for (jet, series) in jets.iter_mut().zip(series) {
                let (a, b) = (series[slot], series[slot + 1]);
                let (in_phase, quadrature) = (a * cos + b * sin, b * cos - a * sin);
                jet[0] += in_phase;
                jet[1] += order * quadrature;
                jet[2] -= order * order * in_phase;
            }
        });
        jets
    }

    /// Writes the basis `[1,] cos kθ, sin kθ, …` at the angle `theta`.
    pub fn basis(&self, theta: f64, basis: &mut [f64]) {
        if self.has_mean() {
            basis[0] = 1.0;
        }
        self.rotate(theta, self.oscillating.len(), |_, cos, sin, slot| {
            basis[slot] = cos;
            basis[slot + 1] = sin;
        });
    }

    /// Writes the antiderivatives `[θ,] sin kθ / k, −cos kθ / k, …` of the basis.
    pub fn antiderivative(&self, theta: f64, out: &mut [f64]) {
        if self.has_mean() {
            out[0] = theta;
        }
        self.rotate(theta, self.oscillating.len(), |order, cos, sin, slot| {
            out[slot] = sin / order;
            out[slot + 1] = -cos / order;
        });
    }

    /// The basis where its antiderivatives are `antiderivative`.
    pub fn differentiate(&self, antiderivative: &[f64], basis: &mut [f64]) {
        if self.has_mean() {
            basis[0] = 1.0;
        }
        for (index, &order) in self.oscillating.iter().enumerate() {
            let slot = self.offset() + 2 * index;
            basis[slot] = -(order as f64) * antiderivative[slot + 1];
            basis[slot + 1] = order as f64 * antiderivative[slot];
        }
    }

    /// Calls `visit(k, cos kθ, sin kθ, slot)` for the first `count` orders k ≥ 1, by rotation instead of one
    /// sine and cosine per order.
    #[inline]
    fn rotate(&self, theta: f64, count: usize, mut visit: impl FnMut(f64, f64, f64, usize)) {
        let (sin_1, cos_1) = theta.sin_cos();
        let (step, (sin_step, cos_step)) = if self.half_wave {
            let double = (2.0 * sin_1 * cos_1, (cos_1 - sin_1) * (cos_1 + sin_1));
            (2.0, double)
        } else {
            (1.0, (sin_1, cos_1))
        };
        let (mut order, mut cos, mut sin) = (1.0, cos_1, sin_1);
        let mut slot = self.offset();
        for _ in 0..count {
            visit(order, cos, sin, slot);
            (cos, sin) = (cos * cos_step - sin * sin_step, sin * cos_step + cos * sin_step);
            order += step;
            slot += 2;
        }
    }
}
