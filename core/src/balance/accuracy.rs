//! How wrong a truncated balance is: what its discarded harmonics would still change.
//!
//! The friction force of the solution has harmonics above H that the balance ignores. A Newton step
//! of the balance extended by them says what they would do: pushed through the compliance they move
//! the contacts, which changes the friction force at all harmonics, which moves the contacts again.
//! The change between two values of H, in contrast, says nothing, for the error stays on a plateau
//! until Hω passes the highest stuck natural frequency.
//!
//! A tangent foresees neither that contacts begin to slip, or cease to, nor that the slip of a nearly
//! rigid contact comes to other parts of the period. Where the first step leaves the motion of a contact
//! unexplained, a second one follows, with the tangent there, and the larger change counts. Along a curve what it
//! adds may be known from a point beside (`neighbour.rs`).

use super::condensed::Condensed;
use super::extension::{Extension, Steps};
use super::resonances::loaded_points;
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::Residual;
use crate::fourier::SampleTable;
use crate::model::Model;
use crate::solve::{norm, System as _};
use crate::structure::Quantity;
use crate::timing::Profile;
use crate::Error;
use faer::c64;

/// Share of the defect at a contact that a step may leave: where it leaves more, the tangent was not that
/// of the way.
const UNEXPLAINED: f64 = 0.3;

/// The change after the second step counts up to this multiple of that after the first, unless a contact
/// begins or ceases to slip: at nearly rigid contacts that go on slipping it overshoots tenfold.
const TRUSTED: f64 = 2.0;
/// Of solutions up to this harmonic the first change falls short there by as much, and the geometric mean of both counts
/// if it is more, …
const FEW: usize = 5;
/// … and all changes count so many times, as those of three grids do (Roache 1998).
const CAUTION: f64 = 1.25;

/// What an extended balance says.
pub(super) struct Estimate {
    /// Sum over all harmonics of the change that it would bring to each observed DOF \[m\]; infinite
    /// where a discarded harmonic meets a resonance that nothing damps.
    pub(super) errors: Vec<f64>,
    /// The same after the first step.
    pub(super) first: Vec<f64>,
    /// Largest change of the motion of a contact, relative to its vibration; of the steps taken together.
    pub(super) contacts: f64,
    /// Whether it makes no contact begin or cease to slip.
    pub(super) keeps_states: bool,
    /// Whether it ended after the first step because of that.
    pub(super) ended_in_state: bool,
    /// Whether it took a second step.
    pub(super) took_two: bool,
    /// Whether it ended after the first step because that says enough.
    pub(super) partial: bool,
}

impl Estimate {
    /// Whether the extended balance led nowhere.
    pub(super) fn is_lost(&self) -> bool {
        !self.contacts.is_finite()
    }

    /// Of the same change of every observed DOF.
    fn of(error: f64, observed: usize) -> Self {
        let errors = vec![error; observed];
        Self {
            first: errors.clone(),
            errors,
            contacts: error,
            keeps_states: error.is_finite(),
            ended_in_state: false,
            took_two: false,
            partial: false,
        }
    }
}

/// The estimate of a solution, whose work `profile` is told; `solved` are the equations that were solved, if they
/// are at hand. Nothing if the analysis is to end.
#[allow(clippy::too_many_arguments)]
pub(super) fn estimate(
    model: &Model,
    table: &SampleTable,
    residual: Residual,
    solution: &Unknowns,
    observe: &[usize],
    point: &Point,
    solved: Option<&Condensed<'_>>,
    extension: &Extension<'_>,
    interrupted: &dyn Fn() -> bool,
    profile: &mut Profile,
) -> Result<Option<Estimate>, Error> {
    let mut extended = Condensed::new(model, table, residual, false);
    if extension.formed {
        extended.densify();
    }
    if let Some(most) = extension.products {
        extended.hold_to_products(most);
    }
    if extension.part {
        extended.answer(loaded_points(model, point));
    }
    extended.watch(interrupted);
    if extended.set_omega_beside(point.omega, solved).is_err() {
        return Ok(Some(Estimate::of(f64::INFINITY, observe.len())));
    }
    if let Some(solved) = solved {
        extended.begin_beside(solved, None);
    }
    let found = of_extended(&mut extended, solution, observe, point, extension);
    profile.work += extended.profile.work;
    found
}

