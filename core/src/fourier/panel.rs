//! Gauss panels: integrals of smooth functions times the basis over an interval of angles.

use super::lanes::{cos_sin, doubled, rotate, sum, Lanes, NODES};
use super::legendre::{gauss_legendre, legendre};
use super::{Harmonics, IntervalSums};
use pulp::{Simd, WithSimd};
use std::sync::OnceLock;

/// Largest product of the highest harmonic and the length of a panel at which the rule integrates
/// products of two basis functions and a function that it resolves.
const LENGTH: f64 = 13.0;

/// The rule of Gauss and Legendre.
struct Rule {
    node: Lanes,
    weight: Lanes,
    /// Weights that give the last two coefficients of a function's Legendre series.
    tail: [Lanes; 2],
}

impl Rule {
    fn get() -> &'static Self {
        static RULE: OnceLock<Rule> = OnceLock::new();
        RULE.get_or_init(|| {
            let (mut node, mut weight) = ([0.0; NODES], [0.0; NODES]);
            let mut tail = [[0.0; NODES]; 2];
            for (i, (x, own)) in gauss_legendre(NODES).into_iter().enumerate() {
                (node[i], weight[i]) = (x, own);
                let p = legendre(NODES, x);
                for (tail, degree) in tail.iter_mut().zip([NODES - 2, NODES - 1]) {
                    tail[i] = own * p[degree] * (degree as f64 + 0.5);
                }
            }
            Self { node, weight, tail }
        })
    }
}

/// How a function behaves at an end of an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Root {
    /// Smooth at both.
    None,
    /// The interval is stretched by this power at its start.
    Start(i32),
    /// The same at its end.
    End(i32),
}

/// An interval of angles, or a part of it in the stretched variable.
#[derive(Debug, Clone, Copy)]
pub struct Interval {
    start: f64,
    end: f64,
    root: Root,
    /// Part of it, between 0 and 1.
    part: [f64; 2],
}

impl Interval {
    /// Cuts an interval so that panels resolve the harmonics. Functions may have a root at its start
    /// or its end, to be stretched by a power, or none where the power is 1.
    pub fn cut(
        harmonics: &Harmonics,
        [start, end]: [f64; 2],
        powers: [i32; 2],
        out: &mut Vec<Self>,
    ) {
        let most = LENGTH / harmonics.highest().max(4) as f64;
        let both = if powers.contains(&1) { 1.0 } else { 0.5 };
        let stretched = |power: i32| match power {
            1 => 0.0,
            power => (most / f64::from(power)).min(both * (end - start)),
        };
        let [first, last] = powers.map(stretched);
        let (from, to) = (start + first, end - last);
        let whole = |start: f64, end: f64, root: Root| Self { start, end, root, part: [0.0, 1.0] };
        if first > 0.0 {
            out.push(whole(start, from, Root::Start(powers[0])));
        }
        if last > 0.0 {
            out.push(whole(to, end, Root::End(powers[1])));
        }
        let count = ((to - from) / most).ceil();
        for n in 0..count as usize {
            let at = |n: usize| from + (to - from) * n as f64 / count;
            out.push(whole(at(n), at(n + 1), Root::None));
        }
    }

    /// Its length in the stretched variable, in units of the angle.
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.end - self.start) * (self.part[1] - self.part[0])
    }

    /// How far a product of two functions of the basis turns over half of it at most.
    #[must_use]
    pub fn phase(&self, harmonics: &Harmonics) -> f64 {
        let power = match self.root {
            Root::None => 1,
            Root::Start(power) | Root::End(power) => power,
        };
        harmonics.highest() as f64 * self.length() * f64::from(power)
    }

    /// Its two halves.
    #[must_use]
    pub fn halves(&self) -> [Self; 2] {
        let [low, high] = self.part;
        let middle = 0.5 * (low + high);
        [[low, middle], [middle, high]].map(|part| Self { part, ..*self })
    }
}

/// The basis at the nodes of an interval.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Weights `dθ`.
    pub weight: Lanes,
    /// What the variable is stretched by.
    stretch: Lanes,
    /// Cosine and sine of the angle from one harmonic to the next.
    step: [Lanes; 2],
    /// Cosines and sines of the harmonics k >= 1, in the order of the coefficients.
    basis: Vec<Lanes>,
}

impl Panel {
    /// Memory for a set of harmonics.
    #[must_use]
    pub fn new(harmonics: &Harmonics) -> Self {
        let zero = [0.0; NODES];
        let basis = vec![zero; 2 * harmonics.oscillating().len()];
        Self { weight: zero, stretch: zero, step: [zero; 2], basis }
    }

    /// Goes to an interval, and gives the values of a series there.
    pub fn place(&mut self, harmonics: &Harmonics, interval: &Interval, series: &[f64]) -> Lanes {
        pulp::Arch::new().dispatch(Placing { panel: self, harmonics, interval, series })
    }

    /// Adds `∫ f basis dθ`, with the weights in f.
    pub fn add_integrals(&self, harmonics: &Harmonics, weighted: &Lanes, out: &mut [f64]) {
        pulp::Arch::new().dispatch(Integrating { panel: self, harmonics, weighted, out });
    }

    /// Adds `∫ f cos mθ dθ` and `∫ f sin mθ dθ`, with the weights in f.
    pub fn add_products(&self, weighted: &Lanes, sums: &mut IntervalSums) {
        sums.add_lanes(&self.step, weighted);
    }

