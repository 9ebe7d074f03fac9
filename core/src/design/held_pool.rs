//! Motions of one point whose sliders are held at different places.

use crate::balance::{HeldMotion, SliderBalance};

/// Corners that are tried at most.
const CORNERS: usize = 8;
/// Vibrations from which others are looked for: complex multiples of the curve's, …
const MULTIPLES: [[f64; 2]; 3] = [[-3.0, 0.0], [0.0, 3.0], [0.0, -3.0]];
/// … and of that without slip, …
const OF_STUCK: [[f64; 2]; 2] = [[-3.0, 0.0], [0.0, 3.0]];
/// … and the curve's with one added that opens a contact or all of them, over its largest component.
const OPENING: [f64; 2] = [3.0, 10.0];
/// Single contacts that are opened at a point.
const OPENED: usize = 3;
/// Width of the bounds, relative to the amplitude, that is none.
pub(super) const NO_WIDTH: f64 = 1e-9;
/// Distance of two positions, relative to their range, that is none.
const SAME: f64 = 1e-3;

/// All motions found at a point: every one is a bound of every DOF.
pub(super) struct HeldPool<'a> {
    pub(super) balance: SliderBalance<'a>,
    /// All motions found, that of the curve first.
    pub(super) motions: Vec<HeldMotion>,
}

