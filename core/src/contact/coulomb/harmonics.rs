//! The harmonics of the Coulomb contact's force, from its cycle: exact, with exact derivatives.
//!
//! The tangential slip load is the scaled slider position, `q = s`. The normal one is
//! `k_n v − (N − balanced)`: constant while the contact is closed, and in addition
//! `N₀ + k_n v < 0` while it is open.

use super::circle::centre;
use super::constant::Constant;
use super::cycle::{Cycle, Response, State, Stretch};
use super::drive::Drive;
use super::grid::Grid;
use super::{period, play};
use crate::contact::law::{effort_of, HarmonicForce};
use crate::contact::slider_integrals::dot;
use crate::contact::{AssumedStart, Closure, ContactLaw as _, Coulomb, Held};
use crate::contact::{Motion, Phase, PointSummary, SlipLoad};
use std::f64::consts::TAU;

/// Share of the slip limit that the force of a first trace of a spring reaches.
const TRACE: f64 = 1e-8;

impl Coulomb {
    /// Whether the normal load varies with the motion.
    fn varies(&self) -> bool {
        !self.is_odd()
    }

    fn cycle(&self, drive: &Drive<'_>, motion: Motion<'_>, rates: bool) -> Cycle {
        if self.directions == 2 {
            return period::cycle(self, drive, motion.residual, rates);
        }
        let rest = self.tangential_stiffness * self.slider()[0];
        play::cycle(drive, motion.residual, rest, rates)
    }

    /// See [`crate::contact::residual`]. The normal displacement is that of the start of the period.
    pub(super) fn assumed_start(&self, motion: Motion<'_>) -> Option<AssumedStart> {
        let harmonics = motion.table.harmonics();
        let slots = harmonics.slots();
        if harmonics.half_wave() || self.friction * self.tangential_stiffness == 0.0 {
            return None;
        }
        let (count, size) = (self.displacements(), motion.displacement.len());
        let drive = Drive::new(self, motion, false);
        let rest = self.slider().map(|w| drive.stiffness * w);
        let mut rate = vec![0.0; count * size];
        let slider = if !motion.residual.follows_middle() {
            rest
        } else if self.directions == 1 {
            let ends = drive.extremes();
            for end in ends {
                let mut basis = vec![0.0; slots];
                harmonics.basis(end.theta, &mut basis);
                rate.iter_mut().zip(&basis).for_each(|(rate, b)| *rate += 0.5 * b);
            }
            let middle = 0.5 * (ends[0].value + ends[1].value);
            let [slider] = motion.residual.slider([middle], [rest[0]]);
            [slider, 0.0]
        } else {
            let (middle, by_pull) = centre(&drive, &Grid::new(&drive));
            for (own, by_pull) in rate.chunks_exact_mut(size).zip(by_pull.chunks(drive.columns())) {
                own[..2 * slots].copy_from_slice(&by_pull[..2 * slots]);
            }
            motion.residual.slider(middle, rest)
        };
        let mut displacement: Vec<f64> =
            slider[..self.directions].iter().map(|s| s / drive.stiffness).collect();
        if count > self.directions {
            let normal = size - slots;
            harmonics.basis(0.0, &mut rate[self.directions * size + normal..][..slots]);
            displacement.push(harmonics.jet(&motion.displacement[normal..], 0.0)[0]);
        }
        Some(AssumedStart { displacement, state: vec![0.0; self.directions], rate })
    }

