//! Modes that harmonics beyond an extended balance meet.
//!
//! What follows the harmonics that an estimate can afford is small, unless one of them comes to a narrow mode: that
//! answers a thousand times as strongly as between modes. The friction force of the solution at such a harmonic, and
//! how it follows the motion at that harmonic, take few evaluations of the laws. A Newton step in this harmonic
//! alone tells what it would change.

use super::effort::Effort;
use super::solution::Point;
use super::unknowns::Unknowns;
use crate::contact::{Motion, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::norm;
use crate::structure::{Quantity, Receptance, Request};
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat};
use std::ops::Range;

/// A harmonic meets a mode up to this distance, relative to the frequency.
const NEAR: f64 = 0.05;
/// Change of a motion by which tangents are found, relative to it.
const PROBE: f64 = 1e-6;

/// Harmonics beyond an extended balance that meet modes, the lowest ones, as far as they can be afforded.
#[derive(Default)]
pub(super) struct Resonances {
    pub(super) orders: Vec<usize>,
    /// What they take, in reckoned nanoseconds.
    pub(super) effort: f64,
}

impl Resonances {
    /// Those above an order, of a structure whose modes are known, that take no more than `most`.
    pub(super) fn beyond(
        highest: usize,
        most: f64,
        effort: &Effort<'_>,
        kept: &Harmonics,
        omega: f64,
    ) -> Self {
        let mut found = Self::default();
        let compliance = effort.compliance();
        if !compliance.finds_modes(0.0) {
            return found;
        }
        let divisor = effort.common_harmonic();
        let step = if kept.half_wave() { 2 * divisor } else { divisor };
        let last = (compliance.highest_frequency() / omega + NEAR) as usize;
        let begin = divisor + (highest + step).saturating_sub(divisor) / step * step;
        for order in (begin..=last).step_by(step) {
            let taken = found.effort + effort.of_resonance(kept.highest(), order);
            if taken > most {
                break;
            }
            let range = [-NEAR, NEAR].map(|aside| (order as f64 + aside) * omega);
            if !compliance.is_clear(order, range, 0.0) {
                found.orders.push(order);
                found.effort = taken;
            }
        }
        found
    }
}

/// What the highest harmonic of a table, which a solution discards, would bring to each observed DOF \[m\]; infinite at
/// a resonance that nothing damps.
pub(super) fn answer(
    model: &Model,
    table: &SampleTable,
    residual: Residual,
    solution: &Unknowns,
    observe: &[usize],
    point: &Point,
) -> Vec<f64> {
    let harmonic = table.harmonics().highest();
    let (compliance, omega) = (model.compliance(), point.omega);
    let (contacts, points) = (compliance.contacts(), loaded_points(model, point));
    let mut receptance = Receptance::default();
    if compliance.receptance_of(&points, harmonic, omega, &mut receptance).is_err() {
        return vec![f64::INFINITY; observe.len()];
    }
    let all = Mat::from_fn(contacts, points.len(), |i, j| receptance.contact[j * contacts + i]);
    let own = Mat::from_fn(points.len(), points.len(), |i, j| all[(points[i], j)]);
    let (load, tangent) = friction(model, table, residual, solution, &points);
    let equations = Mat::<c64>::identity(points.len(), points.len()) - &own * &tangent;
    let motion = equations.partial_piv_lu().solve(&own * &load);
    let load = load + tangent * motion;
    let contact = all * &load;
    let mut slip_load = vec![c64::new(0.0, 0.0); contacts];
    points.iter().zip(load.col(0).iter()).for_each(|(&point, load)| slip_load[point] = *load);
    let contact: Vec<c64> = contact.col(0).iter().copied().collect();
    let (contact, slip_load) = (&contact[..], &slip_load[..]);
    let quantity = Quantity::OfSlip;
    let request = Request { harmonic, omega, quantity, contact, slip_load, observe };
    let mut out = vec![c64::new(0.0, 0.0); observe.len()];
    let found = compliance.displacement(&request, &mut out);
    let size = |u: &c64| if u.is_finite() { u.norm() } else { f64::INFINITY };
    out.iter().map(|u| if found.is_ok() { size(u) } else { f64::INFINITY }).collect()
}

/// Points of the contacts that slip in a solution, and of nodes, which carry loads without slip.
pub(super) fn loaded_points(model: &Model, point: &Point) -> Vec<usize> {
    let slips = |points: &Range<usize>| {
        point.contacts[points.clone()].iter().any(|contact| contact.slip_fraction > 0.0)
    };
    let loaded = model.points().iter().filter(|points| points.len() > 1 || slips(points));
    loaded.flat_map(Range::clone).collect()
}

