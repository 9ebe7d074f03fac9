//! Peaks of a map over two parameters of a design, each to some accuracy.
//!
//! Where all laws are monotone the peak is that of the search for a single one. Where a contact opens that search
//! follows the whole curve by arclength with all the harmonics of its peak, a hundred of a bouncing damper, which
//! a map of many cells cannot pay for. There resonances are located on an even grid with few harmonics. The
//! highest ones are then solved on ever narrower grids with twice the harmonics each, until the peak stays the
//! same; every point starts from the nearest one that is known, of fewer harmonics too. This follows one branch.
//! Where the even grid jumps, or the points around a maximum lie on different branches, the search for a single
//! peak is taken all the same.

use super::peak::{are_torn, climbed, PeakQuery, OF_STUDY};
use crate::balance::{
    keep, sweep, ForcedBalance, HarmonicChoice, Kept, Point, PointStatus, Progress, Settings,
};
use crate::fourier::{amplitude, Harmonics, Measure, SampleTable};
use crate::model::Model;
use crate::Error;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{channel, RecvTimeoutError};
use std::sync::Arc;
use std::time::Duration;

/// Harmonics with which resonances are located.
const COARSE: usize = 7;
/// Share of the highest of the coarse maxima from which on a rival is looked at too.
const NEAR: f64 = 0.7;
/// Frequencies around a maximum, at first and then.
const LOCAL: [usize; 2] = [7, 5];
/// Shares of the tolerance that the last doubling may change, and that the error estimate may reach: what
/// is left decays no faster than what was seen.
const SETTLED: [f64; 2] = [0.25, 0.5];
/// Time between two questions whether to go on.
const PATIENCE: Duration = Duration::from_millis(50);

/// A model of the map, how its balance is solved, and the DOF whose peak is sought.
pub type Cell = (Arc<Model>, Settings, usize);

/// The peak of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellPeak {
    /// Frequency; not-a-number if the peak was not found, as below [rad/s].
    pub omega: f64,
    /// Half range \[m\].
    pub amplitude: f64,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// How its search ended.
    pub status: PointStatus,
}

impl CellPeak {
    /// A peak that was not computed.
    pub const NOT_COMPUTED: Self = Self::missing(0, PointStatus::NotComputed);

    const fn missing(harmonics: usize, status: PointStatus) -> Self {
        Self { omega: f64::NAN, amplitude: f64::NAN, harmonics, status }
    }
}

