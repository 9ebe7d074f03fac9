//! What is read off a closed orbit: harmonics, extremes, energies, slip and events.

use crate::balance::Point;
use crate::contact::{PointState, PointSummary, SlipPlane};
use crate::motion::{
    nodes_of_waves, ContactState, Event, Extremes, FlowEvent, FlowSegment, ModalSystem, Quadrature,
    Turn, Values, ROUNDING,
};
use crate::solve::{dot, multiply};
use faer::{c64, Accum, Mat};
use std::f64::consts::TAU;

/// Quadrature nodes of a segment in which contacts slip little by little or in a plane, beyond those that the
/// highest harmonic needs: its power series has few significant terms.
const NODES: usize = 20;
/// Distance from a limit, relative to it, at which a contact touches it, …
const TOUCHES: f64 = 1e-7;
/// … and share of a period that is but an instant: one of slip by rounding lasts as long as its root.
const INSTANT: f64 = 1e-6;

/// Sums over one pass along an orbit.
pub(super) struct Survey<'a> {
    system: &'a ModalSystem,
    omega: f64,
    half_wave: bool,
    orders: usize,
    /// Orders that do not vanish.
    present: Vec<usize>,
    quadrature: &'a mut Quadrature,
    /// Harmonics of the modes and, behind them, of the contact forces, order after order; once all is seen.
    series: Vec<c64>,
    /// Rows that give the observed DOFs, and after them the contact displacements.
    shapes: Vec<Vec<f64>>,
    extremes: Extremes,
    /// The motion at the nodes of a stretch, cos and −sin of all orders there, and sums of products of both, of
    /// modes and of contact forces, over all stretches.
    values: Values,
    waves: Mat<f64>,
    sums: [Mat<f64>; 2],
    /// Modal loads of an order, with its phase.
    loads: Vec<(usize, [Vec<f64>; 2])>,
    /// Least distance of each contact in a plane from its limit while it sticks, relative to it.
    room: Vec<f64>,
    /// Lowest and highest value of each shape.
    pub(super) range: Vec<[f64; 2]>,
    pub(super) contacts: Vec<PointSummary>,
    pub(super) events: Vec<Event>,
    pub(super) work: f64,
    pub(super) viscous: f64,
}

impl<'a> Survey<'a> {
    pub(super) fn new(
        system: &'a ModalSystem,
        omega: f64,
        half_wave: bool,
        highest: usize,
        observe: &[usize],
        quadrature: &'a mut Quadrature,
    ) -> Self {
        let shapes: Vec<Vec<f64>> = observe
            .iter()
            .map(|&dof| system.shape(dof).collect())
            .chain((0..system.points()).map(|point| system.contact_shape(point).to_vec()))
            .collect();
        let step = if half_wave { 2 } else { 1 };
        let present: Vec<usize> = (usize::from(half_wave)..=highest).step_by(step).collect();
        Self {
            system,
            omega,
            half_wave,
            orders: highest + 1,
            quadrature,
            series: Vec::new(),
            sums: [system.modes(), system.points()].map(|rows| Mat::zeros(rows, 2 * present.len())),
            present,
            loads: system.modal_loads(),
            range: vec![[f64::INFINITY, f64::NEG_INFINITY]; shapes.len()],
            shapes,
            extremes: Extremes::default(),
            values: Values::default(),
            waves: Mat::new(),
            room: vec![f64::INFINITY; system.planes().len()],
            contacts: vec![PointSummary::default(); system.points()],
            events: Vec::new(),
            work: 0.0,
            viscous: 0.0,
        }
    }

    /// Takes a passage of the flow into account.
    pub(super) fn include(&mut self, passage: &FlowEvent<'_>) {
        match passage {
            FlowEvent::Segment(segment) => {
                self.integrate(segment);
                let observed = self.shapes.len() - self.system.points();
                let (dofs, contacts) = self.range.split_at_mut(observed);
                self.extremes.follow(segment, &self.shapes[..observed], dofs);
                self.extremes.follow_contacts(self.system, segment, contacts);
                self.follow_slip(segment);
                self.follow_room(segment);
            }
            FlowEvent::Event { turn: Some((_, Turn::Undone | Turn::Forgotten(_))), .. } => {}
            FlowEvent::Event { event, .. } => {
                let point = self.system.components()[event.point];
                self.events.push(Event { point, ..*event });
            }
        }
    }

