//! The sampled evaluation of a law: alternating frequency and time (Cameron and Griffin 1989;
//! Guillen 1999, section 3.2).
//!
//! The displacements are sampled at equidistant instants, the law's return map takes its state from
//! instant to instant until it repeats, and a discrete Fourier transform leads back. The error is
//! of second order in the distance of the samples. It serves laws that have no closed form, and
//! comparisons with those that have one.

use super::samples::Samples;
use crate::contact::law::HarmonicForce;
use crate::contact::return_map::ReturnMapJacobian;
use crate::contact::{
    AssumedStart, ContactLaw, Describing, Element, Held, Motion, Parameter, Phase, PointSummary,
    Residual, SlipLoad, Unslipped,
};
use crate::fourier::Harmonics;
use crate::Error;
use faer::Mat;
use std::ops::Deref;

/// Fewest samples: a coarser grid shows no hysteresis loop.
const FEWEST: usize = 8;
/// Most samples: as many as memory holds with ease.
const MOST: usize = 1 << 20;
/// Samples per period where nothing controls their error.
const UNCONTROLLED: usize = 1024;
/// Difference of two forces, relative to them, that counts as none.
const ROUNDING: f64 = 1e-12;
/// Step of differences in a parameter, relative to it.
const DIFFERENCE: f64 = 1e-5;

/// A law that is evaluated through a fixed number of samples per period.
#[derive(Debug)]
pub struct Aft<L> {
    pub(super) law: L,
    pub(super) samples: usize,
}

impl Aft<Box<dyn ContactLaw>> {
    /// A law evaluated at `samples` instants per period.
    ///
    /// # Errors
    /// An odd or too small number of samples.
    pub fn new(law: Box<dyn ContactLaw>, samples: usize) -> Result<Self, Error> {
        if !(FEWEST..=MOST).contains(&samples) || samples % 2 == 1 {
            let remedy = format!("must be an even number from {FEWEST} to {MOST}");
            return Err(Error::value("samples", samples as f64, &remedy));
        }
        Ok(Self { law, samples })
    }
}

