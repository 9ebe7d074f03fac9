//! Displacements at the equidistant instants of a march.

use crate::contact::Motion;
use crate::fourier::Basis;
use crate::solve::dot;
use std::sync::Arc;

/// Instants whose sums go through the processor side by side.
const AT_ONCE: usize = 8;

/// Displacements at the instants of one span, with the basis there.
pub struct Samples {
    /// Instants in the span.
    pub count: usize,
    /// −1 if the second half of the period mirrors the first.
    pub sign: f64,
    basis: Arc<Basis>,
    /// Instant after instant.
    pub displacement: Vec<f64>,
}

impl Samples {
    /// Samples of a motion: `samples` per period, half of them for a half-wave symmetric one.
    pub fn of(motion: Motion<'_>, samples: usize) -> Self {
        let harmonics = motion.table.harmonics();
        let slots = harmonics.slots().max(1);
        let half = harmonics.half_wave();
        let count = if half { samples / 2 } else { samples };
        let basis = motion.table.basis(samples, count);
        let mut displacement = vec![0.0; motion.displacement.len() / slots * count];
        pulp::Arch::new().dispatch(Sample {
            all: motion.displacement,
            sizes: [slots, count],
            functions: basis.functions(),
            displacement: &mut displacement,
        });
        Self { count, sign: if half { -1.0 } else { 1.0 }, basis, displacement }
    }

    /// The basis at instant n, or at the first of the next span.
    pub(super) fn basis(&self, n: usize) -> &[f64] {
        self.basis.at(n % self.count)
    }

    /// Displacements at instant n.
    pub fn at(&self, n: usize) -> &[f64] {
        let points = self.displacement.len() / self.count;
        &self.displacement[n * points..(n + 1) * points]
    }

    /// Coefficients of values at the instants, as if all functions had the square of the sines.
    pub fn project(&self, values: &[f64], series: &mut [f64]) {
        pulp::Arch::new().dispatch(Project { samples: self, values, series });
    }
}

/// Closures would be no part of what vector instructions are chosen for.
struct Project<'a> {
    samples: &'a Samples,
    values: &'a [f64],
    series: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Project<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.samples.count;
        let weight = 2.0 / count as f64;
        let functions = self.samples.basis.functions().chunks_exact(count.max(1));
        for (coefficient, function) in self.series.iter_mut().zip(functions) {
            *coefficient = weight * dot(self.values, function);
        }
    }
}

struct Sample<'a> {
    all: &'a [f64],
    /// Coefficients of a point, and instants.
    sizes: [usize; 2],
    functions: &'a [f64],
    displacement: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Sample<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        sample(self.all, self.sizes, self.functions, self.displacement);
    }
}

/// Writes series at instants, instant after instant.
#[inline(always)]
fn sample(all: &[f64], [slots, count]: [usize; 2], functions: &[f64], displacement: &mut [f64]) {
    let points = all.len() / slots;
    for (point, series) in all.chunks_exact(slots).enumerate() {
        for first in (0..count).step_by(AT_ONCE) {
            let here = AT_ONCE.min(count - first);
            let mut sums = [0.0; AT_ONCE];
            for (c, function) in series.iter().zip(functions.chunks_exact(count)) {
                let function = &function[first..first + here];
                match <&[f64; AT_ONCE]>::try_from(function) {
                    Ok(function) => (0..AT_ONCE).for_each(|n| sums[n] += c * function[n]),
                    Err(_) => sums.iter_mut().zip(function).for_each(|(u, b)| *u += c * b),
                }
            }
            let out = displacement[first * points..].iter_mut().skip(point).step_by(points);
            out.zip(&sums[..here]).for_each(|(u, sum)| *u = *sum);
        }
    }
}
