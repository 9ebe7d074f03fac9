//! The unknowns of a balance: complex amplitudes and their real layout.

use crate::fourier::Harmonics;
use faer::c64;

/// Real coefficients of the contact displacements, point after point, with their harmonics.
#[derive(Debug, Clone)]
pub struct Unknowns {
    pub(super) harmonics: Harmonics,
    pub(super) values: Vec<f64>,
}

impl Unknowns {
    /// Real coefficients `values`, point after point, in a set of harmonics.
    #[must_use]
    pub fn new(harmonics: Harmonics, values: Vec<f64>) -> Self {
        Self { harmonics, values }
    }

    /// The set of harmonics.
    #[must_use]
    pub fn harmonics(&self) -> &Harmonics {
        &self.harmonics
    }

    /// The real coefficients.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same series in another set of harmonics: common ones are kept, new ones are zero.
    pub(crate) fn recast(&self, harmonics: &Harmonics) -> Vec<f64> {
        let (from, to) = (self.harmonics.slots(), harmonics.slots());
        if self.harmonics == *harmonics {
            return self.values.clone();
        }
        let points = self.values.len() / from.max(1);
        let mut values = vec![0.0; points * to];
        for order in self.harmonics.orders() {
            let (Some(source), Some(target)) = (self.harmonics.slot(order), harmonics.slot(order))
            else {
                continue;
            };
            let width = if order == 0 { 1 } else { 2 };
            for point in 0..points {
                values[point * to + target..][..width]
                    .copy_from_slice(&self.values[point * from + source..][..width]);
            }
        }
        values
    }
}

/// Writes complex amplitudes of all points at one order into a real layout.
pub fn scatter(harmonics: &Harmonics, order: usize, amplitudes: &[c64], out: &mut [f64]) {
    let slots = harmonics.slots();
    let Some(slot) = harmonics.slot(order) else { return };
    for (point, amplitude) in amplitudes.iter().enumerate() {
        out[point * slots + slot] = amplitude.re;
        if order > 0 {
            out[point * slots + slot + 1] = -amplitude.im;
        }
    }
}

/// Reads the complex amplitudes of all points at one order from a real layout.
pub fn gather(harmonics: &Harmonics, order: usize, series: &[f64], out: &mut Vec<c64>) {
    out.clear();
    append(harmonics, order, series, out);
}

/// Those at all orders, one after the other.
pub(super) fn gather_all(harmonics: &Harmonics, series: &[f64]) -> Vec<c64> {
    let mut all = Vec::with_capacity(series.len());
    harmonics.orders().for_each(|order| append(harmonics, order, series, &mut all));
    all
}

fn append(harmonics: &Harmonics, order: usize, series: &[f64], out: &mut Vec<c64>) {
    let slots = harmonics.slots();
    let Some(slot) = harmonics.slot(order) else { return };
    out.extend(series.chunks_exact(slots).map(|point| {
        let imaginary = if order > 0 { -point[slot + 1] } else { 0.0 };
        c64::new(point[slot], imaginary)
    }));
}
