//! The periodic cycle of a Coulomb contact: stretches in which it is open, sticks or slips, and the
//! Fourier integrals over them.
//!
//! With the pull `K = k_t u`, the limit `M = μN` and the scaled slider position `s = k_t w`
//!
//! | | traction t | s |
//! |---|---|---|
//! | open | 0 | K |
//! | stuck | K − s | constant |
//! | slipping along e | M e | K − M e |
//!
//! so that the tangential slip load is s itself. The traction is continuous at all events: those that
//! move add nothing to derivatives.

use super::drive::Drive;
use super::panel::Panel;
use super::variation::RateIntegrals;
use crate::contact::slider_integrals::{dot, Bounds};
use crate::contact::{Phase, PointState, PointSummary};
use crate::fourier::IntervalSums;
use std::f64::consts::TAU;

/// What a contact does over a stretch of the period.
pub(super) enum State {
    Open,
    /// It sticks.
    Stuck {
        /// Scaled slider position.
        slider: [f64; 2],
        /// Its derivative in the coefficients of K and M, direction after direction, if wanted.
        rate: Vec<f64>,
    },
    /// It slips in the only direction that there is, with this sign; without friction the sign is 0.
    Along(f64),
    /// It slips in the plane.
    Turning(Box<Panel>),
}

/// A stretch of the period.
pub(super) struct Stretch {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) state: State,
}

/// One period, from any angle on.
pub(super) struct Cycle {
    pub(super) stretches: Vec<Stretch>,
    /// Numbers that its states are differentiated in.
    pub(super) columns: usize,
    /// Derivative of the slider's start, which are the last two of these numbers if there are so many.
    pub(super) start_rate: Option<Vec<f64>>,
    /// Whether slip in the plane was too sudden to be followed: its force is not known.
    pub(super) unresolved: bool,
    /// Panels solved for until it was found.
    pub(super) solved: usize,
}

/// Integrals of the slip load over the period, times 2 over its length, and their derivatives.
pub(super) struct Response {
    /// Of the tangential components.
    pub(super) slider: Vec<f64>,
    /// Their derivative in the coefficients of K and M, row by row, if wanted.
    pub(super) rate: Vec<f64>,
    /// Products of the basis while the contact is open; nothing if it never is.
    pub(super) open: Vec<f64>,
    /// Whether the slider ever moves.
    pub(super) moves: bool,
}

impl Cycle {
    /// A cycle without a past, differentiated in so many numbers.
    pub(super) fn new(stretches: Vec<Stretch>, columns: usize) -> Self {
        Self { stretches, columns, start_rate: None, unresolved: false, solved: 0 }
    }

    fn has(&self, of: impl Fn(&State) -> bool) -> bool {
        self.stretches.iter().any(|stretch| of(&stretch.state))
    }

    /// Panels of slip in two directions.
    pub(super) fn panels(&self) -> usize {
        let turning = |stretch: &&Stretch| matches!(stretch.state, State::Turning(_));
        self.stretches.iter().filter(turning).count()
    }

    /// Whether it slips in the only direction that there is, against friction.
    fn rubs(&self) -> bool {
        self.has(|state| matches!(state, State::Along(sign) if *sign != 0.0))
    }

    /// Products of the basis, integrated over stretches with their weights, row by row.
    fn products(
        &self,
        drive: &Drive<'_>,
        weight: impl Fn(&State) -> f64,
        mut visit: impl FnMut(usize, &[f64]),
    ) {
        let harmonics = drive.harmonics();
        let mut sums = IntervalSums::new(harmonics);
        for Stretch { start, end, state } in &self.stretches {
            let weight = weight(state);
            if weight != 0.0 {
                sums.add_length(weight * (end - start));
                sums.add_end(*end, weight);
                sums.add_end(*start, -weight);
            }
        }
        sums.rows(harmonics, 2.0 / harmonics.span(), &mut visit);
    }