    /// See [`crate::contact::ContactLaw::held`].
    pub(super) fn held_sliders(&self, motion: Motion<'_>) -> Vec<Option<Held>> {
        let mut held = vec![None; self.displacements()];
        let Some(assumed) = self.assumed_start(motion) else { return held };
        let drive = Drive::new(self, motion, self.varies());
        let cycle = self.cycle(&drive, motion, false);
        let stuck = |stretch: &Stretch| matches!(stretch.state, State::Stuck { .. });
        let Some(State::Stuck { slider, .. }) = cycle.stretches.first().map(|first| &first.state)
        else {
            return held;
        };
        if !cycle.stretches.iter().all(stuck) {
            return held;
        }
        let (k, rest) = (drive.stiffness, self.slider());
        let reach = self.friction * drive.at_rest.abs().max(drive.at(0.0).1[0].abs()) / k;
        for (i, held) in held.iter_mut().enumerate().take(self.directions) {
            let [low, high] = match self.directions {
                1 => play::room(&drive),
                _ => Grid::new(&drive).room(i),
            };
            let range = [low / k - rest[i], high / k - rest[i]];
            let (position, assumed) = (slider[i] / k - rest[i], assumed.displacement[i] - rest[i]);
            *held = Some(Held::new(position, assumed, range, reach));
        }
        if self.directions == 2 {
            let pushed = held.iter().flatten().any(|one| one.pushed);
            held.iter_mut().flatten().for_each(|one| one.pushed = pushed);
        }
        held
    }

    /// Writes the slip load of a cycle.
    fn write(&self, drive: &Drive<'_>, response: &Response, out: &mut SlipLoad) {
        let harmonics = drive.harmonics();
        let slots = harmonics.slots();
        let (tangential, size) = (drive.pull.len(), out.value.len());
        let width = drive.columns();
        out.active = response.moves || !response.open.is_empty();
        out.value[..tangential].copy_from_slice(&response.slider);
        let varies = drive.pressing.is_some();
        let normal = self.normal_stiffness.unwrap_or(0.0);
        if !out.tangent.is_empty() {
            let rows = out.tangent.chunks_exact_mut(size).zip(response.rate.chunks_exact(width));
            for (row, rate) in rows {
                let (pull, limit) = row.split_at_mut(tangential);
                let (by_pull, by_limit) = rate.split_at(tangential);
                pull.iter_mut().zip(by_pull).for_each(|(t, r)| *t = drive.stiffness * r);
                if varies {
                    let slope = self.friction * normal;
                    limit.iter_mut().zip(by_limit).for_each(|(t, r)| *t = slope * r);
                }
            }
        }
        if harmonics.has_mean() && size > tangential {
            out.value[tangential] += 2.0 * (self.balanced() - self.normal_at_rest());
        }
        if let Some(pressing) = drive.pressing.as_ref().filter(|_| !response.open.is_empty()) {
            for (i, products) in response.open.chunks_exact(slots).enumerate() {
                let row = tangential + i;
                out.value[row] += dot(products, &pressing.series);
                if !out.tangent.is_empty() {
                    let first = row * size + tangential;
                    let entries = out.tangent[first..first + slots].iter_mut();
                    entries.zip(products).for_each(|(entry, p)| *entry = normal * p);
                }
            }
        }
        out.halve_means(harmonics);
    }

    /// How K, `N₀ + k_n v` and the balanced part of N change with a parameter, and how M does.
    fn variation(&self, drive: &Drive<'_>, motion: Motion<'_>, index: usize) -> Variation {
        let slots = drive.harmonics().slots();
        let (tangential, normal) = motion.displacement.split_at(drive.pull.len());
        let mut by = Variation {
            pull: vec![0.0; tangential.len()],
            pressing: vec![0.0; drive.limit_columns()],
            limit: Vec::new(),
            balanced: 0.0,
        };
        let stiffness = self.normal_stiffness.unwrap_or(0.0);
        match index {
            0 => {
                let series = drive.pressing.as_ref().map(|pressing| pressing.series.clone());
                by.limit = series.unwrap_or_else(|| vec![drive.at_rest]);
            }
            1 => {
                let share = drive.stiffness / self.tangential_stiffness;
                by.pull.iter_mut().zip(tangential).for_each(|(by, u)| *by = share * u);
            }
            2 => match self.closure {
                Closure::Preload(_) => (by.pressing[0], by.balanced) = (1.0, 1.0),
                Closure::Gap(_) => by.pressing[0] = -stiffness,
            },
            _ => {
                by.pressing.iter_mut().zip(&normal[..slots]).for_each(|(n, v)| *n = *v);
                if let Closure::Gap(gap) = self.closure {
                    by.pressing[0] -= gap;
                }
            }
        }
        if index > 0 {
            by.limit = by.pressing.iter().map(|n| self.friction * n).collect();
        }
        by
    }

