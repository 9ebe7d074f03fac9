//! Jenkins elements on one displacement: each a spring k_d in series with a slider of limit F_d.
//!
//! An element is the stop operator `f_j = clip(f_{j−1} + k_d Δu, ±F_d)` (Guillen 1999, Table 3.1,
//! corrected: the printed update never unloads). One alone is the Jenkins element; several in
//! parallel are the discrete Iwan model. Here they are followed from event to event: between the
//! turning points of u, each located exactly, an element sticks, or sticks and then slips. The
//! Fourier integrals over the intervals are exact, so that no sampling error enters, and their
//! derivative is exact with them: f is continuous, hence moving interval ends add nothing. Turning
//! points are common to all elements, so that the tangent has one term of rank one for each of them,
//! however many elements there are.

use super::cycle::{Cycle, Path, Slip, Stick};
use super::law::{Element, HarmonicForce, ReturnMapJacobian, SlipElement};
use super::registry::numbers;
use super::{
    ContactLaw, Describing, Motion, Parameter, Parameters, Phase, PointState, PointSummary,
    Residual, SlipLoad,
};
use crate::fourier::{Harmonics, IntervalSums};
use crate::Error;
use faer::Mat;
use std::f64::consts::TAU;
use std::sync::Arc;

/// One elastic, perfectly plastic element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slider {
    /// k_d [N/m].
    pub stiffness: f64,
    /// F_d [N].
    pub slip_force: f64,
}

/// Elastic, perfectly plastic elements in parallel, all on one displacement.
#[derive(Debug, Clone, PartialEq)]
pub struct Jenkins {
    pub(super) sliders: Vec<Slider>,
    /// The factor on the stiffness that the elements were built with: 1 of a single one.
    pub(super) factor: f64,
    /// The stiffness that they were built with.
    pub(super) unit: Vec<f64>,
}

impl Slider {
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

    /// Force that is beyond which the element slips: none of one without spring.
    fn limit(&self) -> f64 {
        if self.stiffness == 0.0 {
            0.0
        } else {
            self.slip_force
        }
    }

    /// Slip load of a stuck element and its derivatives in the middle and in half the range of u.
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

    fn summary(&self, cycle: &Cycle, span: f64) -> PointSummary {
        match cycle {
            Cycle::Free => PointSummary {
                slip_fraction: f64::from(u8::from(self.slip_force == 0.0)),
                dissipation: 0.0,
            },
            Cycle::Stuck => PointSummary::default(),
            Cycle::Slipping { slips, .. } => {
                let length: f64 = slips.iter().map(|slip| slip.end - slip.start).sum();
                let travel: f64 = slips.iter().map(|slip| slip.travel).sum();
                PointSummary {
                    slip_fraction: length / span,
                    dissipation: self.slip_force * travel * TAU / span,
                }
            }
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

impl SlipElement for Slider {
    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.stiffness)
    }

    fn limits(&self) -> Vec<f64> {
        vec![self.limit()]
    }

    fn tangent(&self, points: &[PointState]) -> Mat<f64> {
        let sticks = points[0] == PointState::Stuck && self.slip_force > 0.0;
        Mat::from_fn(1, 1, |_, _| if sticks { self.stiffness } else { 0.0 })
    }

    fn slip_rate(&self, points: &[PointState]) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| points[0].sign().abs())
    }

    fn increment(&self, du: &[f64], force: &mut [f64], gain: Option<&mut [f64]>) {
        let trial = force[0] + self.stiffness * du[0];
        force[0] = trial.clamp(-self.slip_force, self.slip_force);
        if let Some(gain) = gain {
            gain[0] = f64::from(u8::from(trial == force[0]));
        }
    }
}

impl Jenkins {
    /// One element; see [`Slider::new`].
    ///
    /// # Errors
    /// Negative or NaN parameters, infinite stiffness.
    pub fn new(stiffness: f64, slip_force: f64) -> Result<Self, Error> {
        Self::of(vec![Slider::new(stiffness, slip_force)?])
    }

