//! What the modes do over a stretch of a motion: enough to tell where most displacements have no extreme.

use super::modal_system::dot;
use super::power_series::PowerSeries;

/// Displacements at both ends of a stretch, velocities at its start, and the most that both change by, mode
/// by mode; velocities per length of the stretch.
#[derive(Debug, Default)]
pub(super) struct ModalWay {
    start: Vec<f64>,
    end: Vec<f64>,
    velocity: Vec<f64>,
    reach: Vec<f64>,
    bend: Vec<f64>,
}

impl PowerSeries {
    /// Writes what the modes do over a length of τ.
    pub(super) fn write_way(&self, length: f64, way: &mut ModalWay) {
        let mut powers = self.modal.chunks_exact(self.modes);
        for values in [&mut way.start, &mut way.end] {
            values.clear();
        }
        let first = powers.next().unwrap_or(&[]);
        way.start.extend_from_slice(first);
        way.end.extend_from_slice(first);
        for values in [&mut way.velocity, &mut way.reach, &mut way.bend] {
            values.clear();
            values.resize(self.modes, 0.0);
        }
        let mut scale = 1.0;
        for (number, power) in powers.enumerate() {
            scale *= length;
            let order = (number + 1) as f64;
            let ends = way.end.iter_mut().zip(&mut way.reach).zip(&mut way.bend);
            for (((end, reach), bend), c) in ends.zip(power) {
                let moved = scale * c;
                *end += moved;
                *reach += moved.abs();
                *bend += order * moved.abs();
            }
            if number == 0 {
                way.velocity.iter_mut().zip(power).for_each(|(v, c)| *v = scale * c);
                way.bend.fill(0.0);
            }
        }
    }
}

impl ModalWay {
    /// Widens a range by the displacement of a shape, if it has no extreme inside the stretch or stays within
    /// the range.
    pub(super) fn widen(&self, shape: &[f64], range: &mut [f64; 2]) -> bool {
        let start = dot(shape, &self.start);
        let reach = sum_of_sizes(shape, &self.reach);
        if start + reach <= range[1] && start - reach >= range[0] {
            return true;
        }
        if dot(shape, &self.velocity).abs() <= sum_of_sizes(shape, &self.bend) {
            return false;
        }
        for value in [start, dot(shape, &self.end)] {
            range[0] = range[0].min(value);
            range[1] = range[1].max(value);
        }
        true
    }
}

/// `Σ |a| b`.
fn sum_of_sizes(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.abs() * b).sum()
}
