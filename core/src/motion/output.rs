//! What a time integration hands out: samples, ranges and events, period after period.

use super::flow::Flow;
use super::flow_event::{Event, FlowEvent, FlowSegment, Halt};
use super::flow_next::rescale;
use super::history::{History, Trace, TransientSettings};
use super::microslip::Turn;
use super::modal_system::{dot, ModalSystem};
use super::modal_way::ModalWay;
use super::polynomial::{sign_changes, value, DEGREE};
use super::runge_kutta::{lanes, Lanes, RungeKutta};
use super::state::State;
use crate::contact::SlipPlane;
use crate::solve::size;
use std::f64::consts::TAU;

/// Shapes that are gone through one by one.
const FEW: usize = 4;
/// Share of a sampling interval by which rounding may miss an instant.
const ROUNDING: f64 = 1e-9;
/// Steps between two looks at whether to go on.
const LOOK: usize = 4096;
/// Periods that are dropped at once at least: moving the rest costs.
const BLOCK: usize = 16;

/// The output that the settings of a time integration ask for.
pub(super) struct Output<'a> {
    system: &'a ModalSystem,
    settings: &'a TransientSettings,
    shapes: Vec<Vec<f64>>,
    /// The first point on every contact displacement.
    firsts: Vec<usize>,
}

impl<'a> Output<'a> {
    pub(super) fn new(
        system: &'a ModalSystem,
        settings: &'a TransientSettings,
        observe: &[usize],
    ) -> Self {
        let shapes = observe.iter().map(|&dof| system.shape(dof).collect()).collect();
        let points: Vec<usize> = (0..system.points()).collect();
        Self { system, settings, shapes, firsts: system.shared(&points) }
    }

    /// Adds an output instant.
    pub(super) fn push(&self, time: f64, x: &[f64], v: &[f64], force: &[f64], trace: &mut Trace) {
        self.put(
            time,
            self.shapes.iter().map(|shape| [dot(shape, x), dot(shape, v)]),
            |point| dot(self.system.contact_shape(point), x),
            force,
            trace,
        );
    }

    /// The same of the observed displacements and velocities, and the displacement of every point.
    fn put(
        &self,
        time: f64,
        observed: impl Iterator<Item = [f64; 2]>,
        displacement: impl Fn(usize) -> f64,
        force: &[f64],
        trace: &mut Trace,
    ) {
        trace.time.push(time);
        for [x, v] in observed {
            trace.displacement.push(x);
            trace.velocity.push(v);
        }
        trace.contact_displacement.extend(self.firsts.iter().map(|&point| displacement(point)));
        let known = trace.force.len();
        trace.force.resize(known + self.firsts.len(), 0.0);
        for (component, force) in self.system.components().iter().zip(force) {
            trace.force[known + component] += force;
        }
    }

    /// Time of an output instant within the period \[s\].
    fn instant(&self, sample: usize) -> f64 {
        TAU / self.settings.omega * sample as f64 / self.settings.samples as f64
    }

