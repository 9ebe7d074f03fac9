//! What of a load on poles of one frequency no friction balances.
//!
//! A motion of such poles that stays bounded needs forces that make up for the load in all of them at once:
//! `a = Σ g_c e_c` with |g_c| no larger than the square wave of a point. The nearest that friction comes to this
//! leaves the remainder r, and r is the way in which the motion grows: friction at full slip along r is that
//! nearest one. It is zero, or `|rᴴ a| > Σ |rᴴ e_c|` says by itself that nothing bounds the motion.

use faer::c64;

/// Steps of the search for the nearest, and products of numbers in them, at most: some tenths of a second.
const MOST_STEPS: usize = 4000;
const MOST_PRODUCTS: usize = 100_000_000;
/// Steps between two looks at the remainder.
const LOOK: usize = 8;
/// Part of the load that is rounding of none, and the square of what rounding leaves unknown of a remainder.
const NONE: f64 = 1e-9;
const UNKNOWN: f64 = 1e-16;

/// A force: what one newton of it does to each pole, and how many it may have at one harmonic.
#[derive(Debug, Clone)]
pub(super) struct Bounded {
    pub(super) effect: Vec<c64>,
    pub(super) most: f64,
}

/// The remainder of a load in all poles, and the most by which it may be off.
#[derive(Debug, Clone)]
pub(super) struct Remainder {
    pub(super) parts: Vec<c64>,
    pub(super) doubt: f64,
}

/// The part of a load that forces do not balance; of forces without bound nothing is left. Zero or not is for the
/// caller to say, who knows how much friction does along it.
pub(super) fn remainder(load: &[c64], forces: &[Bounded]) -> Remainder {
    let without_bound = forces.iter().filter(|force| force.most >= f64::MAX);
    let unlimited = Unlimited::of(without_bound.map(|force| force.effect.as_slice()));
    let load = unlimited.without(load);
    let limited = forces.iter().filter(|force| force.most < f64::MAX);
    let lines: Vec<Line> = limited.filter_map(|force| Line::of(force, &unlimited)).collect();
    if lines.is_empty() {
        return Remainder { parts: load, doubt: 0.0 };
    }
    nearest(&load, &lines)
}

/// Directions that forces without a bound take.
struct Unlimited(Vec<Vec<c64>>);

impl Unlimited {
    fn of<'e>(effects: impl Iterator<Item = &'e [c64]>) -> Self {
        let mut found = Self(Vec::new());
        for effect in effects {
            let rest = found.without(&found.without(effect));
            let length = size(&rest);
            if length > NONE * size(effect) {
                found.0.push(rest.iter().map(|part| part / length).collect());
            }
        }
        found
    }

    /// A vector without its parts along them.
    fn without(&self, vector: &[c64]) -> Vec<c64> {
        let mut rest = vector.to_vec();
        for direction in &self.0 {
            let along = product(direction, &rest);
            rest.iter_mut().zip(direction).for_each(|(rest, part)| *rest -= along * part);
        }
        rest
    }
}

/// A force by a unit vector among the poles and its largest part along it.
struct Line {
    unit: Vec<c64>,
    most: f64,
}

impl Line {
    fn of(force: &Bounded, unlimited: &Unlimited) -> Option<Self> {
        let effect = unlimited.without(&force.effect);
        let length = size(&effect);
        let counts = length > NONE * size(&force.effect) && length * force.most > 0.0;
        let unit = || effect.iter().map(|part| part / length).collect();
        counts.then(|| Self { unit: unit(), most: length * force.most })
    }
}

/// The remainder by projected gradients with the momentum of Nesterov, which is taken off where
/// it leads back (O'Donoghue and Candès 2015).
fn nearest(load: &[c64], lines: &[Line]) -> Remainder {
    let whole = size(load);
    let step = 1.0 / steepness(lines, load.len());
    let steps = (MOST_PRODUCTS / (2 * lines.len() * load.len())).clamp(LOOK, MOST_STEPS);
    let mut forces = vec![c64::new(0.0, 0.0); lines.len()];
    let mut ahead = forces.clone();
    let mut momentum = 1.0_f64;
    let mut best = Remainder { parts: load.to_vec(), doubt: f64::INFINITY };
    for count in 1..=steps {
        let left = left_of(load, lines, &ahead);
        let next: Vec<c64> = lines
            .iter()
            .zip(&ahead)
            .map(|(line, force)| within(force + product(&line.unit, &left) * step, line.most))
            .collect();
        let mut leads_back = 0.0;
        for ((next, ahead), force) in next.iter().zip(&ahead).zip(&forces) {
            leads_back += ((ahead - next).conj() * (next - force)).re;
        }
        let grown = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
        let carried = if leads_back > 0.0 { 0.0 } else { (momentum - 1.0) / grown };
        momentum = if leads_back > 0.0 { 1.0 } else { grown };
        let pairs = next.iter().zip(&forces);
        ahead = pairs.map(|(next, force)| next + (next - force) * carried).collect();
        forces = next;
        if count % LOOK == 0 || count == steps {
            best = judged(load, lines, &forces);
            if best.doubt <= UNKNOWN.sqrt() * whole || size(&best.parts) <= NONE * whole {
                break;
            }
        }
    }
    best.doubt = best.doubt.max(UNKNOWN.sqrt() * whole);
    best
}

