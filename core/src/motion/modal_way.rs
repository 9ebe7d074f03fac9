//! What the modes do over a stretch of a motion: enough to tell where most displacements have no extreme.

use super::power_series::PowerSeries;
use crate::solve::dot_with_size as sums;

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
    /// Widens the ranges of all shapes that have no extreme inside the stretch, or stay within their range;
    /// `open` are the others.
    pub(super) fn widen(
        &self,
        shapes: &[Vec<f64>],
        ranges: &mut [[f64; 2]],
        open: &mut Vec<usize>,
    ) {
        open.clear();
        pulp::Arch::new().dispatch(Widen { way: self, shapes, ranges, open });
    }
}

/// A closure would be no part of what vector instructions are chosen for.
struct Widen<'a> {
    way: &'a ModalWay,
    shapes: &'a [Vec<f64>],
    ranges: &'a mut [[f64; 2]],
    open: &'a mut Vec<usize>,
}

impl pulp::NullaryFnOnce for Widen<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let ModalWay { start, end, velocity, reach, bend } = self.way;
        for (number, (shape, range)) in self.shapes.iter().zip(self.ranges).enumerate() {
            let [from, reach] = sums(shape, [start, reach]);
            if from + reach <= range[1] && from - reach >= range[0] {
                continue;
            }
            let [velocity, bend] = sums(shape, [velocity, bend]);
            if velocity.abs() <= bend {
                self.open.push(number);
                continue;
            }
            let [to, _] = sums(shape, [end, end]);
            for value in [from, to] {
                range[0] = range[0].min(value);
                range[1] = range[1].max(value);
            }
        }
    }
}
