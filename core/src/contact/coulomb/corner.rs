//! Where pushes in turn leave a slider.
//!
//! The slider stays within the disks of radius M around K of all instants. One that two instants push in turn, nearly
//! against one another, comes to rest where their circles cross, but slowly: what is left shrinks by the angle
//! between them squared. The distance to a disk is convex, so that Newton's method on two of them comes to the
//! crossing from outside. Circles that do not cross push for good.

use super::drive::Drive;
use super::vectors::{cross, dot, less, size, solve};

/// Steps of Newton's method for an instant, and for the crossing, which halve the way at least.
const STEPS: usize = 64;
/// Step that leaves no other but its square.
const NEARLY: f64 = 1e-7;
/// The same of the slider, relative to the limit.
const EXACT: f64 = 1e-14;
/// Way beside circles that touch, relative to the limit, which rounding hides.
const TOUCHING: f64 = 1e-6;
/// Share of a step that the next one may have.
const FALLS: f64 = 0.75;
/// Excess, relative to a step, that the step may leave of another instant.
const LEFT: f64 = 1e-6;

/// Where pushes in turn lead a slider.
pub(super) struct Rest {
    pub(super) slider: [f64; 2],
    /// Its derivative in the coefficients of K and M, direction after direction, as that of a crossing, if it has one.
    pub(super) rate: Option<Vec<f64>>,
    /// Whether circles cross there; else they are close to one another.
    pub(super) crosses: bool,
}

/// An instant whose disk the slider is farthest out of.
#[derive(Clone, Copy)]
struct Push {
    theta: f64,
    /// From the slider to the centre of the disk, of length 1.
    direction: [f64; 2],
    excess: f64,
}

impl Push {
    /// The one near an angle.
    fn near(drive: &Drive<'_>, mut theta: f64, slider: [f64; 2]) -> Option<Self> {
        let mut last = false;
        for _ in 0..STEPS {
            let [x, y, pressing] = drive.jets(theta);
            let of = |n: usize| [x[n], y[n]];
            let from = less(of(0), slider);
            let distance = size(from);
            let direction = from.map(|x| x / distance);
            if last {
                let excess = distance - drive.friction * pressing[0];
                return Some(Self { theta, direction, excess });
            }
            let along = |n: usize| dot(direction, of(n));
            let across = cross(direction, of(1));
            let slope = along(1) - drive.friction * pressing[1];
            let bend = along(2) + across * across / distance - drive.friction * pressing[2];
            if bend.is_nan() || bend >= 0.0 {
                return None;
            }
            let by = -slope / bend;
            theta += by;
            last = by.abs() <= NEARLY;
        }
        None
    }
}

/// The two pushes against one another that hold all others off, as far as they are straight, and the way to
/// their crossing.
fn nearest(pushes: &[Push]) -> Option<([Push; 2], [f64; 2])> {
    let mut found: Option<([Push; 2], [f64; 2])> = None;
    for (n, one) in pushes.iter().enumerate() {
        for other in &pushes[n + 1..] {
            let directions = [one.direction, other.direction];
            if dot(one.direction, other.direction) >= 0.0 {
                continue;
            }
            // Circles that touch: the slider is as far along them as it is anyhow.
            let by = solve(directions, [one.excess, other.excess]).unwrap_or([f64::INFINITY; 2]);
            let outside = |push: &Push| push.excess - dot(push.direction, by) > LEFT * size(by);
            let nearer = found.as_ref().is_none_or(|(_, best)| size(by) < size(*best));
            if nearer && !pushes.iter().any(outside) {
                found = Some(([*one, *other], by));
            }
        }
    }
    found
}

/// Where a slider is led that is pushed near such angles in turn. Nothing if they do not push against one another.
pub(super) fn rest(
    drive: &Drive<'_>,
    angles: &[f64],
    mut slider: [f64; 2],
    scale: f64,
) -> Option<Rest> {
    let near = |angles: &[f64], slider| -> Option<([Push; 2], [f64; 2], Vec<f64>)> {
        let pushes = angles.iter().filter_map(|theta| Push::near(drive, *theta, slider));
        let pushes: Vec<Push> = pushes.collect();
        let (pair, by) = nearest(&pushes)?;
        Some((pair, by, pushes.iter().map(|push| push.theta).collect()))
    };
    let (mut pair, mut by, mut angles) = near(angles, slider)?;
    let mut crosses = false;
    for _ in 0..STEPS {
        let way = size(by);
        let next = [slider[0] + by[0], slider[1] + by[1]];
        let after = near(&angles, next).filter(|(_, by, _)| size(*by) <= FALLS * way);
        crosses = way <= EXACT * scale || (after.is_none() && way <= TOUCHING * scale);
        let Some(after) = after.filter(|_| !crosses) else { break };
        slider = next;
        (pair, by, angles) = after;
    }
    Some(Rest { slider, rate: rate(drive, pair), crosses })
}

