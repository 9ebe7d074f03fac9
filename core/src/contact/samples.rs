//! Displacements at the equidistant instants of a march.

use super::Motion;
use std::sync::Arc;

/// Displacements at the instants of one span, with the basis there.
pub struct Samples {
    /// Instants in the span.
    pub count: usize,
    /// −1 if the second half of the period mirrors the first.
    pub sign: f64,
    pub basis: Arc<[f64]>,
    /// Instant after instant.
    pub displacement: Vec<f64>,
}

impl Samples {
    /// Samples of a motion: `samples` per period, half of them for a half-wave symmetric one.
    pub fn of(motion: Motion<'_>, samples: usize) -> Self {
        let harmonics = motion.table.harmonics();
        let slots = harmonics.slots();
        let half = harmonics.half_wave();
        let count = if half { samples / 2 } else { samples };
        let basis = motion.table.basis(samples, count);
        let mut displacement = Vec::with_capacity(count * motion.displacement.len() / slots);
        for row in basis.chunks_exact(slots) {
            for series in motion.displacement.chunks_exact(slots) {
                displacement.push(series.iter().zip(row).map(|(c, b)| c * b).sum());
            }
        }
        Self { count, sign: if half { -1.0 } else { 1.0 }, basis, displacement }
    }

    /// Displacements at instant n.
    pub fn at(&self, n: usize) -> &[f64] {
        let points = self.displacement.len() / self.count;
        &self.displacement[n * points..(n + 1) * points]
    }
}
