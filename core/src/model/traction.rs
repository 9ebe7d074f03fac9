//! What a traction that is free to turn in a plane does to a motion.

use faer::c64;
use std::f64::consts::PI;

/// Directions in time over which the largest traction is integrated.
const DIRECTIONS: usize = 256;
/// Lines that stand for a traction, to a part in a hundred.
const LINES: usize = 16;

/// What a traction of length one, free to turn, does at most at one harmonic, over what a square wave of the
/// same length does: `¼ ∫ |Re(e z)| dθ` over the turns z of the two effects e.
pub(super) fn most_of_a_traction(effects: [c64; 2]) -> f64 {
    let length = |n: usize| {
        let (sin, cos) = ((n as f64 + 0.5) * PI / DIRECTIONS as f64).sin_cos();
        let [a, b] = effects.map(|e| e.re * cos - e.im * sin);
        a.hypot(b)
    };
    0.5 * PI / DIRECTIONS as f64 * (0..DIRECTIONS).map(length).sum::<f64>()
}

/// Forces along lines that together do what a traction of length one does, for any two effects: each the share of
/// the two components and its largest size. `|x| = ¼ ∫ |x·n| dφ` over all directions n of the plane.
pub(super) fn lines_of_a_traction() -> impl Iterator<Item = ([f64; 2], f64)> {
    (0..LINES).map(|n| {
        let (sin, cos) = ((n as f64 + 0.5) * PI / LINES as f64).sin_cos();
        ([cos, sin], 0.5 * PI / LINES as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_traction_does_most_along_its_line_or_turning_with_its_load() {
        let along = most_of_a_traction([c64::new(3.0, 0.0), c64::new(0.0, 0.0)]);
        assert!((along - 3.0).abs() < 1e-4);
        let oblique = most_of_a_traction([c64::new(0.0, 3.0), c64::new(0.0, 4.0)]);
        assert!((oblique - 5.0).abs() < 1e-4);
        // In phase with a load that turns it does all that it can: 2 of a force of length one.
        let turning = most_of_a_traction([c64::new(1.0, 0.0), c64::new(0.0, 1.0)]);
        assert!((4.0 / PI * turning - 2.0).abs() < 1e-12);
    }

    #[test]
    fn lines_do_what_a_traction_does() {
        for effects in
            [[(1.0, 0.0), (0.0, 1.0)], [(3.0, 0.0), (0.0, 0.0)], [(1.0, 2.0), (-0.3, 1.0)]]
        {
            let [a, b] = effects.map(|(re, im)| c64::new(re, im));
            let whole = most_of_a_traction([a, b]);
            let lines = lines_of_a_traction().map(|([x, y], most)| (a * x + b * y).norm() * most);
            assert!((lines.sum::<f64>() - whole).abs() < 1e-2 * whole);
        }
    }
}
