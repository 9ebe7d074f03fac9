//! Rough answers of many modes: the slowest ones move as they do, all others follow their loads at once,
//! as one flexibility between the contacts.
//!
//! Directions of Newton's method leave some thousandths of a residual in any case, which the next one
//! takes. So numbers of single precision do, each matrix in its own unit: they are half as many bytes,
//! and with many contacts it is the memory that a product waits for.

use super::contact_shapes::{displace, excite, gather};
use super::modal_orders::ModalOrders;
use faer::{Mat, MatRef};

/// A structure at its contacts, or at some of them, roughly.
#[derive(Debug)]
pub struct QuasiStatic {
    /// Ψᵀ of the slowest modes, modes × contacts.
    shapes: Rounded,
    /// Flexibility of all others, contacts × contacts with a load.
    flexibility: Rounded,
    /// The contacts that may have a load, if not all of them do.
    loaded: Option<Loaded>,
}

/// Contacts with a load.
#[derive(Debug)]
struct Loaded {
    /// Their positions.
    places: Vec<usize>,
    /// Ψᵀ of them.
    shapes: Rounded,
}

/// A matrix of single precision in a unit.
#[derive(Debug)]
struct Rounded {
    unit: f64,
    numbers: Mat<f32>,
}

impl Rounded {
    fn of(matrix: MatRef<'_, f64>) -> Self {
        let largest = matrix.norm_max();
        let unit = if largest > 0.0 && largest.is_finite() { largest } else { 1.0 };
        let per = unit.recip();
        let rounded = |i, j| (matrix[(i, j)] * per) as f32;
        Self { unit, numbers: Mat::from_fn(matrix.nrows(), matrix.ncols(), rounded) }
    }

    fn matrix(&self) -> MatRef<'_, f32> {
        self.numbers.as_ref()
    }

    /// Some columns.
    fn part(&self, columns: &[usize]) -> Self {
        let mut numbers = Mat::zeros(self.numbers.nrows(), columns.len());
        gather(self.matrix(), columns, &mut numbers);
        Self { unit: self.unit, numbers }
    }
}

impl QuasiStatic {
    /// Of the shapes of the slowest modes at all contacts, and the flexibility of the others.
    pub(super) fn new(shapes: MatRef<'_, f64>, flexibility: MatRef<'_, f64>) -> Self {
        let (shapes, flexibility) = (Rounded::of(shapes), Rounded::of(flexibility));
        Self { shapes, flexibility, loaded: None }
    }

    /// The same at some of the contacts, of which those at some places may have a load.
    #[must_use]
    pub fn part(&self, contacts: &[usize], places: Vec<usize>) -> Self {
        let mut numbers = Mat::zeros(contacts.len(), places.len());
        for (at, &place) in places.iter().enumerate() {
            let column = self.flexibility.numbers.col_as_slice(contacts[place]);
            let entries = numbers.col_as_slice_mut(at).iter_mut().zip(contacts);
            entries.for_each(|(entry, &i)| *entry = column[i]);
        }
        let flexibility = Rounded { unit: self.flexibility.unit, numbers };
        let shapes = self.shapes.part(contacts);
        let loaded = Some(Loaded { shapes: shapes.part(&places), places });
        Self { shapes, flexibility, loaded }
    }

    /// Displacements by loads, slots × contacts both.
    #[must_use]
    pub fn answer(&self, at: &ModalOrders, load: MatRef<'_, f64>) -> Mat<f64> {
        let Self { shapes, flexibility, loaded } = self;
        let (load, excited) = match loaded {
            Some(Loaded { places, shapes }) => {
                let own = Mat::from_fn(load.nrows(), places.len(), |i, j| load[(i, places[j])]);
                (Rounded::of(own.as_ref()), shapes)
            }
            None => (Rounded::of(load), shapes),
        };
        let forces = excite(excited.matrix(), load.matrix());
        let unit = load.unit * shapes.unit;
        let mut motion =
            Mat::from_fn(forces.nrows(), forces.ncols(), |i, j| unit * f64::from(forces[(i, j)]));
        at.divide(&mut motion);
        let motion = Rounded::of(motion.as_ref());
        let slow = displace(shapes.matrix(), motion.matrix());
        let fast = excite(flexibility.matrix(), load.matrix());
        let units = [motion.unit * shapes.unit, load.unit * flexibility.unit];
        Mat::from_fn(slow.nrows(), slow.ncols(), |i, j| {
            units[0] * f64::from(slow[(i, j)]) + units[1] * f64::from(fast[(i, j)])
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::modal_orders::{Inverse, Order};
    use super::*;
    use faer::c64;

    /// Whatever the unit of loads and shapes is, also where their squares would not be single numbers.
    #[test]
    fn answers_are_those_of_the_matrices_in_any_unit() {
        let number = |i: usize, j: usize| ((3 * i + 7 * j) as f64).sin();
        for unit in [1.0, 1e-30, 1e30] {
            let shapes = Mat::from_fn(4, 50, |i, j| unit * number(i, j));
            let flexibility = Mat::from_fn(50, 50, |i, j| unit * number(i.min(j), i.max(j)));
            let inverse: Vec<c64> = (0..4).map(|j| c64::new(1.0, j as f64) / unit).collect();
            let order =
                Order { harmonic: 1, slot: 0, rate: 1.0, inverse: Inverse::Diagonal(inverse) };
            let at = ModalOrders { orders: vec![order] };
            let places = vec![1, 2, 5];
            let contacts: Vec<usize> = (0..50).step_by(3).collect();
            let load = Mat::from_fn(2, contacts.len(), |i, j| {
                if places.contains(&j) {
                    unit * number(i, j + 1)
                } else {
                    0.0
                }
            });
            let exact = |shapes: &Mat<f64>, flexibility: &Mat<f64>| {
                let mut motion = &load * shapes.transpose();
                at.divide(&mut motion);
                motion * shapes + &load * flexibility
            };
            let own = |matrix: &Mat<f64>, all: bool| {
                let row = |i: usize| if all { contacts[i] } else { i };
                let rows = if all { contacts.len() } else { matrix.nrows() };
                Mat::from_fn(rows, contacts.len(), |i, j| matrix[(row(i), contacts[j])])
            };
            let expected = exact(&own(&shapes, false), &own(&flexibility, true));
            let whole = QuasiStatic::new(shapes.as_ref(), flexibility.as_ref());
            let mut spread = Mat::zeros(2, 50);
            contacts
                .iter()
                .enumerate()
                .for_each(|(j, &at)| spread.col_mut(at).copy_from(load.col(j)));
            let all = whole.answer(&at, spread.as_ref());
            let part = whole.part(&contacts, places).answer(&at, load.as_ref());
            let size = expected.norm_max();
            assert!(size > 0.0);
            for (j, &place) in contacts.iter().enumerate() {
                for i in 0..2 {
                    for got in [part[(i, j)], all[(i, place)]] {
                        let error = (got - expected[(i, j)]).abs();
                        assert!(error < 1e-6 * size, "{unit:e}: {error:e} of {size:e}");
                    }
                }
            }
        }
    }
}
