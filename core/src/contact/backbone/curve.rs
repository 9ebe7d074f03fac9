//! Backbones of laws without sliders: the force of a contact that is loaded for the first time.
//!
//! A backbone is odd and concave. It is kept as a shape without units, `F = S φ(x)` with `x = k u/S`,
//! the stiffness k at rest and the force S that is never exceeded, so that φ'(0) = 1 and φ(∞) = 1. What
//! slip takes off the elastic force is `λ = x − φ`; it is computed without the cancellation of the two,
//! so that small motions keep their digits.

use super::loss::Loss;
use super::shear_layer::Layer;
use crate::fourier::{Lanes, NODES};
use crate::Error;

/// Rise of a table's slope, relative to it, that is rounding.
const CONCAVE: f64 = 1e-9;
/// Argument below which the series of the exponential is used.
const SERIES: f64 = 1.0;

/// Shape of a backbone.
#[derive(Debug, Clone, PartialEq)]
pub enum Backbone {
    /// `φ = 1 − exp(−x)`.
    Exponential,
    /// A bar on a layer of distributed friction, pulled at one end and free at the other (Menq, Bielak
    /// and Griffin 1986): `shear_lag` is λL, with `λ = √(k/EA)`.
    ShearLayer(Layer),
    /// The four-parameter model of Segalman (2005): a power law of slip limits and one limit that many
    /// elements share.
    Iwan {
        /// Exponent χ of the distribution, −1 < χ <= 0.
        chi: f64,
        /// Weight β of the common limit.
        beta: f64,
    },
    /// Points that straight lines join; the force stays at the last one.
    Table(Table),
}

/// A tabulated backbone in the units of its shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Displacements x, from zero on.
    x: Vec<f64>,
    /// The loss at each.
    loss: Vec<Loss>,
    /// Its slope behind each; 1 behind the last.
    slope: Vec<f64>,
}

impl Backbone {
    /// The shear layer.
    ///
    /// # Errors
    /// A shear lag that is not positive.
    pub fn shear_layer(shear_lag: f64) -> Result<Self, Error> {
        if !(shear_lag > 0.0 && shear_lag.is_finite()) {
            let remedy =
                "must be positive: sqrt(k/EA) L of the layer; a rigid bar is a Jenkins element";
            return Err(Error::value("masing: shear_lag", shear_lag, remedy));
        }
        Ok(Self::ShearLayer(Layer::new(shear_lag)))
    }

    /// Segalman's model.
    ///
    /// # Errors
    /// An exponent outside −1 < χ <= 0, a negative β.
    pub fn iwan(chi: f64, beta: f64) -> Result<Self, Error> {
        if !(chi > -1.0 && chi <= 0.0) {
            let remedy = "must be above -1 and at most 0: the loss per cycle grows with the amplitude to the power chi + 3";
            return Err(Error::value("iwan: chi", chi, remedy));
        }
        if !(beta >= 0.0 && beta.is_finite()) {
            let remedy = "must be finite and not negative; 0 is the smooth onset of gross slip";
            return Err(Error::value("iwan: beta", beta, remedy));
        }
        Ok(Self::Iwan { chi, beta })
    }

