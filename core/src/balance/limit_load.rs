//! Whether static loads are beyond what contacts can carry.
//!
//! A body that contacts alone hold slides away where some rigid-body motion exists along which the load
//! does more work than the contacts take, however far it goes: the kinematic theorem of limit analysis.

use super::at_rest::RestStatus;
use super::statics::{static_response, Loading};
use crate::model::Model;
use crate::solve::norm;
use faer::Mat;

/// Distances, over the displacements of the stuck structure, at which a body has left.
const AWAY: [f64; 2] = [1e3, 1e6];
/// Share of the largest singular value, and of the load, that is rounding.
const ROUNDING: f64 = 1e-9;
/// Contact points up to which this is found out: the matrices are dense.
const MOST: usize = 300;

/// Whether the static loads of a model carry a body away that contacts alone hold.
pub(crate) fn is_carried_away(model: &Model) -> bool {
    let loaded = model.compliance().forced_harmonics().contains(&0);
    loaded && Loading::new(model).is_ok_and(|loading| loading.goes_away())
}

/// Whether the static loads of a model, raised from rest, let go of a body that contacts alone hold.
pub(crate) fn is_let_go(model: &Model) -> bool {
    let loaded = model.compliance().forced_harmonics().contains(&0);
    let at_rest = || static_response(model, &[], &|_| true);
    is_carried_away(model)
        || (loaded && at_rest().is_ok_and(|rest| rest.status == RestStatus::Free))
}

impl Loading<'_> {
    /// Whether the whole load takes a body from the level that has been reached as far as it likes.
    pub(super) fn goes_away(&self) -> bool {
        let size = self.level.u.len();
        if size == 0 || size > MOST {
            return false;
        }
        // Rigid-body motion has u = G D u.
        let springs = &self.receptance * &**self.model.contact_stiffness();
        let Ok(parts) = (Mat::<f64>::identity(size, size) - springs).svd() else { return false };
        let values = parts.S().column_vector();
        // All of them are rounding where every contact moves with a body that floats.
        let largest = values[0].max(1.0);
        let rigid = (0..size).filter(|&i| values[i] <= ROUNDING * largest);
        let (left, right) = (parts.U(), parts.V());
        let load = norm(&self.stuck());
        let missing = self.missing(&self.level.u);
        let (mut along, mut against) = (vec![0.0; size], vec![0.0; size]);
        for i in rigid {
            let dot =
                |x: &dyn Fn(usize) -> f64| (0..size).map(|k| left[(k, i)] * x(k)).sum::<f64>();
            let (share, way) = (dot(&|k| missing[k]), dot(&|k| right[(k, i)]).signum());
            for k in 0..size {
                along[k] -= share * way * right[(k, i)];
                against[k] += share * left[(k, i)];
            }
        }
        let length = norm(&along);
        if length <= ROUNDING * load {
            return false;
        }
        AWAY.iter().all(|away| {
            let far = |(u, along): (&f64, &f64)| u + away * load * along / length;
            let u: Vec<f64> = self.level.u.iter().zip(&along).map(far).collect();
            let missing = self.missing(&u);
            against.iter().zip(&missing).map(|(a, b)| a * b).sum::<f64>() > ROUNDING * length * load
        })
    }
}
