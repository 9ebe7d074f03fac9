//! A preconditioner for the linear equations of a nonlinear mode.

use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::Mat;

/// The tangents of slip loads within each harmonic, `I − T_kk G_k`, factorised.
pub(super) struct Preconditioner {
    /// Where the slip loads of an order stand among all, ascending, and the factors.
    pub(super) blocks: Vec<(Vec<usize>, PartialPivLu<f64>)>,
    /// Products that the equations took when it was new.
    pub(super) products: usize,
}

impl Preconditioner {
    /// The preconditioner for these slip loads, ascending: those that it does not know stay as they are.
    pub(super) fn fitted(&self, active: &[usize]) -> Fitted<'_> {
        let place = |load: &usize| active.binary_search(load).ok();
        let places = self.blocks.iter().map(|(loads, _)| loads.iter().map(place).collect());
        Fitted { preconditioner: self, places: places.collect() }
    }
}

/// A preconditioner among other slip loads.
pub(super) struct Fitted<'p> {
    preconditioner: &'p Preconditioner,
    places: Vec<Vec<Option<usize>>>,
}

impl Fitted<'_> {
    /// Solves for slip loads in place.
    pub(super) fn apply(&self, loads: &mut [f64]) {
        for (places, (_, factors)) in self.places.iter().zip(&self.preconditioner.blocks) {
            let of = |place: Option<usize>| place.map_or(0.0, |at| loads[at]);
            let mut own = Mat::from_fn(places.len(), 1, |i, _| of(places[i]));
            factors.solve_in_place(&mut own);
            for (i, at) in places.iter().enumerate() {
                if let Some(at) = at {
                    loads[*at] = own[(i, 0)];
                }
            }
        }
    }
}