    /// Force per tangential stiffness of the first trace of it, which hardly slips where it is pressed.
    fn trace_of_spring(&self, motion: Motion<'_>, out: &mut [f64]) {
        let largest = |series: &[f64]| series.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
        let tangential = self.directions * motion.table.harmonics().slots();
        let (along, across) = motion.displacement.split_at(tangential);
        let normal = self.normal_stiffness.unwrap_or(0.0) * largest(across);
        let limit = self.friction * (self.normal_at_rest().abs() + normal);
        let stiffness = TRACE * limit / largest(along);
        out.fill(0.0);
        if !(stiffness > 0.0 && stiffness.is_finite()) {
            return;
        }
        let mut load = SlipLoad::default();
        Self { tangential_stiffness: stiffness, ..*self }.slip_load(motion, false, &mut load);
        let own = along.iter().zip(&load.value);
        out.iter_mut().zip(own).for_each(|(out, (u, q))| *out = u - q / stiffness);
    }

    /// Traction and `N₀ + k_n v` at equidistant instants.
    fn tractions(&self, motion: Motion<'_>, samples: usize) -> Vec<([f64; 2], f64)> {
        if let Some(constant) = Constant::of(self, motion) {
            let history = constant.traction_history(samples);
            return history.into_iter().map(|t| ([t, 0.0], self.normal_at_rest())).collect();
        }
        let drive = Drive::new(self, motion, self.varies());
        let cycle = self.cycle(&drive, motion, false);
        let at = |n: usize| {
            let theta = TAU * n as f64 / samples as f64;
            let (traction, _) = cycle.traction(&drive, theta);
            (traction, drive.at(theta).1[0])
        };
        (0..samples).map(at).collect()
    }
}

/// Adds the force of a spring at the first coefficients of a motion.
fn add_spring(stiffness: f64, motion: Motion<'_>, count: usize, out: &mut SlipLoad) {
    let size = out.value.len();
    for (i, u) in motion.displacement[..count].iter().enumerate() {
        out.value[i] += stiffness * u;
        if !out.tangent.is_empty() {
            out.tangent[i * size + i] += stiffness;
        }
    }
    out.active = true;
}

/// How what drives a contact changes with a parameter.
struct Variation {
    pull: Vec<f64>,
    pressing: Vec<f64>,
    limit: Vec<f64>,
    balanced: f64,
}

/// Time of a panel of slip in two directions that is solved for, as [`effort_of`], and of the derivatives of one of
/// the period that repeats \[ns\]. Measured with 3 to 63 harmonics, evaluations of contacts that slip, just so or
/// until they stick for good, are reckoned at 0.4 to 1.9 times their time.
const SOLVED: [f64; 3] = [3e3, 30.0, 0.0];
const RATE: [f64; 3] = [1e3, 60.0, 0.5];

