//! The periodic cycle of a Coulomb contact in two directions.
//!
//! The slider is pushed by a disk of radius M around K: a sweeping process (Moreau 1977), which
//! never takes two sliders farther apart. So a motion that makes the contact slip in every period
//! has one periodic cycle, whatever the start: it is found by Newton's method on the slider position
//! after a lap, with the lap's own derivative. A contact that comes to stick for good keeps what its
//! past has left, and is marched from an assumed start, as far as pushes do not lead to a crossing
//! ([`super::corner`]). Opening forgets all history.

use super::circle::centre;
use super::corner::rest;
use super::cycle::{Cycle, State, Stretch};
use super::drive::{Closed, Drive};
use super::grid::Grid;
use super::panel::{RESOLVED, ROUGHLY};
use super::plane::{March, Slider};
use super::slip::Plane;
use super::vectors::{less, size};
use crate::contact::{Coulomb, Residual};

/// Laps of the first, coarse march.
const COARSE_LAPS: usize = 4;
/// Change of the slider over a coarse lap, relative to the limit, that needs no other.
const COARSE: f64 = 1e-3;
/// Correction of the slider, relative to the limit, that leaves the lap and its derivative as they are.
const EXACT: f64 = 1e-11;
/// Correction after which a lap has all digits that rounding leaves it.
const NEARLY: f64 = 1e-10;
/// Excess over the limit, relative to it, with which a lap may begin: a stick begins at the limit, to rounding.
const NEARLY_WITHIN: f64 = 1e-6;
/// Laps by Newton's method; after them, the march alone.
const NEWTON_LAPS: usize = 12;
/// Determinant of `1 − P`, with the derivative P of a lap in its start, below which the slip of the lap
/// may be the last: a single push leaves the slider free to lie anywhere along a circle.
const LEAST: f64 = 2e-3;
/// Laps after which it is looked where pushes in turn lead.
const PUSHES: usize = 3;
/// Laps after which a march is taken as it is.
const MOST_LAPS: usize = 200;
/// Change of the slider over a lap, relative to the limit, that is none.
const PERIODIC: f64 = 1e-13;

/// The cycle of a contact in two directions; `rates` asks for derivatives.
pub(super) fn cycle(law: &Coulomb, drive: &Drive<'_>, residual: Residual, rates: bool) -> Cycle {
    let span = drive.harmonics().span();
    let closed = drive.closed();
    let glides = law.is_smooth();
    let windows = match closed {
        Closed::Never => {
            let state = State::Open;
            return Cycle::new(vec![Stretch { start: 0.0, end: span, state }], drive.columns());
        }
        Closed::During(windows) => windows,
        Closed::Always if glides => vec![[0.0, span]],
        Closed::Always => return Period { law, drive, residual, rates }.cycle(),
    };
    let (plane, grid) = (Plane::new(drive), Grid::new(drive));
    let mut march = March::new(drive, &plane, &grid, rates);
    for (index, [start, end]) in windows.iter().enumerate() {
        if glides {
            march.stretches.push(Stretch { start: *start, end: *end, state: gliding(law, drive) });
        } else {
            let mut slider = march.closing(*start);
            march.follow(*start, *end, &mut slider, true);
        }
        let next = windows.get(index + 1).map_or(windows[0][0] + span, |next| next[0]);
        if next > *end {
            march.stretches.push(Stretch { start: *end, end: next, state: State::Open });
        }
    }
    march.into_cycle(None)
}

/// A contact without friction, or that nothing presses, slips all the time; one without spring has nothing to slip
/// against.
fn gliding(law: &Coulomb, drive: &Drive<'_>) -> State {
    if law.friction == 0.0 || law.tangential_stiffness != 0.0 {
        State::Along(0.0)
    } else {
        State::Stuck { slider: [0.0; 2], rate: vec![0.0; 2 * (drive.columns() + 2)] }
    }
}

/// A contact that never opens.
struct Period<'a> {
    law: &'a Coulomb,
    drive: &'a Drive<'a>,
    residual: Residual,
    rates: bool,
}

