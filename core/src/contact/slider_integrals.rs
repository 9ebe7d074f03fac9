//! Exact Fourier integrals of the slip load of elements that slip, and their derivative.
//!
//! Turning points are common to all elements on a displacement: what is anchored there is summed
//! before the tangent takes one term of rank one for each of them.

use super::stick_slip::{Path, StickSlipIntervals};
use super::{Motion, Slider, SlipLoad};
use crate::fourier::{Harmonics, IntervalSums};

/// Adds the exact integrals of the elements that slip: `k_d u ∓ F_d` while an element slips, the
/// slip load of its last turning point while it sticks.
pub(super) fn add_slipping(
    sliders: &[Slider],
    motion: Motion<'_>,
    path: &Path<'_>,
    cycles: &[StickSlipIntervals],
    tangent: bool,
    out: &mut SlipLoad,
) {
    let harmonics = motion.table.harmonics();
    let size = harmonics.slots();
    let weight = 2.0 / harmonics.span();
    let mut turns = Turns::new(harmonics, path, tangent);
    let mut sums = IntervalSums::new(harmonics);
    let mut at_end = vec![0.0; size];
    for (slider, cycle) in sliders.iter().zip(cycles) {
        let StickSlipIntervals::Slipping { sticks, slips } = cycle else { continue };
        let k = slider.stiffness;
        for (index, stick) in sticks.iter().enumerate() {
            // The last interval ends at the last turning point, without slip behind it.
            let slip = slips.get(index);
            let end = if slip.is_some() {
                harmonics.antiderivative(stick.end, &mut at_end);
                &at_end[..]
            } else {
                turns.last()
            };
            add_difference(
                end,
                turns.antiderivative(stick.anchor),
                weight * stick.slip_load,
                &mut out.value,
            );
            if tangent {
                turns.anchor(stick.anchor, slip.map(|_| &at_end[..]), k * weight);
            }
            let Some(slip) = slip else { continue };
            let constant = -weight * slip.sign * slider.slip_force;
            add_difference(turns.antiderivative(slip.turn), &at_end, constant, &mut out.value);
            sums.add_length(k * (slip.end - slip.start));
            sums.add_end(slip.start, -k);
            turns.slipping[slip.turn] += k;
        }
    }
    for (turn, k) in path.turns.iter().zip(&turns.slipping).filter(|(_, k)| **k > 0.0) {
        sums.add_end(turn.theta, *k);
    }
    let SlipLoad { value, tangent: matrix, .. } = out;
    sums.rows(harmonics, weight, |i, row| {
        value[i] += dot(row, motion.displacement);
        if tangent {
            matrix[i * size..(i + 1) * size].copy_from_slice(row);
        }
    });
    if tangent {
        turns.add_anchors(harmonics, matrix);
    }
    out.halve_means(harmonics);
}

/// Basis integrals over intervals, from the antiderivatives at their two ends.
pub(super) struct Bounds {
    /// Antiderivatives at the start and at the end.
    ends: [Vec<f64>; 2],
    /// The end, with which the next interval begins as a rule.
    at: f64,
}

impl Bounds {
    pub(super) fn new(harmonics: &Harmonics) -> Self {
        let zero = vec![0.0; harmonics.slots()];
        Self { ends: [zero.clone(), zero], at: f64::NAN }
    }

    /// Adds `factor ∫ basis dθ` to `out`.
    pub(super) fn add_integral(
        &mut self,
        harmonics: &Harmonics,
        start: f64,
        end: f64,
        factor: f64,
        out: &mut [f64],
    ) {
        self.ends.swap(0, 1);
        if start != self.at {
            harmonics.antiderivative(start, &mut self.ends[0]);
        }
        harmonics.antiderivative(end, &mut self.ends[1]);
        self.at = end;
        add_difference(&self.ends[1], &self.ends[0], factor, out);
    }
}

/// What the turning points of a path gather from all elements.
struct Turns {
    size: usize,
    /// Antiderivatives of the basis at the turning points.
    antiderivatives: Vec<f64>,
    /// Integrals over the stick intervals that begin at a turning point, by stiffness.
    anchored: Vec<f64>,
    /// Stiffness of the elements that slip up to the turning point.
    slipping: Vec<f64>,
}

impl Turns {
    fn new(harmonics: &Harmonics, path: &Path<'_>, tangent: bool) -> Self {
        let (size, count) = (harmonics.slots(), path.turns.len());
        let mut antiderivatives = vec![0.0; count * size];
        for (turn, out) in path.turns.iter().zip(antiderivatives.chunks_exact_mut(size)) {
            harmonics.antiderivative(turn.theta, out);
        }
        let anchored = vec![0.0; if tangent { count * size } else { 0 }];
        Self { size, antiderivatives, anchored, slipping: vec![0.0; count] }
    }

    fn antiderivative(&self, turn: usize) -> &[f64] {
        &self.antiderivatives[turn * self.size..(turn + 1) * self.size]
    }

    fn last(&self) -> &[f64] {
        self.antiderivative(self.slipping.len() - 1)
    }

    /// Notes a stick interval from a turning point to where the antiderivatives are `end`, or to the
    /// last turning point: its slip load follows the displacement there. Leaving this history out
    /// breaks Newton's method.
    fn anchor(&mut self, turn: usize, end: Option<&[f64]>, factor: f64) {
        let (size, last) = (self.size, self.slipping.len() - 1);
        let end = end.unwrap_or(&self.antiderivatives[last * size..]);
        let start = &self.antiderivatives[turn * size..(turn + 1) * size];
        add_difference(end, start, factor, &mut self.anchored[turn * size..(turn + 1) * size]);
    }

    /// Adds the change of rank one of every turning point at which an interval begins.
    fn add_anchors(&self, harmonics: &Harmonics, tangent: &mut [f64]) {
        let mut basis = vec![0.0; self.size];
        let turns = self.anchored.chunks_exact(self.size);
        for (turn, integral) in turns.enumerate() {
            if integral.iter().all(|entry| *entry == 0.0) {
                continue;
            }
            harmonics.differentiate(self.antiderivative(turn), &mut basis);
            for (row, i) in tangent.chunks_exact_mut(self.size).zip(integral) {
                for (entry, j) in row.iter_mut().zip(&basis) {
                    *entry += i * j;
                }
            }
        }
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `out += factor (end − start)`.
fn add_difference(end: &[f64], start: &[f64], factor: f64, out: &mut [f64]) {
    for ((out, end), start) in out.iter_mut().zip(end).zip(start) {
        *out += factor * (end - start);
    }
}
