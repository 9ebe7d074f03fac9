//! Multiple shooting: half a period, or without half-wave symmetry a whole one, in segments, each from a
//! state of its own.
//!
//! Over one stretch a small change may grow beyond what the digits of its start can steer. Over
//! segments it does not: their start states are unknowns, which the flow has to join (Ascher,
//! Mattheij and Russell 1995, section 4.3). The multipliers are powers of the eigenvalues of the
//! cyclic matrix of all segments, which keeps the small ones that their product loses (Kressner
//! 2006, section 2).

use super::loop_memory::LoopMemory;
use super::shooting::Shooting;
use crate::contact::PointState;
use crate::model::Model;
use crate::motion::{ContactState, LinearPhase, ModalSystem};
use crate::solve::System;
use faer::{c64, Mat};

/// Growth of a small change over a segment, as the Frobenius norm of its transition matrix, beyond
/// which there have to be more: half of the digits remain, and those of the differences in the
/// scalar.
const GROWTH: f64 = 1e4;
/// Share of that below which two segments become one.
const MILD: f64 = 0.03;
/// Most segments of half a period.
const MOST: usize = 64;

/// What is known of the flow over a segment.
pub(super) struct Segment {
    /// Coordinates at its end, of the last segment mirrored.
    pub(super) image: Vec<f64>,
    /// Rate of the coordinates at its end, not mirrored.
    pub(super) rate: Vec<f64>,
    /// Derivative of the image in the start; empty until it is asked for.
    pub(super) derivative: Mat<f64>,
    /// Points that have slipped.
    pub(super) slipped: Vec<bool>,
    course: Course,
}

/// What the flow has passed on its way, of which the derivative is made.
#[derive(Default)]
struct Course {
    phases: Vec<LinearPhase>,
    /// What held the forces at the start, and these.
    held: Vec<PointState>,
    begun: Vec<f64>,
}

/// Follows the motion over all segments from their start states, one after the
/// other in `starts`.
pub(super) fn follow(
    member: &Member<'_>,
    shooting: &mut Shooting<'_>,
    starts: &[f64],
) -> Option<Vec<Segment>> {
    let size = shooting.size();
    let count = starts.len() / size;
    let mut segments = Vec::with_capacity(count);
    for (number, start) in starts.chunks_exact(size).enumerate() {
        shooting.narrow(number, count);
        let image = shooting.image(start)?;
        let state = shooting.end.as_ref()?;
        let regime = ContactState::new(&member.system, &state.points);
        let mut rate = shooting.coordinates.rate(state, &regime);
        // Reversals stay as they are.
        rate.resize(size, 0.0);
        let slipped = shooting.slipped().to_vec();
        let course = shooting.course();
        segments.push(Segment { image, rate, derivative: Mat::new(), slipped, course });
    }
    shooting.join(starts, &mut segments)?;
    Some(segments)
}

impl Shooting<'_> {
    fn course(&mut self) -> Course {
        Course {
            phases: std::mem::take(&mut self.phases),
            held: std::mem::take(&mut self.held),
            begun: std::mem::take(&mut self.begun),
        }
    }

    /// Completes what contacts without sliders remember behind segments that have all been followed, in
    /// the image of each.
    fn join(&mut self, starts: &[f64], segments: &mut [Segment]) -> Option<()> {
        let (size, count) = (self.coordinates.size(), segments.len());
        if !self.joins(count) {
            return Some(());
        }
        self.memory.join()?;
        let all = System::size(self);
        for (number, (one, start)) in segments.iter_mut().zip(starts.chunks_exact(all)).enumerate()
        {
            let side = self.side(number, count);
            let numbers = self.memory.behind(number, start);
            one.image[size..].iter_mut().zip(numbers).for_each(|(to, own)| *to = side * own);
        }
        Some(())
    }

    /// Whether what is remembered behind one of so many segments is that of others, too.
    fn joins(&self, count: usize) -> bool {
        count > 1 && LoopMemory::places(self.coordinates.system()) > 0
    }

    /// Sign of the image of a segment.
    fn side(&self, number: usize, count: usize) -> f64 {
        if self.symmetric && number + 1 == count {
            -1.0
        } else {
            1.0
        }
    }

    /// Writes the derivatives of segments that have all been followed; the memory is the one that they left.
    pub(super) fn derive(&mut self, segments: &mut [Segment]) {
        let (size, count) = (self.coordinates.size(), segments.len());
        for (number, one) in segments.iter_mut().enumerate() {
            self.narrow(number, count);
            let Course { phases, held, begun } = std::mem::take(&mut one.course);
            (self.phases, self.held, self.begun) = (phases, held, begun);
            self.derivative = None;
            one.derivative = self.derivative();
            if self.joins(count) {
                self.memory.derive(number, &mut one.derivative);
                let mut rows = one.derivative.get_mut(size.., ..);
                rows *= faer::Scale(self.side(number, count));
            }
        }
    }
}

/// Start states of twice as many segments.
pub(super) fn halved(shooting: &mut Shooting<'_>, starts: &[f64]) -> Option<Vec<f64>> {
    let size = shooting.size();
    let count = 2 * (starts.len() / size);
    let mut all = Vec::with_capacity(2 * starts.len());
    for (number, start) in starts.chunks_exact(size).enumerate() {
        shooting.narrow(2 * number, count);
        all.extend_from_slice(start);
        all.extend(shooting.image(start)?);
    }
    settle_memory(shooting, &mut all)?;
    Some(all)
}