/// Slip loads at the highest harmonic of a table, and their derivative in the motion at this harmonic, of the contacts
/// that some points belong to.
fn friction(
    model: &Model,
    table: &SampleTable,
    residual: Residual,
    solution: &Unknowns,
    points: &[usize],
) -> (Mat<c64>, Mat<c64>) {
    let slots = table.harmonics().slots();
    // The highest harmonic is last.
    let slot = slots - 2;
    let mut x = solution.recast(table.harmonics());
    let place = |contact: &Range<usize>| points.binary_search(&contact.start).ok();
    let laws = model.laws().iter().zip(model.points());
    let loaded: Vec<_> = laws.filter_map(|(law, own)| Some((law, own, place(own)?))).collect();
    let mut load = SlipLoad::default();
    let mut evaluate = |x: &[f64]| {
        let mut all = Mat::zeros(points.len(), 1);
        for (law, own, place) in &loaded {
            let displacement = &x[own.start * slots..own.end * slots];
            law.slip_load(Motion { table, displacement, residual }, false, &mut load);
            for (row, series) in load.value.chunks_exact(slots).enumerate() {
                all[(place + row, 0)] = c64::new(series[slot], -series[slot + 1]);
            }
        }
        all
    };
    let still = evaluate(&x);
    let mut tangent = Mat::zeros(points.len(), points.len());
    let offset = table.harmonics().offset();
    let vibration = |own: &Range<usize>| {
        let series = x[own.start * slots..own.end * slots].chunks_exact(slots);
        series.map(|series| norm(&series[offset..])).fold(0.0, f64::max)
    };
    // A contact at rest sticks: its tangent is zero.
    let probed = loaded.iter().map(|(_, own, place)| (*own, *place, PROBE * vibration(own)));
    let probed: Vec<_> = probed.filter(|(.., probe)| *probe > 0.0).collect();
    for direction in 0..probed.iter().map(|(own, ..)| own.len()).max().unwrap_or(0) {
        let moved = || probed.iter().filter(|(own, ..)| direction < own.len());
        let at = |own: &Range<usize>| (own.start + direction) * slots + slot;
        moved().for_each(|(own, _, probe)| x[at(own)] = *probe);
        let changed = evaluate(&x);
        for (own, place, probe) in moved() {
            x[at(own)] = 0.0;
            for row in *place..place + own.len() {
                // Motions at high harmonics meet all of the period alike: they bring no conjugate.
                tangent[(row, place + direction)] = (changed[(row, 0)] - still[(row, 0)]) / *probe;
            }
        }
    }
    (still, tangent)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::contact::Jenkins;
    use crate::model::Contact;
    use crate::structure::Structure;
    use faer::mat;

    /// Also of harmonics that pass more than a period between two samples of the motion.
    #[test]
    fn friction_at_one_harmonic_is_that_of_all() {
        let (mass, zero) = (mat![[1.0]], mat![[0.0]]);
        let structure = Structure::new(mass.as_ref(), zero.as_ref(), mass.as_ref()).unwrap();
        let law = Box::new(Jenkins::new(3.0, 0.4).unwrap());
        let contacts = vec![Contact { law, rows: mat![[1.0]] }];
        let model = Model::new(structure, contacts, Vec::new()).unwrap();
        for (half_wave, values) in [
            (true, vec![0.9, 0.2, -0.1, 0.15]),
            (false, vec![0.3, 0.9, 0.2, 0.2, -0.1, -0.1, 0.15]),
        ] {
            let solution = Unknowns::new(Harmonics::new(3, half_wave), values);
            let residual = Residual::Centred;
            for order in [5, 31, 63, 69, 127, 191] {
                let table = SampleTable::coarse_up_to(3, Harmonics::new(order, half_wave));
                let (load, tangent) = friction(&model, &table, residual, &solution, &[0]);
                let table = SampleTable::new(Harmonics::new(order, half_wave));
                let displacement = &solution.recast(table.harmonics())[..];
                let motion = Motion { table: &table, displacement, residual };
                let mut whole = SlipLoad::default();
                model.laws()[0].slip_load(motion, true, &mut whole);
                let slots = table.harmonics().slots();
                let [cosine, sine] = [slots - 2, slots - 1];
                let expected = c64::new(whole.value[cosine], -whole.value[sine]);
                assert!((load[(0, 0)] - expected).norm() < 1e-9, "{order}: {load:?}");
                let column = [cosine, sine].map(|row| whole.tangent[row * slots + cosine]);
                let expected = c64::new(column[0], -column[1]);
                assert!((tangent[(0, 0)] - expected).norm() < 1e-3, "{order}: {tangent:?}");
            }
        }
    }

    /// A node that symmetry keeps at rest has no vibration to probe.
    #[test]
    fn a_contact_at_rest_sticks() {
        let (mass, zero) = (Mat::identity(2, 2), Mat::zeros(2, 2));
        let structure = Structure::new(mass.as_ref(), zero.as_ref(), mass.as_ref()).unwrap();
        let law = Box::new(Jenkins::new(3.0, 0.4).unwrap());
        let rows = |at: usize| Mat::from_fn(1, 2, |_, j| if j == at { 1.0 } else { 0.0 });
        let contacts = (0..2).map(|at| Contact { law: law.clone(), rows: rows(at) }).collect();
        let model = Model::new(structure, contacts, Vec::new()).unwrap();
        let solution = Unknowns::new(Harmonics::new(1, true), vec![0.9, 0.2, 0.0, 0.0]);
        let table = SampleTable::coarse_up_to(1, Harmonics::new(31, true));
        let (load, tangent) = friction(&model, &table, Residual::Centred, &solution, &[0, 1]);
        assert!(load[(0, 0)].norm() > 0.0 && tangent[(0, 0)].norm() > 0.0);
        assert_eq!((load[(1, 0)].norm(), tangent[(1, 1)].norm()), (0.0, 0.0));
    }
}
