//! Where contacts begin to slip: what friction has held down may have a peak there that no slope on either
//! side tells of.

use super::samples::Sample;
use super::search::Search;
use crate::Error;

/// Share of an interval within which the frequency is known at which slip begins, …
const ONSET: f64 = 4e-3;
/// … unless it is as short as this, relative to the frequency.
const SHORT: f64 = 1e-7;
/// Share of the highest point from which such a point is a rival.
const ONSET_RIVAL: f64 = 0.5;
/// Share of the highest point from which an end of an interval is a rival that may hide where contacts
/// stick, …
const WINDOW_RIVAL: f64 = 0.25;
/// … and where in it that is looked for.
const WINDOW: [f64; 3] = [0.5, 0.25, 0.75];
/// Bisections of the place at which one of several contacts begins to slip.
const CHANGE: usize = 4;

impl Search<'_, '_> {
    /// Looks for frequencies at which contacts stick between points at which they slip, about an
    /// antiresonance of their motion: there is an onset of slip on either side then. It takes the stuck
    /// response alone, and is done where no point has confirmed what an interval promises. Whether there
    /// are any that no point has seen.
    pub(super) fn look_between_slips(&mut self) -> Result<bool, Error> {
        let rival = |ends: &[Sample]| {
            (0..self.aim.groups.len()).any(|group| {
                let height = |one| self.envelope.height_of(one, group);
                height(&ends[0]).max(height(&ends[1])) > WINDOW_RIVAL * self.envelope.height(group)
            })
        };
        let slip = |ends: &[Sample]| !ends[0].sticks() && !ends[1].sticks();
        let intervals = self.envelope.intervals().filter(|(gap, ends)| {
            let looked_at = |one: &[f64; 2]| one[0] <= ends[0].at && ends[1].at <= one[1];
            gap.is_unconfirmed()
                && slip(ends)
                && rival(ends)
                && ends[1].at - ends[0].at > SHORT * ends[1].at
                && !self.windows.iter().any(looked_at)
        });
        let intervals: Vec<[f64; 2]> =
            intervals.map(|(_, ends)| [ends[0].at, ends[1].at]).collect();
        let mut found = false;
        for [left, right] in intervals {
            self.windows.push([left, right]);
            for share in WINDOW {
                let omega = left + share * (right - left);
                if !self.balance.sticks(omega)? {
                    continue;
                }
                if let Some(sample) = self.solve(omega, None)? {
                    let before = self.envelope.samples.len();
                    self.envelope.insert(sample);
                    found |= self.envelope.samples.len() > before;
                }
                break;
            }
        }
        Ok(found)
    }

    /// Looks at the frequencies at which slip begins: what friction has held down may have a peak there that
    /// no slope on either side tells of. Whether there are any that no point has seen.
    pub(super) fn look_at_onsets(&mut self) -> Result<bool, Error> {
        let mixed = |ends: &&[Sample]| ends[0].sticks() != ends[1].sticks();
        let intervals = self.envelope.samples.windows(2).filter(mixed);
        let intervals: Vec<[f64; 2]> = intervals
            .map(|ends| if ends[0].sticks() { [0, 1] } else { [1, 0] }.map(|i| ends[i].at))
            .collect();
        let mut found = false;
        for [mut stuck, mut slipping] in intervals {
            let between = stuck.min(slipping)..=stuck.max(slipping);
            if self.lower_onsets.iter().any(|at| between.contains(at)) {
                continue;
            }
            let mut part = slipping - stuck;
            if part.abs() <= SHORT * stuck || !self.balance.sticks(stuck + ONSET * part)? {
                continue;
            }
            let enough = 0.25 * ONSET * part.abs();
            while part.abs() > enough {
                let middle = 0.5 * (stuck + slipping);
                *(if self.balance.sticks(middle)? { &mut stuck } else { &mut slipping }) = middle;
                part = slipping - stuck;
            }
            let sample = self.solve(stuck, None)?;
            let rivals = |sample: &Sample| {
                (0..self.aim.groups.len()).any(|group| {
                    let height = self.envelope.height(group);
                    self.envelope.height_of(sample, group) > ONSET_RIVAL * height
                })
            };
            if sample.as_ref().is_none_or(|one| !rivals(one)) {
                // The highest point only grows: it will be none.
                self.lower_onsets.push(0.5 * (stuck + slipping));
            } else if let Some(sample) = sample {
                let before = self.envelope.samples.len();
                self.envelope.insert(sample);
                found |= self.envelope.samples.len() > before;
            }
        }
        Ok(found)
    }

    /// Looks at the next place at which one of several contacts begins to slip, or ceases to, near the
    /// height of the highest point: narrow resonances, of a `bandwidth` relative to the frequency, hide
    /// there. Whether there was one that had not been looked at.
    pub(super) fn look_at_changes(&mut self, bandwidth: f64) -> Result<bool, Error> {
        let mut intervals = self.envelope.samples.windows(2);
        let found = intervals.position(|ends| self.hides(ends, bandwidth));
        let Some(mut interval) = found else { return Ok(false) };
        for _ in 0..CHANGE {
            let Some(sample) = self.inside(interval, 0.5)? else { break };
            let same = sample.slips == self.envelope.samples[interval].slips;
            self.envelope.split(interval, sample);
            interval += usize::from(same);
        }
        let [left, right] = [interval, interval + 1].map(|i| self.envelope.samples[i].at);
        self.changes.push(0.5 * (left + right));
        Ok(true)
    }

    /// Whether a narrow resonance may hide between two samples in which different contacts slip.
    fn hides(&self, ends: &[Sample], bandwidth: f64) -> bool {
        let [left, right] = [&ends[0], &ends[1]];
        let least = bandwidth.max(SHORT) * right.at;
        let height = |one, group| self.envelope.height_of(one, group);
        let is_rival = |group| {
            let higher = height(left, group).max(height(right, group));
            higher > ONSET_RIVAL * self.envelope.height(group)
        };
        left.slips != right.slips
            && !left.sticks()
            && !right.sticks()
            && right.at - left.at > least
            && !self.changes.iter().any(|at| (left.at..=right.at).contains(at))
            && (0..self.aim.groups.len()).any(is_rival)
    }
}