    /// Follows the exact flow over one period that begins at `begin` \[s\]. `false` if the caller has
    /// ended the run, which then keeps whole periods alone.
    pub(super) fn follow(
        &self,
        flow: &mut Flow<'_>,
        state: &mut State,
        begin: f64,
        history: &mut History,
    ) -> Result<bool, Halt> {
        let until = TAU / self.settings.omega;
        let kept = (history.trace.time.len(), history.events.len());
        let slack = ROUNDING * self.instant(1);
        let mut sample = 1;
        let mut range = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.shapes.len()];
        let (modes, points) = (self.system.modes(), self.system.points());
        let (mut x, mut v, mut f) = (vec![0.0; modes], vec![0.0; modes], vec![0.0; points]);
        let mut extremes = Extremes::default();
        let (trace, events) = (&mut history.trace, &mut history.events);
        let run = flow.run(state, until, &mut |passage| match passage {
            FlowEvent::Segment(segment) => {
                let end = segment.start + segment.duration();
                while sample <= self.settings.samples && self.instant(sample) <= end + slack {
                    let tau = (self.instant(sample) - segment.start) * segment.series.rate();
                    segment.series.state_at(tau, self.system, [&mut x, &mut v, &mut f]);
                    self.push(begin + self.instant(sample), &x, &v, &f, trace);
                    sample += 1;
                }
                extremes.follow(&segment, &self.shapes, &mut range);
            }
            FlowEvent::Event { turn: Some((_, Turn::Undone | Turn::Forgotten(_))), .. } => {}
            FlowEvent::Event { event, .. } => {
                let point = self.system.components()[event.point];
                events.push(Event { time: begin + event.time, point, ..event });
            }
        });
        if run == Err(Halt::Interrupted) {
            self.truncate(&mut history.trace, kept.0);
            history.events.truncate(kept.1);
            return Ok(false);
        }
        history.range.extend(range);
        run.map(|()| true)
    }

    /// Takes the Runge-Kutta steps of one period that begins at `begin` \[s\]. Between steps, motions
    /// are cubic, from displacements and velocities at both ends. `false` if the caller has ended the
    /// run, which then keeps whole periods alone.
    pub(super) fn step_through(
        &self,
        scheme: &mut RungeKutta<'_>,
        begin: f64,
        history: &mut History,
        progress: &dyn Fn() -> bool,
    ) -> Result<bool, Halt> {
        let (steps, samples) = (scheme.steps(), self.settings.samples);
        let kept = history.trace.time.len();
        let h = scheme.step();
        let mut sample = 1;
        let shapes: Vec<Vec<Lanes>> = self.shapes.iter().map(|shape| lanes(shape)).collect();
        let mut last: Vec<[f64; 2]> =
            shapes.iter().map(|shape| scheme.end().along(shape)).collect();
        let mut range: Vec<[f64; 2]> = last.iter().map(|[x, _]| [*x, *x]).collect();
        for index in 0..steps {
            if index % LOOK == LOOK - 1 && !progress() {
                self.truncate(&mut history.trace, kept);
                return Ok(false);
            }
            scheme.advance();
            let end = scheme.end();
            if !end.is_bounded() {
                history.range.extend(range);
                return Err(Halt::Unbounded);
            }
            for ((last, shape), range) in last.iter_mut().zip(&shapes).zip(&mut range) {
                let now = end.along(shape);
                widen_by_cubic([*last, now], h, range);
                *last = now;
            }
            while sample <= samples && sample * steps <= (index + 1) * samples {
                let share = (sample * steps) as f64 / samples as f64 - index as f64;
                let at = scheme.within(share);
                self.put(
                    begin + self.instant(sample),
                    shapes.iter().map(|shape| at.along(shape)),
                    |point| at.contacts[point],
                    &at.force,
                    &mut history.trace,
                );
                sample += 1;
            }
        }
        history.range.extend(range);
        Ok(true)
    }

    /// Keeps the first `instants` of a trace.
    fn truncate(&self, trace: &mut Trace, instants: usize) {
        let (dofs, points) = (self.shapes.len(), self.firsts.len());
        trace.time.truncate(instants);
        trace.displacement.truncate(instants * dofs);
        trace.velocity.truncate(instants * dofs);
        trace.contact_displacement.truncate(instants * points);
        trace.force.truncate(instants * points);
    }

    /// Drops the histories of the periods that are not to be kept, once they are `blocks` of what
    /// is to be kept.
    pub(super) fn forget(&self, history: &mut History, blocks: usize) {
        let Some(keep) = self.settings.keep else { return };
        let samples = self.settings.samples;
        let trace = &mut history.trace;
        let periods = (trace.time.len() - 1) / samples;
        let spare = if blocks > 1 { BLOCK } else { 0 };
        if periods < blocks * keep + spare || periods <= keep {
            return;
        }
        let first = (periods - keep) * samples;
        let (dofs, points) = (self.shapes.len(), self.firsts.len());
        trace.time.drain(..first);
        trace.displacement.drain(..first * dofs);
        trace.velocity.drain(..first * dofs);
        trace.contact_displacement.drain(..first * points);
        trace.force.drain(..first * points);
        let from = trace.time[0];
        history.events.retain(|event| event.time >= from);
    }
}

/// Extremes of a polynomial on the unit interval.
#[derive(Debug, Default)]
pub(crate) struct Extremes {
    /// Coefficients of the polynomial.
    series: Vec<f64>,
    slope: Vec<f64>,
    zeros: Vec<f64>,
    /// Powers of the length of a stretch, and the same times their orders.
    powers: Vec<f64>,
    slopes: Vec<f64>,
    /// Coefficients of a displacement.
    own: Vec<f64>,
    /// What the modes do on a stretch, and shapes that may have an extreme there.
    way: ModalWay,
    open: Vec<usize>,
}

impl Extremes {
    /// Widens the range of each of the shapes by its values on a stretch of the motion.
    pub(crate) fn follow(
        &mut self,
        segment: &FlowSegment<'_>,
        shapes: &[Vec<f64>],
        ranges: &mut [[f64; 2]],
    ) {
        if shapes.len() <= FEW {
            self.measure(segment.length);
            let mut own = std::mem::take(&mut self.own);
            for (shape, range) in shapes.iter().zip(ranges) {
                segment.series.write_projection(shape, &mut own);
                self.widen_by(&own, segment.length, range);
            }
            self.own = own;
            return;
        }
        segment.series.write_way(segment.length, &mut self.way);
        let mut open = std::mem::take(&mut self.open);
        self.way.widen(shapes, ranges, &mut open);
        for &number in &open {
            let shape = shapes[number].iter().copied();
            segment.series.project(shape, segment.length, &mut self.series);
            self.widen(&mut ranges[number]);
        }
        self.open = open;
    }

