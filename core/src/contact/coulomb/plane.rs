//! The march of a Coulomb contact in two directions, from event to event.
//!
//! While it sticks the traction is `K − s`, and slip begins where its size reaches M; while it slips
//! the panels of the slip equation follow it until λ = 0. The slider position carries its derivative
//! in the coefficients of K and M, and in the position that the march has begun with.

use super::collocation::NODES;
use super::cycle::{Cycle, State, Stretch};
use super::drive::Drive;
use super::grid::{excess, Grid};
use super::panel::{Panel, RESOLVED};
use super::slip::Plane;
use crate::contact::transitions::root;

/// Excess over the limit, relative to it, that is none.
const AT_LIMIT: f64 = 1e-13;
/// λ, relative to what it can be, below which a contact at its limit sticks.
const AT_REST: f64 = 1e-9;
/// Panels as short as this are taken as they are.
const SHORTEST: f64 = 1e-9;
/// Panels of a lap per harmonic after which it is not resolved: a contact that is moved a thousand million times
/// as far as it slips at turns within an angle that nothing resolves.
const MOST_PANELS: usize = 200;
/// Most changes between stick and slip per harmonic and period: more are rounding.
const MOST_CHANGES: usize = 64;

/// A slider position with its derivatives, both directions one after the other: in the coefficients
/// of K and M, if they are carried, and in the two numbers of the first position.
#[derive(Clone)]
pub(super) struct Slider {
    pub(super) position: [f64; 2],
    pub(super) rate: Vec<f64>,
}

/// A march through closed contact.
pub(super) struct March<'a> {
    pub(super) drive: &'a Drive<'a>,
    pub(super) plane: &'a Plane<'a>,
    pub(super) grid: &'a Grid,
    /// Whether the derivatives in the coefficients are carried.
    pub(super) coefficients: bool,
    pub(super) stretches: Vec<Stretch>,
    pub(super) slipped: bool,
    /// Way of the slider in slip.
    pub(super) way: f64,
    /// Whether the panels were spent before the end.
    pub(super) unresolved: bool,
    /// What counts as resolved.
    pub(super) resolved: f64,
    /// Start and length of the panels that a lap before has had, as long as they may be here.
    pub(super) hints: Vec<[f64; 2]>,
}

impl<'a> March<'a> {
    pub(super) fn new(
        drive: &'a Drive<'a>,
        plane: &'a Plane<'a>,
        grid: &'a Grid,
        coefficients: bool,
    ) -> Self {
        Self {
            drive,
            plane,
            grid,
            coefficients,
            stretches: Vec::new(),
            slipped: false,
            way: 0.0,
            unresolved: false,
            resolved: RESOLVED,
            hints: Vec::new(),
        }
    }

    /// The lengths of the panels, for a march that resolves more or less.
    pub(super) fn hints(&self, resolved: f64) -> Vec<[f64; 2]> {
        let by = (resolved / self.resolved).powf(1.0 / NODES as f64);
        let panels = self.stretches.iter().filter_map(|stretch| match &stretch.state {
            State::Turning(panel) => Some([stretch.start, by * panel.wanted]),
            _ => None,
        });
        panels.collect()
    }

    /// Angles at which slip has ended.
    pub(super) fn pushes(&self) -> Vec<f64> {
        let slips = |stretch: &&Stretch| matches!(stretch.state, State::Turning(_));
        let ends = |n: &usize| {
            let next = self.stretches.get(n + 1);
            slips(&&self.stretches[*n]) && !next.as_ref().is_some_and(slips)
        };
        (0..self.stretches.len()).filter(ends).map(|n| self.stretches[n].end).collect()
    }

    /// Length of a panel to begin with.
    fn first_length(&self, theta: f64) -> f64 {
        let after = self.hints.partition_point(|[start, _]| *start <= theta + 1e-2);
        let hint = after.checked_sub(1).map(|n| self.hints[n][1]);
        hint.map_or(self.plane.longest, |length| length.min(self.plane.longest))
    }

    /// The cycle that has been marched; the derivative of its start, if it depends on that.
    pub(super) fn into_cycle(self, start_rate: Option<Vec<f64>>) -> Cycle {
        let (columns, solved) = (self.drive.columns() + 2, self.plane.solved.get());
        let (stretches, unresolved) = (self.stretches, self.unresolved);
        Cycle { stretches, start_rate, columns, unresolved, solved }
    }

