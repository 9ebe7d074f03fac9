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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::{ContactLaw, Jenkins, StructuralDamper};
    use crate::model::{Contact, Model};
    use crate::structure::Structure;

    /// Three points on a chain, two of which are of one element.
    fn system() -> ModalSystem {
        let stiffness = Mat::from_fn(3, 3, |i, j| match i.abs_diff(j) {
            0 => 3.0,
            1 => -1.0,
            _ => 0.0,
        });
        let (mass, damping) = (Mat::<f64>::identity(3, 3), Mat::<f64>::zeros(3, 3));
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let rows = |first: usize, count: usize| {
            Mat::from_fn(count, 3, |i, j| f64::from(u8::from(first + i == j)))
        };
        let pair = Mat::from_fn(2, 2, |i, j| if i == j { 2.0 } else { 0.5 });
        let laws: [(Box<dyn ContactLaw>, Mat<f64>); 2] = [
            (Box::new(StructuralDamper::new(pair.as_ref(), &[1.0, 2.0]).unwrap()), rows(0, 2)),
            (Box::new(Jenkins::new(4.0, 1.0).unwrap()), rows(2, 1)),
        ];
        let contacts = laws.map(|(law, rows)| Contact { law, rows });
        let model = Model::new(structure.unwrap(), contacts.into(), Vec::new()).unwrap();
        ModalSystem::new(&model).unwrap()
    }

    /// A change of one element leaves the others their blocks: what a period of many contacts keeps does not grow
    /// with the cube of their number.
    #[test]
    fn states_that_differ_in_one_element_share_the_others() {
        let system = system();
        let mut points = vec![PointState::Stuck; 3];
        let before = ContactState::new(&system, &points);
        points[2] = PointState::Forward;
        let after = before.changed(&system, &points);
        for [old, new] in [[&before.tangent, &after.tangent], [&before.slip_rate, &after.slip_rate]]
        {
            let shared: Vec<bool> =
                old.0.iter().zip(&new.0).map(|(old, new)| Arc::ptr_eq(old, new)).collect();
            assert_eq!(shared, [true, true, false]);
        }
        let anew = ContactState::new(&system, &points);
        let speed = [0.3, -0.7, 1.1];
        for i in 0..3 {
            for j in 0..3 {
                assert_eq!(after.tangent[(i, j)], anew.tangent[(i, j)]);
                assert_eq!(after.slip_rate[(i, j)], anew.slip_rate[(i, j)]);
            }
            let whole: f64 = (0..3).map(|j| after.tangent[(i, j)] * speed[j]).sum();
            assert!((after.tangent.times(i, &speed) - whole).abs() < 1e-15);
        }
        assert!((before.tangent[(0, 1)] - 0.5).abs() < 1e-14);
        assert_eq!(before.tangent[(1, 2)], 0.0);
    }
}