/// Derivative of a crossing, whose distances to both centres vary as their radii.
fn rate(drive: &Drive<'_>, pair: [Push; 2]) -> Option<Vec<f64>> {
    let (slots, width) = (drive.harmonics().slots(), drive.columns());
    let mut out = vec![0.0; 2 * width];
    let directions = pair.map(|push| push.direction);
    let bases = pair.map(|push| {
        let mut basis = vec![0.0; slots];
        drive.harmonics().basis(push.theta, &mut basis);
        basis
    });
    let varies = drive.pressing.is_some();
    for column in 0..width {
        let right = [0, 1].map(|n| match column / slots {
            direction @ (0 | 1) => directions[n][direction] * bases[n][column % slots],
            _ if varies => -bases[n][column % slots],
            _ => -1.0,
        });
        [out[column], out[width + column]] = solve(directions, right)?;
    }
    Some(out)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::contact::{Closure, ContactLaw as _, Coulomb, Motion, Residual, SlipLoad};
    use crate::fourier::{Harmonics, SampleTable};
    use crate::test_numbers::numbers;

    /// Laps in which two short slips are solved for.
    const FEW: usize = 150;

    fn load(law: &Coulomb, displacement: &[f64], highest: usize) -> SlipLoad {
        let table = SampleTable::new(Harmonics::new(highest, false));
        let motion = Motion { table: &table, displacement, residual: Residual::FromRest };
        let mut load = SlipLoad::default();
        law.closed_form().unwrap().slip_load(motion, true, &mut load);
        load
    }

    /// A motion to and fro, half as far as that number says, beside where the slider has begun.
    fn to_and_fro(half: f64) -> SlipLoad {
        let law = Coulomb::new(2, 1.0, 1.0, None, Closure::Preload(1.0)).unwrap();
        load(&law, &[0.0, half, 0.0, -0.5, 0.0, 0.0], 1)
    }

    /// In the end the slider is as far from both ends as its spring reaches. Marched from period to period it
    /// takes as many laps as the circles overlap by parts of their radius, and more.
    #[test]
    fn pushes_in_turn_end_where_circles_cross() {
        for half in [0.9, 0.99, 0.9999, 1.0 - 1e-7, 1.0 - 1e-10] {
            let beside = f64::sqrt((1.0 - half) * (1.0 + half));
            let load = to_and_fro(half);
            assert!((load.value[3] + 0.5 - beside).abs() < 1e-15 / beside.powi(2), "{half}");
            assert!(load.value[0].abs() < 1e-10, "{half}: {}", load.value[0]);
            assert!(load.panels == 0 && load.solved < FEW, "{half}: {}", load.solved);
            for (row, column, slope) in
                [(3, 1, -half / beside), (3, 3, 1.0), (3, 0, 0.0), (0, 0, 1.0), (0, 1, 0.0)]
            {
                let error = (load.tangent[row * 6 + column] - slope).abs();
                assert!(error < 1e-15 / beside.powi(3), "{half} {row} {column}: {error}");
            }
        }
    }

    /// Circles that do not cross push the slider onto the line between their centres.
    #[test]
    fn pushes_in_turn_go_on_where_circles_do_not_cross() {
        for beyond in [1e-3, 1e-5, 1e-7] {
            let load = to_and_fro(1.0 + beyond);
            assert!(load.panels > 0 && load.solved < 2 * FEW, "{beyond}: {}", load.solved);
            assert!((load.value[3] + 0.5).abs() < 1e-9, "{beyond}: {}", load.value[3]);
            for (column, slope) in [(3, 1.0), (0, 0.0), (1, 0.0)] {
                let error = (load.tangent[3 * 6 + column] - slope).abs();
                assert!(error < 1e-9 / beyond, "{beyond} {column}: {error}");
            }
        }
    }

    /// Random motions under loads that vary, by a part of a thousand smaller than what slips for good.
    #[test]
    fn what_has_just_shaken_down_varies_as_its_differences() {
        let mut random = numbers();
        let (highest, slots) = (3, 7);
        let law = Coulomb::new(2, 0.3, 1.0, Some(1.0), Closure::Preload(1.0)).unwrap();
        let mut pushed = 0;
        for case in 0..40 {
            let mut series = |size: f64| -> Vec<f64> {
                let order = |i: usize| i.div_ceil(2) as f64;
                (0..slots).map(|i| if i == 0 { 0.0 } else { size * random() / order(i) }).collect()
            };
            let path = [series(1.0), series([1.0, 0.3, 0.05, 0.0][case % 4])].concat();
            let pressing = series(0.1);
            let of = |size: f64| {
                let path: Vec<f64> = path.iter().map(|u| size * u).collect();
                [path, pressing.clone()].concat()
            };
            let [mut low, mut high] = [1e-3_f64, 1e2];
            while high > (1.0 + 1e-12) * low {
                let middle = (low * high).sqrt();
                let recurs = load(&law, &of(middle), highest).panels > 0;
                *(if recurs { &mut high } else { &mut low }) = middle;
            }
            let [below, above] =
                [1.0 - 1e-9, 1.0 + 1e-9].map(|by| load(&law, &of(by * low), highest));
            for (below, above) in below.value.iter().zip(&above.value) {
                assert!((below - above).abs() < 1e-3, "{case}: {below} {above}");
            }
            let displacement = of((1.0 - 1e-3) * low);
            let own = load(&law, &displacement, highest);
            assert!(own.panels == 0 && own.solved < FEW, "{case}: {}", own.solved);
            pushed += usize::from(own.solved > 0);
            let largest = own.tangent.iter().fold(1.0_f64, |most, t| most.max(t.abs()));
            for column in 0..3 * slots {
                let [up, down] = [1e-7, -1e-7].map(|by| {
                    let mut moved = displacement.clone();
                    moved[column] += by;
                    load(&law, &moved, highest).value
                });
                for (row, (up, down)) in up.iter().zip(&down).enumerate() {
                    let error = (up - down) / 2e-7 - own.tangent[row * 3 * slots + column];
                    assert!(error.abs() < 1e-6 * largest, "{case} {row} {column}: {error}");
                }
            }
        }
        assert!(pushed > 20, "{pushed}");
    }
}
