//! Displacements at the equidistant instants of a march.

use crate::contact::Motion;
use std::sync::Arc;

/// Instants whose sums go through the processor side by side.
const AT_ONCE: usize = 8;

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
        let points = motion.displacement.len() / slots.max(1);
        let mut displacement = vec![0.0; count * points];
        let whole = basis.len() / (AT_ONCE * slots).max(1) * AT_ONCE;
        let (blocks, rest) = displacement.split_at_mut(whole * points);
        let (rows, last) = basis.split_at(whole * slots);
        for (point, series) in motion.displacement.chunks_exact(slots).enumerate() {
            let blocks = blocks.chunks_exact_mut(AT_ONCE * points);
            for (out, rows) in blocks.zip(rows.chunks_exact(AT_ONCE * slots)) {
                let mut sums = [0.0; AT_ONCE];
                for (slot, c) in series.iter().enumerate() {
                    sums.iter_mut().enumerate().for_each(|(n, u)| *u += c * rows[n * slots + slot]);
                }
                out.iter_mut().skip(point).step_by(points).zip(sums).for_each(|(u, sum)| *u = sum);
            }
            let rest = rest.iter_mut().skip(point).step_by(points);
            for (u, row) in rest.zip(last.chunks_exact(slots)) {
                *u = series.iter().zip(row).map(|(c, b)| c * b).sum();
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
