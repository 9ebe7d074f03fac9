//! What is read off an exact limit cycle: harmonics, extremes, slip and energies.

use super::limit_cycle::OrbitCurve;
use super::quadrature::Quadrature;
use super::survey::Survey;
use crate::balance::{Point, PointStatus};
use crate::contact::PointState;
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::motion::{Event, Flow, ModalSystem, State};
use std::f64::consts::PI;

/// Newton steps to the maximum of the DOF with which the period begins.
const POLISH: usize = 4;

/// An exact limit cycle read off.
pub(super) struct CycleSurvey {
    pub(super) response: Point,
    /// Lowest and highest displacement of every DOF [m].
    pub(super) range: Vec<[f64; 2]>,
    /// State at the start of the period, at the DOFs.
    pub(super) state: Vec<f64>,
    pub(super) viscous: f64,
    pub(super) events: Vec<Event>,
}

/// Follows the orbit at a point of a curve, from the maximum of the DOF `phase`.
pub(super) fn survey(
    curve: &OrbitCurve<'_>,
    z: &[f64],
    phase: usize,
    table: &SampleTable,
    quadrature: &mut Quadrature,
) -> Option<CycleSurvey> {
    let [.., omega, _] = z else { return None };
    let first = curve.state(z)?;
    curve.with_shooting(z, |member, _, _| {
        let (model, system) = (member.model(), &member.system);
        let begin = maximum(model, system, *omega, &first, phase, table, quadrature)?;
        let highest = table.harmonics().highest();
        let all: Vec<usize> = (0..system.modes()).collect();
        let survey = pass(model, system, *omega, &begin, &all, highest, quadrature)?;
        let points = system.points();
        let mut response = Point::empty(*omega, PointStatus::Converged, all.len(), points);
        response.harmonics = highest;
        let displacement = survey.displacement();
        let (dofs, contacts) = displacement.split_at(all.len() * (highest + 1));
        response.displacement = dofs.to_vec();
        response.contact_displacement = contacts.to_vec();
        response.contact_force = survey.force();
        response.contacts.clone_from(&survey.contacts);
        response.error_estimate = vec![0.0; all.len()];
        Some(CycleSurvey {
            response,
            range: survey.range[..all.len()].to_vec(),
            state: begin.to_dofs(system),
            viscous: survey.viscous,
            events: survey.events,
        })
    })
}

/// One pass over half a period, completed by its mirror image.
fn pass<'a>(
    model: &'a Model,
    system: &'a ModalSystem,
    omega: f64,
    start: &State,
    observe: &[usize],
    highest: usize,
    quadrature: &'a mut Quadrature,
) -> Option<Survey<'a>> {
    let mut survey = Survey::new(system, omega, true, highest, observe, quadrature);
    let mut state = start.clone();
    Flow::new(model, system, omega)
        .run(&mut state, PI / omega, &mut |passage| survey.include(&passage))
        .ok()?;
    survey.finish();
    Some(survey)
}

/// The state at the maximum of a DOF over the period.
fn maximum(
    model: &Model,
    system: &ModalSystem,
    omega: f64,
    first: &State,
    dof: usize,
    table: &SampleTable,
    quadrature: &mut Quadrature,
) -> Option<State> {
    let highest = table.harmonics().highest();
    let series = pass(model, system, omega, first, &[dof], highest, quadrature)?.displacement();
    let mut values = vec![0.0; table.harmonics().slots()];
    table.harmonics().write_series(&series[..=highest], &mut values);
    let mut turns = Vec::new();
    table.turning_points(&values, &mut turns);
    let most = turns.iter().max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))?;
    let mut time = most.theta / omega;
    let half = PI / omega;
    let mut state = first.clone();
    for round in 0..POLISH {
        state = first.clone();
        Flow::new(model, system, omega).run(&mut state, time, &mut |_| {}).ok()?;
        let acceleration = system.acceleration(&state.displacement, &state.velocity, &state.force);
        let of = |modal: &[f64]| -> f64 { system.shape(dof).zip(modal).map(|(s, q)| s * q).sum() };
        let step = of(&state.velocity) / of(&acceleration);
        // The series leads close to the extremum; a longer step would leave it.
        if round + 1 < POLISH && step.abs() < 0.01 * half {
            time = (time - step).max(0.0);
        }
    }
    state.time = 0.0;
    if most.value < 0.0 {
        mirror(&mut state);
    }
    Some(state)
}

/// The mirror image of a state.
fn mirror(state: &mut State) {
    for values in [&mut state.displacement, &mut state.velocity, &mut state.force] {
        values.iter_mut().for_each(|v| *v = -*v);
    }
    for point in &mut state.points {
        *point = match point {
            PointState::Stuck => PointState::Stuck,
            PointState::Forward => PointState::Backward,
            PointState::Backward => PointState::Forward,
        };
    }
}

/// Sample tables of odd harmonics.
pub(super) fn odd_table(highest: usize) -> SampleTable {
    SampleTable::new(Harmonics::new(highest, true))
}
