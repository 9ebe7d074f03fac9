//! The states of all contacts, and how their forces follow displacements in them.

use super::bodies::Body;
use super::modal_system::ModalSystem;
use crate::contact::PointState;
use faer::Mat;

/// `∂f/∂u` and slip per displacement of all contacts in given states.
#[derive(Debug, Clone)]
pub struct ContactState {
    /// State of each point of an element.
    pub points: Vec<PointState>,
    /// `∂f/∂u`, points × points [N/m].
    pub tangent: Mat<f64>,
    /// `∂s'/∂u'`, points × points.
    pub slip_rate: Mat<f64>,
}

impl ContactState {
    pub(crate) fn new(system: &ModalSystem, points: &[PointState]) -> Self {
        let [tangent, slip_rate] = [(); 2].map(|()| Mat::zeros(points.len(), points.len()));
        let mut regime = Self { points: points.to_vec(), tangent, slip_rate };
        system.bodies().iter().for_each(|body| regime.write(body));
        regime
    }

    /// The same with some points in other states.
    pub(super) fn changed(&self, system: &ModalSystem, points: &[PointState]) -> Self {
        let copy = |of: &Mat<f64>| {
            let mut copy = Mat::zeros(of.nrows(), of.ncols());
            let columns = 0..of.ncols();
            columns.for_each(|j| copy.col_as_slice_mut(j).copy_from_slice(of.col_as_slice(j)));
            copy
        };
        let [tangent, slip_rate] = [&self.tangent, &self.slip_rate].map(copy);
        let mut regime = Self { points: points.to_vec(), tangent, slip_rate };
        let differs =
            |body: &&Body| points[body.points.clone()] != self.points[body.points.clone()];
        system.bodies().iter().filter(differs).for_each(|body| regime.write(body));
        regime
    }

    fn write(&mut self, body: &Body) {
        let (own, place) = (&self.points[body.points.clone()], body.points.clone());
        let [tangent, slip_rate] = [body.law.tangent(own), body.law.slip_rate(own)];
        self.tangent.get_mut(place.clone(), place.clone()).copy_from(tangent);
        self.slip_rate.get_mut(place.clone(), place).copy_from(slip_rate);
    }
}

/// The contacts of a regime as disturbances see them: the same whichever way the others slip.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Springs {
    /// Rates of the strains per velocity: strain, point, factor.
    pub(super) moves: Vec<(usize, usize, f64)>,
    /// Stiffness of points that press.
    pub(super) pressing: Vec<(usize, f64)>,
}