/// The remainder that some forces leave. The square of its distance from the least one is no more than the duality
/// gap: what forces at their bounds do along it, less what these do.
fn judged(load: &[c64], lines: &[Line], forces: &[c64]) -> Remainder {
    let parts = left_of(load, lines, forces);
    let gap = lines.iter().zip(forces).map(|(line, force)| {
        let along = product(&line.unit, &parts);
        line.most * along.norm() - (force.conj() * along).re
    });
    let doubt = gap.sum::<f64>().max(0.0).sqrt();
    Remainder { parts, doubt }
}

fn left_of(load: &[c64], lines: &[Line], forces: &[c64]) -> Vec<c64> {
    let mut left = load.to_vec();
    for (line, force) in lines.iter().zip(forces) {
        left.iter_mut().zip(&line.unit).for_each(|(left, part)| *left -= part * force);
    }
    left
}

/// A bound of the largest eigenvalue of `Σ u uᴴ`.
fn steepness(lines: &[Line], size: usize) -> f64 {
    let mut rows = vec![0.0; size];
    for (i, row) in rows.iter_mut().enumerate() {
        for j in 0..size {
            let entry = lines.iter().map(|line| line.unit[i] * line.unit[j].conj()).sum::<c64>();
            *row += entry.norm();
        }
    }
    rows.into_iter().fold(0.0, f64::max)
}

fn within(force: c64, most: f64) -> c64 {
    let size = force.norm();
    if size > most {
        force * (most / size)
    } else {
        force
    }
}

pub(super) fn product(a: &[c64], b: &[c64]) -> c64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

pub(super) fn size(vector: &[c64]) -> f64 {
    vector.iter().map(|part| part.norm_sqr()).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(parts: &[f64]) -> Vec<c64> {
        parts.iter().map(|part| c64::new(*part, 0.0)).collect()
    }

    fn bounded(effect: &[f64], most: f64) -> Bounded {
        Bounded { effect: real(effect), most }
    }

    #[test]
    fn one_force_takes_off_what_it_may() {
        let found = remainder(&[c64::new(1.2, 1.6)], &[bounded(&[1.0], 0.5)]);
        // Against the phase of the load.
        assert!((found.parts[0] - c64::new(0.9, 1.2)).norm() < 1e-8);
        assert!(found.doubt <= 1e-7);
        let none = remainder(&[c64::new(1.2, 1.6)], &[bounded(&[1.0], 2.1)]);
        assert!(size(&none.parts) <= none.doubt.max(1e-8));
    }

    #[test]
    fn of_a_force_without_bound_nothing_is_left_along_it() {
        let forces = [bounded(&[1.0, 1.0], f64::MAX), bounded(&[1.0, 0.0], 0.5)];
        let found = remainder(&real(&[3.0, 0.0]), &forces);
        assert!(product(&real(&[1.0, 1.0]), &found.parts).norm() < 1e-8);
        // The load across it, (1.5, -1.5), less the half newton that the other one does there.
        let expected = 1.5 * 2f64.sqrt() - 0.5 / 2f64.sqrt();
        assert!((size(&found.parts) - expected).abs() < 1e-7);
    }

    #[test]
    fn the_least_remainder_is_that_of_a_fine_grid() {
        let load = real(&[2.0, 1.0]);
        let forces =
            [bounded(&[1.0, 0.3], 0.7), bounded(&[-0.2, 1.0], 0.9), bounded(&[1.0, 1.0], 0.2)];
        let found = remainder(&load, &forces);
        let steps = 60;
        let share = |i: i32| 2.0 * f64::from(i) / f64::from(steps) - 1.0;
        let mut least = f64::INFINITY;
        for (a, b, c) in (0..=steps)
            .flat_map(|a| (0..=steps).flat_map(move |b| (0..=steps).map(move |c| (a, b, c))))
        {
            let g = [0.7 * share(a), 0.9 * share(b), 0.2 * share(c)];
            let left: Vec<c64> = (0..2)
                .map(|i| load[i] - (0..3).map(|k| forces[k].effect[i] * g[k]).sum::<c64>())
                .collect();
            least = least.min(size(&left));
        }
        assert!(size(&found.parts) <= least + found.doubt);
        assert!(size(&found.parts) >= least - 0.05, "{least} {:?}", found.parts);
    }
}
