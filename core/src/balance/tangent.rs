//! Points of a curve with their tangents, and what these tell of the way between two of them.

use super::settings::Resolution;

/// Part of the way between two points that may be left unexplained.
pub(super) const UNEXPLAINED: f64 = 0.05;
/// The way is divided no nearer to its ends than at this share.
const MARGIN: f64 = 0.03;

/// A point of the curve with its tangent.
#[derive(Clone)]
pub(super) struct Tangent {
    pub(super) resolution: Resolution,
    /// Displacements of the contacts and, behind them, the frequency.
    pub(super) z: Vec<f64>,
    /// Derivative of the displacements in the frequency.
    pub(super) rate: Vec<f64>,
}

impl Tangent {
    pub(super) fn is(&self, resolution: Resolution, omega: f64) -> bool {
        self.resolution == resolution && self.omega().total_cmp(&omega).is_eq()
    }

    pub(super) fn omega(&self) -> f64 {
        self.z[self.z.len() - 1]
    }

    /// The point that the tangent leads to.
    pub(super) fn ahead(&self, step: f64) -> impl Iterator<Item = f64> + '_ {
        self.z.iter().zip(&self.rate).map(move |(u, rate)| u + step * rate)
    }

    /// Whether the mean of the tangents at both points leads from one to the other.
    pub(super) fn explains(&self, to: &Self) -> bool {
        let step = 0.5 * (to.omega() - self.omega());
        let mean = self.ahead(step).zip(&to.rate).map(|(u, rate)| u + step * rate);
        let mean: Vec<f64> = mean.chain([to.omega()]).collect();
        distance(&mean, &to.z) < UNEXPLAINED * distance(&self.z, &to.z)
    }

    /// Share of the way to another point at which the two tangents come closest.
    pub(super) fn meets(&self, to: &Self) -> f64 {
        let step = to.omega() - self.omega();
        let (mut along, mut square) = (0.0, 0.0);
        for ((before, after), (u, v)) in
            self.rate.iter().zip(&to.rate).zip(self.z.iter().zip(&to.z))
        {
            let turn = step * (before - after);
            along += turn * (v - u - step * after);
            square += turn * turn;
        }
        let share = along / square;
        if share.is_finite() {
            share.clamp(MARGIN, 1.0 - MARGIN)
        } else {
            0.5
        }
    }
}

/// Distance of two points: motion against its size, frequency against itself.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    let (Some((w, u)), Some((x, v))) = (a.split_last(), b.split_last()) else { return f64::NAN };
    let way: f64 = u.iter().zip(v).map(|(u, v)| (u - v).powi(2)).sum();
    let size: f64 = u.iter().map(|u| u * u).sum();
    (way / size.max(f64::MIN_POSITIVE) + (x / w - 1.0).powi(2)).sqrt()
}
