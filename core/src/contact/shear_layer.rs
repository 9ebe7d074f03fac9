//! The backbone of a bar on a layer of distributed friction (Menq, Bielak and Griffin 1986).

use super::loss::Loss;

/// Last step of an iteration that squares its error, relative to the solution.
const SQUARED: f64 = 1e-8;

/// The shear layer, by the share α of the bar that slips: with `T = tanh Λ(1 − α)` and `T₀ = tanh Λ`,
/// `φ = α + T/Λ` and `x = Λ T₀ (1/Λ² + α²/2 + α T/Λ)`.
pub(super) struct Layer {
    lag: f64,
    stuck: f64,
    /// x where slip begins, and where all of it slips.
    pub(super) begin: f64,
    pub(super) end: f64,
}

impl Layer {
    pub(super) fn new(lag: f64) -> Self {
        let stuck = lag.tanh();
        Self { lag, stuck, begin: stuck / lag, end: stuck * (1.0 / lag + 0.5 * lag) }
    }

    /// Share of the bar that slips.
    fn slipping(&self, x: f64) -> f64 {
        let (lag, wanted) = (self.lag, (x - self.begin) / (self.lag * self.stuck));
        let first = self.stuck / lag;
        // T is below T₀ and below Λ(1 − α): two bounds of the solution from below.
        let low = 2.0 * wanted / (first + (first * first + 2.0 * wanted).sqrt());
        let (mut low, mut high) = (low.max(1.0 - (1.0 - 2.0 * wanted).max(0.0).sqrt()), 1.0);
        let mut alpha = low;
        for _ in 0..60 {
            let t = (lag * (1.0 - alpha)).tanh();
            let excess = 0.5 * alpha * alpha + alpha * t / lag - wanted;
            if excess > 0.0 {
                high = alpha;
            } else {
                low = alpha;
            }
            let newton = alpha - excess / (t / lag + alpha * t * t);
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let moved = (next - alpha).abs();
            alpha = next;
            // Newton's method squares its error.
            if moved <= SQUARED * alpha {
                break;
            }
        }
        alpha
    }

    /// `∫ φ dx` where the share α slips and φ is known.
    fn work(&self, x: f64, alpha: f64, t: f64) -> f64 {
        let lag = self.lag;
        let phi = alpha + t / lag;
        let lost = phi / (2.0 * lag * lag)
            + alpha.powi(3) / 6.0
            + alpha * t * (alpha + t / lag) / (2.0 * lag);
        x * phi - lag * self.stuck * lost
    }

    pub(super) fn loss(&self, x: f64) -> Loss {
        if x <= self.begin {
            return Loss::default();
        }
        let (lag, t_0) = (self.lag, self.stuck);
        let alpha = if x < self.end { self.slipping(x) } else { 1.0 };
        let t = (lag * (1.0 - alpha)).tanh();
        let lost = (lag * alpha).tanh() * (1.0 - t * t_0);
        let inside = x.min(self.end);
        let inner = Loss {
            integral: 0.5 * inside * inside - self.work(inside, alpha, t),
            value: lag * t_0 * (0.5 * alpha * alpha + alpha * t / lag) - alpha + lost / lag,
            slope: (lost / t_0 + alpha * lag * t) / (1.0 + alpha * lag * t),
        };
        if x < self.end {
            inner
        } else {
            inner.straight(1.0, x - self.end)
        }
    }

    /// `∂φ/∂Λ` at a fixed x.
    pub(super) fn by_shear_lag(&self, x: f64) -> f64 {
        if x <= self.begin || x >= self.end {
            return 0.0;
        }
        let (lag, t_0) = (self.lag, self.stuck);
        let alpha = self.slipping(x);
        let t = (lag * (1.0 - alpha)).tanh();
        let t_by = (1.0 - alpha) * (1.0 - t * t);
        let share = 1.0 / lag + 0.5 * lag * alpha * alpha + alpha * t;
        let x_by = (1.0 - t_0 * t_0) * share
            + t_0 * (-1.0 / (lag * lag) + 0.5 * alpha * alpha + alpha * t_by);
        t_by / lag - t / (lag * lag) - (1.0 - self.loss(x).slope) * x_by
    }
}