    /// A table of displacements \[m\] and forces \[N\], with its stiffness [N/m] and its largest force.
    ///
    /// # Errors
    /// Columns that differ in length or are empty, displacements that do not rise, a force that falls or
    /// rises more steeply than before.
    pub fn table(displacement: &[f64], force: &[f64]) -> Result<(Self, f64, f64), Error> {
        let fail = |row: usize, value: f64, remedy: &str| {
            Err(Error::value(format!("masing: backbone row {}", row + 1), value, remedy))
        };
        if displacement.len() != force.len() {
            let expected = format!("{} forces, one per displacement", displacement.len());
            return Err(Error::shape("masing: backbone", expected, force.len()));
        }
        let (mut u, mut f, mut steepest) = (vec![0.0], vec![0.0], f64::INFINITY);
        for (row, (&to, &reached)) in displacement.iter().zip(force).enumerate() {
            if row == 0 && to == 0.0 && reached == 0.0 {
                continue;
            }
            let (from, held) = (u[u.len() - 1], f[f.len() - 1]);
            if !(to.is_finite() && to > from) {
                return fail(row, to, "is not above the displacement before, which starts at 0; give rising displacements");
            }
            if !(reached.is_finite() && reached >= held) {
                return fail(
                    row,
                    reached,
                    "falls below the force before; give forces that do not fall",
                );
            }
            let slope = (reached - held) / (to - from);
            if slope > steepest * (1.0 + CONCAVE) {
                return fail(row, reached, "is reached more steeply than the row before; a backbone is concave, its slope never grows");
            }
            steepest = slope.min(steepest);
            u.push(to);
            f.push(reached);
        }
        let (Some(&most), true) = (f.last(), u.len() > 1) else {
            return Err(Error::shape("masing: backbone", "at least one row beyond zero", 0));
        };
        let stiffness = f[1] / u[1];
        if stiffness == 0.0 {
            return fail(0, f[1], "has no stiffness; give a force above zero");
        }
        let x: Vec<f64> = u.iter().map(|u| stiffness * u / most).collect();
        let (mut loss, mut slope) = (vec![Loss::default()], Vec::new());
        for i in 1..x.len() {
            let length = x[i] - x[i - 1];
            let own = (1.0 - (f[i] - f[i - 1]) / most / length).max(0.0);
            let own = if i == 1 { 0.0 } else { own };
            slope.push(own);
            loss.push(loss[i - 1].straight(own, length));
        }
        slope.push(1.0);
        Ok((Self::Table(Table { x, loss, slope }), stiffness, most))
    }

    /// The loss at a displacement x >= 0.
    pub(super) fn loss(&self, x: f64) -> Loss {
        match self {
            Self::Exponential => exponential(x),
            Self::ShearLayer(layer) => layer.loss(x),
            Self::Iwan { chi, beta } => iwan(*chi, *beta, x),
            Self::Table(table) => table.loss(x),
        }
    }

    /// Value and slope of the loss at many displacements.
    pub(super) fn losses(&self, x: &Lanes) -> [Lanes; 2] {
        if let Self::ShearLayer(layer) = self {
            return layer.losses(x);
        }
        let mut losses = [[0.0; NODES]; 2];
        for (i, x) in x.iter().enumerate() {
            let loss = self.loss(*x);
            (losses[0][i], losses[1][i]) = (loss.value, loss.slope);
        }
        losses
    }

    /// The loss by the formula that holds behind so many breaks, where that is no straight line: it goes on as
    /// far as it has a meaning.
    pub(super) fn loss_on(&self, piece: usize, x: f64) -> Loss {
        match self {
            Self::Iwan { chi, beta } if piece == 0 => {
                let share = x / gross_slip(*chi, *beta);
                power_loss(*chi, *beta, share)
            }
            _ => self.loss(x),
        }
    }

    /// Value at x = 0 and slope of the loss behind so many breaks, if it is a straight line there.
    pub(super) fn line(&self, piece: usize) -> Option<[f64; 2]> {
        match self {
            Self::ShearLayer(_) if piece == 0 => Some([0.0, 0.0]),
            Self::Table(table) => Some([table.at_rest(piece), table.slope[piece]]),
            Self::ShearLayer(_) if piece == 2 => Some([-1.0, 1.0]),
            Self::Iwan { .. } if piece == 1 => Some([-1.0, 1.0]),
            _ => None,
        }
    }