    /// Elements in parallel.
    ///
    /// # Errors
    /// No element.
    pub fn of(sliders: Vec<Slider>) -> Result<Self, Error> {
        if sliders.is_empty() {
            return Err(Error::shape("jenkins: stiffness", "at least one number", 0));
        }
        let unit = sliders.iter().map(|slider| slider.stiffness).collect();
        Ok(Self { sliders, factor: 1.0, unit })
    }

    pub(super) fn from_parameters(parameters: &Parameters) -> Result<Self, Error> {
        let stiffness = numbers("jenkins", parameters, "stiffness")?;
        let slip_force = numbers("jenkins", parameters, "slip_force")?;
        if stiffness.len() != slip_force.len() {
            let expected = format!("{}, one per stiffness", stiffness.len());
            return Err(Error::shape("jenkins: slip_force", expected, slip_force.len()));
        }
        let sliders = stiffness.iter().zip(slip_force).map(|(k, f)| Slider::new(*k, *f));
        Self::of(sliders.collect::<Result<_, _>>()?)
    }

    fn total_stiffness(&self) -> f64 {
        self.sliders.iter().map(|slider| slider.stiffness).sum()
    }

    /// The mean over the elements, weighted by stiffness.
    fn weighted(&self, of: impl Fn(&Slider) -> f64) -> f64 {
        let total = self.total_stiffness();
        if self.sliders.len() == 1 || total == 0.0 {
            return of(&self.sliders[0]);
        }
        self.sliders.iter().map(|slider| slider.stiffness / total * of(slider)).sum()
    }

    fn cycles(&self, path: &Path<'_>) -> Vec<Cycle> {
        let cycle = |slider: &Slider| Cycle::new(path, slider.stiffness, slider.slip_force);
        self.sliders.iter().map(cycle).collect()
    }

    fn mapped(&self, change: impl Fn(&Slider) -> Slider, share: f64) -> Box<dyn ContactLaw> {
        Box::new(Self {
            sliders: self.sliders.iter().map(change).collect(),
            factor: self.factor,
            unit: self.unit.iter().map(|k| share * k).collect(),
        })
    }
}