    /// Moves the start of the march, and all that depends on it, by a little.
    pub(super) fn correct(&mut self, by: [f64; 2]) {
        let width = self.width();
        for stretch in &mut self.stretches {
            match &mut stretch.state {
                State::Stuck { slider, rate } => {
                    for (slider, rate) in slider.iter_mut().zip(rate.chunks_exact(width)) {
                        *slider += rate[width - 2] * by[0] + rate[width - 1] * by[1];
                    }
                }
                State::Turning(panel) => panel.correct(by),
                _ => {}
            }
        }
    }

    /// Numbers that a slider's position is differentiated in.
    pub(super) fn width(&self) -> usize {
        2 + if self.coefficients { self.drive.columns() } else { 0 }
    }

    /// A slider somewhere, from which the march begins.
    pub(super) fn begin(&self, position: [f64; 2]) -> Slider {
        let width = self.width();
        let mut rate = vec![0.0; 2 * width];
        rate[width - 2] = 1.0;
        rate[2 * width - 1] = 1.0;
        Slider { position, rate }
    }

    /// Takes a slider from which the cone does not reach to the nearest from which it does. One that is but a
    /// little too far comes back by itself, or slips.
    pub(super) fn confine(&self, theta: f64, slider: &mut Slider, little: f64) {
        let (pull, [pressing, _]) = self.drive.at(theta);
        let limit = self.drive.friction * pressing;
        let size = (pull[0][0] - slider.position[0]).hypot(pull[1][0] - slider.position[1]);
        if size > limit * (1.0 + little) {
            let (angle, rate) = self.onset(theta, slider, false);
            self.leave(theta, angle, &rate, slider);
        }
    }

    /// Follows a slider from one angle to another while the contact is closed.
    pub(super) fn follow(&mut self, start: f64, end: f64, slider: &mut Slider, closes: bool) {
        let (pull, pressing) = self.drive.at(start);
        let [limit, growth] = pressing.map(|n| self.drive.friction * n);
        let speed = pull[0][1].hypot(pull[1][1]);
        let mut theta = start;
        let mut slips = if closes {
            speed > growth
        } else {
            let traction = [0, 1].map(|i| pull[i][0] - slider.position[i]);
            let size = traction[0].hypot(traction[1]);
            let rate = (traction[0] * pull[0][1] + traction[1] * pull[1][1]) / size - growth;
            size >= limit * (1.0 - AT_LIMIT) && rate > self.at_rest()
        };
        let most = MOST_CHANGES * self.drive.harmonics().highest().max(4);
        let mut rest = 0.0;
        for change in 0..most {
            if slips {
                let (closes, from) = (closes && change == 0, theta);
                theta = self.slip(theta, end, slider, closes);
                // Rounding at the limit calls for slip that ends where it begins: the contact rests.
                rest = if theta > from { 0.0 } else { f64::max(2.0 * rest, SHORTEST) };
            } else {
                theta = self.stick(theta, end, slider, rest);
            }
            if theta >= end {
                return;
            }
            slips = !slips;
        }
        self.push_stuck(theta, end, slider);
    }

    fn push_stuck(&mut self, start: f64, end: f64, slider: &Slider) {
        let state = State::Stuck { slider: slider.position, rate: slider.rate.clone() };
        self.stretches.push(Stretch { start, end, state });
    }

    /// Sticks until the traction leaves the cone, and for a while in any case.
    fn stick(&mut self, start: f64, end: f64, slider: &Slider, rest: f64) -> f64 {
        let rests = (start + rest).min(end);
        let until = self.leaves(rests, end, slider.position).unwrap_or(end);
        if until > start {
            self.push_stuck(start, until, slider);
        }
        until
    }