impl<L: Deref<Target: ContactLaw>> HarmonicForce for Aft<L> {
    fn resolves(&self) -> usize {
        self.samples / 2 - 1
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let (slots, count) = (harmonics.slots(), self.law.displacements());
        let known = out.repeated.take();
        out.reset(count * slots, tangent && (self.is_sum() || !out.spares_zeros));
        let mut own = SlipLoad::default();
        for part in self.parts() {
            part.slip_load(motion, tangent, &mut own);
            out.value.iter_mut().zip(&own.value).for_each(|(sum, own)| *sum += own);
            out.tangent.iter_mut().zip(&own.tangent).for_each(|(sum, own)| *sum += own);
            out.active |= own.active;
            out.rounds += own.rounds;
            out.derived += own.derived;
        }
        if self.is_sum() {
            return;
        }
        let mut sampled = None;
        if let Some(known) = known {
            let samples = sampled.insert(Samples::of(motion, self.samples));
            let round = self.resume(samples, &known);
            if round.is_some_and(|round| self.write(samples, &round, [tangent, true], slots, out)) {
                return out.halve_means(harmonics);
            }
        }
        // Of several displacements the start is known whether they slip or not.
        let begun = (count > 1).then(|| self.begin(motion));
        if let Some(lost) = begun.as_ref().and_then(|begun| self.surely_unslipped(motion, begun)) {
            return keep(lost, harmonics, tangent, out);
        }
        let samples = sampled.unwrap_or_else(|| Samples::of(motion, self.samples));
        if let Some((load, ends)) = self.stuck(&samples, motion.residual) {
            if harmonics.has_mean() {
                out.value[0] = load;
                out.active = ends.iter().any(|(_, slope)| *slope != 0.0);
                out.make_room(tangent && out.active);
                for (n, slope) in ends.into_iter().filter(|_| tangent && out.active) {
                    let row = out.tangent.iter_mut().zip(samples.basis(n));
                    row.for_each(|(entry, b)| *entry += slope * b);
                }
            }
            return;
        }
        let begun = begun.unwrap_or_else(|| self.begin(motion));
        if let Some(lost) = self.unslipped(&samples, &begun) {
            return keep(lost, harmonics, tangent, out);
        }
        let round = self.march(&samples, &begun);
        out.rounds = round.restarts.len();
        if !round.slipped {
            // What a law holds without displacement, as behind a gap, is all there is.
            let stiffness = self.law.stiffness();
            for i in (0..count).filter(|_| harmonics.has_mean()) {
                let u = samples.at(0);
                let stuck: f64 = (0..count).map(|j| stiffness[(i, j)] * u[j]).sum();
                let q = stuck - round.force[i];
                if q.abs() > ROUNDING * stuck.abs() {
                    out.value[i * slots] = q;
                }
            }
            return;
        }
        if !self.write(&samples, &round, [tangent, false], slots, out) {
            out.make_room(true);
            self.differentiate(&samples, &begun, &round.restarts, slots, &mut out.tangent);
            out.derived = out.rounds;
        }
        out.halve_means(harmonics);
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        out.fill(PointSummary::default());
        let total = self.law.stiffness();
        let mut own = out.to_vec();
        for part in self.parts() {
            part.summary(motion, &mut own);
            let stiffness = part.law.stiffness();
            for (i, (sum, own)) in out.iter_mut().zip(&own).enumerate() {
                sum.slip_fraction += stiffness[(i, i)] / total[(i, i)] * own.slip_fraction;
                sum.dissipation += own.dissipation;
            }
        }
        if self.is_sum() {
            return;
        }
        let begun = self.begin(motion);
        if self.surely_unslipped(motion, &begun).is_some() {
            return;
        }
        let samples = Samples::of(motion, self.samples);
        let sticks = self.stuck(&samples, motion.residual).is_some();
        if sticks || self.unslipped(&samples, &begun).is_some() {
            return;
        }
        let round = self.march(&samples, &begun);
        let [slipping, work] = self.account(&samples, &round);
        let spans = (self.samples / samples.count) as f64;
        // Without slip all work is elastic, and only rounding is left of it.
        let slips = slipping.iter().any(|share| *share > 0.0);
        for (i, summary) in out.iter_mut().enumerate().filter(|_| slips) {
            summary.slip_fraction = slipping[i] / samples.count as f64;
            summary.dissipation = spans * work[i];
        }
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        self.history(motion, samples).0
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        self.history(motion, samples).1
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        Phase::from_forces(&self.force_history(motion, Phase::INSTANTS), &self.law.limits())
    }

    /// By central differences: a march has no derivative in a parameter that would serve all laws.
    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        let parameters = self.law.parameters();
        let Parameter { name, value, factor, .. } = parameters[index];
        // What is zero has the scale of the motion, and of what the law has of its kind.
        let moved = motion.displacement.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        let is_force = |name: &str| name == Parameter::SLIP_FORCE || name == "preload";
        let forces = parameters.iter().filter(|own| is_force(own.name) && own.value.is_finite());
        let force = forces.fold(0.0, |most: f64, own| most.max(own.value.abs()));
        let stiffness = self.law.stiffness().norm_max().max(force / moved);
        let step = DIFFERENCE
            * match name {
                "gap" => value.abs().max(moved),
                _ if value != 0.0 => value.abs(),
                name if is_force(name) => moved * stiffness,
                name if name.ends_with("stiffness") && !factor && stiffness > 0.0 => stiffness,
                _ => 1.0,
            };
        if !(step > 0.0 && step.is_finite()) {
            return;
        }
        // At the edge of what the law takes the difference is to one side.
        let law_at = |at: f64| self.law.with_parameter(index, at).ok().map(|law| (law, at));
        let end = |at: f64| law_at(at).or_else(|| law_at(value));
        let (Some(above), Some(below)) = (end(value + 0.5 * step), end(value - 0.5 * step)) else {
            return out.fill(f64::NAN);
        };
        let slots = motion.table.harmonics().slots();
        let mut load = SlipLoad::default();
        let width = above.1 - below.1;
        for (law, weight) in [(above.0, width.recip()), (below.0, -width.recip())] {
            let law = Aft { law, samples: self.samples };
            law.slip_load(motion, false, &mut load);
            let stiffness = law.law.stiffness();
            for (i, series) in out.chunks_exact_mut(slots).enumerate() {
                for (slot, slope) in series.iter_mut().enumerate() {
                    let stuck: f64 = (0..self.law.displacements())
                        .map(|j| stiffness[(i, j)] * motion.displacement[j * slots + slot])
                        .sum();
                    *slope += weight * (stuck - load.value[i * slots + slot]);
                }
            }
        }
    }
}

