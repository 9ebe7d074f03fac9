//! Natural frequencies with some contact points slipping and all others stuck.

use super::body::Body;
use super::Model;
use crate::solve::hermitian_eigen;
use crate::structure::natural_frequencies;
use crate::Error;
use faer::Mat;

impl Model {
    /// Natural frequencies [rad/s] with the contact points `slipping` at constant force and all
    /// others stuck: slipping points are condensed statically, `D_TT − D_TS D_SS⁻¹ D_ST`
    /// (Guillen 1999, eqs. 6.14-6.17).
    ///
    /// # Errors
    /// A point that does not exist, or an eigenvalue iteration that fails.
    pub fn natural_frequencies(&self, slipping: &[(usize, usize)]) -> Result<Vec<f64>, Error> {
        let (stick, stiffness) = self.partition(slipping)?;
        let rows = picked(&self.ports.rows, &stick);
        let restrained = self.structure.restrained_stiffness(&rows.into(), &stiffness.into());
        natural_frequencies(self.structure.mass(), restrained, self.structure.massless())
    }

    /// The same for a travelling wave, at a nodal diameter of its disk.
    ///
    /// # Errors
    /// As [`Model::natural_frequencies`]; a model that is no travelling wave.
    pub fn wave_frequencies(
        &self,
        diameter: usize,
        slipping: &[(usize, usize)],
    ) -> Result<Vec<f64>, Error> {
        let Body::Wave { cyclic, next } = &self.body else {
            return Err(Error::shape("model", "a travelling wave", "a structure without symmetry"));
        };
        let (stick, stiffness) = self.partition(slipping)?;
        let (own, next) = (picked(&self.ports.rows, &stick), picked(next, &stick));
        cyclic.natural_frequencies(diameter, own.as_ref(), next.as_ref(), stiffness.as_ref())
    }

    /// The points that stick, and their stiffness with the slipping ones condensed.
    fn partition(&self, slipping: &[(usize, usize)]) -> Result<(Vec<usize>, Mat<f64>), Error> {
        let total = self.ports.rows.nrows();
        let mut slips = vec![false; total];
        for &(contact, point) in slipping {
            let index = self
                .points
                .get(contact)
                .filter(|range| point < range.len())
                .map(|range| range.start + point)
                .ok_or_else(|| {
                    Error::shape(
                        &format!("slipping: ({contact}, {point})"),
                        "an existing contact and point",
                        format!("{} contacts with {total} points", self.points.len()),
                    )
                })?;
            slips[index] = true;
        }
        self.condensed_stiffness(&slips)
    }

    /// The points that stick where those of `slips` slip, and their stiffness.
    pub(super) fn condensed_stiffness(
        &self,
        slips: &[bool],
    ) -> Result<(Vec<usize>, Mat<f64>), Error> {
        let (slip, stick): (Vec<usize>, Vec<usize>) = (0..slips.len()).partition(|&i| slips[i]);
        let stiffness = condensed(&self.ports.stiffness, &stick, &slip)?;
        Ok((stick, stiffness))
    }
}

fn picked(rows: &Mat<f64>, which: &[usize]) -> Mat<f64> {
    Mat::from_fn(which.len(), rows.ncols(), |i, j| rows[(which[i], j)])
}

/// `D_TT − D_TS D_SS⁺ D_ST`: directions in which the slipping points meet no stiffness among
/// themselves carry no force and drop out.
fn condensed(stiffness: &Mat<f64>, stick: &[usize], slip: &[usize]) -> Result<Mat<f64>, Error> {
    let part = |rows: &[usize], columns: &[usize]| {
        Mat::from_fn(rows.len(), columns.len(), |i, j| stiffness[(rows[i], columns[j])])
    };
    let stuck = part(stick, stick);
    if slip.is_empty() || stick.is_empty() {
        return Ok(stuck);
    }
    let (values, vectors) = hermitian_eigen(part(slip, slip).as_ref())
        .ok_or_else(|| Error::Eigenvalues("contact stiffness".to_owned()))?;
    let largest = values.iter().copied().fold(0.0, f64::max);
    let mut modal = vectors.transpose() * part(slip, stick);
    let mut weighted = modal.clone();
    for (i, &value) in values.iter().enumerate() {
        let inverse = if value > 1e-12 * largest { 1.0 / value } else { 0.0 };
        for j in 0..stick.len() {
            weighted[(i, j)] *= inverse;
            modal[(i, j)] *= f64::from(u8::from(inverse > 0.0));
        }
    }
    Ok(stuck - modal.transpose() * weighted)
}
