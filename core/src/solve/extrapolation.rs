//! What comes next along a curve, by the points that came before.

/// Highest degree of an extrapolation.
const HIGHEST_DEGREE: usize = 3;
/// Points that it looks back on.
pub(crate) const LOOK_BACK: usize = HIGHEST_DEGREE + 2;
/// Longest way of an extrapolation by a straight line and of one by a parabola or cubic, in steps
/// like the last one: far beyond, nothing is predicted.
const REACH: [f64; 2] = [3.0, 1.5];

/// Polynomial extrapolation from parameters with their vectors, the last one first, of the degree that would have
/// predicted the last one best; the last one itself where the others are too far away.
pub(crate) fn extrapolated(known: &[(f64, Vec<f64>)], at: f64) -> Option<Vec<f64>> {
    let (own, last) = known.first()?;
    let ratio = known.get(1).map_or(f64::NAN, |(before, _)| ((at - own) / (own - before)).abs());
    // On a repeated parameter there is no line either.
    if !ratio.is_finite() || ratio > REACH[0] {
        return Some(last.clone());
    }
    let mut predicted = through(&known[..2], at);
    if ratio <= REACH[1] {
        let mut least = f64::INFINITY;
        for degree in 1..=HIGHEST_DEGREE.min(known.len().saturating_sub(2)) {
            let hindsight = through(&known[1..degree + 2], *own);
            let missed = hindsight.iter().zip(last).map(|(a, b)| (a - b).powi(2)).sum();
            let candidate = through(&known[..=degree], at);
            if missed < least && candidate.iter().all(|x| x.is_finite()) {
                (least, predicted) = (missed, candidate);
            }
        }
    }
    Some(predicted)
}

/// The polynomial through all of `known` at another parameter (Lagrange).
fn through(known: &[(f64, Vec<f64>)], at: f64) -> Vec<f64> {
    let mut values = vec![0.0; known.first().map_or(0, |(_, values)| values.len())];
    for (place, (own, part)) in known.iter().enumerate() {
        let others = known.iter().enumerate().filter(|(other, _)| *other != place);
        let weight: f64 = others.map(|(_, (w, _))| (at - w) / (own - w)).product();
        values.iter_mut().zip(part).for_each(|(x, p)| *x += weight * p);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known(of: impl Fn(f64) -> f64) -> Vec<(f64, Vec<f64>)> {
        [5.0, 4.0, 3.0, 2.0, 1.0].map(|at| (at, vec![of(at)])).to_vec()
    }

    #[test]
    fn smooth_curves_are_continued_and_kinks_are_not_swung_round() {
        let cubic = |x: f64| x * x * x - 2.0 * x;
        let next = extrapolated(&known(cubic), 6.0).unwrap();
        assert!((next[0] - cubic(6.0)).abs() < 1e-9, "{next:?}");
        // Behind a kink the line through the last two points is right; a cubic through all misses by 4.
        let kink = |x: f64| (x - 3.0).max(0.0);
        let next = extrapolated(&known(kink), 6.0).unwrap();
        assert!((next[0] - kink(6.0)).abs() < 1e-9, "{next:?}");
    }

    #[test]
    fn far_away_the_last_point_is_the_best() {
        let line = known(|x| 2.0 * x);
        assert_eq!(extrapolated(&line, 8.5).unwrap(), [10.0]);
        assert_eq!(extrapolated(&line[..1], 6.0).unwrap(), [10.0]);
        assert_eq!(extrapolated(&[line[0].clone(), line[0].clone()], 6.0).unwrap(), [10.0]);
        assert!(extrapolated(&[], 6.0).is_none());
    }
}