/// Has starts remember what stands behind the segment before. What the flow itself remembers there may be
/// the same motion in other numbers: it closes a loop at its own end, or just not.
pub(super) fn settle_memory(shooting: &mut Shooting<'_>, starts: &mut [f64]) -> Option<()> {
    let (size, all) = (shooting.coordinates.size(), shooting.size());
    if all == size {
        return Some(());
    }
    let count = starts.len() / all;
    for (number, start) in starts.chunks_exact(all).enumerate() {
        shooting.narrow(number, count);
        shooting.image(start)?;
    }
    shooting.memory.join()?;
    for number in 0..count {
        let side = shooting.side(number, count);
        let next = (number + 1) % count * all;
        let numbers = shooting.memory.settled(number);
        let own = starts[next + size..next + all].iter_mut();
        own.zip(numbers).for_each(|(to, own)| *to = side * own);
    }
    Some(())
}

/// How many segments suit a motion.
pub(super) enum Segmentation {
    /// As many.
    Keep,
    /// Twice as many.
    Double,
    /// Half as many.
    Halve,
}

/// Judges segments by how much changes grow over each, or over two of them.
pub(super) fn segmentation(segments: &[Segment]) -> Segmentation {
    let count = segments.len();
    if count < MOST && segments.iter().any(|one| one.derivative.norm_l2() > GROWTH) {
        return Segmentation::Double;
    }
    let mild = |pair: &[Segment]| match pair {
        [one, next] => (&next.derivative * &one.derivative).norm_l2() < MILD * GROWTH,
        _ => false,
    };
    if count > 1 && segments.chunks(2).all(mild) {
        return Segmentation::Halve;
    }
    Segmentation::Keep
}

/// Eigenvalues of the product `A_m … A_2 A_1` of square matrices, from those of their cyclic
/// matrix, the m-th power of which holds the product m times.
pub(super) fn product_eigenvalues(factors: Vec<Mat<f64>>) -> Option<Vec<c64>> {
    // Factors of mild growth lose nothing in their product. At a turn of the branch a second
    // eigenvalue comes to 1, and rounding splits the two by its root: more would be too much.
    let mut blocks: Vec<Mat<f64>> = Vec::new();
    for factor in factors {
        if let Some(last) = blocks.last_mut() {
            let product = &factor * &*last;
            if product.norm_l2() <= GROWTH {
                *last = product;
                continue;
            }
        }
        blocks.push(factor);
    }
    let count = blocks.len();
    let size = blocks.first()?.nrows();
    if count == 1 {
        return blocks.first()?.eigenvalues().ok();
    }
    let mut cyclic = Mat::<f64>::zeros(count * size, count * size);
    for (number, block) in blocks.iter().enumerate() {
        let next = (number + 1) % count;
        cyclic.submatrix_mut(next * size, number * size, size, size).copy_from(block);
    }
    let roots = cyclic.eigenvalues().ok()?;
    let mut powers: Vec<c64> = roots.iter().map(|root| root.powu(count as u32)).collect();
    // Each is there as often as there are blocks: the largest and those closest to it are one.
    let mut found = Vec::with_capacity(size);
    while powers.len() >= count {
        let largest = powers.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm()))?;
        let off = |power: &c64| (power - largest).norm();
        powers.sort_by(|a, b| off(a).total_cmp(&off(b)));
        let same: c64 = powers.drain(..count).sum();
        found.push(same / count as f64);
    }
    Some(found)
}

/// A member of the family.
pub(super) struct Member<'a> {
    pub(super) own: Option<Model>,
    pub(super) given: &'a Model,
    pub(super) system: ModalSystem,
}

impl Member<'_> {
    pub(super) fn model(&self) -> &Model {
        self.own.as_ref().unwrap_or(self.given)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twenty factors with the eigenvalues 1e3 and 0.1 in turned coordinates: the product has 1e60
    /// and 1e-20, and to its own digits the smaller one is lost.
    #[test]
    fn small_eigenvalues_of_a_product_of_strong_growth_are_kept() {
        let turn = |angle: f64| {
            let (s, c) = angle.sin_cos();
            Mat::from_fn(2, 2, |i, j| match (i, j) {
                (0, 1) => -s,
                (1, 0) => s,
                _ => c,
            })
        };
        let stretch = Mat::from_fn(2, 2, |i, j| if i == j { [1e3, 0.1][i] } else { 0.0 });
        // Q_{k+1} S Q_k^T: the turns cancel in the product, but for the rounding.
        let factors: Vec<Mat<f64>> = (0..20)
            .map(|k| {
                let next = turn(((k + 1) % 20) as f64);
                &next * &stretch * turn(f64::from(k)).transpose()
            })
            .collect();
        let mut whole = Mat::<f64>::identity(2, 2);
        for factor in &factors {
            whole = factor * whole;
        }
        let naive = whole.eigenvalues().unwrap();
        assert!((naive[1].re / 1e-20 - 1.0).abs() > 0.1, "{naive:?}");
        let values = product_eigenvalues(factors).unwrap();
        assert_eq!(values.len(), 2);
        assert!((values[0].re / 1e60 - 1.0).abs() < 1e-10);
        assert!((values[1].re / 1e-20 - 1.0).abs() < 1e-9, "{values:?}");
    }
}