impl ContactLaw for Jenkins {
    fn name(&self) -> &'static str {
        "jenkins"
    }

    fn displacements(&self) -> usize {
        1
    }

    fn state_size(&self) -> usize {
        self.sliders.len()
    }

    fn stiffness(&self) -> Mat<f64> {
        Mat::from_fn(1, 1, |_, _| self.total_stiffness())
    }

    fn state_stiffness(&self) -> Mat<f64> {
        Mat::from_fn(self.sliders.len(), 1, |i, _| self.sliders[i].stiffness)
    }

    fn is_odd(&self) -> bool {
        true
    }

    fn is_monotone(&self) -> bool {
        true
    }

    fn limits(&self) -> Vec<f64> {
        vec![self.sliders.iter().map(Slider::limit).sum()]
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        let du = [after[0] - before[0]];
        let count = self.sliders.len();
        let mut sticks = vec![0.0; count];
        for (i, slider) in self.sliders.iter().enumerate() {
            slider.increment(&du, &mut state[i..=i], Some(&mut sticks[i..=i]));
        }
        force[0] = state.iter().sum();
        let Some(jacobian) = jacobian else { return };
        jacobian.reset(1, count);
        for (i, slider) in self.sliders.iter().enumerate() {
            jacobian.by_state[i * count + i] = sticks[i];
            jacobian.by_after[i] = sticks[i] * slider.stiffness;
            jacobian.by_before[i] = -jacobian.by_after[i];
            jacobian.force_by_state[i] = 1.0;
        }
        let slips = self.sliders.iter().zip(&sticks).map(|(slider, sticks)| (slider, 1.0 - sticks));
        let total = self.total_stiffness();
        jacobian.slipping[0] = if count == 1 || total == 0.0 {
            1.0 - sticks[0]
        } else {
            slips.map(|(slider, slips)| slider.stiffness / total * slips).sum()
        };
    }

    fn stuck_load(&self, residual: Residual, low: f64, high: f64) -> Option<[f64; 3]> {
        let (middle, half_range) = (0.5 * (low + high), 0.5 * (high - low));
        let mut sum = [0.0; 3];
        for slider in &self.sliders {
            let sticks = slider.stiffness * (high - low) <= 2.0 * slider.slip_force;
            if !sticks || slider.slip_force == 0.0 || slider.stiffness == 0.0 {
                return None;
            }
            let (load, by_middle, by_range) = slider.held_load(residual, middle, half_range);
            let terms = [load, 0.5 * (by_middle - by_range), 0.5 * (by_middle + by_range)];
            sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        Some(sum)
    }

    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        self.mapped(|slider| Slider { stiffness: share * slider.stiffness, ..*slider }, share)
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        self.mapped(|slider| Slider { slip_force: factor * slider.slip_force, ..*slider }, 1.0)
    }

    fn parameters(&self) -> Vec<Parameter> {
        let stiffness = match &self.sliders[..] {
            [one] => Parameter::stiffness(one.stiffness),
            _ => Parameter { factor: true, ..Parameter::stiffness(self.factor) },
        };
        let limits = self.sliders.iter().enumerate();
        let limits = limits.map(|(point, slider)| Parameter::slip_force(point, slider.slip_force));
        std::iter::once(stiffness).chain(limits).collect()
    }

    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let mut changed = self.clone();
        match (index, &mut changed.sliders[..]) {
            (0, [one]) => return Ok(Box::new(Self::new(value, one.slip_force)?)),
            (0, several) => {
                for (slider, unit) in several.iter_mut().zip(&self.unit) {
                    *slider = Slider::new(value * unit, slider.slip_force)?;
                }
                changed.factor = value;
            }
            (_, several) => {
                let slider = &mut several[index - 1];
                *slider = Slider::new(slider.stiffness, value)?;
            }
        }
        Ok(Box::new(changed))
    }

    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        Some(self)
    }

    fn parts(&self) -> Vec<Box<dyn ContactLaw>> {
        if self.sliders.len() == 1 {
            return Vec::new();
        }
        let alone = |(slider, unit): (&Slider, &f64)| -> Box<dyn ContactLaw> {
            Box::new(Self { sliders: vec![*slider], factor: 1.0, unit: vec![*unit] })
        };
        self.sliders.iter().zip(&self.unit).map(alone).collect()
    }

    fn elements(&self) -> Option<Vec<Element>> {
        let element = |slider: &Slider| Element { components: vec![0], law: Arc::new(*slider) };
        Some(self.sliders.iter().map(element).collect())
    }

    fn describing(&self, amplitude: f64) -> Option<Describing> {
        let of = |slider: &Slider| {
            Describing::of_jenkins(slider.stiffness, slider.slip_force, amplitude)
        };
        let sum = |part: fn(Describing) -> faer::c64| {
            self.sliders.iter().map(|slider| part(of(slider))).sum()
        };
        Some(Describing {
            stiffness: sum(|one| one.stiffness),
            slope: sum(|one| one.slope),
            slip_fraction: self.weighted(|slider| of(slider).slip_fraction),
        })
    }
}

