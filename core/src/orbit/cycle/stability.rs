//! Floquet multipliers along a branch of limit cycles, and where its stability changes.

use super::limit_cycle::OrbitCurve;
use super::orbits::CycleOrbits;
use super::settings::{Change, ChangeKind, LimitCycles};
use crate::balance::Point;
use crate::model::FlutterModel;
use crate::orbit::period_map::PeriodMap;
use crate::solve::{across, at_parameter, Bracket, Curve as _};
use faer::c64;
use std::cell::Cell;

/// Share of the progress for the branch, before its stability.
pub(super) const TRACING: f64 = 0.4;
/// Newton iterations from a harmonic balance to its exact orbit.
const ITERATIONS: usize = 12;
/// Frequency of the exact orbit, relative to that of the balance it belongs to.
const SAME: f64 = 0.02;
/// Error of the multipliers of a map, …
const MAPPED: f64 = 1e-6;
/// … and distance of the largest from 1 that decides, in errors.
const DECIDES: f64 = 3.0;
/// Halvings that narrow the interval in which stability changes as much.
const HALVINGS: i32 = 26;
/// Change of the modulus of a multiplier across an interval this short that is a jump.
const JUMP: f64 = 1e-3;
/// Distance from the unit circle at which a multiplier lies on neither side of it: that of a mode that nothing
/// damps is 1 to rounding.
const ROUNDING: f64 = 1e-8;
/// Angle off the real axis within which a multiplier counts as real.
const REAL: f64 = 1e-6;

/// Multipliers of a cycle with the unknowns of its exact orbit.
#[derive(Debug, Clone)]
pub(super) struct Floquet {
    pub(super) z: Vec<f64>,
    /// Over half a period, mirrored, or over a whole one of no symmetry, by falling modulus.
    pub(super) span: Vec<c64>,
    /// Whether it is half a period.
    symmetric: bool,
    pub(super) neutral: usize,
    /// Whether the orbit is exact.
    pub(super) closed: bool,
}

impl Floquet {
    /// Of the exact orbit next to a harmonic balance.
    fn beside(curve: &mut OrbitCurve<'_>, point: &Point, value: f64) -> Option<Self> {
        let start = curve.start(point, value)?;
        Self::near(curve, &start)
    }

    /// Of the exact orbit next to a start of the same value of the scalar; along the exact flow
    /// from the start if there is none.
    pub(super) fn near(curve: &mut OrbitCurve<'_>, start: &[f64]) -> Option<Self> {
        curve.accept(start);
        let [.., omega, value] = start else { return None };
        let found = at_parameter(curve, start, *value, ITERATIONS).map(|(z, _)| z);
        let found = found.filter(|z| (z[z.len() - 2] / omega - 1.0).abs() < SAME);
        let closed = found.is_some();
        Self::of(curve, found.unwrap_or_else(|| start.to_vec()), closed)
    }

    /// Of the orbit at a point of a curve.
    pub(super) fn of(curve: &mut OrbitCurve<'_>, z: Vec<f64>, closed: bool) -> Option<Self> {
        let (span, neutral) = curve.multipliers(&z)?;
        Some(Self { z, span, symmetric: curve.is_symmetric(), neutral, closed })
    }

    /// Over the full period, those of contacts that never slip first.
    pub(super) fn multipliers(&self) -> Vec<c64> {
        let ones = std::iter::repeat_n(c64::new(1.0, 0.0), self.neutral);
        ones.chain(self.whole()).collect()
    }

    fn whole(&self) -> impl Iterator<Item = c64> + '_ {
        self.span.iter().map(|m| if self.symmetric { m * m } else { *m })
    }

    /// How far a disturbance grows beyond rounding in a period, in logarithms.
    fn growth(&self, index: usize) -> f64 {
        self.whole().nth(index).map_or(f64::NAN, |m| m.norm().ln() - ROUNDING)
    }

    /// Number of multipliers outside the unit circle.
    fn unstable(&self) -> usize {
        (0..self.span.len()).filter(|&index| self.growth(index) > 0.0).count()
    }
}

/// What a branch is judged by.
pub(super) struct Judge<'a> {
    pub(super) orbits: &'a CycleOrbits<'a>,
    /// Frequency that scales the coordinates of states [rad/s].
    pub(super) scale: f64,
    /// Exact orbits of all cycles, where they are known already.
    pub(super) exact: Option<Vec<Vec<f64>>>,
    /// Whether they are a whole branch, on which changes of stability can be located.
    pub(super) whole: bool,
}

