//! Tangents of the contacts in single precision.
//!
//! Rough directions leave some thousandths of a residual in any case: half as many bytes come from memory.

use super::slip_jacobian::{largest, Loads};

/// Sums of a scalar product that go through the processor side by side.
const SIDE_BY_SIDE: usize = 16;

/// The tangents of the active contacts, one after the other, in a unit.
pub(super) struct RoundedTangents {
    unit: f64,
    numbers: Vec<f32>,
    /// Coefficients of each of these contacts.
    sizes: Vec<usize>,
}

impl RoundedTangents {
    /// Of all contacts with a tangent.
    pub(super) fn new(of: Loads<'_>) -> Self {
        let active = || of.loads.iter().filter(|load| load.active);
        let sizes: Vec<usize> = active().map(|load| load.value.len()).collect();
        let mut rounded = Self { unit: 1.0, numbers: Vec::new(), sizes };
        rounded.numbers.reserve_exact(active().map(|load| load.tangent.len()).sum());
        let most = active().map(|load| largest(&load.tangent)).fold(0.0, f64::max);
        if most > 0.0 && most.is_finite() {
            rounded.unit = most;
        }
        let per = rounded.unit.recip();
        for load in active() {
            rounded.numbers.extend(load.tangent.iter().map(|entry| (entry * per) as f32));
        }
        rounded
    }

    /// `∂Q v` of these contacts.
    pub(super) fn times(&self, v: &[f64], out: &mut [f64]) {
        let most = largest(v);
        let unit = if most > 0.0 && most.is_finite() { most } else { 1.0 };
        let per = unit.recip();
        let v: Vec<f32> = v.iter().map(|v| (v * per) as f32).collect();
        pulp::Arch::new().dispatch(Product { of: self, unit: unit * self.unit, v: &v, out });
    }
}

/// A closure would be no part of what vector instructions are chosen for.
struct Product<'a> {
    of: &'a RoundedTangents,
    unit: f64,
    v: &'a [f32],
    out: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (mut first, mut numbers) = (0, &self.of.numbers[..]);
        for &size in &self.of.sizes {
            let (own, rest) = numbers.split_at(size * size);
            let v = &self.v[first..first + size];
            let out = self.out[first..first + size].iter_mut();
            for (row, out) in own.chunks_exact(size).zip(out) {
                *out = self.unit * f64::from(dot(row, v));
            }
            (first, numbers) = (first + size, rest);
        }
    }
}

#[inline(always)]
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let (mut a, mut b) = (a.chunks_exact(SIDE_BY_SIDE), b.chunks_exact(SIDE_BY_SIDE));
    let mut sums = [0.0; SIDE_BY_SIDE];
    for (a, b) in (&mut a).zip(&mut b) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    let rest = a.remainder().iter().zip(b.remainder());
    sums.iter_mut().zip(rest).for_each(|(sum, (a, b))| *sum += a * b);
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::SlipLoad;

    /// In any unit, also where squares would not be single numbers.
    #[test]
    fn products_are_those_of_the_tangents() {
        let number = |i: usize| (0.7 * i as f64).sin();
        for unit in [1.0, 1e-30, 1e30] {
            let load = |size: usize, active: bool| SlipLoad {
                value: vec![0.0; size],
                tangent: (0..size * size).map(|i| unit * number(i + size)).collect(),
                active,
                ..SlipLoad::default()
            };
            let loads = [load(33, true), load(7, false), load(11, true)];
            let points = [0..3, 3..4, 4..5];
            let of = RoundedTangents::new(Loads { loads: &loads, points: &points, slots: 11 });
            let v: Vec<f64> = (0..44).map(|i| 1e3 / unit * number(3 * i)).collect();
            let mut out = vec![0.0; 44];
            of.times(&v, &mut out);
            let mut first = 0;
            for load in [&loads[0], &loads[2]] {
                let size = load.value.len();
                for (row, out) in load.tangent.chunks_exact(size).zip(&out[first..]) {
                    let exact: f64 = row.iter().zip(&v[first..]).map(|(t, v)| t * v).sum();
                    assert!((out - exact).abs() < 1e-2, "{unit:e}: {out} {exact}");
                }
                first += size;
            }
        }
    }
}
