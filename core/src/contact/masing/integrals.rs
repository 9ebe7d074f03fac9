//! Fourier integrals of the slip load of a Masing law, and their derivative.
//!
//! Along a branch q depends on the displacement, on the reversals before it and on nothing else, and q
//! is continuous where a branch ends: the derivative of the integrals is the integral of
//! `∂q = ∂q_r + L'(|u − u_r|/2) (∂u − ∂u_r)`. At a reversal u is stationary, so that ∂u_r is the basis
//! there: each reversal adds a term of rank one. Gauss panels are halved until they resolve L'.

use super::loops::{Branch, Loops, Stretch};
use crate::contact::backbone::LoadingCurve;
use crate::contact::slider_integrals::{dot, Bounds};
use crate::contact::stick_slip::Path;
use crate::contact::{Motion, SlipLoad};
use crate::fourier::{Harmonics, Interval, IntervalSums, Lanes, Panel, NODES};

/// Last terms τ of the series of L' on a panel, times its length and relative to the largest L', that are
/// resolved, where the basis hardly turns. If the terms fall like ρ^−n, the rule with n nodes misses
/// `τ ρ^−(n+1) exp(p (ρ − 1/ρ)/2)` of a product with a function that turns by p over half the panel: 1e-13 with
/// these two numbers, for any p that a panel may have.
const RESOLVED: f64 = 6e-7;
/// By how much less for every radian.
const TURNED: f64 = 0.47;
/// Halvings after which a panel is taken as it is.
const MOST_HALVINGS: u32 = 40;
/// Product of the power that an interval is stretched by and of the exponent of its root with which
/// the rule converges. More would move nodes to where the displacement has no digits left.
const SMOOTH: f64 = 4.5;

/// A panel on a stretch.
pub(super) struct Nodes<'a> {
    pub(super) panel: &'a Panel,
    pub(super) stretch: &'a Stretch,
    pub(super) branch: &'a Branch,
    /// Half the distance from the reversal \[m\], the loss there \[N\], and its slope [N/m].
    pub(super) distance: Lanes,
    pub(super) loss: Lanes,
    pub(super) slope: Lanes,
}

/// Wants all of them.
pub(super) fn every(_: &Stretch) -> bool {
    true
}

