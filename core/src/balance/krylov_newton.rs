//! Newton directions of many contacts without a matrix: GMRES with `v − G ∂Q v` as a product.
//!
//! The tangents of the slip loads are known contact by contact, and G is two real matrix products
//! with the modes. On the stuck base the operator is the identity but for what slips: the number of
//! products hardly depends on the number of contacts. Points are scaled by the size of their motion,
//! as the error of the solution is judged.

use super::rounded_tangents::RoundedTangents;
use super::slip_jacobian::{Border, Loads};
use crate::contact::SlipLoad;
use crate::solve::{dot, gmres, norm, KrylovSettings};
use crate::structure::{Compliance, ContactCoordinates, ContactShapes, ModalOrders, QuasiStatic};
use faer::{Mat, MatRef};

/// What a direction may leave of the residual: Newton's method takes it from there.
const FORCING: f64 = 1e-3;
/// The same of equations whose direction nothing corrects.
const FINE: f64 = 1e-11;
/// The same of equations whose frequency is unknown: tangents follow from them, too.
const BORDERED: f64 = 1e-5;
/// Products after which a direction is taken as it is, …
pub(super) const MOST_PRODUCTS: usize = 400;
/// … if it leaves no more than this.
const USEFUL: f64 = 0.5;
/// Tolerance of what damping couples within a product, against that of the whole.
const WITHIN: f64 = 1e-2;

/// What a product with `I − G ∂Q` is made of.
#[derive(Clone, Copy)]
pub(super) struct Products<'a> {
    pub(super) modes: &'a dyn ContactCoordinates,
    pub(super) orders: &'a ModalOrders,
    pub(super) loads: Loads<'a>,
    /// Sizes of the motion of all points.
    pub(super) sizes: &'a [f64],
    /// Whether nothing corrects the direction.
    pub(super) fine: bool,
    /// Products after which a direction is taken as it is.
    pub(super) most: usize,
    pub(super) interrupted: Option<&'a dyn Fn() -> bool>,
}

/// The contacts that slip.
pub(super) struct KrylovNewton {
    points: Vec<usize>,
    answers: Answers,
    /// Their tangents, where rough answers are enough.
    rounded: Option<RoundedTangents>,
}

/// What answers the loads on them.
enum Answers {
    /// All modes, by Ψ of the points.
    Whole(ContactShapes),
    /// The slowest ones, and the flexibility of the others.
    Rough(QuasiStatic),
}

impl Answers {
    /// Displacements of the points by loads on them; `tolerance` is that of what damping couples.
    fn of_points(&self, of: Products<'_>, load: MatRef<'_, f64>, tolerance: f64) -> Mat<f64> {
        match self {
            Self::Rough(rough) => rough.answer(of.orders, load),
            Self::Whole(shapes) => {
                let mut motion = shapes.excite(load);
                of.modes.answer(of.orders, &mut motion, tolerance);
                shapes.displace(motion.as_ref())
            }
        }
    }

    /// The same of all points there are.
    fn of_all(
        &self,
        of: Products<'_>,
        points: &[usize],
        load: MatRef<'_, f64>,
        tolerance: f64,
    ) -> Mat<f64> {
        let mut motion = match self {
            Self::Whole(shapes) => shapes.excite(load),
            Self::Rough(_) => {
                let mut whole = Mat::zeros(load.nrows(), of.modes.contacts());
                for (own, &point) in load.col_iter().zip(points) {
                    whole.col_mut(point).copy_from(own);
                }
                if let Some(rough) = of.modes.quasi_static(of.orders) {
                    return rough.answer(of.orders, whole.as_ref());
                }
                of.modes.excite(whole.as_ref())
            }
        };
        of.modes.answer(of.orders, &mut motion, tolerance);
        of.modes.displace(motion.as_ref())
    }
}

