//! Newton directions of many contacts without a matrix: GMRES with `v − G ∂Q v` as a product.
//!
//! The tangents of the slip loads are known contact by contact, and G is two real matrix products
//! with the modes. On the stuck base the operator is the identity but for what slips: the number of
//! products hardly depends on the number of contacts. Points are scaled by the size of their motion,
//! as the error of the solution is judged.

use super::slip_jacobian::Loads;
use crate::solve::{gmres, KrylovSettings};
use crate::structure::{Compliance, ContactModes, ModalOrders};
use faer::{Mat, MatRef};

/// What a direction may leave of the residual: Newton's method takes it from there.
const FORCING: f64 = 1e-3;
/// The same of equations whose direction nothing corrects.
const FINE: f64 = 1e-11;
/// Products after which a direction is taken as it is, …
const MOST_PRODUCTS: usize = 400;
/// … if it leaves no more than this.
const USEFUL: f64 = 0.5;
/// Tolerance of what damping couples within a product, against that of the whole.
const WITHIN: f64 = 1e-2;

/// What a product with `I − G ∂Q` is made of.
#[derive(Clone, Copy)]
pub(super) struct Products<'a> {
    pub(super) modes: &'a ContactModes,
    pub(super) orders: &'a ModalOrders,
    pub(super) loads: Loads<'a>,
    /// Sizes of the motion of all points.
    pub(super) sizes: &'a [f64],
    /// Whether nothing corrects the direction.
    pub(super) fine: bool,
    pub(super) interrupted: Option<&'a dyn Fn() -> bool>,
}

/// The contacts that slip.
pub(super) struct KrylovNewton {
    points: Vec<usize>,
    /// Ψᵀ of them, modes × points.
    shapes: Mat<f64>,
}

impl KrylovNewton {
    /// Of the points of contacts with a tangent.
    pub(super) fn new(compliance: &dyn Compliance, active: &[usize]) -> Self {
        let shapes = compliance.contact_modes().map_or_else(Mat::new, |modes| {
            let all = modes.contacts();
            let mut shapes = Mat::zeros(all.nrows(), active.len());
            for (mut own, &point) in shapes.col_iter_mut().zip(active) {
                own.copy_from(all.col(point));
            }
            shapes
        });
        Self { points: active.to_vec(), shapes }
    }

    /// Newton's direction, and the number of products that it took; nothing if there is none, or the
    /// caller ends the analysis.
    pub(super) fn solve(
        &self,
        products: Products<'_>,
        rhs: &[f64],
        step: &mut [f64],
    ) -> Option<usize> {
        let Products { modes, orders, loads: Loads { slots, .. }, .. } = products;
        let tolerance = if products.fine { FINE } else { FORCING };
        let mut load = vec![0.0; self.points.len() * slots];
        // Modal coordinates of the motion that the tangents answer a step of the active points with.
        let mut answered = |v: &[f64], tolerance: f64| -> Mat<f64> {
            load.fill(0.0);
            self.add_tangents(products.loads, v, &mut load);
            let load = MatRef::from_column_major_slice(&load, slots, self.points.len());
            let mut motion = ContactModes::excite(self.shapes.as_ref(), load);
            modes.answer(orders, &mut motion, tolerance);
            motion
        };
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
            let motion = answered(&moved, WITHIN * tolerance);
            let motion = ContactModes::displace(self.shapes.as_ref(), motion.as_ref());
            for (out, own) in out.chunks_exact_mut(slots).zip(motion.col_iter()) {
                out.iter_mut().zip(own.iter()).for_each(|(out, u)| *out = *u);
            }
            scaled(out, &|size| 1.0 / size);
            out.iter_mut().zip(v).for_each(|(out, v)| *out = v - *out);
            !products.interrupted.is_some_and(|ask| ask())
        };
        let mut solution = vec![0.0; right.len()];
        let settings = KrylovSettings { tolerance, max_products: MOST_PRODUCTS };
        let report = gmres(product, &right, &mut solution, settings);
        // What the caller has ended is not a number.
        if report.residual.is_nan() || report.residual > USEFUL {
            return None;
        }
        scaled(&mut solution, &|size| size);
        // The others follow from step = rhs + G ∂Q step.
        step.copy_from_slice(rhs);
        if self.points.len() * slots < step.len() {
            let motion = answered(&solution, WITHIN * tolerance);
            let motion = ContactModes::displace(modes.contacts(), motion.as_ref());
            for (step, own) in step.chunks_exact_mut(slots).zip(motion.col_iter()) {
                step.iter_mut().zip(own.iter()).for_each(|(step, u)| *step += u);
            }
        }
        for (own, &point) in solution.chunks_exact(slots).zip(&self.points) {
            step[point * slots..(point + 1) * slots].copy_from_slice(own);
        }
        Some(report.products)
    }

    /// The series of the active points among those of all.
    fn of_points(&self, all: &[f64], slots: usize) -> Vec<f64> {
        self.points
            .iter()
            .flat_map(|point| &all[point * slots..(point + 1) * slots])
            .copied()
            .collect()
    }

    /// `out += ∂Q v` of the active points.
    fn add_tangents(&self, loads: Loads<'_>, v: &[f64], out: &mut [f64]) {
        let mut first = 0;
        for load in loads.loads.iter().filter(|load| load.active) {
            let size = load.value.len();
            let rows = load.tangent.chunks_exact(size).zip(&mut out[first..first + size]);
            for (row, out) in rows {
                *out += row.iter().zip(&v[first..first + size]).map(|(t, v)| t * v).sum::<f64>();
            }
            first += size;
        }
        debug_assert_eq!(first, self.points.len() * loads.slots);
    }
}
