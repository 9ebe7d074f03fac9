//! Ranges of frequencies cut into pieces, which all processors work on at the same time.
//!
//! The points of all seams are solved first, from nothing, so that errors count against the same motions in
//! every piece. A piece goes from its seam to the next one. Where several motions are possible it has to come
//! there to the motion that was found: a curve that does not is followed on as a whole. The pieces, and so all
//! digits, are the same with any number of threads.

use super::balances::Balances;
use crate::balance::{
    branch_piece, check_range, join_branches, join_smooth, seam, seams, smooth_piece, sweep_range,
    Course, CurveEnd, ForcedBalance, Piece, Point, PointStatus, Progress, Solution,
};
use crate::motion::is_passive;
use crate::parallel::in_parts;
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Share of the work that the points of the seams are.
const SEAMS: f64 = 0.1;

/// Follows the curve from `from` to `to` [rad/s], as [`sweep_range`]: in pieces if that pays and if one motion
/// alone is possible or the curve is followed by arclength.
///
/// # Errors
/// As [`sweep_range`].
pub fn sweep_range_in_pieces(
    balances: &Balances<'_>,
    (from, to): (f64, f64),
    progress: &Progress<'_>,
) -> Result<Solution, Error> {
    let start = Instant::now();
    check_range((from, to))?;
    let smooth = balances.model.is_monotone();
    let whole = || balances.with(progress, |balance| sweep_range(balance, from, to));
    let serial = balances.model.laws().iter().any(|law| law.is_serial());
    if serial || smooth && !is_passive(balances.model) {
        return whole();
    }
    let omega = seams(balances.model, &balances.settings, (from, to), balances.much)?;
    if omega.len() == 1 {
        return whole();
    }
    let first_share = |share: f64| progress(SEAMS * share);
    let found = in_parts(omega.len(), &first_share, |number, look| {
        balances.lent(look, |mut balance| {
            // Of the other seams nobody has asked for the frequency.
            let point = match number {
                0 => balance.solve(from, None)?,
                _ => seam(&mut balance, omega[number])?,
            };
            let point = Arc::new(point);
            if number == 0 {
                // The one that a curve that is ended here has.
                balances.keep_only(std::slice::from_ref(&point));
            }
            Ok((point, balance.into_profile()))
        })
    });
    let (mut ends, mut profile, mut ended) = (Vec::new(), Profile::default(), false);
    for (number, found) in found.into_iter().enumerate() {
        match found {
            Ok((point, own)) => {
                profile.add_whole(&own);
                ended |= point.status == PointStatus::NotComputed;
                if number == 0 || point.status == PointStatus::Converged {
                    ends.push(point);
                }
            }
            Err(error) if number == 0 => return Err(error),
            Err(_) => {}
        }
    }
    let course =
        balances.lent(progress, |mut balance| Course::new(&mut balance, &ends, (from, to)))?;
    let rest = |share: f64| progress(SEAMS + (1.0 - SEAMS) * share);
    let found = in_parts(ends.len(), &rest, |number, look| {
        // Without all seams the pieces would be others.
        piece(balances, &course, &ends, number, smooth, &|share| !ended && look(share))
    });
    let pieces: Vec<Piece> = found.into_iter().collect::<Result<_, _>>()?;
    balances.with(&|_| progress(1.0), |mut balance| {
        balance.add_profile(&profile);
        if smooth {
            return Ok(join_smooth(balance, pieces, start));
        }
        join_branches(balance, &course, pieces, start)
    })
}

/// The piece of a number, from its seam to the next one.
fn piece(
    balances: &Balances<'_>,
    course: &Course,
    ends: &[Arc<Point>],
    number: usize,
    smooth: bool,
    look: &Progress<'_>,
) -> Result<Piece, Error> {
    let (first, last) = (Arc::clone(&ends[number]), ends.get(number + 1));
    let work = |mut balance: ForcedBalance<'_>| {
        let (points, end) = if smooth {
            let (points, interrupted) = smooth_piece(&mut balance, course, first, last)?;
            (points, if interrupted { CurveEnd::Interrupted } else { CurveEnd::Range })
        } else {
            branch_piece(&mut balance, course, first, last)?
        };
        Ok(Piece { points, end, profile: balance.into_profile() })
    };
    // Of pieces that are behind a gap nothing is told.
    if number == 0 {
        // Its first point is kept once more.
        balances.keep_only(&[]);
        balances.with(look, work)
    } else {
        balances.lent(look, work)
    }
}
