//! Points of a sweep as they are solved, for one who does not wait for its end.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex};

/// Where a sweep puts its points as they are solved, for one who does not wait for its end.
pub type Kept<T> = Mutex<Vec<Arc<T>>>;

/// Puts a point where it is kept.
pub(crate) fn keep<T>(kept: Option<&Kept<T>>, point: &Arc<T>) {
    if let Some(Ok(mut points)) = kept.map(Mutex::lock) {
        points.push(Arc::clone(point));
    }
}

/// Takes back the point that was kept last, if it is this one.
pub(crate) fn take_back<T>(kept: Option<&Kept<T>>, point: &Arc<T>) {
    if let Some(Ok(mut points)) = kept.map(Mutex::lock) {
        if points.last().is_some_and(|last| Arc::ptr_eq(last, point)) {
            points.pop();
        }
    }
}

/// Keeps these points and no others.
pub(crate) fn keep_instead<T>(kept: Option<&Kept<T>>, points: &[Arc<T>]) {
    if let Some(Ok(mut kept)) = kept.map(Mutex::lock) {
        kept.clear();
        kept.extend_from_slice(points);
    }
}

/// Brings points that were kept as they were found into the order of the frequencies of their sweep; those of
/// one frequency, to which it may come back, stay in theirs.
fn in_order<T>(points: &mut [Arc<T>], order: &[f64], omega: impl Fn(&T) -> f64) {
    let mut places: HashMap<u64, VecDeque<usize>> = HashMap::new();
    for (place, own) in order.iter().enumerate() {
        places.entry(own.to_bits()).or_default().push_back(place);
    }
    let mut place_of = |point: &T| places.get_mut(&omega(point).to_bits())?.pop_front();
    // One after the other, as they were found: a sort may ask for its keys in any order.
    let placed = points.iter().map(|point| (place_of(point), Arc::clone(point)));
    let mut placed: Vec<(Option<usize>, Arc<T>)> = placed.collect();
    placed.sort_by_key(|(place, _)| place.unwrap_or(usize::MAX));
    points.iter_mut().zip(placed).for_each(|(to, (_, point))| *to = point);
}

/// As [`in_order`], without what lies behind the first frequency that is missing: a curve that was ended early
/// has no gap.
pub fn without_gap<T>(points: &mut Vec<Arc<T>>, order: &[f64], omega: impl Fn(&T) -> f64) {
    in_order(points, order, &omega);
    let both = points.iter().zip(order);
    points.truncate(both.take_while(|(point, own)| omega(point) == **own).count());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points with their frequency and the number under which they were found.
    fn ordered(found: &[f64], order: &[f64]) -> Vec<(f64, usize)> {
        let mut points: Vec<Arc<(f64, usize)>> =
            found.iter().enumerate().map(|(number, omega)| Arc::new((*omega, number))).collect();
        in_order(&mut points, order, |point| point.0);
        points.iter().map(|point| **point).collect()
    }

    #[test]
    fn a_sweep_up_and_down_that_is_given_up_keeps_its_order() {
        let order = [1.0, 2.0, 3.0, 2.0, 1.0];
        // As it goes: what was found last is on the way down, not beside its like on the way up.
        let found = ordered(&order[..4], &order);
        assert_eq!(found, [(1.0, 0), (2.0, 1), (3.0, 2), (2.0, 3)]);
        assert_eq!(ordered(&order, &order)[4], (1.0, 4));
    }

    #[test]
    fn pieces_that_were_found_side_by_side_are_joined() {
        let order = [4.0, 3.0, 2.0, 1.0, 2.0];
        let found = ordered(&[2.0, 4.0, 1.0, 3.0, 2.0], &order);
        assert_eq!(found, [(4.0, 1), (3.0, 3), (2.0, 0), (1.0, 2), (2.0, 4)]);
        // A piece behind a gap stays behind it.
        assert_eq!(ordered(&[1.0, 4.0], &order), [(4.0, 1), (1.0, 0)]);
    }

    #[test]
    fn what_lies_behind_a_gap_is_left_out() {
        let order = [4.0, 3.0, 2.0, 1.0];
        let mut points: Vec<Arc<f64>> = [1.0, 3.0, 4.0].into_iter().map(Arc::new).collect();
        without_gap(&mut points, &order, |omega| *omega);
        assert_eq!(points, [Arc::new(4.0), Arc::new(3.0)]);
    }
}