    /// Displacements x at which the shape is not analytic, ascending.
    pub(super) fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Exponential => Vec::new(),
            Self::ShearLayer(layer) => vec![layer.begin, layer.end],
            Self::Iwan { chi, beta } => vec![gross_slip(*chi, *beta)],
            Self::Table(table) => table.x[1..].to_vec(),
        }
    }

    /// Displacement x from which on all of the contact slips.
    pub(crate) fn end(&self) -> f64 {
        self.breaks().last().copied().unwrap_or(f64::INFINITY)
    }

    /// Exponent p of `λ' ~ x^p` about zero, where that is no analytic function of √x.
    pub(crate) fn root_at_rest(&self) -> Option<f64> {
        match self {
            Self::Iwan { chi, .. } if (2.0 * chi).fract() != 0.0 => Some(chi + 1.0),
            _ => None,
        }
    }

    /// Whether λ' has a square root before the last of its breaks.
    pub(crate) fn root_at_end(&self) -> bool {
        matches!(self, Self::ShearLayer(_))
    }

    /// Names and values of its numbers.
    pub(crate) fn numbers(&self) -> Vec<(&'static str, f64)> {
        match self {
            Self::ShearLayer(layer) => vec![("shear_lag", layer.lag)],
            Self::Iwan { chi, beta } => vec![("chi", *chi), ("beta", *beta)],
            Self::Exponential | Self::Table(_) => Vec::new(),
        }
    }

    /// The same shape with another value of one of its numbers.
    pub(crate) fn with_number(&self, index: usize, value: f64) -> Result<Self, Error> {
        match self {
            Self::ShearLayer(_) => Self::shear_layer(value),
            Self::Iwan { beta, .. } if index == 0 => Self::iwan(value, *beta),
            Self::Iwan { chi, .. } => Self::iwan(*chi, value),
            Self::Exponential | Self::Table(_) => Ok(self.clone()),
        }
    }

    /// Derivative of φ in one of its numbers.
    pub(super) fn by_number(&self, index: usize, x: f64) -> f64 {
        match self {
            Self::ShearLayer(layer) => layer.by_shear_lag(x),
            Self::Iwan { chi, beta } if x > 0.0 && x < gross_slip(*chi, *beta) => {
                let (chi, beta) = (*chi, *beta);
                let rest = beta * (chi + 2.0) + chi + 1.0;
                let loss = iwan(chi, beta, x).value;
                let relative = if index == 0 {
                    let end = 1.0 / (chi + 2.0) - (beta + 1.0) / rest;
                    (x / gross_slip(chi, beta)).ln() - (chi + 1.0) * end - 1.0 / (chi + 2.0)
                } else {
                    let end = 1.0 / (1.0 + beta) - (chi + 2.0) / rest;
                    -(chi + 1.0) * end - 1.0 / (1.0 + beta)
                };
                -loss * relative
            }
            _ => 0.0,
        }
    }
}

/// `x − 1 + e^{−x}` and what belongs to it.
fn exponential(x: f64) -> Loss {
    let slope = -(-x).exp_m1();
    if x >= SERIES {
        let value = x - slope;
        return Loss { integral: 0.5 * x * x - value, value, slope };
    }
    // Σ (−1)^n x^n/n! from n = 2 and from n = 3, which the differences above would lose.
    let tail =
        |first: i32| (first..first + 18).rev().fold(0.0, |sum, n| 1.0 - sum * x / f64::from(n + 1));
    let square = 0.5 * x * x;
    Loss { integral: square * x / 3.0 * tail(3), value: square * tail(2), slope }
}

/// `x_max = φ_max K_T/F_S`.
fn gross_slip(chi: f64, beta: f64) -> f64 {
    (1.0 + beta) * (chi + 2.0) / (beta * (chi + 2.0) + chi + 1.0)
}

/// `λ' = (x/x_max)^(χ+1)/(1 + β)` up to gross slip, 1 beyond.
fn iwan(chi: f64, beta: f64, x: f64) -> Loss {
    let end = gross_slip(chi, beta);
    let inner = power_loss(chi, beta, (x / end).min(1.0));
    if x < end {
        inner
    } else {
        inner.straight(1.0, x - end)
    }
}

