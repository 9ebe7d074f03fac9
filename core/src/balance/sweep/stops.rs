//! Where a curve over a range has to have a point: at its resonances.

use crate::balance::forced::ForcedBalance;
use crate::balance::solution::Point;
use crate::model::Resonance;
use crate::Error;

/// Longest step as a share of the range: a curve needs points to be looked at.
pub(super) const LONGEST: f64 = 1.0 / 60.0;
/// Shortest step relative to the frequency.
pub(super) const SHORTEST: f64 = 1e-7;
/// Resonances closer than this share of their bandwidths are one stop.
const SEEN: f64 = 0.25;

/// Resonances inside the range, each with its bandwidth, and the end, in the order of the sweep.
/// Those of harmonics that no force excites count where friction can make them as high as the
/// response is at the start.
pub(super) fn stops(
    balance: &mut ForcedBalance<'_>,
    first: &Point,
    from: f64,
    to: f64,
) -> Result<Vec<(f64, f64)>, Error> {
    let (low, high) = (from.min(to), from.max(to));
    let table = balance.table(first.harmonics.max(1));
    let resonances = balance.model.resonances((low, high), table.harmonics().orders())?;
    let orders = first.harmonics + 1;
    let rises = |reach: &Vec<f64>| {
        let sizes = first.displacement.chunks_exact(orders);
        let mut observed = balance.observe.iter().zip(sizes).enumerate();
        observed.any(|(position, (&dof, series))| {
            let size = series[1..].iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt();
            balance.scale.counts(position) && reach[dof] > size
        })
    };
    let counts =
        |one: &&Resonance| one.forced || !one.partial && one.reach.as_ref().is_none_or(rises);
    let mut stops: Vec<(f64, f64)> = resonances
        .iter()
        .filter(counts)
        // A relative shift by 1e-7 keeps an undamped resonance at a distance.
        .map(|one| (one.omega * (1.0 - 1e-7), one.bandwidth))
        .filter(|(w, _)| *w > low && *w < high)
        .collect();
    stops.dedup_by(|a, b| a.0 - b.0 < (SEEN * a.1.min(b.1)).max(1e-6 * b.0));
    let end = (to, f64::INFINITY);
    if to < from {
        stops.reverse();
    }
    stops.push(end);
    Ok(stops)
}
