//! Newton's equations in the slip loads.
//!
//! The Jacobian `1 − G ∂Q` of the contact displacements differs from the identity by `G ∂Q`, and
//! many rows of ∂Q vanish: the slip load of a contact that sticks does not depend on the motion, nor
//! does that of the normal direction as long as it stays closed. With the rows that are left,
//! `dQ = ∂Q dU` for `dU = r + G dQ` leaves
//!
//! ```text
//! (1 − ∂Q G) dQ = ∂Q r
//! ```
//!
//! in them alone: often half as many unknowns, and one more where the frequency is unknown, too. The
//! determinant is the same (Sylvester).

use super::ring::RingAnswers;
use crate::contact::SlipLoad;
use crate::fourier::Harmonics;
use crate::solve::parity;
use crate::structure::Receptance;
use faer::linalg::solvers::{PartialPivLu, SolveCore as _};
use faer::{Conj, Mat};
use std::ops::Range;

/// Numbers that are looked at together.
const LANES: usize = 8;

/// A point whose slip load depends on the motion.
struct Yielding {
    contact: usize,
    /// Its position in the contact.
    local: usize,
    /// Its position among all.
    point: usize,
    /// Largest slope of its slip load, which equations and unknowns are divided by [N/m].
    scale: f64,
}

/// Factors of `1 − ∂Q G`, or of that bordered.
pub(super) struct SlipJacobian {
    yielding: Vec<Yielding>,
    slots: usize,
    /// Of the transposed matrix, whose columns are its rows.
    factors: PartialPivLu<f64>,
}

/// What borders the equations where the frequency is unknown.
pub(super) struct Border<'a> {
    /// Negative derivative of the residual in the frequency.
    pub(super) rate: &'a [f64],
    /// A row over all contact displacements and the frequency.
    pub(super) row: &'a [f64],
    /// The frequency, which its change is compared with.
    pub(super) omega: f64,
}

/// The loads of all contacts with their points.
#[derive(Clone, Copy)]
pub(super) struct Loads<'a> {
    pub(super) loads: &'a [SlipLoad],
    pub(super) points: &'a [Range<usize>],
    pub(super) slots: usize,
}

impl<'a> Loads<'a> {
    /// The rows of ∂Q that belong to a point of a contact, one after the other.
    fn rows(self, contact: usize, local: usize) -> impl Iterator<Item = &'a [f64]> {
        let size = self.points[contact].len() * self.slots;
        let first = local * self.slots * size;
        self.loads[contact].tangent[first..first + self.slots * size].chunks_exact(size)
    }

    fn yielding(self) -> Vec<Yielding> {
        let active = (0..self.loads.len()).filter(|&contact| self.loads[contact].active);
        let all = active.flat_map(|contact| {
            self.points[contact].clone().enumerate().map(move |(local, point)| {
                let scale = self.rows(contact, local).map(largest).fold(0.0, larger);
                Yielding { contact, local, point, scale }
            })
        });
        // What is not a number has to come to light.
        all.filter(|one| one.scale != 0.0).collect()
    }

    /// The points that yield.
    pub(super) fn yielding_points(self) -> Vec<usize> {
        let active = (0..self.loads.len()).filter(|&contact| self.loads[contact].active);
        let all = active.flat_map(|contact| {
            let size = self.points[contact].len() * self.slots;
            let rows = self.loads[contact].tangent.chunks_exact(self.slots * size);
            self.points[contact].clone().zip(rows)
        });
        // What is not a number has to come to light.
        all.filter(|(_, rows)| rows.iter().any(|slope| *slope != 0.0)).map(|(i, _)| i).collect()
    }

    /// `∂Q x` at the points that yield, each divided by its scale.
    fn product(self, yielding: &[Yielding], x: &[f64], out: &mut [f64]) {
        for (one, out) in yielding.iter().zip(out.chunks_exact_mut(self.slots)) {
            let points = &self.points[one.contact];
            let own = &x[points.start * self.slots..points.end * self.slots];
            for (row, out) in self.rows(one.contact, one.local).zip(out) {
                *out = row.iter().zip(own).map(|(t, x)| t * x).sum::<f64>() / one.scale;
            }
        }
    }
}

/// The second number if it is larger, which it is not if it is none: a single instruction.
fn larger(most: f64, x: f64) -> f64 {
    if x > most {
        x
    } else {
        most
    }
}