    fn integrate(&mut self, segment: &FlowSegment<'_>) {
        let system = self.system;
        let angle = self.omega * segment.duration();
        let count = nodes(segment, angle * self.orders as f64);
        let Self { quadrature, values, waves, sums, present, .. } = self;
        let (rule, powers) = quadrature.rule_of_series(count);
        segment.series.write_values(powers, segment.length, values);
        let slipping = Slipping::of(system, segment.regime);
        let mut damping = vec![0.0; system.modes()];
        waves.resize_with(2 * present.len(), count, |_, _| 0.0);
        for (node, &(x, weight)) in rule.iter().enumerate() {
            let velocity = values.velocity.col_as_slice(node);
            let phase = self.omega * segment.start + x * angle;
            damping.fill(0.0);
            system.add_damping(velocity, 1.0, &mut damping);
            let time = weight * segment.duration();
            self.viscous += time * dot(&damping, velocity);
            for (order, load) in &self.loads {
                let (sin, cos) = (*order as f64 * phase).sin_cos();
                let [re, im] = [0, 1].map(|part| dot(&load[part], velocity));
                self.work += time * (re * cos - im * sin);
            }
            let [speed, force] = [&values.speed, &values.force].map(|all| all.col_as_slice(node));
            let share = time * self.omega / TAU;
            for branch in segment.series.branches() {
                let own = &system.microslips()[branch.number];
                let summary = &mut self.contacts[own.point];
                summary.dissipation += time * force[own.point] * speed[own.point];
                // Mean over its elements, weighted by their stiffness.
                let stiffness = own.curve.stiffness();
                if stiffness > 0.0 {
                    let left = branch.stiffness_at(x * segment.length) / stiffness;
                    summary.slip_fraction += share * (1.0 - left);
                }
            }
            slipping.add_friction(system, time, [speed, force], &mut self.contacts);
            // Half a period of an odd motion counts twice.
            let share = weight * angle / TAU * if self.half_wave { 2.0 } else { 1.0 };
            let turn = c64::new(phase.cos(), -phase.sin());
            let (mut rotation, stride) =
                if self.half_wave { (turn, turn * turn) } else { (c64::new(1.0, 0.0), turn) };
            let wave = waves.col_as_slice_mut(node).chunks_exact_mut(2);
            for (order, wave) in present.iter().zip(wave) {
                let weight = rotation * if *order == 0 { share } else { 2.0 * share };
                wave.copy_from_slice(&[weight.re, weight.im]);
                rotation *= stride;
            }
        }
        for (to, motion) in sums.iter_mut().zip([&values.displacement, &values.force]) {
            let nodes = waves.transpose();
            multiply(to.as_mut(), Accum::Add, motion.as_ref(), nodes, 1.0);
        }
    }

    /// Harmonics of what was summed up.
    fn gather(&mut self) {
        let [modes, points] = [0, 1].map(|part| self.sums[part].nrows());
        self.series = vec![c64::new(0.0, 0.0); self.orders * (modes + points)];
        for (place, order) in self.present.iter().enumerate() {
            let (own, forces) = self.series[order * (modes + points)..].split_at_mut(modes);
            for (row, sums) in [own, forces].into_iter().zip(&self.sums) {
                let [re, im] = [0, 1].map(|part| sums.col_as_slice(2 * place + part));
                let parts = row.iter_mut().zip(re.iter().zip(im));
                parts.for_each(|(to, (re, im))| *to = c64::new(*re, *im));
            }
        }
    }

    fn follow_slip(&mut self, segment: &FlowSegment<'_>) {
        let share = self.omega * segment.duration() / TAU;
        for (point, summary) in self.contacts.iter_mut().enumerate() {
            let limit = self.system.limits()[point];
            let state = segment.regime.points[point];
            let counts = match state {
                // Of a point that presses: the share of the period in which it is open.
                _ if self.system.is_microslip(point) => false,
                PointState::Open => limit.is_infinite(),
                _ => limit == 0.0 || state.slips(),
            };
            if counts {
                summary.slip_fraction += share;
            }
        }
    }

    fn follow_room(&mut self, segment: &FlowSegment<'_>) {
        for (plane, room) in self.system.planes().iter().zip(&mut self.room) {
            if segment.regime.points[plane.points[0]] == PointState::Stuck {
                let own = self.extremes.least_room(self.system, segment, *plane);
                *room = room.min(own);
            }
        }
    }

    /// Whether a contact in a plane but touches the limit that it never passes, and that varies.
    pub(super) fn touches(&self) -> bool {
        let planes = self.system.planes().iter().zip(&self.room);
        planes.into_iter().any(|(plane, room)| {
            let [point, _] = plane.points;
            *room <= TOUCHES
                && self.system.limit_slope(point).iter().any(|slope| *slope != 0.0)
                && self.contacts[point].slip_fraction <= INSTANT
        })
    }

