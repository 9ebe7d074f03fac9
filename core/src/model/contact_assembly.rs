//! Contacts assembled into the rows and the stiffness of a structure.

use crate::contact::ContactLaw;
use crate::structure::Matrix;
use crate::Error;
use std::ops::Range;

/// Contacts one after the other, their rows and their stiffness.
pub(super) struct ContactAssembly {
    pub(super) laws: Vec<Box<dyn ContactLaw>>,
    pub(super) points: Vec<Range<usize>>,
    /// Rows of B, one matrix per part of the structure that they act on.
    pub(super) rows: [Matrix; 2],
    pub(super) stiffness: Matrix,
}

impl ContactAssembly {
    pub(super) fn new(
        dofs: usize,
        contacts: impl Iterator<Item = (Box<dyn ContactLaw>, Vec<Matrix>)>,
    ) -> Result<Self, Error> {
        let contacts: Vec<_> = contacts.collect();
        let total: usize = contacts.iter().map(|(law, _)| law.displacements()).sum();
        let whole = contacts.first().is_some_and(|(_, parts)| parts.len() == 1);
        let mut rows = [Vec::new(), Vec::new()];
        let (mut laws, mut points, mut first) = (Vec::new(), Vec::new(), 0);
        for (index, (law, parts)) in contacts.into_iter().enumerate() {
            let size = law.displacements();
            let entry = format!("contact {}", index + 1);
            for (part, rows) in parts.iter().zip(&mut rows) {
                if (part.nrows(), part.ncols()) != (size, dofs) {
                    return Err(Error::shape(
                        &entry,
                        format!("rows of shape {size} x {dofs}"),
                        format!("{} x {}", part.nrows(), part.ncols()),
                    ));
                }
                if part.entries().any(|(_, _, share)| !share.is_finite()) {
                    return Err(Error::value(entry, f64::NAN, "its rows must be finite"));
                }
                rows.extend(part.entries().map(|(i, j, share)| (first + i, j, share)));
            }
            points.push(first..first + size);
            laws.push(law);
            first += size;
        }
        let [own, next] = rows;
        let rows = [
            Matrix::of_entries(total, dofs, &own),
            Matrix::of_entries(total, if whole { 0 } else { dofs }, &next),
        ];
        let stiffness = stiffness_of(&laws);
        Ok(Self { laws, points, rows, stiffness })
    }
}

/// Stiffness D of the points of all laws [N/m]: a block for each.
pub(crate) fn stiffness_of(laws: &[Box<dyn ContactLaw>]) -> Matrix {
    let (mut numbers, mut first) = (Vec::new(), 0);
    for law in laws {
        let own = Matrix::from(law.stiffness());
        numbers.extend(own.entries().map(|(i, j, d)| (first + i, first + j, d)));
        first += law.displacements();
    }
    Matrix::of_entries(first, first, &numbers)
}