/// Largest modulus of numbers: in lanes, as it is asked of whole tangents.
pub(super) fn largest(numbers: &[f64]) -> f64 {
    let mut most = [0.0_f64; LANES];
    let mut rest = numbers.chunks_exact(LANES);
    for lanes in rest.by_ref() {
        most.iter_mut().zip(lanes).for_each(|(most, x)| *most = larger(*most, x.abs()));
    }
    rest.remainder().iter().chain(&most).fold(0.0, |most, x| larger(most, x.abs()))
}

impl SlipJacobian {
    /// Assembles and factors the equations; nothing where ∂Q vanishes and nothing borders it.
    pub(super) fn new(of: Loads<'_>, answers: &Answers, border: Option<&Border<'_>>) -> Self {
        let (yielding, slots) = (of.yielding(), of.slots);
        let size = yielding.len() * slots;
        let total = size + usize::from(border.is_some());
        let mut transposed = Mat::<f64>::identity(total, total);
        for (r, one) in yielding.iter().enumerate() {
            let points = of.points[one.contact].clone();
            for (a, row) in of.rows(one.contact, one.local).enumerate() {
                let Some(out) = transposed.col_mut(r * slots + a).try_as_col_major_mut() else {
                    continue;
                };
                let out = out.as_slice_mut();
                for (other, out) in yielding.iter().zip(out.chunks_exact_mut(slots)) {
                    let factor = -other.scale / one.scale;
                    for (point, row) in points.clone().zip(row.chunks_exact(slots)) {
                        answers.add([point, other.point], row, factor, out);
                    }
                }
            }
        }
        if let Some(border) = border {
            let mut column = vec![0.0; size];
            of.product(&yielding, border.rate, &mut column);
            for (j, by) in column.iter().enumerate() {
                transposed[(size, j)] = -by * border.omega;
            }
            let row = &border.row[..border.rate.len()];
            let mut last = vec![0.0; size];
            for (other, out) in yielding.iter().zip(last.chunks_exact_mut(slots)) {
                for (point, row) in row.chunks_exact(slots).enumerate() {
                    answers.add([point, other.point], row, other.scale, out);
                }
            }
            let along: f64 = row.iter().zip(border.rate).map(|(b, r)| b * r).sum();
            last.push((border.row[row.len()] + along) * border.omega);
            last.into_iter().enumerate().for_each(|(i, entry)| transposed[(i, size)] = entry);
        }
        Self { yielding, slots, factors: transposed.partial_piv_lu() }
    }

    fn solve_in_place(&self, x: &mut [f64]) {
        if x.is_empty() {
            return;
        }
        let x = faer::MatMut::from_column_major_slice_mut(x, x.len(), 1);
        self.factors.solve_transpose_in_place_with_conj(Conj::No, x);
    }

    /// Adds slip loads to their places among all.
    fn spread(&self, scaled: &[f64], out: &mut [f64]) {
        for (one, q) in self.yielding.iter().zip(scaled.chunks_exact(self.slots)) {
            let own = &mut out[one.point * self.slots..(one.point + 1) * self.slots];
            own.iter_mut().zip(q).for_each(|(out, q)| *out = one.scale * q);
        }
    }

    /// `dU` of `(1 − G ∂Q) dU = r`; `add_response` adds G q.
    pub(super) fn solve(
        &self,
        of: Loads<'_>,
        add_response: impl FnOnce(&[f64], &mut [f64]),
        right: &[f64],
        step: &mut [f64],
    ) {
        let mut q = vec![0.0; self.yielding.len() * self.slots];
        of.product(&self.yielding, right, &mut q);
        self.solve_in_place(&mut q);
        let mut change = vec![0.0; right.len()];
        self.spread(&q, &mut change);
        step.copy_from_slice(right);
        add_response(&change, step);
    }