    /// Completes half a period by its mirror image.
    pub(super) fn finish(&mut self) {
        self.gather();
        if !self.half_wave {
            return;
        }
        for range in &mut self.range {
            let largest = range[1].max(-range[0]);
            *range = [-largest, largest];
        }
        for summary in &mut self.contacts {
            summary.slip_fraction *= 2.0;
            summary.dissipation *= 2.0;
        }
        (self.work, self.viscous) = (2.0 * self.work, 2.0 * self.viscous);
        let half = 0.5 * TAU / self.omega;
        let mirrored: Vec<Event> = self
            .events
            .iter()
            .map(|event| Event { time: event.time + half, state: event.state.mirrored(), ..*event })
            .collect();
        self.events.extend(mirrored);
    }

    /// Writes harmonics, slip and friction work into a point.
    pub(super) fn write(&self, point: &mut Point) {
        let displacement = self.displacement();
        let observed = self.shapes.len() - self.system.points();
        let (dofs, contacts) = displacement.split_at(observed * self.orders);
        point.harmonics = self.orders - 1;
        point.displacement = dofs.to_vec();
        point.contact_displacement = contacts.to_vec();
        point.contact_force = self.force();
        point.contacts = self.summaries();
    }

    /// Harmonics X_0, X_1, … of the observed DOFs and the contact displacements, row after row.
    pub(super) fn displacement(&self) -> Vec<c64> {
        let (observed, contacts) = self.shapes.split_at(self.shapes.len() - self.system.points());
        let columns = self.system.modes() + self.system.points();
        let mut out = Vec::with_capacity(self.shapes.len() * self.orders);
        let shared: Vec<usize> = self.system.shared(&(0..contacts.len()).collect::<Vec<_>>());
        for shape in observed.iter().chain(shared.into_iter().map(|point| &contacts[point])) {
            for row in self.series.chunks_exact(columns) {
                out.push(shape.iter().zip(row).map(|(s, c)| *c * *s).sum());
            }
        }
        out
    }

    /// Harmonics of the contact forces, contact displacement after contact displacement.
    fn force(&self) -> Vec<c64> {
        let modes = self.system.modes();
        let columns = modes + self.system.points();
        let mut out = vec![c64::new(0.0, 0.0); self.system.displacements() * self.orders];
        for (order, row) in self.series.chunks_exact(columns).enumerate() {
            for (component, force) in self.system.components().iter().zip(&row[modes..]) {
                out[component * self.orders + order] += force;
            }
        }
        out
    }

    /// What the contact displacements do.
    fn summaries(&self) -> Vec<PointSummary> {
        self.system.contact_summaries(&self.contacts)
    }
}

/// Nodes that a segment needs over which the highest harmonic turns by an angle. No wave in a linear motion
/// turns by more than the length of its series, and energies by twice that.
fn nodes(segment: &FlowSegment<'_>, angle: f64) -> usize {
    if segment.series.is_nonlinear() {
        return NODES + (0.5 * angle).ceil() as usize;
    }
    nodes_of_waves(0.25 * (segment.length + segment.length.max(angle)), ROUNDING)
}

/// The points that slip on a stretch.
struct Slipping {
    /// Each with the points that move it, and how far.
    points: Vec<(usize, Vec<(usize, f64)>)>,
    planes: Vec<SlipPlane>,
}

impl Slipping {
    fn of(system: &ModalSystem, regime: &ContactState) -> Self {
        let slips = |point: &usize| regime.points[*point].sign() != 0.0;
        let rates = |point: usize| {
            let own = system.together_with(point).map(|j| (j, regime.slip_rate[(point, j)]));
            (point, own.filter(|(_, rate)| *rate != 0.0).collect())
        };
        let slides = |plane: &&SlipPlane| regime.points[plane.points[0]] == PointState::Sliding;
        Self {
            points: (0..system.points()).filter(slips).map(rates).collect(),
            planes: system.planes().iter().filter(slides).copied().collect(),
        }
    }

    /// Adds the friction work of a short time with these velocities and forces of the points.
    fn add_friction(
        &self,
        system: &ModalSystem,
        time: f64,
        [speed, force]: [&[f64]; 2],
        contacts: &mut [PointSummary],
    ) {
        for (point, rates) in &self.points {
            let slip: f64 = rates.iter().map(|(j, rate)| rate * speed[*j]).sum();
            contacts[*point].dissipation += time * force[*point] * slip;
        }
        for plane in &self.planes {
            let (along, pull) = system.pull(plane, force, speed);
            for (point, e) in plane.points.into_iter().zip(along) {
                let slip = e * pull / plane.stiffness;
                contacts[point].dissipation += time * force[point] * slip;
            }
        }
    }
}
