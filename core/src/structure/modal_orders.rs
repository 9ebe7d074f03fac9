//! The dynamic stiffness of many modes at several harmonics.

use faer::linalg::solvers::Solve as _;
use faer::sparse::linalg::solvers::Lu;
use faer::{c64, Mat};

/// The dynamic stiffness at the harmonics of a frequency.
#[derive(Debug, Clone, Default)]
pub struct ModalOrders {
    pub(super) orders: Vec<Order>,
}

/// The dynamic stiffness at one harmonic.
#[derive(Debug, Clone)]
pub(super) struct Order {
    pub(super) harmonic: usize,
    pub(super) slot: usize,
    /// `kω`.
    pub(super) rate: f64,
    pub(super) inverse: Inverse,
}

/// `Z⁻¹`, or that of its diagonal.
#[derive(Debug, Clone)]
pub(super) enum Inverse {
    /// Of every mode.
    Diagonal(Vec<c64>),
    /// As a factorisation.
    Factors(Box<Lu<usize, c64>>),
}

impl Inverse {
    /// What forces displace; on modes from the first one on, of a diagonal.
    fn times(&self, forces: &mut Mat<c64>, first: usize) {
        match self {
            Self::Diagonal(inverse) => {
                let own = forces.col_as_slice_mut(0).iter_mut().zip(&inverse[first..]);
                own.for_each(|(f, z)| *f *= *z);
            }
            Self::Factors(factors) => factors.solve_in_place(forces.as_mut()),
        }
    }
}

impl ModalOrders {
    /// Divides by Z, or by its diagonal.
    pub(super) fn divide(&self, forces: &mut Mat<f64>) {
        self.divide_part(forces, 0);
    }

    /// The same of some modes, from the first of them on, where Z is diagonal.
    pub(super) fn divide_part(&self, forces: &mut Mat<f64>, first: usize) {
        let mut own: Mat<c64> = Mat::zeros(forces.ncols(), 1);
        for Order { slot, rate, inverse, .. } in &self.orders {
            let mean = *rate == 0.0;
            for (j, own) in own.col_as_slice_mut(0).iter_mut().enumerate() {
                let sine = if mean { 0.0 } else { forces[(slot + 1, j)] };
                *own = c64::new(forces[(*slot, j)], -sine);
            }
            inverse.times(&mut own, first);
            for (j, own) in own.col_as_slice(0).iter().enumerate() {
                forces[(*slot, j)] = own.re;
                if !mean {
                    forces[(slot + 1, j)] = -own.im;
                }
            }
        }
    }

    /// Adds loads `Re P exp(ikωt)` on the coordinates.
    pub(super) fn add<'a>(&self, load: impl Fn(usize) -> Option<&'a [c64]>, forces: &mut Mat<f64>) {
        for Order { harmonic, slot, .. } in &self.orders {
            for (j, p) in load(*harmonic).into_iter().flatten().enumerate() {
                forces[(*slot, j)] += p.re;
                if *harmonic > 0 {
                    forces[(slot + 1, j)] -= p.im;
                }
            }
        }
    }
}