    /// `(dU, dω)` of the bordered equations, and the sign of their determinant. `right` holds their
    /// right-hand side, that of the border behind the others.
    pub(super) fn solve_bordered(
        &self,
        of: Loads<'_>,
        add_response: impl FnOnce(&[f64], &mut [f64]),
        border: &Border<'_>,
        right: &[f64],
    ) -> (Vec<f64>, f64) {
        let size = self.yielding.len() * self.slots;
        let count = border.rate.len();
        let mut x = vec![0.0; size + 1];
        of.product(&self.yielding, &right[..count], &mut x[..size]);
        let along: f64 = border.row.iter().zip(&right[..count]).map(|(b, r)| b * r).sum();
        x[size] = right[count] - along;
        self.solve_in_place(&mut x);
        let ahead = x[size] * border.omega;
        let mut change = vec![0.0; count];
        self.spread(&x[..size], &mut change);
        let mut step: Vec<f64> =
            right[..count].iter().zip(border.rate).map(|(r, rate)| r + ahead * rate).collect();
        add_response(&change, &mut step);
        step.push(ahead);
        let pivots = self.factors.U().diagonal().column_vector().iter().map(|p| p.signum());
        let sign = pivots.product::<f64>() * parity(self.factors.P().arrays().0);
        (step, sign)
    }
}

/// Receptances, pair of points after pair and order after order.
pub(super) struct Answers {
    /// Position of each point among those whose receptances are known.
    places: Vec<usize>,
    known: usize,
    has_mean: bool,
    orders: usize,
    /// Real and imaginary parts in turn.
    values: Vec<[f64; 2]>,
}

impl Answers {
    /// Of all points.
    pub(super) fn new(receptances: &[Receptance], harmonics: &Harmonics) -> Self {
        let pairs = receptances.first().map_or(0, |receptance| receptance.contact.len());
        let mut values = Vec::with_capacity(pairs * receptances.len());
        for pair in 0..pairs {
            values.extend(receptances.iter().map(|r| [r.contact[pair].re, r.contact[pair].im]));
        }
        let (known, orders) = (pairs.isqrt(), receptances.len());
        let places = (0..known).collect();
        Self { places, known, has_mean: harmonics.has_mean(), orders, values }
    }

    /// Of loads at some points.
    pub(super) fn of_part(
        receptances: &[Receptance],
        harmonics: &Harmonics,
        contacts: usize,
        points: &[usize],
    ) -> Self {
        let mut values = Vec::with_capacity(points.len().pow(2) * receptances.len());
        for source in 0..points.len() {
            for point in points {
                let answers = receptances.iter().map(|r| r.contact[source * contacts + point]);
                values.extend(answers.map(|g| [g.re, g.im]));
            }
        }
        let (known, orders) = (points.len(), receptances.len());
        let places = places(contacts, points);
        Self { places, known, has_mean: harmonics.has_mean(), orders, values }
    }

    /// Of some points of a ring, which were asked for.
    pub(super) fn of_ring(
        orders: &[RingAnswers],
        harmonics: &Harmonics,
        contacts: usize,
        points: &[usize],
    ) -> Self {
        let mut values = Vec::with_capacity(points.len().pow(2) * orders.len());
        for source in points {
            for point in points {
                let answer = orders.iter().map(|order| order.between(*point, *source));
                values.extend(answer.map(|g| [g.re, g.im]));
            }
        }
        let (known, orders) = (points.len(), orders.len());
        let places = places(contacts, points);
        Self { places, known, has_mean: harmonics.has_mean(), orders, values }
    }

    /// Adds `factor row G` for the displacement of the one point by a slip load at the other.
    fn add(&self, [point, source]: [usize; 2], row: &[f64], factor: f64, out: &mut [f64]) {
        let [point, source] = [point, source].map(|point| self.places[point]);
        let first = (source * self.known + point) * self.orders;
        let mut answers = &self.values[first..first + self.orders];
        let (mut row, mut out) = (row, out);
        if self.has_mean {
            out[0] += factor * answers[0][0] * row[0];
            (answers, row, out) = (&answers[1..], &row[1..], &mut out[1..]);
        }
        let pairs = row.chunks_exact(2).zip(out.chunks_exact_mut(2)).zip(answers);
        for ((t, out), [re, im]) in pairs {
            out[0] += factor * (t[0] * re - t[1] * im);
            out[1] += factor * (t[0] * im + t[1] * re);
        }
    }
}

/// Where some points of all are in their list.
fn places(contacts: usize, points: &[usize]) -> Vec<usize> {
    let mut places = vec![usize::MAX; contacts];
    points.iter().enumerate().for_each(|(place, point)| places[*point] = place);
    places
}
