//! Fourier coefficients of the slip load of a march, and their derivative, exact integrals both.
//!
//! On a stretch `q = (D − T) u + κ`. Products of basis functions are summed over all stretches of
//! the same slip set at once; moving transitions add nothing, because f is continuous.

use crate::contact::periodic_march::PeriodicMarch;
use crate::contact::slider_integrals::Bounds;
use crate::contact::{Motion, SlipLoad};
use crate::fourier::IntervalSums;
use faer::Mat;

/// Writes the series of the slip load of a march and, if it carries rates, its tangent.
pub(super) fn write(
    march: &PeriodicMarch,
    stiffness: &Mat<f64>,
    motion: Motion<'_>,
    out: &mut SlipLoad,
) {
    let harmonics = motion.table.harmonics();
    let (points, slots) = (stiffness.nrows(), harmonics.slots());
    let size = points * slots;
    let weight = 2.0 / harmonics.span();
    let with_tangent = !out.tangent.is_empty();
    for (index, set) in march.sets.iter().enumerate() {
        if !set.slips.contains(&true) {
            continue;
        }
        let mut sums = IntervalSums::new(harmonics);
        for stretch in march.stretches.iter().filter(|stretch| stretch.set == index) {
            sums.add(stretch.start, stretch.end);
        }
        let mut products = vec![0.0; slots * slots];
        sums.products(harmonics, weight, |row, column, v| products[row * slots + column] = v);
        for i in 0..points {
            for j in 0..points {
                let lost = stiffness[(i, j)] - set.reduced.tangent[(i, j)];
                if lost == 0.0 {
                    continue;
                }
                let u = &motion.displacement[j * slots..(j + 1) * slots];
                for (k, row) in products.chunks_exact(slots).enumerate() {
                    let sum: f64 = row.iter().zip(u).map(|(m, u)| m * u).sum();
                    out.value[i * slots + k] += lost * sum;
                    if with_tangent {
                        let first = (i * slots + k) * size + j * slots;
                        let entries = out.tangent[first..first + slots].iter_mut();
                        entries.zip(row).for_each(|(entry, m)| *entry += lost * m);
                    }
                }
            }
        }
    }
    let mut bounds = Bounds::new(harmonics);
    let mut integral = vec![0.0; slots];
    for stretch in &march.stretches {
        integral.fill(0.0);
        bounds.add_integral(harmonics, stretch.start, stretch.end, weight, &mut integral);
        for i in 0..points {
            let rate = stretch.rate.get(i * size..(i + 1) * size).unwrap_or_default();
            for (k, integral) in integral.iter().enumerate() {
                let row = i * slots + k;
                out.value[row] += integral * stretch.offset[i];
                if with_tangent {
                    let entries = out.tangent[row * size..(row + 1) * size].iter_mut();
                    entries.zip(rate).for_each(|(entry, rate)| *entry += integral * rate);
                }
            }
        }
    }
}
