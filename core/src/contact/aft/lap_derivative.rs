//! How the state at the end of a part of a round follows what it begins with.

/// Derivative of a part of a round: numbers of state by those that it begins with, row by row.
pub(super) struct LapDerivative {
    size: usize,
    pub(super) by: Vec<f64>,
    room: Vec<f64>,
}

impl LapDerivative {
    pub(super) fn new(size: usize) -> Self {
        let by: Vec<f64> = (0..size * size).map(|at| own(at, size)).collect();
        Self { size, room: by.clone(), by }
    }

    /// Goes on by a step with a derivative.
    pub(super) fn advance(&mut self, step: &[f64]) {
        let size = self.size;
        if is_identity(step, size) {
            return;
        }
        self.room.fill(0.0);
        for (row, shares) in self.room.chunks_exact_mut(size).zip(step.chunks_exact(size)) {
            // Laws that remember much change little of it in a step.
            for (k, share) in shares.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                let old = &self.by[k * size..(k + 1) * size];
                row.iter_mut().zip(old).for_each(|(entry, old)| *entry += share * old);
            }
        }
        std::mem::swap(&mut self.by, &mut self.room);
    }
}

fn own(at: usize, size: usize) -> f64 {
    f64::from(u8::from(at / size == at % size))
}

pub(super) fn is_identity(matrix: &[f64], size: usize) -> bool {
    matrix.iter().enumerate().all(|(at, entry)| *entry == own(at, size))
}