    /// Size of the last terms of the Legendre series of f in the stretched variable.
    #[must_use]
    pub fn tail(&self, f: &Lanes) -> f64 {
        let term = |tail: &Lanes| -> f64 {
            (0..NODES).map(|i| tail[i] * self.stretch[i] * f[i]).sum::<f64>().abs()
        };
        Rule::get().tail.iter().map(term).sum()
    }
}

/// A panel that goes to an interval.
struct Placing<'a> {
    panel: &'a mut Panel,
    harmonics: &'a Harmonics,
    interval: &'a Interval,
    series: &'a [f64],
}

impl WithSimd for Placing<'_> {
    type Output = Lanes;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Lanes {
        let Self { panel, harmonics, interval, series } = self;
        let rule = Rule::get();
        let [low, high] = interval.part;
        let length = interval.end - interval.start;
        let (from, power, sign) = match interval.root {
            Root::None => (interval.start, 1, 1.0),
            Root::Start(power) => (interval.start, power, 1.0),
            Root::End(power) => (interval.end, power, -1.0),
        };
        let [first, last] = if sign > 0.0 { [low, high] } else { [1.0 - low, 1.0 - high] };
        let (mut share, mut stretch) = ([0.0; NODES], [1.0; NODES]);
        (0..NODES).for_each(|i| share[i] = first + (last - first) * 0.5 * (1.0 + rule.node[i]));
        for _ in 1..power {
            (0..NODES).for_each(|i| stretch[i] *= share[i]);
        }
        // Angles from the middle of those that there are.
        let middle = 0.5 * length * (first.powi(power) + last.powi(power));
        let (sin_middle, cos_middle) = (from + sign * middle).sin_cos();
        let scale = 0.5 * (high - low) * length;
        let mut angle = [0.0; NODES];
        for i in 0..NODES {
            angle[i] = sign * (length * stretch[i] * share[i] - middle);
            panel.stretch[i] = f64::from(power) * stretch[i];
            panel.weight[i] = scale * rule.weight[i] * panel.stretch[i];
        }
        let [own_cos, own_sin] = cos_sin(&angle);
        let (mut cos, mut sin) = ([0.0; NODES], [0.0; NODES]);
        for i in 0..NODES {
            cos[i] = cos_middle * own_cos[i] - sin_middle * own_sin[i];
            sin[i] = sin_middle * own_cos[i] + cos_middle * own_sin[i];
        }
        panel.step = if harmonics.half_wave() { doubled(&cos, &sin) } else { [cos, sin] };
        let mut value = [harmonics.mean(series); NODES];
        let oscillating = series[harmonics.offset()..].chunks_exact(2);
        for (row, coefficients) in panel.basis.chunks_exact_mut(2).zip(oscillating) {
            for i in 0..NODES {
                value[i] += coefficients[0] * cos[i] + coefficients[1] * sin[i];
            }
            (row[0], row[1]) = (cos, sin);
            rotate(&mut cos, &mut sin, &panel.step);
        }
        value
    }
}

/// Integrals of a function times the basis.
struct Integrating<'a> {
    panel: &'a Panel,
    harmonics: &'a Harmonics,
    weighted: &'a Lanes,
    out: &'a mut [f64],
}

impl WithSimd for Integrating<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { panel, harmonics, weighted, out } = self;
        if harmonics.has_mean() {
            out[0] += sum(weighted);
        }
        for (row, out) in panel.basis.iter().zip(&mut out[harmonics.offset()..]) {
            *out += sum::<NODES>(&std::array::from_fn(|i| weighted[i] * row[i]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_integrates_polynomials_and_roots() {
        let harmonics = Harmonics::new(5, false);
        let mut panel = Panel::new(&harmonics);
        for (powers, exponent) in [([1, 1], 5.0), ([8, 1], 0.13), ([1, 2], 0.5)] {
            let mut intervals = Vec::new();
            Interval::cut(&harmonics, [0.3, 1.9], powers, &mut intervals);
            let (mut sum, mut length) = (0.0, 0.0);
            for interval in &intervals {
                panel.place(&harmonics, interval, &[0.0; 11]);
                for i in 0..NODES {
                    let theta = panel.step[1][i].atan2(panel.step[0][i]);
                    let from = if powers[1] > 1 { 1.9 - theta } else { theta - 0.3 };
                    sum += panel.weight[i] * from.max(0.0).powf(exponent);
                    length += panel.weight[i];
                }
            }
            let exact = 1.6_f64.powf(exponent + 1.0) / (exponent + 1.0);
            assert!((length - 1.6).abs() < 1e-13);
            assert!((sum - exact).abs() < 1e-10, "{powers:?}: {sum} {exact}");
        }
    }

    #[test]
    fn the_tail_tells_what_is_resolved() {
        let harmonics = Harmonics::new(5, true);
        let mut panel = Panel::new(&harmonics);
        let mut intervals = Vec::new();
        Interval::cut(&harmonics, [0.0, 2.0], [1, 1], &mut intervals);
        let sines = panel.place(&harmonics, &intervals[0], &[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        let (smooth, rough) = (sines.map(f64::exp), sines.map(|s| (s - 0.3).abs()));
        assert!(panel.tail(&smooth) < 1e-12 && panel.tail(&rough) > 1e-4);
    }
}