impl HeldPool<'_> {
    /// Follows the extremes of a neighbour, whose own motion is `from`, to here.
    pub(super) fn continue_from<'m>(
        &mut self,
        from: &HeldMotion,
        extremes: impl Iterator<Item = &'m HeldMotion>,
    ) {
        for motion in extremes {
            let u = &self.motions[0].u;
            let mut start = motion.clone();
            if start.u.len() == u.len() && from.u.len() == u.len() {
                let moved = u.iter().zip(&from.u);
                start.u.iter_mut().zip(moved).for_each(|(x, (here, there))| *x += here - there);
            } else {
                start.u.clone_from(u);
            }
            let target = beyond(motion, &motion.sliders);
            let found = self.balance.solve(&target, Some(&start.u), true);
            let stays = |found: &HeldMotion| found.held().count() >= motion.held().count();
            let lost = !found.as_ref().is_some_and(stays);
            self.motions.extend(found);
            if lost && motion.u.len() == start.u.len() {
                // The curve itself may have come to another state.
                self.motions.extend(self.balance.solve(&target, Some(&motion.u), true));
            }
        }
    }

    /// Tries all corners of what is known of the sliders; with some that the curve's motion does not
    /// hold, motions that begin without slip as well.
    pub(super) fn try_corners(&mut self, ranges: &[(usize, [f64; 2])], lost: bool) {
        let nominal = self.motions[0].clone();
        let most = if ranges.is_empty() { 0 } else { CORNERS };
        for corner in 0..most.min(1 << ranges.len().min(CORNERS)) {
            let mut target = nominal.sliders.clone();
            for (bit, (slider, [low, high])) in ranges.iter().enumerate() {
                let past = high - low;
                target[*slider] = if is_low(corner, bit) { low - past } else { high + past };
            }
            self.reach(0, &target);
            if lost {
                let stuck = self.balance.stuck_response().to_vec();
                self.motions.extend(self.balance.look(&target, &stuck, &self.motions));
            }
        }
    }

    /// Looks for motions far from that of the curve: from large vibrations out of phase with it, and from
    /// those in which contacts open, one by one, all at once and in turn. `survey` counts the points at
    /// which this was done: contacts and phases differ from one to the next.
    pub(super) fn try_starts(&mut self, survey: usize) {
        let nominal = self.motions[0].clone();
        let target = beyond(&nominal, &nominal.sliders);
        for start in self.starts(&nominal, survey) {
            self.motions.extend(self.balance.look(&target, &start, &self.motions));
        }
    }

    /// Looks for the motion of a neighbour.
    pub(super) fn look_from(&mut self, other: &HeldMotion) {
        if other.u.len() == self.motions[0].u.len() {
            let target = beyond(other, &other.sliders);
            self.motions.extend(self.balance.look(&target, &other.u, &self.motions));
        }
    }

    fn starts(&self, nominal: &HeldMotion, survey: usize) -> Vec<Vec<f64>> {
        let slots = (nominal.u.len() / nominal.sliders.len().max(1)).max(1);
        let turned = |of: &[f64], [re, im]: &[f64; 2]| {
            let mut u = of.to_vec();
            let harmonics = u.chunks_exact_mut(slots).flat_map(|own| own[1..].chunks_exact_mut(2));
            harmonics
                .for_each(|x| x.copy_from_slice(&[re * x[0] - im * x[1], im * x[0] + re * x[1]]));
            u
        };
        let fundamental = nominal.u.chunks_exact(slots).flat_map(|own| &own[1..3]);
        let largest = fundamental.fold(0.0_f64, |most, x| most.max(x.abs()));
        let (quarter, sign) = (survey % 2, if survey % 4 < 2 { 1.0 } else { -1.0 });
        let open = |u: &mut Vec<f64>, component: usize, by: f64| {
            u[component * slots + 1 + quarter] += sign * by * largest;
        };
        let components: Vec<usize> = self.balance.last_components().collect();
        let [one, all] = OPENING;
        let together = [1.0, -1.0].map(|next: f64| {
            let mut u = nominal.u.clone();
            let signs = std::iter::successors(Some(1.0), |sign| Some(sign * next));
            components.iter().zip(signs).for_each(|(at, sign)| open(&mut u, *at, sign * all));
            u
        });
        let first = survey * OPENED;
        let singly = (first..first + OPENED.min(components.len())).map(|turn| {
            let mut u = nominal.u.clone();
            open(&mut u, components[turn % components.len()], one);
            u
        });
        let multiples = MULTIPLES.iter().map(|by| turned(&nominal.u, by));
        let of_stuck = OF_STUCK.iter().map(|by| turned(self.balance.stuck_response(), by));
        multiples.chain(of_stuck).chain(together).chain(singly).collect()
    }

    /// Moves the sliders of a motion of the pool; those that are sent to a limit go with it.
    pub(super) fn reach(&mut self, from: usize, target: &[f64]) -> Option<usize> {
        let from = self.motions[from].clone();
        let target = beyond(&from, target);
        let found = self.balance.follow(&from, &target)?;
        self.motions.push(found);
        Some(self.motions.len() - 1)
    }

    /// The motion with the largest amplitude of a DOF, or the least one.
    pub(super) fn best(&self, dof: usize, sign: f64) -> usize {
        let height = |motion: &HeldMotion| sign * motion.amplitude[dof];
        let order = |a: &usize, b: &usize| {
            height(&self.motions[*a]).total_cmp(&height(&self.motions[*b])).then(b.cmp(a))
        };
        (0..self.motions.len()).max_by(order).unwrap_or(0)
    }

    pub(super) fn bounds(&self) -> Vec<[f64; 2]> {
        let dofs = self.motions[0].amplitude.len();
        let of = |dof: usize, sign: f64| self.motions[self.best(dof, sign)].amplitude[dof];
        (0..dofs).map(|dof| [of(dof, -1.0), of(dof, 1.0)]).collect()
    }

    /// Whether the motions found last have left bounds.
    pub(super) fn is_beyond(&self, known: &[[f64; 2]]) -> bool {
        let wider = |(a, b): (&[f64; 2], &[f64; 2])| a[0] < b[0] || a[1] > b[1];
        self.bounds().iter().zip(known).any(wider)
    }

    /// The motions that are extreme in some DOF, largest and least.
    pub(super) fn extremes(&self) -> Vec<HeldMotion> {
        let mut extremes: Vec<HeldMotion> = Vec::new();
        for (dof, amplitude) in self.motions[0].amplitude.iter().enumerate() {
            for sign in [1.0, -1.0] {
                let best = &self.motions[self.best(dof, sign)];
                let beyond = (best.amplitude[dof] - amplitude).abs() > NO_WIDTH * amplitude;
                let known = |own: &HeldMotion| own.amplitude == best.amplitude;
                if beyond && !extremes.iter().any(known) {
                    extremes.push(best.clone());
                }
            }
        }
        extremes
    }
}

/// On which side of its range a slider is in a corner: all corners in turn of up to three sliders, of
/// more those of the columns of a Hadamard matrix.
pub(super) fn is_low(corner: usize, slider: usize) -> bool {
    (corner & (1 << (slider % 3) | (slider / 3))).count_ones() % 2 == 0
}

/// Positions, of which those at or past a limit go past it: there the law holds them at it, wherever
/// it moves.
pub(super) fn beyond(motion: &HeldMotion, target: &[f64]) -> Vec<f64> {
    let mut target = target.to_vec();
    for (slider, [low, high]) in motion.held() {
        let width = high - low;
        if target[slider] <= low + SAME * width {
            target[slider] = low - width;
        } else if target[slider] >= high - SAME * width {
            target[slider] = high + width;
        }
    }
    target
}
