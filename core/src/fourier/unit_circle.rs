//! Sines and cosines of a turn.

use std::f64::consts::TAU;

/// Sines and cosines of an even number of angles, equally spaced over a turn.
pub(super) fn unit_circle(count: usize) -> Vec<(f64, f64)> {
    let step = TAU / count as f64;
    // A quarter of a turn later the sine is the cosine; after half a turn both change their signs.
    let quarters = count % 4 == 0;
    let own = if quarters { count / 4 } else { count / 2 };
    let mut unit: Vec<_> = (0..own).map(|i| (i as f64 * step).sin_cos()).collect();
    for i in own..count {
        let (sin, cos) = unit[i - own];
        unit.push(if quarters { (cos, -sin) } else { (-sin, -cos) });
    }
    unit
}