impl HarmonicForce for Coulomb {
    /// In the plane every panel carries derivatives in all coefficients.
    fn effort(&self, slots: usize, load: &SlipLoad, tangent: bool) -> f64 {
        let coefficients = self.displacements() * slots;
        if self.directions == 1 {
            return effort_of([3e3, 100.0, 0.7], coefficients, tangent);
        }
        let solved = load.solved as f64 * effort_of(SOLVED, coefficients, false);
        let rates = if tangent { effort_of(RATE, coefficients, true) } else { 0.0 };
        effort_of([3e3, 180.0, 3.0], coefficients, tangent) + solved + load.panels as f64 * rates
    }

    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad) {
        out.reset(motion.displacement.len(), tangent);
        if let Some(constant) = Constant::of(self, motion) {
            return constant.slip_load(tangent, out);
        }
        let drive = Drive::new(self, motion, self.varies());
        let cycle = self.cycle(&drive, motion, tangent);
        self.write(&drive, &cycle.response(&drive, tangent), out);
        (out.panels, out.solved) = (cycle.panels(), cycle.solved);
        let left = self.tangential_stiffness - drive.stiffness;
        if left > 0.0 {
            add_spring(left, motion, drive.pull.len(), out);
        }
    }

    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]) {
        out.fill(PointSummary::default());
        if let Some(constant) = Constant::of(self, motion) {
            return constant.summary(out);
        }
        let drive = Drive::new(self, motion, self.varies());
        let cycle = self.cycle(&drive, motion, false);
        let (tangential, normal) = out.split_at_mut(self.directions);
        let open = cycle.summary(&drive, drive.stiffness, tangential);
        normal.fill(open);
    }

    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let tractions = self.tractions(motion, samples);
        tractions.iter().flat_map(|(traction, _)| traction[..self.directions].to_vec()).collect()
    }

    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
        let mut history = Vec::with_capacity(samples * self.displacements());
        for (traction, pressing) in self.tractions(motion, samples) {
            history.extend_from_slice(&traction[..self.directions]);
            if self.normal_stiffness.is_some() {
                history.push(pressing.max(0.0) - self.balanced());
            }
        }
        history
    }

    /// The normal component counts as slipping backward while the contact is open: its force is at
    /// its least.
    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        if let Some(constant) = Constant::of(self, motion) {
            return constant.phases(self.displacements());
        }
        let drive = Drive::new(self, motion, self.varies());
        self.cycle(&drive, motion, false).phases(&drive, self.displacements())
    }

    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        let harmonics = motion.table.harmonics();
        let slots = harmonics.slots();
        if let Some(constant) = Constant::of(self, motion).filter(|_| index < 3) {
            out.fill(0.0);
            return constant.parameter_slope(index, out);
        }
        if index == 1 && self.tangential_stiffness == 0.0 {
            return self.trace_of_spring(motion, out);
        }
        if index == 3 && !self.varies() && !harmonics.has_mean() {
            // What a normal load that varies does to friction is the same in both halves of the period.
            let (tangential, normal) = motion.displacement.split_at(out.len() - slots);
            out[..tangential.len()].fill(0.0);
            return out[tangential.len()..].copy_from_slice(normal);
        }
        // A vanishing normal stiffness is differentiated in as well.
        let drive = Drive::new(self, motion, self.varies() || index == 3);
        let response = self.cycle(&drive, motion, true).response(&drive, true);
        let by = self.variation(&drive, motion, index);
        let (tangential, width) = (drive.pull.len(), drive.columns());
        for (row, out) in out[..tangential].iter_mut().enumerate() {
            let (by_pull, by_limit) =
                response.rate[row * width..(row + 1) * width].split_at(tangential);
            let lost = by_pull.iter().zip(&by.pull).chain(by_limit.iter().zip(&by.limit));
            *out = -lost.map(|(rate, change)| rate * change).sum::<f64>();
        }
        if let Some(normal) = out.get_mut(tangential..tangential + slots) {
            normal.fill(0.0);
            for (row, products) in response.open.chunks_exact(slots).enumerate() {
                let open = products.iter().zip(&by.pressing).map(|(p, n)| p * n);
                normal[row] = -open.sum::<f64>();
            }
        }
        harmonics.halve_means(out);
        out.iter_mut().zip(&by.pull).for_each(|(out, u)| *out += u);
        if let Some(normal) = out.get_mut(tangential..tangential + slots) {
            normal.iter_mut().zip(&by.pressing).for_each(|(out, n)| *out += n);
            if harmonics.has_mean() {
                normal[0] -= by.balanced;
            }
        }
    }
}
