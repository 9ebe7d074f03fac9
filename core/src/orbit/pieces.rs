//! Sweeps cut into pieces, which all processors work on at the same time.
//!
//! Where one motion alone is possible no point needs those before it: they are a start that is close, and
//! save Newton steps. A piece begins without one. The pieces, and so all digits, are the same with any
//! number of threads.

use crate::balance::{
    check_frequencies, work_of_given, CurveEnd, Point, PointStatus, Progress, Settings, Solution,
    MUCH,
};
use crate::contact::Residual;
use crate::model::Model;
use crate::motion::is_passive;
use crate::parallel::in_parts;
use crate::timing::Profile;
use crate::Error;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// Most points that are found one from the other where each could be found by itself.
const PIECE: usize = 16;

/// A sweep of some points in pieces of about the same length.
pub(super) fn pieces(points: usize) -> Vec<Range<usize>> {
    let count = points.div_ceil(PIECE).max(1);
    (0..count).map(|i| i * points / count..(i + 1) * points / count).collect()
}

/// Balances harmonics at the frequencies `omega` [rad/s] by `sweep`, which is given those of a piece and
/// somebody to report to. It is one piece if the model allows for several motions, if harmonics or samples
/// are chosen on the way, if laws are marched through a period, or if there is little to do.
///
/// # Errors
/// A frequency that is not positive, or as `sweep`.
pub fn sweep_in_pieces(
    model: &Model,
    settings: &Settings,
    omega: &[f64],
    progress: &Progress<'_>,
    sweep: impl Fn(&[f64], &Progress<'_>) -> Result<Solution, Error> + Sync,
) -> Result<Solution, Error> {
    let start = Instant::now();
    check_frequencies(omega)?;
    let closed = model.laws().iter().all(|law| law.closed_form().is_some());
    let starts_anywhere = closed && settings.residual != Residual::FromRest;
    let work = work_of_given(model, settings).filter(|_| starts_anywhere).unwrap_or(0.0);
    if omega.len() <= PIECE || work * (omega.len() as f64) < MUCH || !is_passive(model) {
        return sweep(omega, progress);
    }
    let pieces = pieces(omega.len());
    let found = in_parts(pieces.len(), progress, |piece, progress| {
        // What lies behind the end of a curve is left out: nothing is prepared for it.
        let begun = piece == 0 || progress(0.0);
        begun.then(|| sweep(&omega[pieces[piece].clone()], progress)).transpose()
    });
    let (mut points, mut profile) = (Vec::with_capacity(omega.len()), Profile::default());
    let (mut half_wave, mut interrupted, mut first) = (false, false, None);
    for piece in found {
        let Some(piece) = piece? else {
            interrupted = true;
            break;
        };
        profile.add_whole(&piece.profile);
        half_wave |= piece.half_wave;
        // A curve that was ended early has no gap.
        if !interrupted {
            let computed = |point: &&Arc<Point>| point.status != PointStatus::NotComputed;
            points.extend(piece.points.iter().filter(computed).cloned());
            first = first.or(piece.points.into_iter().next());
        }
        interrupted |= piece.interrupted;
    }
    if points.is_empty() {
        points.extend(first);
    }
    let end = if interrupted { CurveEnd::Interrupted } else { CurveEnd::Range };
    let profile = Profile { total: start.elapsed(), ..profile };
    Ok(Solution { points, half_wave, interrupted, end, cut: 0, profile })
}