impl Period<'_> {
    fn cycle(&self) -> Cycle {
        let (plane, grid) = (Plane::new(self.drive), Grid::new(self.drive));
        let coarse = self.coarse(&grid);
        let found = coarse.and_then(|start| self.recurrent(&plane, &grid, start, LEAST));
        found.unwrap_or_else(|| self.shaken_down(&plane, &grid))
    }

    fn mirror(&self) -> f64 {
        if self.drive.harmonics().half_wave() {
            -1.0
        } else {
            1.0
        }
    }

    /// A march along the straight lines between the instants of the grid: where a stick begins, and
    /// the slider there; nothing if it comes to stick for good.
    fn coarse(&self, grid: &Grid) -> Option<(f64, [f64; 2])> {
        let [x, y, limit] = &grid.value;
        let (count, k) = (grid.count(), self.law.tangential_stiffness);
        let middle = |of: &[f64]| {
            let (low, high) =
                of.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                    (low.min(*x), high.max(*x))
                });
            0.5 * (low + high)
        };
        let mirror = self.mirror();
        let mut start = if mirror < 0.0 { [0.0; 2] } else { [middle(x), middle(y)] };
        let mut found = None;
        for _ in 0..COARSE_LAPS {
            let pull = |n: usize| {
                let sign = if n < count { 1.0 } else { mirror };
                [sign * x[n % count], sign * y[n % count]]
            };
            let size =
                limit[0] / [x[0] - start[0], y[0] - start[1]].into_iter().fold(0.0, f64::hypot);
            let mut traction = [0, 1].map(|i| (pull(0)[i] - start[i]) * size.min(1.0));
            let mut slipped = false;
            found = None;
            for n in 1..=count {
                let du = [0, 1].map(|i| (pull(n)[i] - pull(n - 1)[i]) / k);
                let pressing = |n: usize| limit[n % count] / self.law.friction;
                let passage = self.law.step(traction, du, pressing(n - 1), pressing(n));
                let slips = passage.slipping > 0.0;
                traction = passage.traction;
                if slipped && !slips {
                    found = Some((n, [0, 1].map(|i| pull(n)[i] - traction[i])));
                }
                slipped = slips;
                if slips && found.is_none() {
                    found = Some((count, [0.0; 2]));
                }
            }
            let end = [0, 1].map(|i| mirror * (pull(count)[i] - traction[i]));
            let moved = (end[0] - start[0]).hypot(end[1] - start[1]);
            start = end;
            if moved <= COARSE * limit[0] {
                break;
            }
        }
        found.map(
            |(n, slider)| {
                if n == count {
                    (0.0, start)
                } else {
                    (n as f64 * grid.step, slider)
                }
            },
        )
    }

    /// The only cycle of a contact that slips in every period; nothing if it does not.
    fn recurrent(
        &self,
        plane: &Plane<'_>,
        grid: &Grid,
        (theta, mut position): (f64, [f64; 2]),
        least: f64,
    ) -> Option<Cycle> {
        let end = theta + self.drive.harmonics().span();
        let (mut last, mut hints) = (false, Vec::new());
        let mut before = f64::INFINITY;
        for lap in 0..MOST_LAPS {
            let mut march = March::new(self.drive, plane, grid, self.rates && last);
            march.resolved = if last { RESOLVED } else { ROUGHLY };
            march.hints = hints;
            let mut slider = march.begin(position);
            march.confine(theta, &mut slider, NEARLY_WITHIN);
            march.follow(theta, end, &mut slider, false);
            if march.way <= EXACT * plane.scale || march.unresolved {
                return None;
            }
            let (after, width) = (slider.position.map(|s| self.mirror() * s), march.width());
            slider.rate.iter_mut().for_each(|rate| *rate *= self.mirror());
            let residual = less(after, position);
            let (inverse, determinant) = fixed_point(&slider.rate, width);
            let alone = self.mirror() > 0.0 && march.pushes().len() < 2;
            let least = if alone { least.max(LEAST) } else { least };
            if determinant.is_nan() || determinant <= least {
                return None;
            }
            // What is left of circles that all but touch is rounding.
            let rests = lap > NEWTON_LAPS && size(residual) <= PERIODIC * plane.scale;
            let by = if rests {
                [0.0; 2]
            } else {
                inverse.map(|row| row[0] * residual[0] + row[1] * residual[1])
            };
            let step = size(by).max(size(residual));
            let carried = last && (march.coefficients || !self.rates);
            let settled = step <= EXACT * plane.scale || before <= NEARLY * plane.scale;
            if carried && (settled || lap + 1 == MOST_LAPS) {
                march.correct(by);
                let start = self.rates.then(|| start_rate(&slider, inverse, width));
                return Some(march.into_cycle(start));
            }
            // What is left after this step, which the lap then shrinks.
            let slopes = [0, 1].map(|i| slider.rate[i * width + width - 2..][..2].to_vec());
            let shrinks = slopes.iter().flatten().fold(0.0_f64, |most, p| most.max(p.abs()));
            let left = 10.0 * step * step / plane.scale * shrinks.min(1.0);
            last = left <= EXACT * plane.scale || lap + 2 == MOST_LAPS;
            before = step;
            hints = march.hints(if last { RESOLVED } else { ROUGHLY });
            let newton = lap < NEWTON_LAPS && by.iter().all(|by| by.is_finite());
            let [x, y] = if newton { by } else { residual };
            position = [position[0] + x, position[1] + y];
        }
        None
    }

    /// What a contact keeps that slips no more, from its assumed start.
    fn shaken_down(&self, plane: &Plane<'_>, grid: &Grid) -> Cycle {
        let span = self.drive.harmonics().span();
        // Whether it depends on the motion is always told.
        let (position, rate) = self.assumed(grid);
        let mut first = March::new(self.drive, plane, grid, true);
        let mut slider = first.begin(position);
        first.confine(0.0, &mut slider, 0.0);
        for lap in 0..MOST_LAPS {
            let before = slider.position;
            first.follow(0.0, span, &mut slider, false);
            slider.position = slider.position.map(|s| self.mirror() * s);
            slider.rate.iter_mut().for_each(|rate| *rate *= self.mirror());
            let moved = size(less(slider.position, before));
            if !first.slipped || first.unresolved {
                break;
            }
            // Slip that recurs hardly changes the slider, either.
            let rests = moved <= PERIODIC * plane.scale;
            if rests || lap % PUSHES == PUSHES - 1 || lap + 1 == MOST_LAPS {
                if let Some(cycle) = self.in_turn(plane, grid, &first, slider.position) {
                    return cycle;
                }
            }
            if rests {
                break;
            }
            if lap + 1 < MOST_LAPS {
                first = March::new(self.drive, plane, grid, true);
            }
        }
        first.into_cycle((!rate.is_empty()).then_some(rate))
    }

    /// What becomes of a slider that a lap has pushed in turn, as far as that is known.
    fn in_turn(
        &self,
        plane: &Plane<'_>,
        grid: &Grid,
        lap: &March<'_>,
        slider: [f64; 2],
    ) -> Option<Cycle> {
        let span = self.drive.harmonics().span();
        let mut angles = lap.pushes();
        if self.mirror() < 0.0 {
            angles.extend(lap.pushes().iter().map(|theta| theta + span));
        }
        let rest = rest(self.drive, &angles, slider, plane.scale)?;
        let recurrent = |start| self.recurrent(plane, grid, (0.0, start), f64::MIN_POSITIVE);
        if !rest.crosses {
            if let Some(cycle) = recurrent(rest.slider) {
                return Some(cycle);
            }
        }
        let mut march = March::new(self.drive, plane, grid, false);
        let mut held = march.begin(rest.slider);
        march.follow(0.0, span, &mut held, false);
        let after = held.position.map(|s| self.mirror() * s);
        let stays = size(less(after, rest.slider)) <= NEARLY * plane.scale && !march.unresolved;
        if !stays {
            // Others push there.
            return if rest.crosses { recurrent(after) } else { None };
        }
        let state = State::Stuck { slider: rest.slider, rate: rest.rate? };
        let stretch = Stretch { start: 0.0, end: span, state };
        let cycle = Cycle::new(vec![stretch], self.drive.columns());
        Some(Cycle { solved: plane.solved.get(), ..cycle })
    }

    /// The assumed slider position of a contact that never slips, and its derivative.
    fn assumed(&self, grid: &Grid) -> ([f64; 2], Vec<f64>) {
        if self.drive.harmonics().half_wave() {
            return ([0.0; 2], Vec::new());
        }
        let rest = self.law.slider().map(|w| self.drive.stiffness * w);
        if !self.residual.follows_middle() {
            return (rest, Vec::new());
        }
        let (middle, rate) = centre(self.drive, grid);
        (self.residual.slider(middle, rest), rate)
    }
}

