//! Numbers for tests that look random and are the same everywhere.

/// A number from −0.5 to 0.5.
pub(crate) fn random(seed: usize) -> f64 {
    let x = (seed as f64 * 12.9898 + 4.1).sin() * 43758.5453;
    x - x.floor() - 0.5
}

/// Numbers from −1 to 1, one after the other.
pub(crate) fn numbers() -> impl FnMut() -> f64 {
    let mut drawn = 0;
    move || {
        drawn += 1;
        2.0 * random(drawn)
    }
}
