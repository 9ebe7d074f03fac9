//! The describing function of any law: in closed form, or by the harmonics of its force.

use super::{ContactLaw, Describing, Motion, PointSummary, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use faer::c64;
use std::sync::OnceLock;

impl dyn ContactLaw + '_ {
    /// Describing function of a law of one displacement, in closed form or by the harmonics of its force
    /// under a cosine; nothing of a law of several.
    #[must_use]
    pub fn first_harmonic(&self, amplitude: f64) -> Option<Describing> {
        self.describing(amplitude).or_else(|| self.under_cosine(amplitude))
    }

    /// Describing function by the slip load of a cosine: `K = k − Q/A`.
    pub(super) fn under_cosine(&self, amplitude: f64) -> Option<Describing> {
        static TABLE: OnceLock<SampleTable> = OnceLock::new();
        if self.displacements() != 1 {
            return None;
        }
        let k = c64::new(self.stiffness()[(0, 0)], 0.0);
        if amplitude == 0.0 {
            let zero = c64::new(0.0, 0.0);
            return Some(Describing { stiffness: k, slope: zero, slip_fraction: 0.0 });
        }
        let table = TABLE.get_or_init(|| SampleTable::new(Harmonics::new(1, true)));
        let displacement = [amplitude, 0.0];
        let motion = Motion { table, displacement: &displacement, residual: Residual::Centred };
        let mut load = SlipLoad::default();
        self.slip_load(motion, true, &mut load);
        let mut summary = [PointSummary::default()];
        self.summary(motion, &mut summary);
        // q = Re Q e^{iθ} with Q = a − i b.
        let q = c64::new(load.value[0], -load.value[1]);
        let by_amplitude = c64::new(load.tangent[0], -load.tangent[2]);
        Some(Describing {
            stiffness: k - q / amplitude,
            slope: (q / amplitude - by_amplitude) / amplitude,
            slip_fraction: summary[0].slip_fraction,
        })
    }
}