impl HarmonicForce for Jenkins {
    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        out.reset(size, tangent);
        let path = Path::new(motion);
        let cycles = self.cycles(&path);
        if cycles.iter().any(|cycle| matches!(cycle, Cycle::Slipping { .. })) {
            out.active = true;
            self.add_slipping(motion, &path, &cycles, tangent, out);
        }
        for (slider, cycle) in self.sliders.iter().zip(&cycles) {
            match cycle {
                Cycle::Free => add_free(slider.stiffness, motion, tangent, out),
                Cycle::Stuck if harmonics.has_mean() => {
                    slider.add_stuck(motion, &path, tangent, out);
                }
                _ => {}
            }
        }
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        let (path, span) = (Path::new(motion), motion.table.harmonics().span());
        let of = |slider: &Slider| {
            slider.summary(&Cycle::new(&path, slider.stiffness, slider.slip_force), span)
        };
        out[0] = PointSummary {
            slip_fraction: self.weighted(|slider| of(slider).slip_fraction),
            dissipation: self.sliders.iter().map(|slider| of(slider).dissipation).sum(),
        };
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let harmonics = motion.table.harmonics();
        let path = Path::new(motion);
        let cycles = self.cycles(&path);
        let (middle, half_range) = (path.middle(), path.half_range());
        let mut history = Vec::with_capacity(samples * self.sliders.len());
        for n in 0..samples {
            let theta = TAU * n as f64 / samples as f64;
            let u = harmonics.jet(motion.displacement, theta)[0];
            for (slider, cycle) in self.sliders.iter().zip(&cycles) {
                history.push(match cycle {
                    Cycle::Free => 0.0,
                    Cycle::Stuck => {
                        let load = slider.held_load(motion.residual, middle, half_range).0;
                        slider.stiffness * u - load
                    }
                    Cycle::Slipping { sticks, slips } => {
                        let span = harmonics.span();
                        let turns = ((theta - sticks[0].start) / span).floor();
                        let folded = theta - turns * span;
                        let mirror = harmonics.half_wave() && turns.rem_euclid(2.0) != 0.0;
                        let sign = if mirror { -1.0 } else { 1.0 };
                        sign * slider.force_at(sticks, slips, folded, sign * u)
                    }
                });
            }
        }
        history
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let states = self.state_history(motion, samples);
        states.chunks_exact(self.sliders.len()).map(|forces| forces.iter().sum()).collect()
    }

    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        Phase::from_forces(&self.force_history(motion, Phase::INSTANTS), &self.limits())
    }

    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        out.fill(0.0);
        let path = Path::new(motion);
        match index {
            0 => {
                let mut slope = vec![0.0; out.len()];
                for (slider, unit) in self.sliders.iter().zip(&self.unit) {
                    slope.fill(0.0);
                    slider.stiffness_slope(motion, &path, &mut slope);
                    let weight = if self.sliders.len() == 1 { 1.0 } else { *unit };
                    out.iter_mut().zip(&slope).for_each(|(out, slope)| *out += weight * slope);
                }
            }
            _ => self.sliders[index - 1].slip_force_slope(motion, &path, out),
        }
    }
}

impl Jenkins {
    /// Adds the exact integrals of the elements that slip: `k_d u ∓ F_d` while an element slips, the
    /// slip load of its last turning point while it sticks.
    fn add_slipping(
        &self,
        motion: Motion<'_>,
        path: &Path<'_>,
        cycles: &[Cycle],
        tangent: bool,
        out: &mut SlipLoad,
    ) {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        let weight = 2.0 / harmonics.span();
        let mut turns = Turns::new(harmonics, path, tangent);
        let mut sums = IntervalSums::new(harmonics);
        let mut at_end = vec![0.0; size];
        for (slider, cycle) in self.sliders.iter().zip(cycles) {
            let Cycle::Slipping { sticks, slips } = cycle else { continue };
            let k = slider.stiffness;
            for (index, stick) in sticks.iter().enumerate() {
                // The last interval ends at the last turning point, without slip behind it.
                let slip = slips.get(index);
                let end = if slip.is_some() {
                    harmonics.antiderivative(stick.end, &mut at_end);
                    &at_end[..]
                } else {
                    turns.last()
                };
                add_difference(
                    end,
                    turns.antiderivative(stick.anchor),
                    weight * stick.slip_load,
                    &mut out.value,
                );
                if tangent {
                    turns.anchor(stick.anchor, slip.map(|_| &at_end[..]), k * weight);
                }
                let Some(slip) = slip else { continue };
                let constant = -weight * slip.sign * slider.slip_force;
                add_difference(turns.antiderivative(slip.turn), &at_end, constant, &mut out.value);
                sums.add_end(slip.start, -k);
                turns.slipping[slip.turn] += k;
            }
        }
        for (turn, k) in path.turns.iter().zip(&turns.slipping).filter(|(_, k)| **k > 0.0) {
            sums.add_end(turn.theta, *k);
        }
        let SlipLoad { value, tangent: matrix, .. } = out;
        sums.products(harmonics, weight, |i, j, v| {
            value[i] += v * motion.displacement[j];
            if tangent {
                matrix[i * size + j] = v;
            }
        });
        if tangent {
            turns.add_anchors(harmonics, matrix);
        }
        halve_mean_row(harmonics, size, out, tangent);
    }
}

