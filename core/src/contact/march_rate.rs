//! What a march through a friction law carries from instant to instant: its derivative, and the
//! friction work.

use super::{Elastic, FrictionLaw};
use faer::Mat;

/// Derivative of the slip loads at one instant in all coefficients, point after point.
#[derive(Clone)]
pub(super) struct Rate {
    slots: usize,
    stiffness: Mat<f64>,
    value: Vec<f64>,
}

impl Rate {
    /// No derivative yet, in `slots` coefficients per point.
    pub(super) fn new(stiffness: Mat<f64>, slots: usize) -> Self {
        let points = stiffness.nrows();
        Self { slots, stiffness, value: vec![0.0; points * points * slots] }
    }

    /// Multiplies the derivative by a sign.
    pub(super) fn scale(&mut self, sign: f64) {
        self.value.iter_mut().for_each(|rate| *rate *= sign);
    }

    /// The mean of this derivative and another.
    pub(super) fn average(&mut self, other: &Self) {
        self.value.iter_mut().zip(&other.value).for_each(|(a, b)| *a = 0.5 * (*a + b));
    }

    /// Takes the derivative through one return map.
    pub(super) fn follow(&mut self, gain: &[f64], basis: &[f64]) {
        let points = self.stiffness.nrows();
        if is_identity(gain, points) {
            return;
        }
        let size = points * self.slots;
        let mut next = vec![0.0; self.value.len()];
        for (i, row) in next.chunks_exact_mut(size).enumerate() {
            for j in 0..points {
                let through = gain[i * points + j];
                let slips = f64::from(u8::from(i == j)) - through;
                let old = &self.value[j * size..(j + 1) * size];
                row.iter_mut().zip(old).for_each(|(row, old)| *row += through * old);
                for (l, block) in row.chunks_exact_mut(self.slots).enumerate() {
                    let taken = slips * self.stiffness[(j, l)];
                    block.iter_mut().zip(basis).for_each(|(block, b)| *block += taken * b);
                }
            }
        }
        self.value = next;
    }

    /// Adds the outer product with the summed basis to a tangent, and clears the sum.
    pub(super) fn add_to(&self, sum: &mut [f64], out: &mut [f64]) {
        let size = self.stiffness.nrows() * self.slots;
        for (rows, rate) in
            out.chunks_exact_mut(self.slots * size).zip(self.value.chunks_exact(size))
        {
            for (row, s) in rows.chunks_exact_mut(size).zip(&*sum) {
                row.iter_mut().zip(rate).for_each(|(row, rate)| *row += s * rate);
            }
        }
        sum.fill(0.0);
    }
}

/// Whether point i of a return map sticks: its own displacement moves its force in full. Others may
/// take part of it by their slip.
pub(super) fn sticks(gain: &[f64], points: usize, i: usize) -> bool {
    gain[i * points + i] == 1.0
}

/// Whether all points stick.
pub(super) fn is_identity(gain: &[f64], points: usize) -> bool {
    (0..points).all(|i| sticks(gain, points, i))
}

/// Adds the friction work of a step. Over a period that of a single point is the work of its
/// force; coupled points exchange elastic energy, so that their slip has to be known.
pub(super) fn add_work(
    law: &dyn FrictionLaw,
    before: &[f64],
    force: &[f64],
    du: &[f64],
    gain: &[f64],
    work: &mut [f64],
) {
    let points = force.len();
    if points == 1 {
        work[0] += 0.5 * (before[0] + force[0]) * du[0];
        return;
    }
    let slips: Vec<bool> = (0..points).map(|i| !sticks(gain, points, i)).collect();
    if !slips.contains(&true) {
        return;
    }
    let stiffness = law.stiffness();
    let lost: Vec<f64> = (0..points)
        .map(|i| {
            let elastic: f64 = (0..points).map(|j| stiffness[(i, j)] * du[j]).sum();
            before[i] + elastic - force[i]
        })
        .collect();
    if let Ok(elastic) = Elastic::new(stiffness.as_ref()) {
        let slip = elastic.slip(&slips, &lost);
        for (i, s) in slip.into_iter().enumerate() {
            work[i] += 0.5 * (before[i] + force[i]) * s;
        }
    }
}
