//! The maximum of a curve of which nothing but values is known.

use super::vertex;
use crate::Error;

/// Width of the final bracket relative to the frequency; the amplitude is stationary there, so
/// that its own error is of second order in it.
const TOLERANCE: f64 = 1e-8;
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// The maximum of a height over a frequency between two others, by Brent's method: golden section and parabolas.
pub(crate) fn brent(
    mut low: f64,
    guess: f64,
    mut high: f64,
    height: &mut impl FnMut(f64) -> Result<f64, Error>,
) -> Result<(f64, f64), Error> {
    let value = height(guess)?;
    let (mut best, mut second, mut third) = ((guess, value), (guess, value), (guess, value));
    let (mut step, mut before_last) = (0.0_f64, 0.0_f64);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let resolution = TOLERANCE * best.0;
        if (best.0 - middle).abs() + 0.5 * (high - low) <= 2.0 * resolution {
            break;
        }
        let parabola = vertex([second, best, third]);
        let accepted = parabola
            .filter(|&p| p > low && p < high && (p - best.0).abs() < 0.5 * before_last.abs());
        before_last = step;
        step = match accepted {
            Some(p) => p - best.0,
            None => {
                let room = if best.0 < middle { high - best.0 } else { low - best.0 };
                before_last = room;
                GOLDEN * room
            }
        };
        let shift = if step.abs() >= resolution { step } else { resolution.copysign(step) };
        let omega = (best.0 + shift).clamp(low, high);
        let trial = (omega, height(omega)?);
        if trial.1 >= best.1 {
            if omega >= best.0 {
                low = best.0
            } else {
                high = best.0
            }
            (third, second, best) = (second, best, trial);
        } else {
            if omega < best.0 {
                low = omega
            } else {
                high = omega
            }
            if trial.1 >= second.1 || second.0 == best.0 {
                (third, second) = (second, trial);
            } else if trial.1 >= third.1 || third.0 == best.0 || third.0 == second.0 {
                third = trial;
            }
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_and_a_kinked_maximum_are_found() {
        let mut smooth = |x: f64| Ok(-(x - 1.3_f64).powi(2) + (x - 1.3).powi(3));
        let (x, _) = brent(1.0, 1.1, 1.8, &mut smooth).unwrap();
        assert!((x - 1.3).abs() < 1e-7);
        let mut kinked = |x: f64| Ok(-(x - 1.3_f64).abs());
        let (x, _) = brent(1.0, 1.6, 1.8, &mut kinked).unwrap();
        assert!((x - 1.3).abs() < 1e-7);
        let mut rising = |x: f64| Ok(x);
        let (x, _) = brent(1.0, 1.0, 1.8, &mut rising).unwrap();
        assert!((x - 1.8).abs() < 1e-6);
    }
}