/// Writes what slip takes off the stuck spring's force where nothing slips: it is constant.
fn keep(
    Unslipped { value, rate }: Unslipped,
    harmonics: &Harmonics,
    tangent: bool,
    out: &mut SlipLoad,
) {
    if !harmonics.has_mean() {
        return;
    }
    let (slots, size) = (harmonics.slots(), out.value.len());
    out.value.iter_mut().step_by(slots).zip(value).for_each(|(mean, q)| *mean = q);
    out.active = rate.iter().any(|rate| *rate != 0.0);
    out.make_room(tangent && out.active);
    let means = out.tangent.chunks_exact_mut(size).step_by(slots);
    means.zip(rate.chunks_exact(size)).for_each(|(row, rate)| row.copy_from_slice(rate));
}

/// Methods that a law which evaluates another one has from that.
macro_rules! of_the_law {
    ($($method:ident($($argument:ident: $type:ty),*) $(-> $returned:ty)?;)*) => {
        $(fn $method(&self, $($argument: $type),*) $(-> $returned)? {
            self.law.$method($($argument),*)
        })*
    };
}
pub(crate) use of_the_law;

impl ContactLaw for Aft<Box<dyn ContactLaw>> {
    of_the_law! {
        name() -> &'static str;
        displacements() -> usize;
        state_size() -> usize;
        stiffness() -> Mat<f64>;
        state_stiffness() -> Mat<f64>;
        is_odd() -> bool;
        is_monotone() -> bool;
        is_serial() -> bool;
        limits() -> Vec<f64>;
        planes() -> Vec<[usize; 2]>;
        grows() -> Vec<bool>;
        onsets() -> Vec<f64>;
        beginning() -> (Vec<f64>, Vec<f64>);
        assumed(motion: Motion<'_>) -> Option<AssumedStart>;
        held(motion: Motion<'_>) -> Vec<Option<Held>>;
        return_map(before: &[f64], after: &[f64], state: &mut [f64], force: &mut [f64],
            jacobian: Option<&mut ReturnMapJacobian>);
        stuck_load(residual: Residual, low: f64, high: f64) -> Option<[f64; 3]>;
        parameters() -> Vec<Parameter>;
        elements() -> Option<Vec<Element>>;
        loading() -> Option<crate::contact::LoadingCurve>;
        describing(amplitude: f64) -> Option<Describing>;
    }

    /// Where amplitudes show that the law slips; samples may pass over the last of it.
    fn surely_slips(&self, motion: Motion<'_>) -> Option<bool> {
        self.law.surely_slips(motion).filter(|slips| *slips)
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        let law = self.law.with_scaled_stiffness(share);
        Box::new(Self { law, samples: self.samples })
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        Box::new(Self { law: self.law.with_scaled_forces(factor), samples: self.samples })
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let law = self.law.with_parameter(index, value)?;
        Ok(Box::new(Self { law, samples: self.samples }))
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }
}

/// Evaluates a law by its own form, or by samples where there is none.
macro_rules! by_form_or_samples {
    ($($method:ident($($argument:ident: $type:ty),*) $(-> $returned:ty)?;)*) => {
        $(
            #[doc = concat!("See [`HarmonicForce::", stringify!($method), "`].")]
            pub fn $method(&self, $($argument: $type),*) $(-> $returned)? {
                match self.closed_form() {
                    Some(exact) => exact.$method($($argument),*),
                    None => Aft { law: self, samples: UNCONTROLLED }.$method($($argument),*),
                }
            }
        )*
    };
}

/// Every law has the harmonics of a periodic motion: by its closed form, or by samples.
impl dyn ContactLaw + '_ {
    by_form_or_samples! {
        slip_load(motion: Motion<'_>, tangent: bool, out: &mut SlipLoad);
        resolves() -> usize;
        summary(motion: Motion<'_>, out: &mut [PointSummary]);
        state_history(motion: Motion<'_>, samples: usize) -> Vec<f64>;
        force_history(motion: Motion<'_>, samples: usize) -> Vec<f64>;
        phases(motion: Motion<'_>) -> Vec<Phase>;
        parameter_slope(motion: Motion<'_>, index: usize, out: &mut [f64]);
    }
}
