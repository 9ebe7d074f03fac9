//! Coordinates in which a structure with many contacts answers forces, without a receptance.

use super::contact_shapes::ContactShapes;
use super::modal_orders::ModalOrders;
use super::quasi_static::QuasiStatic;
use crate::Error;
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

    /// Displacements of all contacts by loads on them.
    fn respond(&self, at: &ModalOrders, load: MatRef<'_, f64>, tolerance: f64) -> Mat<f64> {
        let mut motion = self.excite(load);
        self.answer(at, &mut motion, tolerance);
        self.displace(motion.as_ref())
    }

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
