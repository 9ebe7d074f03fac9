//! Coordinates in which a structure with many contacts answers forces, without a receptance.

use super::contact_shapes::ContactShapes;
use super::quasi_static::QuasiStatic;
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::sparse::linalg::solvers::Lu;
use faer::{c64, Mat, MatRef};

/// The stuck structure in coordinates, modes or its own DOFs. Series of several harmonics are matrices,
/// slots × contacts or slots × coordinates, with the cosines and sines of a harmonic in neighbouring
/// rows.
pub trait ContactCoordinates: Send + Sync {
    /// Number of coordinates.
    fn size(&self) -> usize;

    /// Number of contacts.
    fn contacts(&self) -> usize;

    /// Floating-point operations from loads on so many contacts to their displacements.
    fn work(&self, contacts: f64, slots: f64) -> f64;

    /// About the time that the dynamic stiffness of a harmonic takes on a common processor \[ns\].
    fn effort(&self) -> f64;

    /// Forces on the coordinates from loads on all contacts.
    fn excite(&self, load: MatRef<'_, f64>) -> Mat<f64>;

    /// Displacements of all contacts.
    fn displace(&self, coordinates: MatRef<'_, f64>) -> Mat<f64>;

    /// The shapes of some contacts.
    fn part(&self, contacts: &[usize]) -> ContactShapes;

    /// Answers of the slowest coordinates and of the flexibility of all others; nothing where the others do
    /// not follow their loads at once. They differ from those of the whole by some thousandths of that
    /// flexibility.
    fn quasi_static(&self, _at: &ModalOrders) -> Option<&QuasiStatic> {
        None
    }

    /// Adds the external load to forces.
    fn add_load(&self, at: &ModalOrders, forces: &mut Mat<f64>);

    /// The dynamic stiffness at a frequency [rad/s], of harmonics with their slots.
    ///
    /// # Errors
    /// The harmonic at which the structure is singular, and why.
    fn orders(
        &self,
        harmonics: &[(usize, usize)],
        omega: f64,
    ) -> Result<ModalOrders, (usize, Error)>;

    /// Turns forces into coordinates, `Z⁻¹ f`, to a relative tolerance where damping couples modes.
    fn answer(&self, at: &ModalOrders, forces: &mut Mat<f64>, tolerance: f64);

    /// Rate of change with ω of coordinates under fixed forces: `−Z⁻¹ dZ/dω y`.
    fn answer_rate(&self, at: &ModalOrders, coordinates: &mut Mat<f64>, tolerance: f64);

    /// Amplitudes of DOFs from the coordinates of a harmonic at a slot.
    fn observe(
        &self,
        harmonic: usize,
        slot: usize,
        coordinates: &Mat<f64>,
        observe: &[usize],
        out: &mut [c64],
    );
}

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
    /// What forces displace.
    fn times(&self, forces: &mut Mat<c64>) {
        match self {
            Self::Diagonal(inverse) => {
                forces.col_as_slice_mut(0).iter_mut().zip(inverse).for_each(|(f, z)| *f *= *z);
            }
            Self::Factors(factors) => factors.solve_in_place(forces.as_mut()),
        }
    }
}

impl ModalOrders {
    /// Divides by Z, or by its diagonal.
    pub(super) fn divide(&self, forces: &mut Mat<f64>) {
        let mut own: Mat<c64> = Mat::zeros(forces.ncols(), 1);
        for Order { slot, rate, inverse, .. } in &self.orders {
            let mean = *rate == 0.0;
            for (j, own) in own.col_as_slice_mut(0).iter_mut().enumerate() {
                let sine = if mean { 0.0 } else { forces[(slot + 1, j)] };
                *own = c64::new(forces[(*slot, j)], -sine);
            }
            inverse.times(&mut own);
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