/// Calls `visit` with panels that cover the wanted stretches of the loops, and counts all that were tried.
pub(super) fn sweep(
    curve: &LoadingCurve,
    motion: Motion<'_>,
    loops: &Loops,
    wanted: impl Fn(&Stretch) -> bool,
    largest: f64,
    mut visit: impl FnMut(&Nodes<'_>),
) -> usize {
    let harmonics = motion.table.harmonics();
    let mut panel = Panel::new(harmonics);
    let power = |root: f64| (SMOOTH / (2.0 * root + 1.0)).ceil() as i32;
    let at_rest = curve.backbone.root_at_rest().map_or(1, power);
    let (mut intervals, mut open, mut solved) = (Vec::new(), Vec::new(), 0);
    for stretch in loops.stretches.iter().filter(|stretch| wanted(stretch)) {
        let branch = &loops.branches[stretch.branch];
        let powers =
            [if stretch.reverses { at_rest } else { 1 }, if stretch.reaches_end { 4 } else { 1 }];
        Interval::cut(harmonics, [stretch.start, stretch.end], powers, &mut intervals);
        open.extend(intervals.drain(..).map(|interval| (interval, 0)));
        while let Some((interval, halvings)) = open.pop() {
            solved += 1;
            let u = panel.place(harmonics, &interval, motion.displacement);
            let distance = u.map(|u| (0.5 * branch.sign * (u - branch.origin)).max(0.0));
            let [loss, slope] = curve.losses(&distance);
            let resolved = RESOLVED * (-TURNED * interval.phase(harmonics)).exp();
            let rough = panel.tail(&slope) * interval.length() > resolved * largest;
            if rough && halvings < MOST_HALVINGS {
                open.extend(interval.halves().map(|half| (half, halvings + 1)));
                continue;
            }
            visit(&Nodes { panel: &panel, stretch, branch, distance, loss, slope });
        }
    }
    solved
}

/// Adds the integrals of the loops, without what keeps them from their middle.
pub(super) fn add_loops(
    curve: &LoadingCurve,
    motion: Motion<'_>,
    path: &Path<'_>,
    loops: &Loops,
    tangent: bool,
    out: &mut SlipLoad,
) {
    let harmonics = motion.table.harmonics();
    let (size, half_range) = (harmonics.slots(), path.half_range());
    let weight = 2.0 / harmonics.span();
    let largest = curve.loss(half_range).slope;
    let mut sums = IntervalSums::new(harmonics);
    let count = loops.branches.len();
    // Integrals over the stretches of each branch, of the basis and of L' times the basis.
    let mut held = vec![0.0; count * size];
    let mut followed = vec![0.0; count * size];
    let (mut bounds, mut over) = (Bounds::new(harmonics), vec![0.0; size]);
    let loads = loops.at_reversals(half_range, |u| curve.loss(u).value);
    for stretch in &loops.stretches {
        let range = stretch.branch * size..(stretch.branch + 1) * size;
        let Branch { origin, sign, .. } = loops.branches[stretch.branch];
        over.fill(0.0);
        bounds.add_integral(harmonics, stretch.start, stretch.end, weight, &mut over);
        add(loads[stretch.branch], &over, &mut out.value);
        add(1.0, &over, &mut held[range.clone()]);
        // q = q_r ± 2 L(0) + L' (u − u_r) where L is a straight line.
        let Some([at_rest, slope]) = curve.line(stretch.piece) else { continue };
        add(2.0 * sign * at_rest - slope * origin, &over, &mut out.value);
        add(slope, &over, &mut followed[range]);
        sums.add_weighted(stretch.start, stretch.end, weight * slope);
    }
    sums.rows(harmonics, 1.0, |i, row| out.value[i] += dot(row, motion.displacement));
    let bent = |stretch: &Stretch| curve.line(stretch.piece).is_none();
    out.solved = sweep(curve, motion, loops, bent, largest, |nodes| {
        let (mut load, mut slope) = ([0.0; NODES], [0.0; NODES]);
        for i in 0..NODES {
            let own = weight * nodes.panel.weight[i];
            load[i] = 2.0 * nodes.branch.sign * own * nodes.loss[i];
            slope[i] = own * nodes.slope[i];
        }
        nodes.panel.add_integrals(harmonics, &load, &mut out.value);
        if tangent {
            let own = &mut followed[nodes.stretch.branch * size..][..size];
            nodes.panel.add_integrals(harmonics, &slope, own);
            nodes.panel.add_products(&slope, &mut sums);
        }
    });
    if tangent {
        let matrix = &mut out.tangent;
        sums.rows(harmonics, 1.0, |i, row| {
            matrix[i * size..(i + 1) * size].copy_from_slice(row);
        });
        let slopes = loops.slopes(half_range, |u| curve.loss(u).slope);
        let anchored = anchors(loops, harmonics, &slopes, held, &followed);
        let mut basis = over;
        let mut follow = |theta: f64, factor: f64, anchored: &[f64]| {
            harmonics.basis(theta, &mut basis);
            for (row, held) in matrix.chunks_exact_mut(size).zip(anchored) {
                add(factor * held, &basis, row);
            }
        };
        let (reversals, first) = anchored.split_at(count * size);
        for (branch, own) in loops.branches.iter().zip(reversals.chunks_exact(size)) {
            follow(path.turns[branch.turn].theta, 1.0, own);
        }
        // The first reversal is half a range from the middle: ∂q = L' (∂u_crest − ∂u_trough)/2.
        if harmonics.half_wave() {
            follow(path.turns[0].theta, slopes[0], first);
        } else {
            follow(path.turns[0].theta, 0.5 * slopes[0], first);
            follow(path.trough.theta, -0.5 * slopes[0], first);
        }
    }
    out.halve_means(harmonics);
}

/// `out += factor values`.
fn add(factor: f64, values: &[f64], out: &mut [f64]) {
    out.iter_mut().zip(values).for_each(|(out, value)| *out += factor * value);
}

/// What follows the displacement at the reversal of each branch, and behind them what follows the first
/// reversal load.
fn anchors(
    loops: &Loops,
    harmonics: &Harmonics,
    slopes: &[f64],
    mut held: Vec<f64>,
    followed: &[f64],
) -> Vec<f64> {
    let size = harmonics.slots();
    let mut anchored: Vec<f64> = followed.iter().map(|own| -own).collect();
    for (index, branch) in loops.branches.iter().enumerate().rev() {
        let Some(parent) = branch.parent else { continue };
        for slot in 0..size {
            let own = held[index * size + slot];
            anchored[index * size + slot] += slopes[index] * own;
            anchored[parent * size + slot] -= slopes[index] * own;
            held[parent * size + slot] += own;
        }
    }
    anchored.extend_from_slice(&held[..size]);
    anchored
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::contact::backbone::Backbone;
    use crate::contact::masing::Masing;
    use crate::contact::{HarmonicForce as _, Motion, Residual, SlipLoad};
    use crate::fourier::{Harmonics, SampleTable};

    /// Where a contact is moved changes nothing in what its integrals take, and how far, as much as its logarithm
    /// does: panels are halved towards the reversals.
    #[test]
    fn far_motions_take_few_panels() {
        let law = Masing::new(1.0, 1.0, Backbone::Exponential).unwrap();
        let table = SampleTable::new(Harmonics::new(3, false));
        let at = |mean: f64, size: f64| {
            let displacement = [mean, size, 0.3 * size, -0.2 * size, 0.1 * size, 0.05 * size, 0.0];
            let mut load = SlipLoad::default();
            let residual = Residual::Centred;
            law.slip_load(
                Motion { table: &table, displacement: &displacement, residual },
                true,
                &mut load,
            );
            load
        };
        let usual = at(0.0, 1.0).solved as f64;
        for size in [0.1, 1.0, 1e3, 1e6, 1e9] {
            let near = at(0.0, size);
            let most = 4.0 * usual * (1.0 + size.log10().max(0.0));
            assert!((near.solved as f64) < most, "{size}: {}", near.solved);
            for mean in [1.0, 1e6, 1e12] {
                let far = at(mean * size, size);
                assert_eq!(far.solved, near.solved, "{size} {mean}");
                assert_eq!(far.value[1..], near.value[1..]);
                assert_eq!(far.tangent[1..], near.tangent[1..]);
            }
        }
    }
}