impl KrylovNewton {
    /// Of the points of contacts with a tangent, and those of them that yield; with the harmonics in `rough`,
    /// fast modes follow their loads at once: directions are corrected by what follows them.
    pub(super) fn new(
        compliance: &dyn Compliance,
        [active, yielding]: [&[usize]; 2],
        loads: Loads<'_>,
        rough: Option<&ModalOrders>,
    ) -> Self {
        let points = active.to_vec();
        let Some(modes) = compliance.contact_modes() else {
            let answers = Answers::Whole(ContactShapes::default());
            return Self { points, answers, rounded: None };
        };
        let answers = match rough.and_then(|orders| modes.quasi_static(orders)) {
            Some(rough) => {
                let places = yielding.iter().filter_map(|point| active.binary_search(point).ok());
                Answers::Rough(rough.part(active, places.collect()))
            }
            None => Answers::Whole(modes.part(active)),
        };
        let is_rough = matches!(answers, Answers::Rough(_));
        let rounded = is_rough.then(|| RoundedTangents::new(loads));
        Self { points, answers, rounded }
    }

    /// Newton's direction, and the number of products that it took; nothing if there is none, or the
    /// caller ends the analysis.
    pub(super) fn solve(
        &self,
        products: Products<'_>,
        rhs: &[f64],
        step: &mut [f64],
    ) -> Option<usize> {
        let Products { loads: Loads { slots, .. }, .. } = products;
        let tolerance = if products.fine { FINE } else { FORCING };
        let mut load = vec![0.0; self.points.len() * slots];
        let sizes: Vec<f64> = self.points.iter().map(|&point| products.sizes[point]).collect();
        let scaled = |values: &mut [f64], scale: &dyn Fn(f64) -> f64| {
            for (own, size) in values.chunks_exact_mut(slots).zip(&sizes) {
                own.iter_mut().for_each(|value| *value *= scale(*size));
            }
        };
        let mut right = self.of_points(rhs, slots);
        scaled(&mut right, &|size| 1.0 / size);
        let mut moved = vec![0.0; right.len()];
        let product = |v: &[f64], out: &mut [f64]| {
            moved.copy_from_slice(v);
            scaled(&mut moved, &|size| size);
            let load = self.loaded(products.loads, &moved, &mut load);
            let motion = self.answers.of_points(products, load, WITHIN * tolerance);
            for (out, own) in out.chunks_exact_mut(slots).zip(motion.col_iter()) {
                out.iter_mut().zip(own.iter()).for_each(|(out, u)| *out = *u);
            }
            scaled(out, &|size| 1.0 / size);
            out.iter_mut().zip(v).for_each(|(out, v)| *out = v - *out);
            !products.interrupted.is_some_and(|ask| ask())
        };
        let mut solution = vec![0.0; right.len()];
        let settings = KrylovSettings { tolerance, max_products: products.most };
        let report = gmres(product, &right, &mut solution, settings);
        // What the caller has ended is not a number.
        if report.residual.is_nan() || report.residual > USEFUL {
            return None;
        }
        scaled(&mut solution, &|size| size);
        // The others follow from step = rhs + G ∂Q step.
        step.copy_from_slice(rhs);
        if self.points.len() * slots < step.len() {
            let load = self.loaded(products.loads, &solution, &mut load);
            let motion = self.answers.of_all(products, &self.points, load, WITHIN * tolerance);
            for (step, own) in step.chunks_exact_mut(slots).zip(motion.col_iter()) {
                step.iter_mut().zip(own.iter()).for_each(|(step, u)| *step += u);
            }
        }
        for (own, &point) in solution.chunks_exact(slots).zip(&self.points) {
            step[point * slots..(point + 1) * slots].copy_from_slice(own);
        }
        Some(report.products)
    }

