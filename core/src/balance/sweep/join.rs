//! A curve over a range from its pieces.

use super::branch::branch_on;
use super::branches::with_others;
use super::course::Course;
use super::given::finish;
use crate::balance::forced::ForcedBalance;
use crate::balance::kept::keep_instead;
use crate::balance::solution::{CurveEnd, Point, Solution};
use crate::balance::tangent::distance;
use crate::timing::Profile;
use crate::Error;
use std::sync::Arc;
use std::time::Instant;

/// Distance of two motions at a seam that are the same.
const SAME: f64 = 1e-6;

/// A piece of a curve, and how it ended.
pub(crate) struct Piece {
    pub(crate) points: Vec<Arc<Point>>,
    pub(crate) end: CurveEnd,
    pub(crate) profile: Profile,
}

/// Joins pieces in which one motion alone is possible, up to where the analysis was ended. The last point of a
/// piece is the first of the next one.
pub(crate) fn join_smooth(
    mut balance: ForcedBalance<'_>,
    pieces: Vec<Piece>,
    start: Instant,
) -> Solution {
    let mut points: Vec<Arc<Point>> = Vec::new();
    let mut interrupted = false;
    for piece in pieces {
        balance.profile.add_whole(&piece.profile);
        if !interrupted {
            points.pop();
            points.extend(piece.points);
        }
        interrupted |= piece.end == CurveEnd::Interrupted;
    }
    keep_instead(balance.kept, &points);
    finish(balance, points, interrupted, start)
}

/// Joins pieces of a branch on which the frequency may turn back. A piece goes on from the one before if that
/// ends with the motion that it begins with, and comes back to it no more; else the branch is followed on from
/// there as a whole.
///
/// # Errors
/// As for a curve over a range.
pub(crate) fn join_branches(
    mut balance: ForcedBalance<'_>,
    course: &Course,
    pieces: Vec<Piece>,
    start: Instant,
) -> Result<Solution, Error> {
    let mut points: Vec<Arc<Point>> = Vec::new();
    let mut end = CurveEnd::Range;
    pieces.iter().for_each(|piece| balance.profile.add_whole(&piece.profile));
    let mut pieces = pieces.into_iter().peekable();
    while let Some(piece) = pieces.next() {
        let lost = matches!(piece.end, CurveEnd::Returned | CurveEnd::Stalled);
        let first = piece.points.first().cloned().filter(|_| lost && !points.is_empty());
        end = piece.end;
        if first.is_none() {
            points.extend(piece.points);
        }
        let next = pieces.peek().and_then(|next| next.points.first());
        let last = points.last().filter(|_| end == CurveEnd::Range);
        let on = match (next, last) {
            (Some(next), Some(last)) if !is_same(&mut balance, last, next)? => points.pop(),
            (Some(_), Some(_)) => {
                points.pop();
                continue;
            }
            _ => first,
        };
        keep_instead(balance.kept, &points);
        if let Some(on) = on {
            let (rest, last) = branch_on(&mut balance, course, on)?;
            points.extend(rest);
            end = last;
        }
        break;
    }
    points.iter().filter(|one| one.is_solved()).for_each(|one| balance.scale.include(one));
    with_others(balance, (points, end), course.range, start)
}

/// Whether the motion with which a piece ends is that with which the next one begins.
fn is_same(balance: &mut ForcedBalance<'_>, end: &Point, next: &Point) -> Result<bool, Error> {
    let resolution = next.resolution();
    let solved;
    let mut end = end;
    if end.resolution() != resolution {
        solved = balance.solve_with(resolution, next.omega, end.unknowns())?;
        end = &solved;
    }
    let (Some(x), Some(y)) = (end.unknowns().filter(|_| end.is_solved()), next.unknowns()) else {
        return Ok(false);
    };
    let [x, y] = [x, y].map(|one| {
        let mut z = one.values().to_vec();
        z.push(next.omega);
        z
    });
    Ok(x.len() == y.len() && distance(&x, &y) < SAME)
}
