//! The states of all contacts, and how their forces follow displacements in them.

use super::modal_system::ModalSystem;
use crate::contact::PointState;
use faer::Mat;
use std::ops::Index;
use std::sync::Arc;

/// `∂f/∂u` and slip per displacement of all contacts in given states.
#[derive(Debug, Clone)]
pub struct ContactState {
    /// State of each point of an element.
    pub points: Vec<PointState>,
    /// `∂f/∂u`, points × points [N/m].
    pub tangent: Blocks,
    /// `∂s'/∂u'`, points × points.
    pub slip_rate: Blocks,
}

impl ContactState {
    pub(crate) fn new(system: &ModalSystem, points: &[PointState]) -> Self {
        let [tangent, slip_rate] = [(); 2].map(|()| Blocks(Vec::with_capacity(points.len())));
        let mut regime = Self { points: points.to_vec(), tangent, slip_rate };
        for body in system.bodies() {
            let (own, first) = (&points[body.points.clone()], body.points.start);
            regime.tangent.add(first, body.law.tangent(own));
            regime.slip_rate.add(first, body.law.slip_rate(own));
        }
        regime
    }

    /// The same with some points in other states.
    pub(super) fn changed(&self, system: &ModalSystem, points: &[PointState]) -> Self {
        let mut regime = Self { points: points.to_vec(), ..self.clone() };
        for body in system.bodies() {
            let (own, first) = (&points[body.points.clone()], body.points.start);
            if *own != self.points[body.points.clone()] {
                regime.tangent.write(first, body.law.tangent(own));
                regime.slip_rate.write(first, body.law.slip_rate(own));
            }
        }
        regime
    }
}

/// A matrix of the points of all elements with one block per element: states that differ in one share the others.
#[derive(Debug, Clone)]
pub struct Blocks(Vec<Arc<Block>>);

/// The block of the element that a point belongs to, and the first of its points.
#[derive(Debug)]
struct Block {
    first: usize,
    entries: Mat<f64>,
}

impl Blocks {
    fn add(&mut self, first: usize, entries: Mat<f64>) {
        let end = self.0.len() + entries.nrows();
        self.0.resize(end, Arc::new(Block { first, entries }));
    }

    fn write(&mut self, first: usize, entries: Mat<f64>) {
        let place = first..first + entries.nrows();
        self.0[place].fill(Arc::new(Block { first, entries }));
    }

    /// The product of a row with a vector.
    pub(super) fn times(&self, row: usize, vector: &[f64]) -> f64 {
        let Block { first, entries } = &*self.0[row];
        let own = entries.row(row - first).iter();
        own.zip(&vector[*first..]).map(|(entry, v)| entry * v).sum()
    }
}

impl Index<(usize, usize)> for Blocks {
    type Output = f64;

    fn index(&self, (row, column): (usize, usize)) -> &f64 {
        let Block { first, entries } = &*self.0[row];
        match column.checked_sub(*first) {
            Some(column) if column < entries.ncols() => &entries[(row - first, column)],
            _ => &0.0,
        }
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