    /// Widens the range of each contact displacement.
    pub(crate) fn follow_contacts(
        &mut self,
        system: &ModalSystem,
        segment: &FlowSegment<'_>,
        ranges: &mut [[f64; 2]],
    ) {
        self.measure(segment.length);
        let mut own = std::mem::take(&mut self.own);
        for (point, range) in ranges.iter_mut().enumerate() {
            if system.is_felt(point) {
                self.widen_by(segment.series.contact(point), segment.length, range);
            } else {
                segment.series.write_projection(system.contact_shape(point), &mut own);
                self.widen_by(&own, segment.length, range);
            }
        }
        self.own = own;
    }

    /// Prepares bounds on how far polynomials move over a length.
    fn measure(&mut self, length: f64) {
        self.powers.clear();
        self.powers.extend((0..=DEGREE).scan(1.0, |power, _| {
            let own = *power;
            *power *= length;
            Some(own)
        }));
        self.slopes.clear();
        let orders = self.powers.iter().enumerate();
        self.slopes.extend(orders.map(|(order, power)| order as f64 * power));
    }

    /// Widens a range by the values of a polynomial over the length that was measured.
    fn widen_by(&mut self, a: &[f64], length: f64, range: &mut [f64; 2]) {
        let reach = size(&a[1..], &self.powers[1..]);
        if a[0] + reach <= range[1] && a[0] - reach >= range[0] {
            return;
        }
        // It rises or falls all the way.
        if (a[1] * length).abs() > size(&a[2..], &self.slopes[2..]) {
            for value in [a[0], value(a, length)] {
                range[0] = range[0].min(value);
                range[1] = range[1].max(value);
            }
            return;
        }
        self.series.clear();
        self.series.extend_from_slice(a);
        rescale(&mut self.series, length);
        self.widen(range);
    }

    /// Least `M² − |t|²` of a contact in a plane on a stretch of the motion, relative to the greatest M².
    pub(crate) fn least_room(
        &mut self,
        system: &ModalSystem,
        segment: &FlowSegment<'_>,
        plane: SlipPlane,
    ) -> f64 {
        let limit = segment.series.limit(system, plane.points[0]);
        segment.series.fill_room(plane, &limit, &mut self.series);
        rescale(&mut self.series, segment.length);
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        self.widen(&mut range);
        range[0] / value(&limit, segment.length).max(limit[0]).powi(2)
    }

    /// Widens a range by the values of the polynomial.
    fn widen(&mut self, range: &mut [f64; 2]) {
        let series = &self.series;
        let mut include = |value: f64| {
            range[0] = range[0].min(value);
            range[1] = range[1].max(value);
        };
        include(series[0]);
        include(value(series, 1.0));
        let reach: f64 = series[1..].iter().map(|a| a.abs()).sum();
        if series[0] + reach <= range[1] && series[0] - reach >= range[0] {
            return;
        }
        self.slope.clear();
        self.slope.extend(series[1..].iter().enumerate().map(|(n, a)| (n + 1) as f64 * a));
        sign_changes(&self.slope, &mut self.zeros);
        for &x in &self.zeros {
            let value = value(series, x);
            range[0] = range[0].min(value);
            range[1] = range[1].max(value);
        }
    }
}

/// Widens a range, which has the first of two displacements, by the second and by the cubic between them
/// that their velocities give over a step of length h.
fn widen_by_cubic([[x_0, v_0], [x_1, v_1]]: [[f64; 2]; 2], h: f64, range: &mut [f64; 2]) {
    let mut include = |value: f64| {
        range[0] = range[0].min(value);
        range[1] = range[1].max(value);
    };
    include(x_1);
    if (v_0 > 0.0) != (v_1 > 0.0) {
        let (rise, v_0, v_1) = (x_1 - x_0, h * v_0, h * v_1);
        let cubic = [x_0, v_0, 3.0 * rise - 2.0 * v_0 - v_1, v_0 + v_1 - 2.0 * rise];
        let slope = [cubic[1], 2.0 * cubic[2], 3.0 * cubic[3]];
        let mut zeros = Vec::new();
        sign_changes(&slope, &mut zeros);
        zeros.iter().for_each(|&x| include(value(&cubic, x)));
    }
}