impl Slider {
    /// Adds the mean slip load of an element that never slips.
    fn add_stuck(&self, motion: Motion<'_>, path: &Path<'_>, tangent: bool, out: &mut SlipLoad) {
        let harmonics = motion.table.harmonics();
        let size = harmonics.slots();
        let (load, by_middle, by_range) =
            self.held_load(motion.residual, path.middle(), path.half_range());
        out.value[0] += load;
        if by_middle == 0.0 && by_range == 0.0 {
            return;
        }
        out.active = true;
        if tangent {
            let (mut high, mut low) = (vec![0.0; size], vec![0.0; size]);
            harmonics.basis(path.crest.theta, &mut high);
            harmonics.basis(path.trough.theta, &mut low);
            for (j, slope) in out.tangent[..size].iter_mut().enumerate() {
                *slope += 0.5 * (by_middle * (high[j] + low[j]) + by_range * (high[j] - low[j]));
            }
        }
    }
}

/// Adds the slip load of an element without friction, `k_d u`.
fn add_free(k: f64, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
    let size = motion.displacement.len();
    for (i, u) in motion.displacement.iter().enumerate() {
        out.value[i] += k * u;
        if tangent {
            out.tangent[i * size + i] += k;
        }
    }
    out.active |= k > 0.0;
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

/// What the turning points of a path gather from all elements.
struct Turns {
    size: usize,
    /// Antiderivatives of the basis at the turning points.
    antiderivatives: Vec<f64>,
    /// Integrals over the stick intervals that begin at a turning point, by stiffness.
    anchored: Vec<f64>,
    /// Stiffness of the elements that slip up to the turning point.
    slipping: Vec<f64>,
}

impl Turns {
    fn new(harmonics: &Harmonics, path: &Path<'_>, tangent: bool) -> Self {
        let (size, count) = (harmonics.slots(), path.turns.len());
        let mut antiderivatives = vec![0.0; count * size];
        for (turn, out) in path.turns.iter().zip(antiderivatives.chunks_exact_mut(size)) {
            harmonics.antiderivative(turn.theta, out);
        }
        let anchored = vec![0.0; if tangent { count * size } else { 0 }];
        Self { size, antiderivatives, anchored, slipping: vec![0.0; count] }
    }

    fn antiderivative(&self, turn: usize) -> &[f64] {
        &self.antiderivatives[turn * self.size..(turn + 1) * self.size]
    }

    fn last(&self) -> &[f64] {
        self.antiderivative(self.slipping.len() - 1)
    }

    /// Notes a stick interval from a turning point to where the antiderivatives are `end`, or to the
    /// last turning point: its slip load follows the displacement there. Leaving this history out
    /// breaks Newton's method.
    fn anchor(&mut self, turn: usize, end: Option<&[f64]>, factor: f64) {
        let (size, last) = (self.size, self.slipping.len() - 1);
        let end = end.unwrap_or(&self.antiderivatives[last * size..]);
        let start = &self.antiderivatives[turn * size..(turn + 1) * size];
        add_difference(end, start, factor, &mut self.anchored[turn * size..(turn + 1) * size]);
    }

    /// Adds the change of rank one of every turning point at which an interval begins.
    fn add_anchors(&self, harmonics: &Harmonics, tangent: &mut [f64]) {
        let mut basis = vec![0.0; self.size];
        let turns = self.anchored.chunks_exact(self.size);
        for (turn, integral) in turns.enumerate() {
            if integral.iter().all(|entry| *entry == 0.0) {
                continue;
            }
            harmonics.differentiate(self.antiderivative(turn), &mut basis);
            for (row, i) in tangent.chunks_exact_mut(self.size).zip(integral) {
                for (entry, j) in row.iter_mut().zip(&basis) {
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

/// The mean of a series is its integral over the period, not twice that.
fn halve_mean_row(harmonics: &Harmonics, size: usize, out: &mut SlipLoad, tangent: bool) {
    if harmonics.has_mean() {
        out.value[0] *= 0.5;
        if tangent {
            out.tangent[..size].iter_mut().for_each(|entry| *entry *= 0.5);
        }
    }
}
