//! Where a curve over a range is cut into pieces.
//!
//! The seams follow from the model and the range alone: about as many points are expected in one piece as in
//! another, and with them as much work. The distance of points grows with that to the next resonance, so that a
//! straight line between two of them stays within the tolerance.

use super::stops::{LONGEST, SHORTEST};
use crate::balance::price::Price;
use crate::balance::settings::{HarmonicChoice, Settings};
use crate::model::Model;
use crate::Error;

/// Expected points of a piece, whose first one, which starts from nothing, costs as much as four others: where one
/// motion alone is possible, because friction broadens resonances so that fewer are needed, …
const PIECE: usize = 24;
/// … and along curves by arclength, which need more of them, and unevenly.
const PIECE_OF_BRANCH: usize = 12;
/// Most pieces: more processors than these have nothing to do.
const MOST: usize = 16;
/// Shortest expected step as a share of the longest.
const FINEST: f64 = 1e-3;
/// Distance from the range, as a share of it, up to which resonances count.
const NEARBY: f64 = 0.25;
/// Harmonics that automatic ones often come to.
const USUAL: usize = 27;

/// Frequencies at which pieces of a range begin, from its first end on; that end alone if the range is to
/// remain whole, because it takes less than so `much` operations.
///
/// # Errors
/// An eigenvalue iteration that fails.
pub(crate) fn seams(
    model: &Model,
    settings: &Settings,
    (from, to): (f64, f64),
    much: f64,
) -> Result<Vec<f64>, Error> {
    // Steps at the ends follow resonances outside, too.
    let beyond = NEARBY * (to - from).abs();
    let bounds = ((from.min(to) - beyond).max(f64::MIN_POSITIVE), from.max(to) + beyond);
    let forced = model.compliance().forced_harmonics();
    let resonances = model.resonances(bounds, forced.into_iter())?;
    let narrow: Vec<(f64, f64)> = resonances
        .iter()
        .filter(|one| one.forced && !one.partial)
        .map(|one| (one.omega, one.bandwidth))
        .collect();
    let course = expected(&narrow, settings.tolerance, (from, to));
    if work_of_point(model, settings) * (course.len() as f64) < much {
        return Ok(vec![from]);
    }
    let piece = if model.is_monotone() { PIECE } else { PIECE_OF_BRANCH };
    let count = (course.len() / piece).clamp(1, MOST);
    Ok((0..count).map(|piece| course[piece * course.len() / count]).collect())
}

/// Points that a curve past resonances of some bandwidths is expected to have.
fn expected(resonances: &[(f64, f64)], tolerance: f64, (from, to): (f64, f64)) -> Vec<f64> {
    let longest = LONGEST * (to - from).abs();
    let mut course = vec![from];
    let mut omega = from;
    while (to - omega) * (to - from).signum() > 0.0 {
        // Less than a digit of the frequency would lead nowhere.
        let step = expected_step(resonances, tolerance, longest, omega).max(SHORTEST * omega);
        omega += step * (to - from).signum();
        course.push(omega);
    }
    course.pop();
    course
}

/// Step that is expected at a frequency: half a bandwidth from a resonance and farther the response falls as the
/// distance grows, and its bend falls with the square of it.
pub(super) fn expected_step(
    resonances: &[(f64, f64)],
    tolerance: f64,
    longest: f64,
    omega: f64,
) -> f64 {
    let room =
        |&(at, width): &(f64, f64)| 2.0 * tolerance.sqrt() * (at - omega).abs().max(0.5 * width);
    resonances.iter().map(room).fold(longest, f64::min).max(FINEST * longest)
}

/// Operations of a solution in which all points slip.
fn work_of_point(model: &Model, settings: &Settings) -> f64 {
    let order = match settings.harmonics {
        HarmonicChoice::Fixed(order) => order,
        HarmonicChoice::Auto => USUAL.min(settings.max_harmonics),
    };
    let half_wave = model.is_symmetric() && settings.residual.is_symmetric();
    let slipping = model.compliance().contacts();
    Price { model, half_wave, slipping, lowest: order }.of(order)
}
