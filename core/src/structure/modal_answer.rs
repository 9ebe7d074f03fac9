//! What the modes of the stuck structure answer to forces at the harmonics of a frequency.

use super::contact_coordinates::ContactCoordinates;
use super::contact_modes::ContactModes;
use super::contact_shapes::{add_forces, displace, excite, gather, loaded, ContactShapes};
use super::modal::UNDAMPED;
use super::modal_orders::{Inverse, ModalOrders, Order};
use super::quasi_static::QuasiStatic;
use crate::solve::{gmres, multiply, settle, KrylovSettings};
use crate::Error;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::solvers::Solve as _;
use faer::{c64, Accum, Mat, MatRef, Par};

/// Products with the coupling of the damping: far more than it takes.
const MOST_PRODUCTS: usize = 400;
/// … which count as so many within one with the modes.
const COUPLING: f64 = 4.0;
/// Modes whose shapes at the contacts stay in the cache from one product to the next.
const TOGETHER: usize = 128;
/// Least modulus of a dynamic stiffness, relative to the squared frequency.
const FLOOR: f64 = 1e-9;

/// The lowest of so many modes move as they do, the others follow their loads at once, …
const SLOWEST: usize = 10;
/// … where inertia and damping change their answers by no more than this.
const QUASI_STATIC: f64 = 5e-3;

impl ContactModes {
    /// `Σ ψ ψᵀ / ω²` of all modes behind the first ones.
    fn flexibility_behind(&self, first: usize) -> Mat<f64> {
        let (count, size) = (self.modes() - first, self.contacts.ncols());
        let mut out = Mat::zeros(size, size);
        // A part of the modes at a time needs no copy of the whole.
        for start in (0..count).step_by(size.clamp(1, 256)) {
            let rows = (count - start).min(size.clamp(1, 256));
            let own = self.shapes().subrows(first + start, rows);
            let carried = Mat::from_fn(rows, size, |j, i| {
                own[(j, i)] / self.omega_squared[first + start + j]
            });
            triangular::matmul(
                out.as_mut(),
                BlockStructure::TriangularLower,
                Accum::Add,
                own.transpose(),
                BlockStructure::Rectangular,
                carried.as_ref(),
                BlockStructure::Rectangular,
                1.0,
                Par::Seq,
            );
            settle();
        }
        for j in 0..size {
            (0..j).for_each(|i| out[(i, j)] = out[(j, i)]);
        }
        out
    }

    /// `Z⁻¹` of the columns of a matrix of complex modal forces, by a factorisation where the damping
    /// couples modes.
    pub(super) fn solved(&self, order: usize, omega: f64, forces: Mat<c64>) -> Mat<c64> {
        let rate = order as f64 * omega;
        let own = |j: usize| self.stiffness(j, rate);
        // Damping couples nothing at rest.
        let Some(coupling) = self.coupling.as_ref().filter(|_| rate != 0.0) else {
            return Mat::from_fn(forces.nrows(), forces.ncols(), |i, j| forces[(i, j)] / own(i));
        };
        let whole = Mat::from_fn(self.modes(), self.modes(), |i, j| {
            let diagonal = if i == j { own(i) } else { c64::new(0.0, 0.0) };
            diagonal + c64::new(0.0, rate * coupling[(j, i)])
        });
        whole.partial_piv_lu().solve(forces)
    }

    /// `−dZ/dω` of the columns of a matrix of complex modal coordinates.
    pub(super) fn softening(&self, order: usize, omega: f64, coordinates: &Mat<c64>) -> Mat<c64> {
        let k = order as f64;
        let coupled = self.coupling.as_ref().map(|coupling| {
            let matrix = coupling.transpose();
            Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| c64::new(matrix[(i, j)], 0.0))
                * coordinates
        });
        Mat::from_fn(coordinates.nrows(), coordinates.ncols(), |i, j| {
            let y = coordinates[(i, j)];
            let other = coupled.as_ref().map_or(c64::new(0.0, 0.0), |coupled| coupled[(i, j)]);
            2.0 * k * k * omega * self.inertia[i] * y
                - c64::new(0.0, k) * (self.damping[i] * y + other)
        })
    }
}

impl ContactCoordinates for ContactModes {
    fn size(&self) -> usize {
        self.modes()
    }

    fn contacts(&self) -> usize {
        self.contacts.ncols()
    }

    fn work(&self, contacts: f64, slots: f64) -> f64 {
        let count = self.modes() as f64;
        let coupled = if self.is_coupled() { COUPLING * count } else { 0.0 };
        2.0 * slots * count * (2.0 * contacts + coupled)
    }

    fn effort(&self) -> f64 {
        10.0 * self.modes() as f64
    }

    fn excite(&self, load: MatRef<'_, f64>) -> Mat<f64> {
        excite(self.shapes(), load)
    }

    fn displace(&self, coordinates: MatRef<'_, f64>) -> Mat<f64> {
        displace(self.shapes(), coordinates)
    }

    fn part(&self, contacts: &[usize]) -> ContactShapes {
        let mut own = Mat::zeros(self.modes(), contacts.len());
        gather(self.shapes(), contacts, &mut own);
        ContactShapes::Modal(own)
    }

    fn add_load(&self, at: &ModalOrders, forces: &mut Mat<f64>) {
        at.add(|harmonic| self.load(harmonic), forces);
    }

