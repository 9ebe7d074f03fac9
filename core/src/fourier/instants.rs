//! The basis at equidistant instants, computed once for all contacts that are marched through them.

use super::Harmonics;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};

/// By its numbers of samples and of instants a basis, instant after instant and function after function.
type Kept = ([usize; 2], [Arc<[f64]>; 2]);

/// What has been asked for last.
#[derive(Debug, Clone, Default)]
pub(super) struct Instants {
    kept: Arc<Mutex<Vec<Kept>>>,
}

/// Different numbers of instants that are kept: those of a balance and of its error estimate.
const MOST: usize = 4;

impl Instants {
    /// The basis at the first `count` of `samples` instants: instant after instant, and function after
    /// function.
    pub(super) fn basis(
        &self,
        harmonics: &Harmonics,
        samples: usize,
        count: usize,
    ) -> [Arc<[f64]>; 2] {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = kept.iter().find(|(key, _)| *key == [samples, count]) {
            return known.clone();
        }
        let mut basis = vec![0.0; count * harmonics.slots()];
        for (n, row) in basis.chunks_exact_mut(harmonics.slots().max(1)).enumerate() {
            harmonics.basis(TAU * n as f64 / samples as f64, row);
        }
        let slots = harmonics.slots();
        let functions = (0..slots).flat_map(|slot| basis.iter().skip(slot).step_by(slots));
        let functions: Vec<f64> = functions.copied().collect();
        let basis: [Arc<[f64]>; 2] = [basis.into(), functions.into()];
        if kept.len() == MOST {
            kept.remove(0);
        }
        kept.push(([samples, count], basis.clone()));
        basis
    }
}
