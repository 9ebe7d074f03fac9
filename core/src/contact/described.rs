//! A law evaluated by its describing function.

use super::aft::of_the_law;
use super::law::HarmonicForce;
use super::return_map::ReturnMapJacobian;
use super::{ContactLaw, Describing, Motion, Phase, PointSummary, SlipLoad};
use faer::{c64, Mat};
use std::f64::consts::PI;

/// A law of one displacement evaluated by its describing function, for the fundamental alone.
#[derive(Debug)]
pub(crate) struct Described {
    law: Box<dyn ContactLaw>,
    stiffness: f64,
}

impl Described {
    /// The law evaluated so; nothing if it has no describing function.
    pub(crate) fn new(law: Box<dyn ContactLaw>) -> Option<Self> {
        law.describing(1.0)?;
        Some(Self { stiffness: law.stiffness()[(0, 0)], law })
    }

    /// Displacement and describing function of a motion.
    fn at(&self, motion: Motion<'_>) -> Option<(c64, Describing)> {
        let &[cosine, sine] = motion.displacement else { return None };
        let u = c64::new(cosine, -sine);
        self.law.describing(u.norm()).map(|describing| (u, describing))
    }
}

impl HarmonicForce for Described {
    /// `q = (k − K(|u|)) u` and, with u = p − i s, `dq = (k − K) du − K' u (p dp + s ds)/|u|`.
    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        out.reset(motion.displacement.len(), tangent);
        let Some((u, describing)) = self.at(motion) else { return };
        let loss = self.stiffness - describing.stiffness;
        let q = loss * u;
        out.value.copy_from_slice(&[q.re, -q.im]);
        out.active = describing.stiffness != c64::new(self.stiffness, 0.0);
        if tangent {
            let turn =
                if u.norm() > 0.0 { describing.slope * u / u.norm() } else { c64::new(0.0, 0.0) };
            let [by_p, by_s] = [loss - turn * u.re, -c64::i() * loss + turn * u.im];
            out.tangent.copy_from_slice(&[by_p.re, by_s.re, -by_p.im, -by_s.im]);
        }
    }

    fn resolves(&self) -> usize {
        1
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        if let Some((u, describing)) = self.at(motion) {
            let dissipation = PI * describing.stiffness.im * u.norm_sqr();
            out[0] = PointSummary { slip_fraction: describing.slip_fraction, dissipation };
        }
    }

    of_the_law! {
        state_history(motion: Motion<'_>, samples: usize) -> Vec<f64>;
        force_history(motion: Motion<'_>, samples: usize) -> Vec<f64>;
        phases(motion: Motion<'_>) -> Vec<Phase>;
        parameter_slope(motion: Motion<'_>, index: usize, out: &mut [f64]);
    }
}

impl ContactLaw for Described {
    of_the_law! {
        name() -> &'static str;
        displacements() -> usize;
        state_size() -> usize;
        stiffness() -> Mat<f64>;
        state_stiffness() -> Mat<f64>;
        is_odd() -> bool;
        is_monotone() -> bool;
        limits() -> Vec<f64>;
        planes() -> Vec<[usize; 2]>;
        grows() -> Vec<bool>;
        return_map(before: &[f64], after: &[f64], state: &mut [f64], force: &mut [f64],
            jacobian: Option<&mut ReturnMapJacobian>);
        with_scaled_stiffness(share: f64) -> Box<dyn ContactLaw>;
        with_scaled_forces(factor: f64) -> Box<dyn ContactLaw>;
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }
}
