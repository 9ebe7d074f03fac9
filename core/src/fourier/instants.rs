//! The basis at equidistant instants, computed once for all contacts that are marched through them.

use super::unit_circle::unit_circle;
use super::Harmonics;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The basis at equidistant instants.
#[derive(Debug)]
pub struct Basis {
    slots: usize,
    count: usize,
    functions: Vec<f64>,
    rows: OnceLock<Vec<f64>>,
}

impl Basis {
    /// At the first `count` of `samples` instants per period, an even number of them.
    fn new(harmonics: &Harmonics, samples: usize, count: usize) -> Self {
        let unit = unit_circle(samples);
        let mut functions = vec![1.0; harmonics.slots() * count];
        let oscillating = &mut functions[harmonics.offset() * count..];
        let pairs = oscillating.chunks_exact_mut((2 * count).max(1));
        for (order, pair) in harmonics.oscillating().iter().zip(pairs) {
            let (cos, sin) = pair.split_at_mut(count);
            let (mut at, ahead) = (0, order % samples);
            for (cos, sin) in cos.iter_mut().zip(sin) {
                (*sin, *cos) = unit[at];
                at += ahead;
                if at >= samples {
                    at -= samples;
                }
            }
        }
        Self { slots: harmonics.slots(), count, functions, rows: OnceLock::new() }
    }

    /// Function after function.
    #[must_use]
    pub fn functions(&self) -> &[f64] {
        &self.functions
    }

    /// All functions at instant n; only tangents ask for them.
    #[must_use]
    pub fn at(&self, n: usize) -> &[f64] {
        let rows = self.rows.get_or_init(|| {
            let mut rows = vec![0.0; self.functions.len()];
            for (n, row) in rows.chunks_exact_mut(self.slots.max(1)).enumerate() {
                let functions = self.functions.chunks_exact(self.count);
                row.iter_mut().zip(functions).for_each(|(entry, function)| *entry = function[n]);
            }
            rows
        });
        &rows[n * self.slots..(n + 1) * self.slots]
    }
}

/// Numbers of samples and of instants, and the basis there.
type Kept = ([usize; 2], Arc<Basis>);

/// What has been asked for last.
#[derive(Debug, Clone, Default)]
pub(super) struct Instants {
    kept: Arc<Mutex<Vec<Kept>>>,
}

/// Different numbers of instants that are kept: those of a balance and of its error estimate.
const MOST: usize = 4;

impl Instants {
    /// The basis at the first `count` of `samples` instants.
    pub(super) fn basis(&self, harmonics: &Harmonics, samples: usize, count: usize) -> Arc<Basis> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = kept.iter().find(|(key, _)| *key == [samples, count]) {
            return known.clone();
        }
        let basis = Arc::new(Basis::new(harmonics, samples, count));
        if kept.len() == MOST {
            kept.remove(0);
        }
        kept.push(([samples, count], basis.clone()));
        basis
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn one_table_of_sines_serves_all_functions() {
        for (highest, half_wave, samples) in [(1, true, 8), (7, false, 34), (30, false, 64)] {
            let harmonics = Harmonics::new(highest, half_wave);
            let count = if half_wave { samples / 2 } else { samples };
            let basis = Basis::new(&harmonics, samples, count);
            let mut row = vec![0.0; harmonics.slots()];
            for n in 0..count {
                harmonics.basis(TAU * n as f64 / samples as f64, &mut row);
                for (slot, expected) in row.iter().enumerate() {
                    assert!((basis.at(n)[slot] - expected).abs() < 1e-13);
                    assert_eq!(basis.functions()[slot * count + n], basis.at(n)[slot]);
                }
            }
        }
    }
}
