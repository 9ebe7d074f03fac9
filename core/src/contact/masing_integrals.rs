//! Fourier integrals of the slip load of a Masing law, and their derivative.
//!
//! Along a branch q depends on the displacement, on the reversals before it and on nothing else, and q
//! is continuous where a branch ends: the derivative of the integrals is the integral of
//! `∂q = ∂q_r + L'(|u − u_r|/2) (∂u − ∂u_r)`. At a reversal u is stationary, so that ∂u_r is the basis
//! there: each reversal adds a term of rank one. Gauss panels are halved until they resolve L'.

use super::loading_curve::LoadingCurve;
use super::masing_loops::{Branch, Loops, Stretch};
use super::slider_integrals::Bounds;
use super::stick_slip::Path;
use super::{Motion, SlipLoad};
use crate::fourier::{Harmonics, Interval, IntervalSums, Lanes, Panel, NODES};

/// Last terms of the series of L' on a panel, times its length and relative to the largest L', that are
/// resolved: the error of the rule is of their square.
const RESOLVED: f64 = 1e-10;
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

/// Calls `visit` with panels that cover the loops.
pub(super) fn sweep(
    curve: &LoadingCurve,
    motion: Motion<'_>,
    loops: &Loops,
    largest: f64,
    mut visit: impl FnMut(&Nodes<'_>),
) {
    let harmonics = motion.table.harmonics();
    let mut panel = Panel::new(harmonics);
    let power = |root: f64| (SMOOTH / (2.0 * root + 1.0)).ceil() as i32;
    let at_rest = curve.backbone.root_at_rest().map_or(1, power);
    let (mut intervals, mut open) = (Vec::new(), Vec::new());
    for stretch in &loops.stretches {
        let branch = &loops.branches[stretch.branch];
        let powers =
            [if stretch.reverses { at_rest } else { 1 }, if stretch.reaches_end { 2 } else { 1 }];
        Interval::cut(harmonics, [stretch.start, stretch.end], powers, &mut intervals);
        open.extend(intervals.drain(..).map(|interval| (interval, 0)));
        while let Some((interval, halvings)) = open.pop() {
            panel.place(harmonics, &interval);
            let u = panel.series(harmonics, motion.displacement);
            let (mut distance, mut loss, mut slope) = ([0.0; NODES], [0.0; NODES], [0.0; NODES]);
            for i in 0..NODES {
                distance[i] = (0.5 * branch.sign * (u[i] - branch.origin)).max(0.0);
                let own = curve.loss(distance[i]);
                (loss[i], slope[i]) = (own.value, own.slope);
            }
            let rough = panel.tail(&slope) * interval.length() > RESOLVED * largest;
            if rough && halvings < MOST_HALVINGS {
                open.extend(interval.halves().map(|half| (half, halvings + 1)));
                continue;
            }
            visit(&Nodes { panel: &panel, stretch, branch, distance, loss, slope });
        }
    }
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
    let mut bounds = Bounds::new(harmonics);
    for stretch in &loops.stretches {
        let own = &mut held[stretch.branch * size..(stretch.branch + 1) * size];
        bounds.add_integral(harmonics, stretch.start, stretch.end, weight, own);
    }
    let loads = loops.at_reversals(half_range, |u| curve.loss(u).value);
    for (load, held) in loads.iter().zip(held.chunks_exact(size)) {
        out.value.iter_mut().zip(held).for_each(|(q, held)| *q += load * held);
    }
    sweep(curve, motion, loops, largest, |nodes| {
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
            nodes.panel.add_products(harmonics, &slope, &mut sums);
        }
    });
    if tangent {
        let matrix = &mut out.tangent;
        sums.products(harmonics, 1.0, |i, j, value| matrix[i * size + j] = value);
        let slopes = loops.slopes(half_range, |u| curve.loss(u).slope);
        let anchored = anchors(loops, harmonics, &slopes, held, &followed);
        let mut basis = vec![0.0; size];
        let mut add = |theta: f64, factor: f64, anchored: &[f64]| {
            harmonics.basis(theta, &mut basis);
            for (row, held) in matrix.chunks_exact_mut(size).zip(anchored) {
                row.iter_mut().zip(&basis).for_each(|(entry, b)| *entry += factor * held * b);
            }
        };
        let (reversals, first) = anchored.split_at(count * size);
        for (branch, own) in loops.branches.iter().zip(reversals.chunks_exact(size)) {
            add(path.turns[branch.turn].theta, 1.0, own);
        }
        // The first reversal is half a range from the middle: ∂q = L' (∂u_crest − ∂u_trough)/2.
        if harmonics.half_wave() {
            add(path.turns[0].theta, slopes[0], first);
        } else {
            add(path.turns[0].theta, 0.5 * slopes[0], first);
            add(path.trough.theta, -0.5 * slopes[0], first);
        }
    }
    out.halve_means(harmonics);
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
