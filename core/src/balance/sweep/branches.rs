//! A curve over a range of frequencies where solutions may not be unique: the branch that begins at the
//! first end of the range, on which the frequency may turn back, and further ones.

use super::branch::branch_through;
use super::further::add_further_branches;
use super::given::finish;
use crate::balance::forced::ForcedBalance;
use crate::balance::keep;
use crate::balance::solution::{CurveEnd, Point, PointStatus, Solution};
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Follows the curve from `from` to `to` [rad/s]; from the other end where that leads nowhere.
pub(super) fn sweep_branches(
    mut balance: ForcedBalance<'_>,
    (from, to): (f64, f64),
) -> Result<Solution, Error> {
    let start = Instant::now();
    let first = branch(&mut balance, from, to)?;
    with_others(balance, first, (from, to), start)
}

/// A curve of its first branch, or of that from the other end where it leads nowhere, and of further ones.
pub(super) fn with_others(
    mut balance: ForcedBalance<'_>,
    (mut points, mut end): (Vec<Arc<Point>>, CurveEnd),
    (from, to): (f64, f64),
    start: Instant,
) -> Result<Solution, Error> {
    if matches!(end, CurveEnd::Returned | CurveEnd::Stalled) {
        let (mut others, other_end) = branch(&mut balance, to, from)?;
        if other_end == CurveEnd::Range {
            others.reverse();
            (points, end) = (others, other_end);
        } else if other_end == CurveEnd::Interrupted {
            end = other_end;
            // From the other end there might have been a point here.
            if points.first().is_some_and(|first| !first.is_solved()) {
                points = vec![Arc::new(balance.not_computed(from))];
            }
        }
    }
    let mut cut = 0;
    if balance.further && matches!(end, CurveEnd::Range | CurveEnd::Returned) {
        let bounds = (from.min(to), from.max(to));
        let complete;
        (complete, cut) = add_further_branches(&mut balance, &mut points, bounds);
        end = if complete { end } else { CurveEnd::Interrupted };
    }
    let interrupted = end == CurveEnd::Interrupted;
    Ok(Solution { end, cut, ..finish(balance, points, interrupted, start) })
}

/// The branch that begins at one end of a range, and how it ended.
fn branch(
    balance: &mut ForcedBalance<'_>,
    from: f64,
    to: f64,
) -> Result<(Vec<Arc<Point>>, CurveEnd), Error> {
    let first = balance.solve(from, None)?;
    if !first.is_solved() {
        let ended = first.status == PointStatus::NotComputed;
        let end = if ended { CurveEnd::Interrupted } else { CurveEnd::Stalled };
        return Ok((vec![Arc::new(first)], end));
    }
    balance.scale.include(&first);
    let first = Arc::new(first);
    keep(balance.kept, &first);
    branch_through(balance, first, (from, to), (from.min(to), from.max(to)))
}
