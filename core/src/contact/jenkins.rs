//! The Jenkins element: a spring k_d in series with a slider of limit F_d.
//!
//! It is the stop operator `f_j = clip(f_{j−1} + k_d Δu, ±F_d)` (Guillen 1999, Table 3.1,
//! corrected: the printed update never unloads). Here it is followed from event to event: between
//! the turning points of u, each located exactly, the element sticks, or sticks and then slips.
//! The Fourier integrals over the intervals are exact, so that no sampling error enters, and
//! their derivative is exact with them: f is continuous, hence moving interval ends add nothing.

use super::cycle::{Cycle, Slip, Stick};
use super::{
    scalar, Describing, FrictionLaw, Motion, Parameter, Parameters, PointState, PointSummary,
    Residual, SlipLoad,
};
use crate::fourier::{Harmonics, IntervalSums};
use crate::Error;
use faer::Mat;
use std::f64::consts::PI;

/// Elastic, perfectly plastic friction element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jenkins {
    pub(super) stiffness: f64,
    pub(super) slip_force: f64,
}

impl Jenkins {
    /// An element of stiffness k_d [N/m] and slip force F_d [N]; an infinite slip force never
    /// slips.
    ///
    /// # Errors
    /// Negative or NaN parameters, infinite stiffness.
    pub fn new(stiffness: f64, slip_force: f64) -> Result<Self, Error> {
        if !(stiffness.is_finite() && stiffness >= 0.0) {
            return Err(Error::value(
                "jenkins: stiffness",
                stiffness,
                "must be finite and not negative; take about 1000 times the local stiffness of the structure for a rigid damper",
            ));
        }
        if slip_force.is_nan() || slip_force < 0.0 {
            return Err(Error::value(
                "jenkins: slip_force",
                slip_force,
                "must not be negative; infinity means that the contact never slips",
            ));
        }
        Ok(Self { stiffness, slip_force })
    }

    pub(super) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        Self::new(
            scalar("jenkins", parameters, "stiffness")?,
            scalar("jenkins", parameters, "slip_force")?,
        )
    }

    /// Slip load of a stuck contact and its derivatives in the middle and in half the range of u.
    fn held_load(&self, residual: Residual, middle: f64, half_range: f64) -> (f64, f64, f64) {
        let k = self.stiffness;
        let (wanted, wanted_slope) = match residual {
            Residual::Centred => (0.0, 0.0),
            Residual::FromRest => (k * middle, k),
            Residual::Value(force) => (force, 0.0),
        };
        let room = self.slip_force - k * half_range;
        if wanted.abs() <= room {
            (k * middle - wanted, k - wanted_slope, 0.0)
        } else {
            (k * middle - room.copysign(wanted), k, k.copysign(wanted))
        }
    }
}

