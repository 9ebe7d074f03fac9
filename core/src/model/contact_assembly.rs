//! Contacts assembled into the rows and the stiffness of a structure.

use crate::contact::ContactLaw;
use crate::Error;
use faer::Mat;
use std::ops::Range;

/// Contacts one after the other, their rows and their stiffness.
pub(super) struct ContactAssembly {
    pub(super) laws: Vec<Box<dyn ContactLaw>>,
    pub(super) points: Vec<Range<usize>>,
    /// Rows of B, one matrix per part of the structure that they act on.
    pub(super) rows: [Mat<f64>; 2],
    pub(super) stiffness: Mat<f64>,
}

impl ContactAssembly {
    pub(super) fn new(
        dofs: usize,
        contacts: impl Iterator<Item = (Box<dyn ContactLaw>, Vec<Mat<f64>>)>,
    ) -> Result<Self, Error> {
        let contacts: Vec<_> = contacts.collect();
        let total: usize = contacts.iter().map(|(law, _)| law.displacements()).sum();
        let whole = contacts.first().is_some_and(|(_, parts)| parts.len() == 1);
        let mut rows = [Mat::zeros(total, dofs), Mat::zeros(total, if whole { 0 } else { dofs })];
        let mut stiffness = Mat::zeros(total, total);
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
                if (0..size).any(|i| (0..dofs).any(|j| !part[(i, j)].is_finite())) {
                    return Err(Error::value(entry, f64::NAN, "its rows must be finite"));
                }
                // They hold few numbers.
                for j in 0..dofs {
                    for i in (0..size).filter(|&i| part[(i, j)] != 0.0) {
                        rows[(first + i, j)] = part[(i, j)];
                    }
                }
            }
            let own = law.stiffness();
            stiffness.get_mut(first..first + size, first..first + size).copy_from(&own);
            points.push(first..first + size);
            laws.push(law);
            first += size;
        }
        Ok(Self { laws, points, rows, stiffness })
    }
}