/// Finds the peaks of all cells over a grid of frequencies, in parallel threads, to the tolerance of
/// their settings; `kept` takes them with the numbers of their cells as they are found.
///
/// # Errors
/// No thread, or as for a solution.
pub fn peak_map(
    cells: &[Cell],
    grid: &[f64],
    threads: usize,
    kept: &Kept<(usize, CellPeak)>,
    progress: &Progress<'_>,
) -> Result<Vec<CellPeak>, Error> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Error::shape("threads", "as many as the system grants", error))?;
    let stop = AtomicBool::new(false);
    let (sender, receiver) = channel();
    let mut found: Vec<Result<CellPeak, Error>> = vec![Ok(CellPeak::NOT_COMPUTED); cells.len()];
    pool.in_place_scope_fifo(|scope| {
        for (index, cell) in cells.iter().enumerate() {
            let (sender, stop) = (sender.clone(), &stop);
            scope.spawn_fifo(move |_| {
                let proceed = |_| !stop.load(Ordering::Relaxed);
                let search = Search { cell, grid, progress: &proceed };
                // Nobody listens any more once the map has ended.
                let _ = sender.send((index, or_singular(search.peak())));
            });
        }
        drop(sender);
        let mut done = 0;
        loop {
            match receiver.recv_timeout(PATIENCE) {
                Ok((index, peak)) => {
                    if let Ok(peak) = peak {
                        keep(Some(kept), &Arc::new((index, peak)));
                    }
                    found[index] = peak;
                    done += 1;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if !progress(f64::from(done) / cells.len() as f64) {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
    found.into_iter().collect()
}

/// What was found of a cell; an undamped resonance is no reason to give up the others.
fn or_singular(found: Result<CellPeak, Error>) -> Result<CellPeak, Error> {
    match found {
        Err(Error::UndampedResonance { .. }) => Ok(CellPeak::missing(0, PointStatus::Singular)),
        found => found,
    }
}

/// The search for the peak of a cell.
struct Search<'a> {
    cell: &'a Cell,
    grid: &'a [f64],
    progress: &'a Progress<'a>,
}

impl Search<'_> {
    fn peak(&self) -> Result<CellPeak, Error> {
        let (model, _, dof) = self.cell;
        let span = (self.grid[0], self.grid[self.grid.len() - 1]);
        if model.unbounded(span, self.progress)?[*dof].is_some() {
            return Ok(CellPeak::missing(0, PointStatus::Singular));
        }
        let quest = PeakQuery { groups: vec![vec![*dof]], measure: Measure::HalfRange, span };
        let located = if model.is_monotone() { None } else { self.located(&quest)? };
        let found = located.map_or_else(|| self.climbed(&quest), Ok);
        // Of a search that was stopped what is found need not be the highest.
        if (self.progress)(0.0) {
            found
        } else {
            Ok(CellPeak::NOT_COMPUTED)
        }
    }

    /// The peak by the search for a single one.
    fn climbed(&self, quest: &PeakQuery) -> Result<CellPeak, Error> {
        let (model, settings, _) = self.cell;
        let found = climbed(model, *settings, quest, OF_STUDY, None, self.progress)?;
        Ok(found.summits.first().map_or(CellPeak::NOT_COMPUTED, |peak| CellPeak {
            omega: if peak.status.is_solved() { peak.omega } else { f64::NAN },
            amplitude: peak.amplitude,
            harmonics: peak.harmonics,
            status: peak.status,
        }))
    }

    /// The highest peak by the even grid; nothing if there are several branches.
    fn located(&self, quest: &PeakQuery) -> Result<Option<CellPeak>, Error> {
        let coarse = sweep(self.balance(COARSE)?, self.grid)?.points;
        if coarse.iter().any(|point| point.jump) {
            return Ok(None);
        }
        let highest = coarse.iter().map(|point| height(point)).fold(0.0, f64::max);
        self.highest(&coarse, NEAR * highest, quest)
    }

    /// The highest peak near the maxima of the even grid that reach so high.
    fn highest(
        &self,
        points: &[Arc<Point>],
        least: f64,
        quest: &PeakQuery,
    ) -> Result<Option<CellPeak>, Error> {
        let heights: Vec<f64> = points.iter().map(|point| height(point)).collect();
        let at = |at: Option<usize>| at.and_then(|at| heights.get(at)).map_or(0.0, |h| h.max(0.0));
        let mut best = CellPeak::missing(COARSE, unsolved(points));
        for (top, (point, &own)) in points.iter().zip(&heights).enumerate() {
            let is_top = own >= at(top.checked_sub(1)) && own >= at(Some(top + 1));
            if is_top && own >= least && (self.progress)(0.0) {
                let Some(peak) = self.refined(points, point.omega, quest)? else {
                    return Ok(None);
                };
                if best.amplitude.is_nan() || peak.amplitude > best.amplitude {
                    best = peak;
                }
            }
        }
        Ok(Some(best))
    }

    /// The peak near a frequency.
    fn refined(
        &self,
        coarse: &[Arc<Point>],
        mut centre: f64,
        quest: &PeakQuery,
    ) -> Result<Option<CellPeak>, Error> {
        let (low, high) = (self.grid[0], self.grid[self.grid.len() - 1]);
        let Settings { tolerance, max_harmonics, .. } = self.cell.1;
        let (mut step, mut before) = (2.0 * (self.grid[1] - low), f64::NAN);
        let (mut harmonics, mut known) = (COARSE, coarse.to_vec());
        while 2 * harmonics < max_harmonics {
            harmonics = 2 * harmonics + 1;
            let mut balance = self.balance(harmonics)?;
            let (from, to) = ((centre - step).max(low), (centre + step).min(high));
            let last = LOCAL[usize::from(!before.is_nan())] - 1;
            let near: Vec<f64> =
                (0..=last).map(|n| from + (to - from) * n as f64 / last as f64).collect();
            let mut points: Vec<Arc<Point>> = Vec::with_capacity(near.len());
            for &omega in &near {
                let distance = |point: &&Arc<Point>| (point.omega - omega).abs();
                let solved = points.iter().chain(&known).filter(|point| point.is_solved());
                let start = solved.min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let start = start.and_then(|point| point.unknowns());
                points.push(Arc::new(balance.solve(omega, start)?));
            }
            let heights: Vec<f64> = points.iter().map(|point| height(point)).collect();
            if heights.iter().all(|height| height.is_nan()) {
                return Ok(Some(CellPeak::missing(harmonics, unsolved(&points))));
            }
            let top = top(&heights);
            let around = &points[top.saturating_sub(1)..(top + 2).min(points.len())];
            let settings = self.settings(harmonics);
            if are_torn(&self.cell.0, settings, quest, around, self.progress)? {
                return Ok(None);
            }
            let (omega, amplitude) = vertex(&near, &heights, top);
            let solved = points.iter().filter(|point| point.is_solved());
            let error = solved.map(|point| point.error_estimate[0]).fold(0.0, f64::max);
            let [change, left] = SETTLED.map(|share| share * tolerance * amplitude);
            if (amplitude - before).abs() <= change && error <= left {
                let status = PointStatus::Converged;
                return Ok(Some(CellPeak { omega, amplitude, harmonics, status }));
            }
            // A peak that has wandered off is followed before the grid narrows.
            step *= if near[0] < omega && omega < near[last] { 0.5 } else { 1.0 };
            (centre, before, known) = (omega, amplitude, points);
        }
        let status = PointStatus::HarmonicsLimit;
        Ok(Some(CellPeak { omega: centre, amplitude: before, harmonics, status }))
    }

    fn settings(&self, harmonics: usize) -> Settings {
        Settings { harmonics: HarmonicChoice::Fixed(harmonics), ..self.cell.1 }
    }

    fn balance(&self, harmonics: usize) -> Result<ForcedBalance<'_>, Error> {
        let (model, _, dof) = self.cell;
        let observe = std::slice::from_ref(dof);
        Ok(ForcedBalance::new(model, self.settings(harmonics), observe)?.watched(self.progress))
    }
}

/// How the first of some points ended that have no solution.
fn unsolved(points: &[Arc<Point>]) -> PointStatus {
    let first = points.iter().find(|point| !point.is_solved());
    first.map_or(PointStatus::NotComputed, |point| point.status)
}

/// Half the range of the only DOF that is observed.
fn height(point: &Point) -> f64 {
    if !point.is_solved() {
        return f64::NAN;
    }
    let table = SampleTable::new(Harmonics::new(point.harmonics, false));
    let mut series = vec![0.0; table.harmonics().slots()];
    table.harmonics().write_series(&point.displacement, &mut series);
    amplitude(&table, &series, Measure::HalfRange)
}

/// Where the highest point is.
fn top(heights: &[f64]) -> usize {
    let order = |&a: &usize, &b: &usize| heights[a].total_cmp(&heights[b]);
    (0..heights.len()).filter(|&at| !heights[at].is_nan()).max_by(order).unwrap_or(0)
}

/// The top of the parabola through the highest point and its neighbours, or that point.
fn vertex(omega: &[f64], heights: &[f64], top: usize) -> (f64, f64) {
    let own = (omega[top], heights[top]);
    if top == 0 || top + 1 == heights.len() {
        return own;
    }
    let (left, right) = (heights[top - 1] - own.1, heights[top + 1] - own.1);
    // Of points that are equally far.
    let (rise, bend) = (0.5 * (right - left), right + left);
    let share = -rise / bend;
    if !(bend < 0.0 && share.is_finite()) {
        return own;
    }
    (own.0 + share * (omega[top + 1] - omega[top]), own.1 - 0.5 * rise * rise / bend)
}

#[cfg(test)]
mod tests {
    use super::{top, vertex as through};

    fn vertex(omega: &[f64], heights: &[f64]) -> (f64, f64) {
        through(omega, heights, top(heights))
    }

    #[test]
    fn the_vertex_of_a_parabola_is_found() {
        let omega = [1.0, 2.0, 3.0, 4.0, 5.0];
        let heights = omega.map(|w: f64| 7.0 - (w - 3.3) * (w - 3.3));
        let (at, height) = vertex(&omega, &heights);
        assert!((at - 3.3).abs() < 1e-12 && (height - 7.0).abs() < 1e-12);
        assert_eq!(vertex(&omega, &[3.0, 2.0, f64::NAN, 1.0, 0.0]), (1.0, 3.0));
        assert_eq!(vertex(&omega, &[f64::NAN, 2.0, 1.0, 1.0, 0.0]), (2.0, 2.0));
    }
}