impl FrictionLaw for Jenkins {
    fn points(&self) -> usize {
        1
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.stiffness)
    }

    fn softened(&self, share: f64) -> Box<dyn FrictionLaw> {
        Box::new(Self { stiffness: share * self.stiffness, ..*self })
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        out.reset(size, tangent);
        let k = self.stiffness;
        match Cycle::new(motion, self.stiffness, self.slip_force) {
            Cycle::Free => {
                for (i, u) in motion.displacement.iter().enumerate() {
                    out.value[i] = k * u;
                    if tangent {
                        out.tangent[i * size + i] = k;
                    }
                }
                out.active = k > 0.0;
            }
            Cycle::Stuck { crest, trough } => {
                if !harmonics.has_mean() {
                    return;
                }
                let middle = 0.5 * (crest.value + trough.value);
                let half_range = 0.5 * (crest.value - trough.value);
                let (load, by_middle, by_range) =
                    self.held_load(motion.residual, middle, half_range);
                out.value[0] = load;
                out.active = by_middle != 0.0 || by_range != 0.0;
                if tangent && out.active {
                    let (mut high, mut low) = (vec![0.0; size], vec![0.0; size]);
                    harmonics.basis(crest.theta, &mut high);
                    harmonics.basis(trough.theta, &mut low);
                    for (j, slope) in out.tangent[..size].iter_mut().enumerate() {
                        *slope =
                            0.5 * (by_middle * (high[j] + low[j]) + by_range * (high[j] - low[j]));
                    }
                }
            }
            Cycle::Slipping { sticks, slips } => {
                out.active = true;
                let weight = 2.0 / harmonics.span();
                let SlipLoad { value, tangent: matrix, .. } = out;
                let union = union_of(&slips, harmonics);
                union.products(harmonics, weight * k, |i, j, v| {
                    value[i] += v * motion.displacement[j];
                    if tangent {
                        matrix[i * size + j] = v;
                    }
                });
                let ends = StickEnds::new(harmonics, &sticks);
                self.add_constants(&ends, &sticks, &slips, weight, value);
                if tangent {
                    ends.add_anchors(harmonics, sticks.len(), k * weight, matrix);
                }
                halve_mean_row(harmonics, size, out, tangent);
            }
        }
    }

    fn stuck_load(&self, residual: Residual, low: f64, high: f64) -> Option<[f64; 3]> {
        let sticks = self.stiffness * (high - low) <= 2.0 * self.slip_force;
        if !sticks || self.slip_force == 0.0 || self.stiffness == 0.0 {
            return None;
        }
        let (load, by_middle, by_range) =
            self.held_load(residual, 0.5 * (low + high), 0.5 * (high - low));
        Some([load, 0.5 * (by_middle - by_range), 0.5 * (by_middle + by_range)])
    }

    fn describing(&self, amplitude: f64) -> Option<Describing> {
        Some(Describing::of_jenkins(self.stiffness, self.slip_force, amplitude))
    }

    fn advance(&self, du: &[f64], force: &mut [f64], gain: Option<&mut [f64]>) {
        let trial = force[0] + self.stiffness * du[0];
        force[0] = trial.clamp(-self.slip_force, self.slip_force);
        if let Some(gain) = gain {
            gain[0] = f64::from(u8::from(trial == force[0]));
        }
    }

    fn limits(&self) -> Vec<f64> {
        vec![if self.stiffness == 0.0 { 0.0 } else { self.slip_force }]
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        let sticks = points[0] == PointState::Stuck && self.slip_force > 0.0;
        Mat::from_fn(1, 1, |_, _| if sticks { self.stiffness } else { 0.0 })
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| points[0].sign().abs())
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        let span = motion.table.harmonics().span();
        out[0] = match Cycle::new(motion, self.stiffness, self.slip_force) {
            Cycle::Free => PointSummary {
                slip_fraction: f64::from(u8::from(self.slip_force == 0.0)),
                dissipation: 0.0,
            },
            Cycle::Stuck { .. } => PointSummary::default(),
            Cycle::Slipping { slips, .. } => {
                let length: f64 = slips.iter().map(|slip| slip.end - slip.start).sum();
                let travel: f64 = slips.iter().map(|slip| slip.travel).sum();
                PointSummary {
                    slip_fraction: length / span,
                    dissipation: self.slip_force * travel * 2.0 * PI / span,
                }
            }
        };
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let k = self.stiffness;
        let cycle = Cycle::new(motion, self.stiffness, self.slip_force);
        (0..samples)
            .map(|n| {
                let theta = 2.0 * PI * n as f64 / samples as f64;
                let u = harmonics.jet(motion.displacement, theta)[0];
                match &cycle {
                    Cycle::Free => 0.0,
                    Cycle::Stuck { crest, trough } => {
                        let middle = 0.5 * (crest.value + trough.value);
                        let half_range = 0.5 * (crest.value - trough.value);
                        k * u - self.held_load(motion.residual, middle, half_range).0
                    }
                    Cycle::Slipping { sticks, slips } => {
                        let span = harmonics.span();
                        let start = sticks[0].start;
                        let turns = ((theta - start) / span).floor();
                        let folded = theta - turns * span;
                        let mirror = harmonics.half_wave() && turns.rem_euclid(2.0) != 0.0;
                        let sign = if mirror { -1.0 } else { 1.0 };
                        sign * self.force_at(sticks, slips, folded, sign * u)
                    }
                }
            })
            .collect()
    }

    fn parameters(&self) -> Vec<Parameter> {
        vec![Parameter::stiffness(self.stiffness), Parameter::slip_force(0, self.slip_force)]
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn FrictionLaw>, Error> {
        Ok(Box::new(match index {
            0 => Self::new(value, self.slip_force)?,
            _ => Self::new(self.stiffness, value)?,
        }))
    }

    fn magnified(&self, factor: f64) -> Box<dyn FrictionLaw> {
        Box::new(Self { slip_force: factor * self.slip_force, ..*self })
    }

    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        match index {
            0 => self.stiffness_slope(motion, out),
            _ => self.slip_force_slope(motion, out),
        }
    }
}