    /// Integrals of the slip load; of their derivatives, too, where the cycle has `rates`.
    pub(super) fn response(&self, drive: &Drive<'_>, rates: bool) -> Response {
        let harmonics = drive.harmonics();
        let (slots, width) = (harmonics.slots(), self.columns);
        let tangential = drive.pull.len();
        let mut slider = vec![0.0; tangential];
        let mut rate = vec![0.0; if rates { tangential * width } else { 0 }];
        let mut open = Vec::new();
        if self.has(|state| matches!(state, State::Open)) {
            open.resize(slots * slots, 0.0);
            let weight = |state: &State| f64::from(u8::from(matches!(state, State::Open)));
            self.products(drive, weight, |i, row| {
                open[i * slots..(i + 1) * slots].copy_from_slice(row);
            });
        }
        let free = |state: &State| !matches!(state, State::Stuck { .. });
        if self.has(free) {
            let weight = |state: &State| f64::from(u8::from(free(state)));
            self.products(drive, weight, |i, row| {
                for first in (0..tangential).step_by(slots) {
                    slider[first + i] += dot(row, &drive.pull[first..first + slots]);
                    if rates {
                        let at = (first + i) * width + first;
                        rate[at..at + slots].copy_from_slice(row);
                    }
                }
            });
        }
        if self.rubs() {
            let limit = drive.limit();
            let weight = |state: &State| if let State::Along(sign) = state { *sign } else { 0.0 };
            self.products(drive, weight, |i, row| {
                slider[i] -= dot(row, &limit);
                if rates {
                    let own = rate[i * width + slots..(i + 1) * width].iter_mut().zip(row);
                    own.for_each(|(rate, v)| *rate = -v);
                }
            });
        }
        self.add_stuck(drive, &mut slider, &mut rate);
        self.add_turning(drive, &mut slider, &mut rate);
        if self.unresolved {
            slider.fill(f64::NAN);
        }
        let own = drive.columns();
        let varies = |rate: &[f64]| rate.iter().any(|rate| *rate != 0.0);
        let moves = self.start_rate.as_ref().is_some_and(|rate| varies(rate))
            || self.has(|state| match state {
                State::Stuck { rate, .. } => {
                    rate.chunks_exact(self.columns).any(|row| varies(&row[..own]))
                }
                _ => true,
            });
        let rate = self.with_start(rate, own);
        Response { slider, rate, open, moves }
    }

    /// Derivatives in the coefficients alone: the start depends on them.
    fn with_start(&self, rate: Vec<f64>, own: usize) -> Vec<f64> {
        if self.columns == own {
            return rate;
        }
        let mut out = Vec::with_capacity(rate.len());
        for row in rate.chunks_exact(self.columns) {
            let first = out.len();
            out.extend_from_slice(&row[..own]);
            for (by, start) in row[own..]
                .iter()
                .zip(self.start_rate.iter().flat_map(|rate| rate.chunks_exact(own)))
            {
                out[first..].iter_mut().zip(start).for_each(|(out, start)| *out += by * start);
            }
        }
        out
    }

    fn add_stuck(&self, drive: &Drive<'_>, value: &mut [f64], out: &mut [f64]) {
        let harmonics = drive.harmonics();
        let (slots, width) = (harmonics.slots(), self.columns);
        let weight = 2.0 / harmonics.span();
        let mut bounds = Bounds::new(harmonics);
        let mut integral = vec![0.0; slots];
        for Stretch { start, end, state } in &self.stretches {
            let State::Stuck { slider, rate } = state else { continue };
            integral.fill(0.0);
            bounds.add_integral(harmonics, *start, *end, weight, &mut integral);
            for (row, value) in value.iter_mut().enumerate() {
                *value += integral[row % slots] * slider[row / slots];
            }
            if out.is_empty() {
                continue;
            }
            for (row, out) in out.chunks_exact_mut(width).enumerate() {
                let integral = integral[row % slots];
                let rate = &rate[row / slots * width..];
                out.iter_mut().zip(rate).for_each(|(out, rate)| *out += integral * rate);
            }
        }
    }

    /// The traction M e of slip in the plane, by the quadrature of its panels.
    fn add_turning(&self, drive: &Drive<'_>, value: &mut [f64], out: &mut [f64]) {
        let slots = drive.harmonics().slots();
        let weight = 2.0 / drive.harmonics().span();
        let width = if out.is_empty() { 0 } else { self.columns };
        let panels = self.stretches.iter().filter_map(|stretch| match &stretch.state {
            State::Turning(panel) => Some(panel),
            _ => None,
        });
        let count = panels.clone().count();
        let mut rates = (width > 0 && count > 0).then(|| RateIntegrals::new(count, slots, width));
        for panel in panels {
            let weights = panel.weights().map(|own| -weight * own);
            panel.add_traction(&weights, value);
            if let Some(rates) = &mut rates {
                rates.add(panel, &weights, drive);
            }
        }
        let Some(sums) = rates.map(RateIntegrals::into_sums) else { return };
        for (row, out) in out.chunks_exact_mut(width).enumerate() {
            let first = row / slots * width;
            for (column, out) in out.iter_mut().enumerate() {
                *out += sums[(row % slots, first + column)];
            }
        }
    }