/// What that is at a share of x_max by its power law.
fn power_loss(chi: f64, beta: f64, share: f64) -> Loss {
    let end = gross_slip(chi, beta);
    let slope = share.powf(chi + 1.0) / (1.0 + beta);
    let value = slope * share * end / (chi + 2.0);
    Loss { integral: value * share * end / (chi + 3.0), value, slope }
}

impl Table {
    fn loss(&self, x: f64) -> Loss {
        self.on_row(self.x.partition_point(|own| *own <= x).max(1) - 1, x)
    }

    /// What the straight line behind a row would be at x = 0.
    fn at_rest(&self, row: usize) -> f64 {
        self.loss[row].value - self.slope[row] * self.x[row]
    }

    fn on_row(&self, row: usize, x: f64) -> Loss {
        self.loss[row].straight(self.slope[row], x - self.x[row])
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn all() -> Vec<Backbone> {
        let rows = [0.1, 0.3, 0.7, 2.0];
        let forces = [1.0, 2.5, 4.0, 4.0];
        vec![
            Backbone::Exponential,
            Backbone::shear_layer(0.05).unwrap(),
            Backbone::shear_layer(3.0).unwrap(),
            Backbone::shear_layer(200.0).unwrap(),
            Backbone::iwan(-0.5, 0.0).unwrap(),
            Backbone::iwan(-0.97, 0.3).unwrap(),
            Backbone::iwan(0.0, 20.0).unwrap(),
            Backbone::table(&rows, &forces).unwrap().0,
        ]
    }

    #[test]
    fn value_and_slope_are_derivatives_of_the_integral() {
        for backbone in all() {
            let breaks = backbone.breaks();
            for x in [0.03, 0.2, 0.47, 0.9, 1.7, 5.1, 40.0, 2e4] {
                let h = 1e-4 * x;
                if breaks.iter().any(|own| (own - x).abs() < 3.0 * h) {
                    continue;
                }
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|n| backbone.loss(x + n * h));
                let slope =
                    |of: fn(Loss) -> f64| (8.0 * (of(c) - of(b)) - of(d) + of(a)) / (12.0 * h);
                let own = backbone.loss(x);
                assert!((slope(|l| l.integral) - own.value).abs() < 1e-9 * x, "{backbone:?} {x}");
                assert!((slope(|l| l.value) - own.slope).abs() < 1e-9, "{backbone:?} {x}");
                assert!(own.slope >= 0.0 && own.slope <= 1.0 && own.value <= x);
            }
            let far = backbone.loss(1e3 * backbone.end().min(100.0));
            assert!((far.slope - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn losses_of_tiny_motions_keep_their_digits() {
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-13 * b, "{a} {b}");
        for x in [1e-12, 1e-9, 1e-5] {
            let loss = Backbone::Exponential.loss(x);
            close(loss.value, 0.5 * x * x * (1.0 - x / 3.0 * (1.0 - x / 4.0)));
            close(loss.integral, x.powi(3) / 6.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0)));
        }
        let (below, above) = (exponential(1.0 - 1e-15), exponential(1.0));
        close(below.value, above.value);
        assert!((below.integral - above.integral).abs() <= 1e-14);
    }

    #[test]
    fn derivatives_in_the_numbers_are_those_of_differences() {
        for backbone in all() {
            for (index, (_, value)) in backbone.numbers().into_iter().enumerate() {
                let h = 1e-5 * if value == 0.0 { 1.0 } else { value.abs() };
                let side = |n: f64| backbone.with_number(index, value + n * h);
                let (Ok(low), Ok(high)) = (side(-1.0), side(1.0)) else { continue };
                for x in [0.03, 0.2, 0.47, 0.9, 1.7, 5.1, 40.0] {
                    if backbone.breaks().iter().any(|own| (own - x).abs() < 1e-3 * x) {
                        continue;
                    }
                    let slope = (low.loss(x).value - high.loss(x).value) / (2.0 * h);
                    let own = backbone.by_number(index, x);
                    assert!((slope - own).abs() < 1e-7, "{backbone:?} {x}: {slope} {own}");
                }
            }
        }
    }
}