/// The same of extended equations at its frequency.
fn of_extended(
    extended: &mut Condensed<'_>,
    solution: &Unknowns,
    observe: &[usize],
    point: &Point,
    extension: &Extension<'_>,
) -> Result<Option<Estimate>, Error> {
    let table = extended.table;
    let begin = solution.recast(table.harmonics());
    let mut x = begin.clone();
    let (mut defect, mut step) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    extended.residual(&x, &mut defect);
    let mut found = Estimate::of(0.0, observe.len());
    let caution = if point.harmonics <= FEW { CAUTION } else { 1.0 };
    let counts = caution * extension.unseen;
    for last in [false, true] {
        if extended.interrupted() {
            return Ok(None);
        }
        if !extended.solve(&defect, &mut step) {
            let lost = Estimate::of(f64::INFINITY, observe.len());
            return Ok(if extended.interrupted() { None } else { Some(lost) });
        }
        step.iter_mut().for_each(|s| *s = -*s);
        let mut slip_load = extended.slip_load();
        extended.add_tangent_product(&step, &mut slip_load);
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        let mut changes = changes(extended, &x, &slip_load, observe, point)?;
        changes.iter_mut().for_each(|change| *change *= counts);
        found.contacts = contact_change(extended, &begin, &x);
        found.took_two = last;
        if last {
            let [keeps, few] = [found.keeps_states, point.harmonics <= FEW];
            let trusted = |first: f64, second: f64| {
                let between = if few { (first * second).sqrt() } else { 0.0 };
                let most = between.max(TRUSTED * first);
                if keeps {
                    second.min(most)
                } else {
                    second
                }
            };
            let errors = found.errors.iter_mut().zip(changes);
            errors.for_each(|(error, change)| *error = error.max(trusted(*error, change)));
            break;
        }
        (found.first, found.errors) = (changes.clone(), changes);
        found.partial = extension.is_exceeded(&found.errors);
        if found.partial {
            break;
        }
        match extension.steps {
            Steps::One => break,
            Steps::OneInState => {
                found.ended_in_state = extended.keeps_states(&x);
                if found.ended_in_state {
                    break;
                }
            }
            Steps::Two => {}
        }
        let slipped = slipping(extended);
        let before = by_point(&defect, table);
        extended.residual(&x, &mut defect);
        found.keeps_states = slipped == slipping(extended);
        let mut after = by_point(&defect, table).into_iter().zip(before);
        if after.all(|(after, before)| after <= UNEXPLAINED * before) {
            break;
        }
    }
    found.contacts *= extension.unseen;
    Ok(Some(found))
}

/// Which contacts slip where the tangents are known.
fn slipping(extended: &Condensed<'_>) -> Vec<bool> {
    extended.loads.iter().map(|load| load.active).collect()
}

/// Sizes of the series of all points.
fn by_point(series: &[f64], table: &SampleTable) -> Vec<f64> {
    series.chunks_exact(table.harmonics().slots()).map(norm).collect()
}

/// Largest change of the motion of a contact, relative to its vibration.
fn contact_change(extended: &Condensed<'_>, begin: &[f64], x: &[f64]) -> f64 {
    let (slots, offset) = (extended.harmonics().slots(), extended.harmonics().offset());
    let changes = extended.model.points().iter().map(|points| {
        let (mut change, mut vibration) = (0.0_f64, 0.0_f64);
        for point in points.clone() {
            let series = point * slots + offset..(point + 1) * slots;
            let (begin, x) = (&begin[series.clone()], &x[series]);
            vibration += begin.iter().map(|a| a * a).sum::<f64>();
            change += begin.iter().zip(x).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
        }
        if vibration > 0.0 {
            (change / vibration).sqrt()
        } else {
            0.0
        }
    });
    changes.fold(0.0, f64::max)
}

/// Sum over all harmonics of how far each observed DOF is from a point in the extended balance.
fn changes(
    extended: &Condensed<'_>,
    x: &[f64],
    slip_load: &[f64],
    observe: &[usize],
    point: &Point,
) -> Result<Vec<f64>, Error> {
    let mut sums = vec![0.0; observe.len()];
    let orders = point.harmonics + 1;
    extended.displacements(Quantity::Whole, [x, slip_load], observe, |order, observed, _, _| {
        for (dof, sum) in sums.iter_mut().enumerate() {
            let before = if order < orders {
                point.displacement[dof * orders + order]
            } else {
                c64::new(0.0, 0.0)
            };
            // In place of `norm`, which guards against squares beyond all numbers and takes five times as long.
            *sum += (observed[dof] - before).norm_sqr().sqrt();
        }
    })?;
    Ok(sums)
}
