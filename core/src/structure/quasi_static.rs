//! Rough answers of many modes: the slowest ones move as they do, all others follow their loads at once,
//! as one flexibility between the contacts.
//!
//! Directions of Newton's method leave some thousandths of a residual in any case, which the next one
//! takes. So numbers of single precision do, each matrix in its own unit: they are half as many bytes,
//! and with many contacts it is the memory that a product waits for.

use super::contact_coordinates::ModalOrders;
use super::contact_shapes::{displace, excite, gather};
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