    /// The traction at an angle, inside the cone to rounding, and the direction of slip there, zero
    /// without slip.
    pub(super) fn traction(&self, drive: &Drive<'_>, theta: f64) -> ([f64; 2], [f64; 2]) {
        let start = self.stretches[0].start;
        let span = drive.harmonics().span();
        let spans = ((theta - start) / span).floor();
        // Half a period of a half-wave symmetric motion is the mirror image of the other.
        if drive.harmonics().half_wave() && spans.rem_euclid(2.0) == 1.0 {
            let mirrored = self.traction(drive, theta - span);
            return (mirrored.0.map(|t| -t), mirrored.1.map(|e| -e));
        }
        let (pull, [pressing, _]) = drive.at(theta);
        let limit = drive.friction * pressing.max(0.0);
        let theta = theta - spans * span;
        let after = self.stretches.partition_point(|stretch| stretch.end <= theta);
        let Stretch { state, .. } = &self.stretches[after.min(self.stretches.len() - 1)];
        match state {
            State::Open => ([0.0; 2], [0.0; 2]),
            State::Stuck { slider, .. } => {
                let mut traction = [pull[0][0] - slider[0], pull[1][0] - slider[1]];
                let size = traction[0].hypot(traction[1]);
                if size > limit {
                    traction = traction.map(|t| t * (limit / size));
                }
                (traction, [0.0; 2])
            }
            State::Along(sign) => ([sign * limit, 0.0], [*sign, 0.0]),
            State::Turning(panel) => {
                let direction = panel.direction(theta);
                (direction.map(|e| limit * e), direction)
            }
        }
    }

    /// What the tangential components do over the period, and the normal one behind them if there
    /// are as many `components`.
    pub(super) fn phases(&self, drive: &Drive<'_>, components: usize) -> Vec<Phase> {
        let span = drive.harmonics().span();
        let spans = if drive.harmonics().half_wave() { 2 } else { 1 };
        let mut phases: Vec<Phase> = Vec::new();
        for number in 0..spans {
            let turn = span * number as f64;
            for Stretch { start, end, state } in &self.stretches {
                let middle = 0.5 * (start + end) + turn;
                let (_, slip) = self.traction(drive, middle);
                let states = (0..components).map(|i| match (i < drive.directions, state) {
                    (true, _) if slip[i] != 0.0 => PointState::slipping(slip[i]),
                    (false, State::Open) => PointState::Backward,
                    _ => PointState::Stuck,
                });
                let states = states.collect();
                if phases.last().is_none_or(|last| last.states != states) {
                    phases.push(Phase { start: (start + turn).rem_euclid(TAU), states });
                }
            }
        }
        phases.sort_by(|a, b| a.start.total_cmp(&b.start));
        phases
    }

    /// Slip share and friction work of every tangential direction, and the open share.
    pub(super) fn summary(
        &self,
        drive: &Drive<'_>,
        stiffness: f64,
        tangential: &mut [PointSummary],
    ) -> PointSummary {
        let span = drive.harmonics().span();
        let share = |of: &dyn Fn(&State) -> bool| {
            let stretches = self.stretches.iter().filter(|stretch| of(&stretch.state));
            // A sum of nothing would be -0.
            stretches.fold(0.0, |sum, stretch| sum + (stretch.end - stretch.start)) / span
        };
        let open = share(&|state| matches!(state, State::Open));
        let stuck = share(&|state| matches!(state, State::Stuck { .. }));
        for summary in tangential.iter_mut() {
            summary.slip_fraction = (1.0 - open - stuck).max(0.0);
        }
        if self.rubs() {
            tangential[0].dissipation = (self.work_along(drive) / stiffness).max(0.0);
        }
        for stretch in &self.stretches {
            if let State::Turning(panel) = &stretch.state {
                let work = panel.work().map(|work| work / stiffness * TAU / span);
                tangential.iter_mut().zip(work).for_each(|(own, work)| own.dissipation += work);
            }
        }
        PointSummary { slip_fraction: open, dissipation: 0.0 }
    }

    /// `∫ t ds` of slip in one direction: `t = σM`, `s = K − σM`.
    fn work_along(&self, drive: &Drive<'_>) -> f64 {
        let harmonics = drive.harmonics();
        let limit = drive.limit();
        let mut slope = vec![0.0; drive.pull.len()];
        for (index, order) in harmonics.oscillating().iter().enumerate() {
            let slot = harmonics.offset() + 2 * index;
            slope[slot] = *order as f64 * drive.pull[slot + 1];
            slope[slot + 1] = -(*order as f64) * drive.pull[slot];
        }
        let mut work = 0.0;
        let weight = |state: &State| if let State::Along(sign) = state { *sign } else { 0.0 };
        self.products(drive, weight, |i, row| work += limit[i] * dot(row, &slope));
        work *= 0.5 * harmonics.span();
        for Stretch { start, end, state } in &self.stretches {
            if let State::Along(_) = state {
                let of = |theta: f64| drive.friction * drive.at(theta).1[0];
                work -= 0.5 * (of(*end).powi(2) - of(*start).powi(2));
            }
        }
        work * TAU / harmonics.span()
    }
}
