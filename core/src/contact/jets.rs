//! Displacements of the points of a contact with their slopes and curvatures.

use super::Motion;
use crate::fourier::Harmonics;

/// Displacements of all points, their slopes and curvatures at an angle.
#[derive(Debug, Clone)]
pub(super) struct Jet {
    pub(super) theta: f64,
    /// One after the other.
    orders: Vec<f64>,
}

impl Jet {
    /// The jet of the series of all points at an angle.
    pub(super) fn at(harmonics: &Harmonics, series: &[f64], theta: f64) -> Self {
        let points = series.len() / harmonics.slots();
        let mut orders = vec![0.0; 3 * points];
        for (i, series) in series.chunks_exact(harmonics.slots()).enumerate() {
            for (of, value) in harmonics.jet(series, theta).into_iter().enumerate() {
                orders[of * points + i] = value;
            }
        }
        Self { theta, orders }
    }

    /// The jets at the ends of the cells of a grid over the span of a motion.
    pub(super) fn grid(motion: Motion<'_>) -> Vec<Self> {
        let harmonics = motion.table.harmonics();
        let points = motion.displacement.len() / harmonics.slots();
        let cells = motion.table.coarse_samples();
        let spacing = harmonics.span() / cells as f64;
        let blank = |cell: usize| Self {
            theta: (cell + 1) as f64 * spacing,
            orders: vec![0.0; 3 * points],
        };
        let mut grid: Vec<Self> = (0..cells).map(blank).collect();
        // The last end mirrors or repeats the first angle.
        let sign = if harmonics.half_wave() { -1.0 } else { 1.0 };
        for (i, series) in motion.displacement.chunks_exact(harmonics.slots()).enumerate() {
            for (of, values) in motion.table.jets(series).iter().enumerate() {
                let Some((first, later)) = values.split_first() else { continue };
                let ends = later.iter().copied().chain([sign * first]);
                grid.iter_mut().zip(ends).for_each(|(jet, u)| jet.orders[of * points + i] = u);
            }
        }
        grid
    }

    pub(super) fn value(&self) -> &[f64] {
        self.order(0)
    }

    pub(super) fn slope(&self) -> &[f64] {
        self.order(1)
    }

    pub(super) fn curvature(&self) -> &[f64] {
        self.order(2)
    }

    fn order(&self, of: usize) -> &[f64] {
        let points = self.orders.len() / 3;
        &self.orders[of * points..(of + 1) * points]
    }
}