    fn quasi_static(&self, at: &ModalOrders) -> Option<&QuasiStatic> {
        let slow = self.modes() / SLOWEST;
        let one = c64::new(1.0, 0.0);
        let follows = |order: &Order| {
            let Inverse::Diagonal(inverse) = &order.inverse else { return false };
            let others = inverse.iter().zip(&self.omega_squared).skip(slow);
            let mut change = others.map(|(z, k)| (z * *k - one).norm_sqr());
            change.all(|squared| squared <= QUASI_STATIC * QUASI_STATIC)
        };
        if self.is_coupled() || !at.orders.iter().all(follows) {
            return None;
        }
        Some(self.quasi_static.get_or_init(|| {
            let flexibility = self.flexibility_behind(slow);
            QuasiStatic::new(self.shapes().subrows(0, slow), flexibility.as_ref())
        }))
    }

    fn orders(
        &self,
        harmonics: &[(usize, usize)],
        omega: f64,
    ) -> Result<ModalOrders, (usize, Error)> {
        let mut orders = Vec::with_capacity(harmonics.len());
        for &(order, slot) in harmonics {
            let rate = order as f64 * omega;
            self.check(order, omega).map_err(|error| (order, error))?;
            let inverse = (0..self.modes()).map(|j| {
                let own = self.stiffness(j, rate);
                // Met exactly by a mode that damping only couples: the iteration sees to the rest.
                let least = FLOOR * rate * rate;
                let undamped = own.im.abs() < UNDAMPED * rate * rate;
                let meets = undamped && own.norm_sqr() < least * least;
                if meets { c64::new(0.0, least) } else { own }.inv()
            });
            let inverse = Inverse::Diagonal(inverse.collect());
            orders.push(Order { harmonic: order, slot, rate, inverse });
        }
        Ok(ModalOrders { orders })
    }

    fn observe(
        &self,
        harmonic: usize,
        slot: usize,
        coordinates: &Mat<f64>,
        observe: &[usize],
        out: &mut [c64],
    ) {
        for (x, &dof) in out.iter_mut().zip(observe) {
            let part = |slot: usize| -> f64 {
                let shape = self.dofs.col(dof).iter();
                shape.zip(coordinates.row(slot).iter()).map(|(phi, y)| phi * y).sum()
            };
            *x = c64::new(part(slot), if harmonic == 0 { 0.0 } else { -part(slot + 1) });
        }
    }

    /// From modes to modes where nothing couples them: their shapes at the contacts, which have to come from
    /// memory, serve for both products.
    fn respond(&self, at: &ModalOrders, load: MatRef<'_, f64>, tolerance: f64) -> Mat<f64> {
        let (slots, contacts) = load.shape();
        if self.is_coupled() {
            let mut motion = self.excite(load);
            self.answer(at, &mut motion, tolerance);
            return self.displace(motion.as_ref());
        }
        let loaded = loaded(load);
        let mut out = Mat::zeros(slots, contacts);
        for first in (0..self.modes()).step_by(TOGETHER) {
            let shapes = self.shapes();
            let shapes = shapes.subrows(first, TOGETHER.min(shapes.nrows() - first));
            let mut forces = Mat::zeros(shapes.nrows(), slots);
            add_forces(shapes, load, &loaded, &mut forces);
            let mut motion = forces.transpose().to_owned();
            at.divide_part(&mut motion, first);
            multiply(out.as_mut(), Accum::Add, motion.as_ref(), shapes, 1.0);
        }
        out
    }

    fn answer(&self, at: &ModalOrders, forces: &mut Mat<f64>, tolerance: f64) {
        let Some(coupling) = &self.coupling else { return at.divide(forces) };
        let (slots, modes) = (forces.nrows(), forces.ncols());
        let rhs: Vec<f64> = (0..modes).flat_map(|j| forces.col(j).iter().copied()).collect();
        let mut carried = vec![0.0; rhs.len()];
        let column_major =
            |values: &[f64]| Mat::from_fn(slots, modes, |i, j| values[j * slots + i]);
        let mut work = Mat::zeros(slots, modes);
        // Forces that the diagonal carries: (1 + iω C_off diag(Z)⁻¹) carried = forces.
        let product = |v: &[f64], out: &mut [f64]| {
            let mut y = column_major(v);
            at.divide(&mut y);
            multiply(work.as_mut(), Accum::Replace, y.as_ref(), coupling.as_ref(), 1.0);
            out.copy_from_slice(v);
            for (j, out) in out.chunks_exact_mut(slots).enumerate() {
                for &Order { slot, rate, .. } in at.orders.iter().filter(|own| own.rate > 0.0) {
                    out[slot] += rate * work[(slot + 1, j)];
                    out[slot + 1] -= rate * work[(slot, j)];
                }
            }
            true
        };
        gmres(
            product,
            &rhs,
            &mut carried,
            KrylovSettings { tolerance, max_products: MOST_PRODUCTS },
        );
        *forces = column_major(&carried);
        at.divide(forces);
    }

    fn answer_rate(&self, at: &ModalOrders, coordinates: &mut Mat<f64>, tolerance: f64) {
        let coupled = self.coupling.as_ref().map(|coupling| &*coordinates * coupling);
        for Order { harmonic, slot, rate, .. } in &at.orders {
            let order = *harmonic as f64;
            for j in 0..coordinates.ncols() {
                if order == 0.0 {
                    coordinates[(*slot, j)] = 0.0;
                    continue;
                }
                let y = c64::new(coordinates[(*slot, j)], -coordinates[(slot + 1, j)]);
                let mut damped = self.damping[j] * y;
                if let Some(other) = &coupled {
                    damped += c64::new(other[(*slot, j)], -other[(slot + 1, j)]);
                }
                let change =
                    2.0 * order * rate * self.inertia[j] * y - c64::new(0.0, order) * damped;
                (coordinates[(*slot, j)], coordinates[(slot + 1, j)]) = (change.re, -change.im);
            }
        }
        self.answer(at, coordinates, tolerance);
    }
}