impl Jenkins {
    /// Integrals of the constant parts: the slip load of each stick interval, and `−(±F_d)` of
    /// each slip interval, which lies between two of them.
    fn add_constants(
        &self,
        ends: &StickEnds,
        sticks: &[Stick],
        slips: &[Slip],
        weight: f64,
        out: &mut [f64],
    ) {
        for (index, stick) in sticks.iter().enumerate() {
            let constant = weight * stick.slip_load;
            add_difference(ends.of(2 * index + 1), ends.of(2 * index), constant, out);
        }
        for (index, slip) in slips.iter().enumerate() {
            let constant = -weight * slip.sign * self.slip_force;
            add_difference(ends.of(2 * index + 2), ends.of(2 * index + 1), constant, out);
        }
    }

    /// Force at an angle inside the span that the intervals cover.
    fn force_at(&self, sticks: &[Stick], slips: &[Slip], theta: f64, u: f64) -> f64 {
        if let Some(slip) = slips.iter().find(|s| theta >= s.start && theta < s.end) {
            return slip.sign * self.slip_force;
        }
        let stick = sticks.iter().find(|s| theta >= s.start && theta <= s.end);
        let load = stick.or(sticks.last()).map_or(0.0, |s| s.slip_load);
        (self.stiffness * u - load).clamp(-self.slip_force, self.slip_force)
    }
}

/// Basis integrals over intervals, from the antiderivatives at their two ends.
pub(super) struct Bounds {
    /// Antiderivatives at the start and, behind them, at the end.
    ends: Vec<f64>,
}

impl Bounds {
    pub(super) fn new(harmonics: &Harmonics) -> Self {
        Self { ends: vec![0.0; 2 * harmonics.slots()] }
    }

    /// Adds `factor ∫ basis dθ` to `out`.
    pub(super) fn add_integral(
        &mut self,
        harmonics: &Harmonics,
        start: f64,
        end: f64,
        factor: f64,
        out: &mut [f64],
    ) {
        let (from, to) = self.ends.split_at_mut(harmonics.slots());
        harmonics.antiderivative(start, from);
        harmonics.antiderivative(end, to);
        for ((out, start), end) in out.iter_mut().zip(&*from).zip(&*to) {
            *out += factor * (end - start);
        }
    }
}

/// Antiderivatives of the basis at the start and the end of each stick interval, in turn.
struct StickEnds {
    size: usize,
    values: Vec<f64>,
}

impl StickEnds {
    fn new(harmonics: &Harmonics, sticks: &[Stick]) -> Self {
        let size = harmonics.slots();
        // Behind them, room for one integral and one basis.
        let mut values = vec![0.0; 2 * (sticks.len() + 1) * size];
        for (stick, ends) in sticks.iter().zip(values.chunks_exact_mut(2 * size)) {
            let (start, end) = ends.split_at_mut(size);
            harmonics.antiderivative(stick.start, start);
            harmonics.antiderivative(stick.end, end);
        }
        Self { size, values }
    }

    fn of(&self, end: usize) -> &[f64] {
        &self.values[end * self.size..(end + 1) * self.size]
    }

    /// Adds the rank-one change of every stick interval: its slip load follows the displacement
    /// of its anchor, where it starts. Leaving this history out breaks Newton's method.
    fn add_anchors(
        mut self,
        harmonics: &Harmonics,
        sticks: usize,
        weight: f64,
        tangent: &mut [f64],
    ) {
        let size = self.size;
        let (ends, rest) = self.values.split_at_mut(2 * sticks * size);
        let (integral, at_anchor) = rest.split_at_mut(size);
        for ends in ends.chunks_exact(2 * size) {
            let (start, end) = ends.split_at(size);
            integral.fill(0.0);
            add_difference(end, start, weight, integral);
            harmonics.differentiate(start, at_anchor);
            for (row, i) in tangent.chunks_exact_mut(size).zip(&*integral) {
                for (entry, j) in row.iter_mut().zip(&*at_anchor) {
                    *entry += i * j;
                }
            }
        }
    }
}

/// `out += factor (end − start)`.
fn add_difference(end: &[f64], start: &[f64], factor: f64, out: &mut [f64]) {
    for ((out, end), start) in out.iter_mut().zip(end).zip(start) {
        *out += factor * (end - start);
    }
}

/// Sums over all slip intervals.
pub(super) fn union_of(slips: &[Slip], harmonics: &Harmonics) -> IntervalSums {
    let mut sums = IntervalSums::new(harmonics);
    for slip in slips {
        sums.add(slip.start, slip.end);
    }
    sums
}

/// The mean of a series is its integral over the period, not twice that.
fn halve_mean_row(harmonics: &Harmonics, size: usize, out: &mut SlipLoad, tangent: bool) {
    if harmonics.has_mean() {
        out.value[0] *= 0.5;
        if tangent {
            out.tangent[..size].iter_mut().for_each(|entry| *entry *= 0.5);
        }
    }
}