    /// `(dU, dω)` of the equations with an unknown frequency, `J dU − R' dω = r` and one row more,
    /// and the number of products that they took; nothing if there is none, or the caller ends the
    /// analysis. Columns and the row have the size of one there.
    pub(super) fn solve_bordered(
        &self,
        products: Products<'_>,
        border: &Border<'_>,
        right: &[f64],
    ) -> Option<(Vec<f64>, usize)> {
        let Products { loads: Loads { slots, .. }, .. } = products;
        let count = border.rate.len();
        let (size, mut load) = (self.points.len() * slots, vec![0.0; self.points.len() * slots]);
        let sizes = self.points.iter().flat_map(|&point| vec![products.sizes[point]; slots]);
        let sizes: Vec<f64> = sizes.collect();
        let divided = |values: Vec<f64>| -> Vec<f64> {
            values.iter().zip(&sizes).map(|(value, size)| value / size).collect()
        };
        // What does not depend on the motion follows from what does: dU = r + R' dω + G ∂Q dU.
        let mut rest = border.row[..count].to_vec();
        self.points.iter().for_each(|point| rest[point * slots..(point + 1) * slots].fill(0.0));
        let mut column = divided(self.of_points(border.rate, slots));
        let unit = norm(&column).recip().min(border.omega);
        column.iter_mut().for_each(|c| *c *= unit);
        let mut row: Vec<f64> = self.of_points(&border.row[..count], slots);
        row.iter_mut().zip(&sizes).for_each(|(row, size)| *row *= size);
        row.push((border.row[count] + dot(&rest, border.rate)) * unit);
        let weight = norm(&row).recip();
        let mut rhs = divided(self.of_points(&right[..count], slots));
        rhs.push(weight * (right[count] - dot(&rest, &right[..count])));
        let mut moved = vec![0.0; size];
        let product = |v: &[f64], out: &mut [f64]| {
            moved.iter_mut().zip(v).zip(&sizes).for_each(|((m, v), size)| *m = v * size);
            let load = self.loaded(products.loads, &moved, &mut load);
            let answer = self.answers.of_all(products, &self.points, load, WITHIN * BORDERED);
            let answer = series(&answer);
            let own = divided(self.of_points(&answer, slots));
            let ahead = v[size];
            for (((out, v), own), c) in out.iter_mut().zip(&v[..size]).zip(own).zip(&column) {
                *out = v - own - c * ahead;
            }
            out[size] = weight * (dot(&row, v) + dot(&rest, &answer));
            !products.interrupted.is_some_and(|ask| ask())
        };
        let mut solution = vec![0.0; size + 1];
        let settings = KrylovSettings { tolerance: BORDERED, max_products: products.most };
        let report = gmres(product, &rhs, &mut solution, settings);
        if report.residual.is_nan() || report.residual > USEFUL {
            return None;
        }
        let ahead = solution[size] * unit;
        solution.iter_mut().zip(&sizes).for_each(|(x, size)| *x *= size);
        let load = self.loaded(products.loads, &solution[..size], &mut load);
        let answer = self.answers.of_all(products, &self.points, load, WITHIN * BORDERED);
        let answer = series(&answer);
        let linear = right[..count].iter().zip(border.rate).map(|(r, rate)| r + ahead * rate);
        let mut step: Vec<f64> =
            linear.zip(answer).map(|(linear, answer)| linear + answer).collect();
        for (own, &point) in solution.chunks_exact(slots).zip(&self.points) {
            step[point * slots..(point + 1) * slots].copy_from_slice(own);
        }
        step.push(ahead);
        Some((step, report.products))
    }

    /// The series of the active points among those of all.
    fn of_points(&self, all: &[f64], slots: usize) -> Vec<f64> {
        self.points
            .iter()
            .flat_map(|point| &all[point * slots..(point + 1) * slots])
            .copied()
            .collect()
    }

    /// `∂Q v` of the active points, slots × points, in the room for it.
    fn loaded<'b>(&self, loads: Loads<'_>, v: &[f64], out: &'b mut [f64]) -> MatRef<'b, f64> {
        match &self.rounded {
            Some(rounded) => rounded.times(v, out),
            None => {
                pulp::Arch::new().dispatch(Product { loads: loads.loads, v, out: &mut *out });
            }
        }
        MatRef::from_column_major_slice(out, loads.slots, self.points.len())
    }
}

/// `∂Q v` of the active contacts. A closure would be no part of what vector instructions are chosen for.
struct Product<'a> {
    loads: &'a [SlipLoad],
    v: &'a [f64],
    out: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let mut first = 0;
        for load in self.loads.iter().filter(|load| load.active) {
            let size = load.value.len();
            let rows = load.tangent.chunks_exact(size).zip(&mut self.out[first..first + size]);
            for (row, out) in rows {
                *out = dot(row, &self.v[first..first + size]);
            }
            first += size;
        }
    }
}

/// Series of all points, one after the other.
fn series(motion: &Mat<f64>) -> Vec<f64> {
    motion.col_iter().flat_map(|column| column.iter().copied()).collect()
}
