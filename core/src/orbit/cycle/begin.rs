//! Where in time the segments of an exact limit cycle begin.
//!
//! What a contact without sliders remembers jumps where it turns round, and where it closes a loop: from
//! there on other reversals of the period count. A segment that begins close to such an instant hinders
//! Newton's method, and one that meets it along the branch stops the walk. Nothing drives the motion, so
//! that its segments may as well begin later.

use super::limit_cycle::OrbitCurve;
use crate::balance::Point;
use crate::motion::{FlowEvent, Turn};
use crate::orbit::segments::settle_memory;
use crate::solve::{norm, Curve as _};

/// Distance of the begin from the nearest jump, relative to the largest there is, below which it moves.
const CLOSE: f64 = 0.25;
/// Begins that are compared to bring two motions in step.
const BEGINS: usize = 32;
/// Distance of two motions, relative to one of them, below which they are.
const IN_STEP: f64 = 0.2;

impl OrbitCurve<'_> {
    /// As [`CycleOrbits::unknowns`], in as many segments as the motion needs.
    ///
    /// [`CycleOrbits::unknowns`]: super::orbits::CycleOrbits::unknowns
    pub(super) fn start(&mut self, point: &Point, value: f64) -> Option<Vec<f64>> {
        let mut z = self.unknowns_of(point, value, 1)?;
        loop {
            let suitable = self.suitable_unknowns(&z);
            if suitable <= z.len() {
                return self.best_begin(&z).map_or(Some(z.clone()), |by| self.begun(&z, by));
            }
            z = self.unknowns_of(point, value, (suitable - 2) / self.state_size()[0])?;
        }
    }

    /// How much later segments begin best, in lengths of one; nothing where they may stay.
    pub(super) fn best_begin(&self, z: &[f64]) -> Option<f64> {
        if self.state_size()[1] == 0 {
            return None;
        }
        let mut jumps = self.jumps(z)?;
        jumps.sort_by(f64::total_cmp);
        let first = *jumps.first()?;
        jumps.push(first + 1.0);
        let gaps = jumps.windows(2).map(|pair| [pair[0], pair[1]]);
        let [from, to] = gaps.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
        let nearest = jumps.iter().map(|at| at.min((1.0 - at).abs())).fold(1.0, f64::min);
        (nearest < CLOSE * 0.5 * (to - from)).then(|| (0.5 * (from + to)).fract())
    }

    /// Instants at which what is remembered jumps, each in lengths of its segment.
    fn jumps(&self, z: &[f64]) -> Option<Vec<f64>> {
        self.with_shooting(z, |_, shooting, y| {
            let mut jumps = Vec::new();
            let starts = y.chunks_exact(self.state_size()[0]);
            let count = starts.len();
            for (number, start) in starts.enumerate() {
                shooting.narrow(number, count);
                shooting.later(start, 1.0, &mut |share, passage| {
                    let FlowEvent::Event { turn: Some((_, turn)), .. } = passage else { return };
                    if *turn != Turn::Forgotten(0) {
                        jumps.push(share);
                    }
                })?;
            }
            Some(jumps)
        })
    }

    /// The same motion with segments that begin so much later, in lengths of one.
    pub(super) fn begun(&self, z: &[f64], later: f64) -> Option<Vec<f64>> {
        let [.., omega, value] = *z else { return None };
        let mut moved = self.with_shooting(z, |_, shooting, y| {
            let [size, _] = self.state_size();
            let count = y.len() / size;
            let mut moved = Vec::with_capacity(z.len());
            for (number, start) in y.chunks_exact(size).enumerate() {
                shooting.narrow(number, count);
                moved.extend(shooting.later(start, later, &mut |_, _| {})?);
            }
            settle_memory(shooting, &mut moved)?;
            Some(moved)
        })?;
        moved.extend([omega, value]);
        Some(moved)
    }

    /// A motion that begins when another one of as many segments does.
    pub(super) fn in_step(&self, a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
        // What is remembered is not compared.
        let [size, memory] = self.state_size();
        let motion = |z: &[f64]| -> Vec<f64> {
            let states = z[..z.len() - 2].chunks_exact(size);
            states.flat_map(|state| &state[..size - memory]).copied().collect()
        };
        let to = motion(b);
        let apart =
            |z: &[f64]| norm(&motion(z).iter().zip(&to).map(|(a, b)| a - b).collect::<Vec<f64>>());
        if apart(a) <= IN_STEP * norm(&to) {
            return Some(a.to_vec());
        }
        let begins = (1..BEGINS).filter_map(|k| self.begun(a, k as f64 / BEGINS as f64));
        begins.chain([a.to_vec()]).min_by(|a, b| apart(a).total_cmp(&apart(b)))
    }
}
