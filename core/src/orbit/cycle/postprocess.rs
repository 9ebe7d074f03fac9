//! What is read off an exact limit cycle: harmonics, extremes, slip and energies.

use super::limit_cycle::OrbitCurve;
use super::settings::Cycle;
use crate::balance::{Point, PointStatus};
use crate::contact::PointState;
use crate::fourier::SampleTable;
use crate::motion::{Flow, FlowEvent, ModalSystem, Quadrature, State};
use crate::orbit::survey::Survey;
use std::f64::consts::{PI, TAU};

/// Newton steps to the maximum of the DOF with which the period begins.
const POLISH: usize = 4;

/// Reads a limit cycle off the orbit at a point of a curve, from the maximum of the DOF `phase`;
/// nothing if the flow does not run to its end.
pub(super) fn postprocess(
    curve: &OrbitCurve<'_>,
    z: &[f64],
    phase: usize,
    table: &SampleTable,
    quadrature: &mut Quadrature,
    mut cycle: Cycle,
) -> Option<Cycle> {
    let [.., omega, _] = z else { return None };
    let starts = curve.states(z)?;
    curve.with_shooting(z, |member, _, _| {
        let system = &member.system;
        let symmetric = curve.is_symmetric();
        let orbit = OrbitPostprocess { system, omega: *omega, starts, symmetric };
        let begin = orbit.maximum(phase, table, quadrature)?;
        let all: Vec<usize> = (0..system.modes()).collect();
        let survey = orbit.pass(&begin, &all, table.harmonics().highest(), quadrature)?;
        let points = system.displacements();
        cycle.response = Point::empty(*omega, PointStatus::Converged, all.len(), points);
        survey.write(&mut cycle.response);
        cycle.response.error_estimate = vec![0.0; all.len()];
        cycle.range = survey.range[..all.len()].to_vec();
        cycle.state = begin.state.to_dofs(system);
        cycle.viscous = survey.viscous;
        cycle.events = survey.events;
        Some(cycle)
    })
}

/// Where a pass over half a period, or a whole one of no symmetry, begins.
struct Begin {
    /// Time after the start of the motion \[s\].
    time: f64,
    /// −1 where it begins with the mirror image of the motion, otherwise 1.
    side: f64,
    state: State,
}

/// The motion over half a period, or a whole one of no symmetry, with the states from which its segments
/// start.
struct OrbitPostprocess<'a> {
    system: &'a ModalSystem,
    omega: f64,
    starts: Vec<State>,
    symmetric: bool,
}

impl OrbitPostprocess<'_> {
    /// How long the motion is given \[s\].
    fn span(&self) -> f64 {
        if self.symmetric {
            PI / self.omega
        } else {
            TAU / self.omega
        }
    }

    /// One pass over half a period, completed by its mirror image, or over a whole one.
    fn pass<'a>(
        &'a self,
        begin: &Begin,
        observe: &[usize],
        highest: usize,
        quadrature: &'a mut Quadrature,
    ) -> Option<Survey<'a>> {
        let (system, symmetric) = (self.system, self.symmetric);
        let mut survey = Survey::new(system, self.omega, symmetric, highest, observe, quadrature);
        let mut flow = Flow::new(self.system, self.omega);
        let span = self.span();
        let again = if symmetric { -begin.side } else { begin.side };
        let mut state = begin.state.clone();
        let mut see = |passage: FlowEvent<'_>| survey.include(&passage);
        for (lap, side) in [(0.0, begin.side), (span, again)] {
            // A single segment passes its end as it comes.
            for start in self.starts.iter().filter(|_| self.starts.len() > 1) {
                let at = start.time + lap - begin.time;
                if at > 0.0 && at < span {
                    flow.run(&mut state, at, &mut see).ok()?;
                    renew(&mut state, start, side);
                }
            }
        }
        flow.run(&mut state, span, &mut see).ok()?;
        survey.finish();
        Some(survey)
    }

    /// The state at a time of the motion given.
    fn state_at(&self, time: f64) -> Option<State> {
        let start = self.starts.iter().rev().find(|start| start.time <= time)?;
        let mut state = start.clone();
        Flow::new(self.system, self.omega).run(&mut state, time, &mut |_| {}).ok()?;
        Some(state)
    }

    /// The maximum of a DOF over the period, under symmetry also the mirror image of a minimum in the
    /// half.
    fn maximum(
        &self,
        dof: usize,
        table: &SampleTable,
        quadrature: &mut Quadrature,
    ) -> Option<Begin> {
        let system = self.system;
        let highest = table.harmonics().highest();
        let first = Begin { time: 0.0, side: 1.0, state: self.starts.first()?.clone() };
        let series = self.pass(&first, &[dof], highest, quadrature)?.displacement();
        let mut values = vec![0.0; table.harmonics().slots()];
        table.harmonics().write_series(&series[..=highest], &mut values);
        let mut turns = Vec::new();
        table.turning_points(&values, &mut turns);
        let height = |value: f64| if self.symmetric { value.abs() } else { value };
        let most = turns.iter().max_by(|a, b| height(a.value).total_cmp(&height(b.value)))?;
        let side = if self.symmetric { most.value.signum() } else { 1.0 };
        let mut time = most.theta / self.omega;
        let mut state = self.state_at(time)?;
        for _ in 1..POLISH {
            let acceleration =
                system.acceleration(&state.displacement, &state.velocity, &state.force);
            let of =
                |modal: &[f64]| -> f64 { system.shape(dof).zip(modal).map(|(s, q)| s * q).sum() };
            let step = of(&state.velocity) / of(&acceleration);
            // The series leads close to the extremum; a longer step would leave it.
            if step.abs() < 0.01 * PI / self.omega {
                time = (time - step).max(0.0);
            }
            state = self.state_at(time)?;
        }
        state.time = 0.0;
        if side < 0.0 {
            state.mirror();
        }
        Some(Begin { time, side, state })
    }
}

/// Takes a state over the join of two segments: displacements, velocities and the forces that may
/// vary become those at the start of the next one, or on the other side their mirror image.
fn renew(state: &mut State, start: &State, side: f64) {
    for (own, new) in
        [(&mut state.displacement, &start.displacement), (&mut state.velocity, &start.velocity)]
    {
        own.iter_mut().zip(new).for_each(|(own, new)| *own = side * new);
    }
    for ((own, new), point) in state.force.iter_mut().zip(&start.force).zip(&state.points) {
        if matches!(*point, PointState::Stuck | PointState::Sliding) {
            *own = side * new;
        }
    }
    for (own, new) in state.reversals.iter_mut().zip(&start.reversals) {
        own.clone_from(new);
        if side < 0.0 {
            own.mirror();
        }
    }
}