/// Multipliers of all cycles, and changes of stability between neighbours on a whole branch.
pub(super) fn judge(
    Judge { orbits, scale, exact, whole }: Judge<'_>,
    out: &mut LimitCycles,
    interrupted: &dyn Fn() -> bool,
    share: &Cell<f64>,
) {
    let mut curve = OrbitCurve::new(orbits, scale, &[], interrupted);
    let total = out.cycles.len() as f64;
    let mut known: Vec<(usize, Floquet)> = Vec::new();
    for (index, cycle) in out.cycles.iter_mut().enumerate() {
        share.set(TRACING + (1.0 - TRACING) * index as f64 / total);
        if interrupted() {
            return;
        }
        let floquet = match &exact {
            Some(points) => Floquet::of(&mut curve, points[index].clone(), true),
            None => Floquet::beside(&mut curve, &cycle.response, cycle.value),
        };
        let Some(floquet) = floquet else { continue };
        cycle.multipliers = floquet.multipliers();
        cycle.neutral = floquet.neutral;
        cycle.closed = floquet.closed;
        if floquet.closed {
            known.push((index, floquet));
        }
    }
    if !whole {
        return;
    }
    for pair in known.windows(2) {
        let [(at, before), (_, after)] = pair else { continue };
        let [a, b] = [before, after].map(Floquet::unstable);
        if a != b && !interrupted() {
            out.changes.push(change(&mut curve, before, after, *at));
        }
    }
}

/// Multipliers of cycles without symmetry, by the map over a period that is linearised along the
/// balance. They stay unknown where contacts touch their limit, and where the map does not tell on which
/// side of 1 the largest lies: that of the phase, which has to be 1, says how far to trust it.
pub(super) fn judge_along(
    family: &FlutterModel<'_>,
    out: &mut LimitCycles,
    interrupted: &dyn Fn() -> bool,
    share: &Cell<f64>,
) {
    let Some(negative) = family.negative() else { return };
    let total = out.cycles.len() as f64;
    for (index, cycle) in out.cycles.iter_mut().enumerate() {
        share.set(TRACING + (1.0 - TRACING) * index as f64 / total);
        if interrupted() {
            return;
        }
        let Ok(model) = family.at(cycle.value) else { continue };
        let damping = model.structure().damping() + faer::Scale(cycle.ratio) * negative;
        let Ok(map) = PeriodMap::damped(&model, damping.as_ref()) else { continue };
        let map = map.assuming(family.residual());
        let Some(motion) = cycle.response.unknowns() else { continue };
        let found = map.multipliers(cycle.response.omega, motion, Some(MAPPED));
        let found = found.filter(|found| !found.touches);
        let Some(mut values) = found.map(|found| found.values) else { continue };
        let off = |m: &c64| (m - c64::new(1.0, 0.0)).norm();
        let phase = (0..values.len()).min_by(|&i, &j| off(&values[i]).total_cmp(&off(&values[j])));
        let Some(phase) = phase.map(|at| values.remove(at)) else { continue };
        let largest = values.first().map_or(0.0, |m| m.norm());
        if (largest - 1.0).abs() <= DECIDES * off(&phase).max(MAPPED) {
            continue;
        }
        values.resize(cycle.multipliers.len(), c64::new(0.0, 0.0));
        cycle.multipliers = values;
    }
}

/// The change of stability between two neighbouring orbits: located by the multiplier that leaves the unit
/// circle, and named by those on either side.
fn change(
    curve: &mut OrbitCurve<'_>,
    before: &Floquet,
    after: &Floquet,
    position: usize,
) -> Change {
    let (mut low, mut high) = (before.clone(), after.clone());
    let leaving = before.unstable().min(after.unstable());
    let growth = [before, after].map(|one| one.growth(leaving));
    let mut bracket = Bracket::new(growth, HALVINGS);
    while let Some(share) = bracket.next().filter(|_| !curve.interrupted()) {
        let Some((a, b)) = curve.matched(&low.z, &high.z) else { break };
        curve.accept(&a);
        let Some(z) = across(curve, &a, &b, share) else { break };
        let Some(middle) = Floquet::of(curve, z, true) else { break };
        let stays = middle.unstable() == before.unstable();
        bracket.narrow(share, middle.growth(leaving), stays);
        if stays {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (omega, value) = match high.z[..] {
        [.., omega, value] => (omega, value),
        _ => (f64::NAN, f64::NAN),
    };
    Change {
        value,
        omega,
        after: position,
        kind: kind(&low, &high, leaving),
        unstable: (before.unstable(), after.unstable()),
    }
}

/// What happens between two orbits close to each other, of which one has more multipliers outside than `leaving`.
fn kind(low: &Floquet, high: &Floquet, leaving: usize) -> ChangeKind {
    let off = |m: &c64| (m.norm() - 1.0).abs();
    let [inner, outer] = if low.unstable() > leaving { [high, low] } else { [low, high] };
    let (Some(a), Some(b)) = (inner.span.get(leaving), outer.span.get(leaving)) else {
        return ChangeKind::Grazing;
    };
    if off(a).max(off(b)) > JUMP {
        return ChangeKind::Grazing;
    }
    let angle = b.arg().abs();
    if angle < REAL {
        ChangeKind::Fold
    } else if angle > std::f64::consts::PI - REAL && low.symmetric {
        ChangeKind::Symmetry
    } else if angle > std::f64::consts::PI - REAL {
        ChangeKind::PeriodDoubling
    } else {
        ChangeKind::ComplexPair
    }
}