    /// First angle at which the traction of a stuck contact leaves the cone.
    fn leaves(&self, start: f64, end: f64, slider: [f64; 2]) -> Option<f64> {
        let step = self.grid.step;
        let mut n = (start / step).floor() as usize + 1;
        let (mut from, mut before) = (start, excess(self.at(start), slider));
        let rounding = 4.0 * f64::EPSILON * self.plane.reach;
        loop {
            let last = n as f64 * step >= end;
            let (to, at) =
                if last { (end, self.at(end)) } else { (n as f64 * step, self.grid.at(n)) };
            let after = excess(at, slider);
            let limit = at[2][0];
            let least = limit * (AT_LIMIT * limit + rounding);
            if after[0] > least {
                return Some(self.crossing(from, to, slider));
            }
            // A turning point between the two may lie outside.
            let width = to - from;
            let reach = before[0] + 2.0 * before[1] * width;
            if before[1] > 0.0
                && after[1] < 0.0
                && reach > least
                && after[0] - 2.0 * after[1] * width > least
            {
                let top = self.top(from, to, slider);
                if excess(self.at(top), slider)[0] > least {
                    return Some(self.crossing(from, top, slider));
                }
            }
            if last {
                return None;
            }
            (from, before) = (to, after);
            n += 1;
        }
    }

    fn at(&self, theta: f64) -> [[f64; 2]; 3] {
        let ([x, y], pressing) = self.drive.at(theta);
        [x, y, pressing.map(|n| self.drive.friction * n)]
    }

    /// λ that counts as none.
    fn at_rest(&self) -> f64 {
        AT_REST * self.plane.reach * self.drive.harmonics().highest() as f64
    }

    /// Where the excess becomes positive. It may begin at zero and fall first.
    fn crossing(&self, start: f64, end: f64, slider: [f64; 2]) -> f64 {
        let of = |theta: f64| excess(self.at(theta), slider);
        let (mut low, [value, slope]) = (start, of(start));
        let limit = self.at(start)[2][0];
        if value >= -AT_LIMIT * limit * limit {
            if slope > self.at_rest() * limit {
                return start;
            }
            let mut width = end - start;
            while of(start + width)[0] >= 0.0 {
                width *= 0.5;
                if width < 1e-12 {
                    return start;
                }
            }
            low = start + width;
        }
        root([low, end], &|theta| {
            let [value, slope] = of(theta);
            [-value, -2.0 * slope]
        })
    }

    /// Where the excess is largest between an angle at which it grows and one at which it falls.
    fn top(&self, mut low: f64, mut high: f64, slider: [f64; 2]) -> f64 {
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if excess(self.at(middle), slider)[1] > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Slips until the traction falls back into the cone.
    fn slip(&mut self, start: f64, end: f64, slider: &mut Slider, closes: bool) -> f64 {
        let (mut angle, mut rate) = self.onset(start, slider, closes);
        let mut theta = start;
        let mut length = self.first_length(start);
        let mut ended = false;
        let most = MOST_PANELS * self.drive.harmonics().highest().max(4);
        let mut panels = 0;
        while theta < end && !ended {
            let left = end - theta;
            length = if length >= left { left } else { length.min(0.5 * left) };
            let Some(mut panel) = Panel::solve(self.plane, theta, length, angle) else {
                if length < 1e-12 {
                    break;
                }
                length *= 0.25;
                continue;
            };
            let error = panel.error(self.plane, self.resolved);
            let tried = length;
            if panels > most {
                self.unresolved = true;
                return end;
            }
            if error > 1.0 && length > SHORTEST {
                length *= (0.8 * error.powf(-1.0 / NODES as f64)).clamp(0.1, 0.8);
                continue;
            }
            if let Some(share) = panel.ends() {
                if share * length < 1e-13 {
                    break;
                }
                let Some(shorter) = Panel::solve(self.plane, theta, share * length, angle) else {
                    length *= 0.5;
                    continue;
                };
                (panel, ended) = (shorter, true);
            }
            panel.carry(self.drive, self.coefficients, &mut rate);
            self.slipped = true;
            self.way += panel.way();
            let from = theta;
            theta = if !ended && length == left { end } else { panel.end() };
            angle = panel.last_angle;
            let grown = tried * (0.9 * error.powf(-1.0 / NODES as f64)).clamp(0.3, 2.0);
            panel.wanted = grown.min(self.plane.longest);
            length = panel.wanted;
            let state = State::Turning(Box::new(panel));
            self.stretches.push(Stretch { start: from, end: theta, state });
            panels += 1;
        }
        if theta > start {
            self.leave(theta, angle, &rate, slider);
            if theta < end {
                self.stop(theta, angle, &rate, slider);
            }
        }
        theta
    }
}
