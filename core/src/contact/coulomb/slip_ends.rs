//! Where slip in two directions begins and ends: the slider and the direction of the traction, with
//! their derivatives.

use super::plane::{March, Slider};
use super::slip::differentiated;

/// Angle to the end of slip up to which λ is a straight line.
const NEXT_TO: f64 = 1e-3;

impl March<'_> {
    /// The slider where the contact closes. It has followed until then.
    pub(super) fn closing(&self, theta: f64) -> Slider {
        let (pull, [_, growth]) = self.drive.at(theta);
        let width = self.width();
        let mut rate = vec![0.0; 2 * width];
        if self.coefficients {
            let slots = self.drive.harmonics().slots();
            let mut basis = vec![0.0; slots];
            self.drive.harmonics().basis(theta, &mut basis);
            for (i, rate) in rate.chunks_exact_mut(width).enumerate() {
                let by_limit = -pull[i][1] / (self.drive.friction * growth);
                for (j, b) in basis.iter().enumerate() {
                    rate[i * slots + j] = *b;
                    rate[2 * slots + j] = by_limit * b;
                }
            }
        }
        Slider { position: [pull[0][0], pull[1][0]], rate }
    }

    /// Direction of the traction where slip begins, with its derivative. The moving angle adds nothing
    /// to it: φ' and the direction of `K − s` turn equally fast there.
    pub(super) fn onset(&self, theta: f64, slider: &Slider, closes: bool) -> (f64, Vec<f64>) {
        let harmonics = self.drive.harmonics();
        let slots = harmonics.slots();
        let width = self.width();
        let (pull, [_, growth]) = self.drive.at(theta);
        let mut rate = vec![0.0; width];
        let (angle, size) = if closes {
            let speed = pull[0][1].hypot(pull[1][1]);
            (pull[1][1].atan2(pull[0][1]), speed)
        } else {
            let [x, y] = [0, 1].map(|i| pull[i][0] - slider.position[i]);
            (y.atan2(x), x.hypot(y))
        };
        let across = [-angle.sin(), angle.cos()];
        if !closes {
            let (x, y) = slider.rate.split_at(width);
            for (rate, (x, y)) in rate.iter_mut().zip(x.iter().zip(y)) {
                *rate = -(across[0] * x + across[1] * y) / size;
            }
        }
        if self.coefficients {
            let mut basis = vec![0.0; slots];
            harmonics.basis(theta, &mut basis);
            let mut by_limit = 0.0;
            let mut by_pull = basis.clone();
            if closes {
                // φ follows the direction of motion, from K'·e⊥ = M φ' = 0.
                differentiated(self.drive, &basis, &mut by_pull);
                let curvature = [0, 1].map(|i| harmonics.jet(self.drive.pull(i), theta)[2]);
                let turned = (across[0] * curvature[0] + across[1] * curvature[1]) / size;
                let growth = self.drive.friction * growth;
                by_limit = -turned / (growth + size);
            }
            for (j, by_pull) in by_pull.iter().enumerate() {
                rate[j] += across[0] * by_pull / size;
                rate[slots + j] += across[1] * by_pull / size;
            }
            if closes {
                for (j, b) in basis.iter().enumerate().take(self.drive.limit_columns()) {
                    rate[2 * slots + j] += by_limit * b;
                }
            }
        }
        (angle, rate)
    }

    /// The slider where slip ends: `s = K − M e`, stationary there.
    pub(super) fn leave(&self, theta: f64, angle: f64, rate: &[f64], slider: &mut Slider) {
        let harmonics = self.drive.harmonics();
        let slots = harmonics.slots();
        let (pull, [pressing, _]) = self.drive.at(theta);
        let limit = self.drive.friction * pressing;
        let (sin, cos) = angle.sin_cos();
        let (along, across) = ([cos, sin], [-sin, cos]);
        let width = self.width();
        let mut basis = vec![0.0; slots];
        harmonics.basis(theta, &mut basis);
        for (i, own) in slider.rate.chunks_exact_mut(width).enumerate() {
            slider.position[i] = pull[i][0] - limit * along[i];
            own.iter_mut().zip(rate).for_each(|(own, rate)| *own = -limit * across[i] * rate);
            if !self.coefficients {
                continue;
            }
            for (j, b) in basis.iter().enumerate() {
                own[i * slots + j] += b;
            }
            let varies = self.drive.pressing.is_some();
            for (j, b) in basis.iter().enumerate().take(self.drive.limit_columns()) {
                own[2 * slots + j] -= along[i] * if varies { *b } else { 1.0 };
            }
        }
    }

    /// Moves a slider from where its slip has been left to where λ vanishes, `λ/λ'` before. Along the
    /// way its derivative changes by that of λ: whatever little the panels miss the event by is an error
    /// of first order in the derivative, and of second order in the position.
    pub(super) fn stop(&self, theta: f64, angle: f64, rate: &[f64], slider: &mut Slider) {
        let harmonics = self.drive.harmonics();
        let slots = harmonics.slots();
        let (sin, cos) = angle.sin_cos();
        let [x, y] = [0, 1].map(|i| harmonics.jet(self.drive.pull(i), theta));
        let limit = self.drive.limit();
        let limit =
            if limit.len() > 1 { harmonics.jet(&limit, theta) } else { [limit[0], 0.0, 0.0] };
        let slip_rate = x[1] * cos + y[1] * sin - limit[1];
        let across = y[1] * cos - x[1] * sin;
        let slope = x[2] * cos + y[2] * sin - limit[2] + across * across / limit[0];
        let beyond = slip_rate / slope;
        if slope >= 0.0 || beyond.abs() > NEXT_TO {
            return;
        }
        // The derivative of λ.
        let mut by: Vec<f64> = rate.iter().map(|rate| across * rate).collect();
        if self.coefficients {
            let (mut basis, mut turned) = (vec![0.0; slots], vec![0.0; slots]);
            harmonics.basis(theta, &mut basis);
            differentiated(self.drive, &basis, &mut turned);
            let varies = self.drive.pressing.is_some();
            for (j, turned) in turned.iter().enumerate() {
                by[j] += cos * turned;
                by[slots + j] += sin * turned;
                if varies {
                    by[2 * slots + j] -= turned;
                }
            }
        }
        let rows = slider.rate.chunks_exact_mut(rate.len());
        for ((along, row), position) in [cos, sin].into_iter().zip(rows).zip(&mut slider.position) {
            *position -= 0.5 * beyond * slip_rate * along;
            row.iter_mut().zip(&by).for_each(|(own, by)| *own -= beyond * along * by);
        }
    }
}