/// `(1 − P)⁻¹`, and the determinant of `1 − P`, with the derivative P of a lap in its start, the last two columns of its rate.
fn fixed_point(rate: &[f64], width: usize) -> ([[f64; 2]; 2], f64) {
    let p = |i: usize, j: usize| rate[i * width + width - 2 + j];
    let (a, b, c, d) = (1.0 - p(0, 0), -p(0, 1), -p(1, 0), 1.0 - p(1, 1));
    let determinant = a * d - b * c;
    ([[d / determinant, -b / determinant], [-c / determinant, a / determinant]], determinant)
}

/// Derivative of the start that a lap returns to.
fn start_rate(slider: &Slider, inverse: [[f64; 2]; 2], width: usize) -> Vec<f64> {
    let (x, y) = slider.rate.split_at(width);
    let own = width - 2;
    let row =
        |row: [f64; 2]| x[..own].iter().zip(&y[..own]).map(move |(x, y)| row[0] * x + row[1] * y);
    row(inverse[0]).chain(row(inverse[1])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Closure, Motion};
    use crate::fourier::{Harmonics, SampleTable};
    use crate::test_numbers::numbers;

    /// Rough motions, up to three thousand times as far as the contact slips at, along a line and beside
    /// it: rounding at the limit neither stops a march nor takes the traction out of the cone, and a lap that
    /// begins outside of it finds the cycle, too.
    #[test]
    fn rough_motions_stay_within_the_cone() {
        let mut random = numbers();
        let law = Coulomb::new(2, 0.3, 1.0, Some(1.0), Closure::Preload(1.0)).unwrap();
        for case in 0..60 {
            let table = SampleTable::new(Harmonics::new(11 + 10 * (case % 5), false));
            let slots = table.harmonics().slots();
            let across = [0.0, 1e-16, 1e-3][case % 3];
            let size = 10.0_f64.powf(1.5 + random());
            let mut series = |size: f64| -> Vec<f64> {
                (0..slots).map(|i| size * random() / (1.0 + (i / 2) as f64)).collect()
            };
            let mut displacement = series(size);
            displacement.extend(series(across * size));
            displacement.extend(series(0.05));
            let motion =
                Motion { table: &table, displacement: &displacement, residual: Residual::Centred };
            let drive = Drive::new(&law, motion, true);
            let period =
                Period { law: &law, drive: &drive, residual: Residual::Centred, rates: false };
            let (plane, grid) = (Plane::new(&drive), Grid::new(&drive));
            let (pull, _) = drive.at(0.0);
            let far = [pull[0][0] + 10.0, pull[1][0]];
            let cycle = period.recurrent(&plane, &grid, (0.0, far), LEAST);
            let cycle = cycle.unwrap_or_else(|| panic!("{case} has no cycle from outside"));
            let stuck = cycle.stretches.iter().filter_map(|stretch| match &stretch.state {
                State::Stuck { slider, .. } => Some((stretch.start, stretch.end, *slider)),
                _ => None,
            });
            for (start, end, slider) in stuck {
                for share in 0..=20 {
                    let theta = start + (end - start) * f64::from(share) / 20.0;
                    let (pull, [pressing, _]) = drive.at(theta);
                    let size = (pull[0][0] - slider[0]).hypot(pull[1][0] - slider[1]);
                    let limit = drive.friction * pressing;
                    assert!(size <= limit * (1.0 + 1e-6), "{case} at {theta}: {size} of {limit}");
                }
            }
        }
    }
}
