//! The linear equations of a nonlinear mode, condensed to the slip loads that are left.
//!
//! In the modes of the stuck structure the tangent is `D − Ψᵀ T Ψ`: D is the dynamic stiffness, block by
//! block of every mode where damping couples none, and T the tangent of the slip loads, which vanishes
//! for every contact that sticks. So the modes are eliminated, and unknown are the changes `w = T Ψ y` of
//! the slip loads that are left. Modes at their resonance keep unknowns of their own: there D is
//! made regular, `D + ρ e eᵀ`, and `κ = eᵀ y` takes that back.
//!
//! Few slip loads are solved for directly, which tells the orientation of the curve too. Many are
//! solved for by GMRES, with the solution of each harmonic by itself as preconditioner.

use super::mode_equations::{ModeEquations, FLOOR};
use super::mode_preconditioner::Preconditioner;
use crate::solve::{factorised, gmres, KrylovSettings};
use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{c64, Mat};

/// Unknowns up to which they are solved for directly.
const LARGEST_FORMED: usize = 400;
/// Relative residual of linear equations: Newton's method squares the rest.
const LINEAR: f64 = 1e-6;
/// Most products with the tangent per Newton step.
const PRODUCTS: usize = 400;
/// Products from which on a preconditioner is made anew.
const STALE: usize = 30;
/// Residual up to which a solution leads on.
const USEFUL: f64 = 0.1;

/// `D⁻¹` of one order, made regular.
enum Inverse {
    Diagonal(Vec<c64>),
    Coupled(PartialPivLu<c64>),
}

impl Inverse {
    fn apply(&self, columns: &mut Mat<c64>) {
        match self {
            Self::Diagonal(inverse) => {
                for j in 0..columns.ncols() {
                    columns.col_mut(j).iter_mut().zip(inverse).for_each(|(x, d)| *x *= d);
                }
            }
            Self::Coupled(factors) => factors.solve_in_place(columns),
        }
    }
}

/// The linear equations at a point that has been evaluated, with one more row.
pub(super) struct Condensed<'e, 'a> {
    equations: &'e ModeEquations<'a>,
    inverses: Vec<(usize, Inverse)>,
    /// Modes at their resonance: where they stand among the amplitudes, and ρ.
    kept: Vec<(usize, f64)>,
    rates: [Vec<f64>; 3],
    border: &'e [f64],
    /// Where the slip loads that change stand, point after point.
    active: Vec<usize>,
}

/// Solution, the sign of the determinant where it is known, and products with the tangent.
pub(super) struct Solved {
    pub(super) step: Vec<f64>,
    pub(super) sign: f64,
    pub(super) products: usize,
}

impl<'e, 'a> Condensed<'e, 'a> {
    pub(super) fn new(equations: &'e ModeEquations<'a>, border: &'e [f64]) -> Self {
        let z = equations.at.as_slice();
        let [omega, excess, _] = equations.scalars(z);
        let (mut inverses, mut kept) = (Vec::new(), Vec::new());
        for order in equations.harmonics().orders() {
            let (basis, modes) = (equations.basis(order), equations.modes());
            let (rate, start) = (order as f64 * omega, equations.range(order).start);
            let mut own: Vec<c64> = (0..modes)
                .map(|j| {
                    let stiffness = basis.squared[j] - rate * rate;
                    c64::new(stiffness, rate * (basis.damping[j] - excess))
                })
                .collect();
            for (j, d) in own.iter_mut().enumerate() {
                let scale = basis.squared[j].abs().max(rate * rate);
                if order == 0 {
                    *d = if basis.free[j] { c64::new(1.0, 0.0) } else { *d };
                } else if d.norm() < FLOOR * scale {
                    *d += scale;
                    kept.extend([(start + j, scale), (start + modes + j, scale)]);
                }
            }
            let inverse = match basis.coupling.as_ref().filter(|_| order > 0) {
                None => Inverse::Diagonal(own.iter().map(|d| d.inv()).collect()),
                Some(coupling) => {
                    let coupling = coupling.matrix();
                    let full = Mat::from_fn(modes, modes, |i, j| {
                        let coupled = c64::new(0.0, rate) * coupling[(i, j)];
                        if i == j {
                            own[j]
                        } else {
                            coupled
                        }
                    });
                    Inverse::Coupled(full.partial_piv_lu())
                }
            };
            inverses.push((order, inverse));
        }
        let slots = equations.harmonics().slots();
        let laws = equations.loads.iter().zip(equations.model.points());
        let active = laws
            .filter(|(load, _)| load.active)
            .flat_map(|(_, points)| points.start * slots..points.end * slots)
            .collect();
        Self { equations, inverses, kept, rates: equations.scalar_rates(z), border, active }
    }

    fn size(&self) -> usize {
        self.active.len() + self.kept.len() + 3
    }

    /// Amplitudes that belong to slip loads, κ and scalars, and to the right-hand side of the modes.
    fn amplitudes(&self, unknowns: &[f64], right: Option<&[f64]>) -> Vec<f64> {
        let equations = self.equations;
        let slots = equations.harmonics().slots();
        let mut rows = right.map_or_else(|| vec![0.0; self.border.len() - 3], <[f64]>::to_vec);
        let (loads, rest) = unknowns.split_at(self.active.len());
        let (kappa, scalars) = rest.split_at(self.kept.len());
        let mut load = vec![0.0; equations.model.compliance().contacts() * slots];
        self.active.iter().zip(loads).for_each(|(at, w)| load[*at] = *w);
        equations.subtract_forces(&load, -1.0, &mut rows);
        for ((at, stiffness), kappa) in self.kept.iter().zip(kappa) {
            rows[*at] += stiffness * kappa;
        }
        for (rate, by) in self.rates.iter().zip(scalars) {
            rows.iter_mut().zip(rate).for_each(|(row, rate)| *row -= by * rate);
        }
        if equations.harmonics().has_mean() {
            let free = &equations.basis(0).free;
            for j in (0..equations.modes()).filter(|j| free[*j]) {
                rows[j] = right.map_or(0.0, |right| right[j]);
            }
        }
        for (order, inverse) in &self.inverses {
            let own = equations.part(&rows, *order);
            let mut column = Mat::from_fn(own.nrows(), 1, |j, _| {
                c64::new(own[(j, 0)], if *order > 0 { -own[(j, 1)] } else { 0.0 })
            });
            inverse.apply(&mut column);
            let (range, modes) = (equations.range(*order), column.nrows());
            for (i, row) in rows[range].iter_mut().enumerate() {
                *row = if i < modes { column[(i, 0)].re } else { -column[(i - modes, 0)].im };
            }
        }
        rows
    }

    /// What the condensed equations make of the unknowns with these amplitudes.
    fn rows(&self, unknowns: &[f64], amplitudes: &[f64]) -> Vec<f64> {
        let equations = self.equations;
        let moved = equations.at_contacts(amplitudes, 1.0, false);
        let load = equations.load_change(&moved);
        let (loads, rest) = unknowns.split_at(self.active.len());
        let (kappa, scalars) = rest.split_at(self.kept.len());
        let range = equations.range(1);
        let own = &amplitudes[range.clone()];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut out: Vec<f64> =
            loads.iter().zip(&self.active).map(|(w, at)| w - load[*at]).collect();
        out.extend(kappa.iter().zip(&self.kept).map(|(kappa, (at, _))| kappa - amplitudes[*at]));
        let border = dot(self.border, amplitudes) + dot(&self.border[amplitudes.len()..], scalars);
        out.extend([dot(&equations.at[range], own), dot(&equations.phase, own), border]);
        out
    }

    fn product(&self, unknowns: &[f64]) -> Vec<f64> {
        self.rows(unknowns, &self.amplitudes(unknowns, None))
    }

    /// Solves with a right-hand side of modes, amplitude, phase and the border.
    pub(super) fn solve(
        &self,
        right: &[f64],
        preconditioner: &mut Option<Preconditioner>,
    ) -> Option<Solved> {
        let modes = right.len() - 3;
        let size = self.size();
        let none = vec![0.0; size];
        let of_right = self.rows(&none, &self.amplitudes(&none, Some(&right[..modes])));
        let mut rhs: Vec<f64> = of_right.iter().map(|row| -row).collect();
        rhs[size - 3..].iter_mut().zip(&right[modes..]).for_each(|(row, right)| *row += right);
        let (unknowns, sign, products) = if size <= LARGEST_FORMED {
            let mut matrix = Mat::zeros(size, size);
            for j in 0..size {
                let mut unit = none.clone();
                unit[j] = 1.0;
                self.product(&unit).iter().enumerate().for_each(|(i, row)| matrix[(i, j)] = *row);
            }
            let (unknowns, sign) = factorised(&mut matrix, &rhs, &vec![1.0; size])?;
            (unknowns, sign, size)
        } else {
            let (unknowns, products) = self.iterate(&rhs, preconditioner)?;
            (unknowns, 1.0, products)
        };
        let mut step = self.amplitudes(&unknowns, Some(&right[..modes]));
        step.extend(&unknowns[size - 3..]);
        step.iter().all(|s| s.is_finite()).then_some(Solved { step, sign, products })
    }

    /// GMRES with the preconditioner that is there, or a new one.
    fn iterate(
        &self,
        rhs: &[f64],
        preconditioner: &mut Option<Preconditioner>,
    ) -> Option<(Vec<f64>, usize)> {
        let known = preconditioner.take().filter(|own| own.active == self.active);
        let fresh = known.is_none();
        let blocks = known.unwrap_or_else(|| self.preconditioner());
        let (unknowns, residual, mut products) = self.preconditioned(rhs, &blocks)?;
        if products < STALE {
            *preconditioner = Some(blocks);
        }
        if residual < USEFUL {
            return Some((unknowns, products));
        }
        if fresh {
            return None;
        }
        let blocks = self.preconditioner();
        let (unknowns, residual, more) = self.preconditioned(rhs, &blocks)?;
        products += more;
        *preconditioner = Some(blocks);
        (residual < USEFUL).then_some((unknowns, products))
    }

    /// Solution, its residual, and the products that it took.
    fn preconditioned(
        &self,
        rhs: &[f64],
        blocks: &Preconditioner,
    ) -> Option<(Vec<f64>, f64, usize)> {
        let (size, few) = (self.size(), self.kept.len() + 3);
        let split = self.active.len();
        // The last columns as they are; the rest of the last rows follows from them.
        let mut columns = Vec::with_capacity(few);
        let mut corner = Mat::zeros(few, few);
        for j in 0..few {
            let mut unit = vec![0.0; size];
            unit[split + j] = 1.0;
            let column = self.product(&unit);
            let mut solved = column[..split].to_vec();
            blocks.apply(&mut solved);
            unit[..split].copy_from_slice(&solved);
            unit[split + j] = 0.0;
            let through = self.product(&unit);
            for i in 0..few {
                corner[(i, j)] = column[split + i] - through[split + i];
            }
            columns.push(solved);
        }
        let corner = corner.partial_piv_lu();
        let apply = |v: &[f64]| {
            let mut out = v.to_vec();
            let mut last = Mat::from_fn(few, 1, |i, _| v[split + i]);
            corner.solve_in_place(&mut last);
            blocks.apply(&mut out[..split]);
            for (j, column) in columns.iter().enumerate() {
                out[split + j] = last[(j, 0)];
                out[..split].iter_mut().zip(column).for_each(|(out, c)| *out -= last[(j, 0)] * c);
            }
            out
        };
        let mut x = vec![0.0; size];
        let report = gmres(
            |v, out| {
                out.copy_from_slice(&self.product(&apply(v)));
                !self.equations.is_interrupted()
            },
            rhs,
            &mut x,
            KrylovSettings { tolerance: LINEAR, max_products: PRODUCTS },
        );
        report.residual.is_finite().then(|| (apply(&x), report.residual, report.products))
    }

    /// The tangents within each harmonic, factorised.
    fn preconditioner(&self) -> Preconditioner {
        let equations = self.equations;
        let slots = equations.harmonics().slots();
        let laws = || equations.loads.iter().zip(equations.model.points());
        let points: Vec<usize> =
            laws().filter(|(load, _)| load.active).flat_map(|(_, p)| p.clone()).collect();
        let count = points.len();
        let mut blocks = Vec::new();
        for (order, inverse) in &self.inverses {
            let Some(slot) = equations.harmonics().slot(*order) else { continue };
            let shapes = equations.basis(*order).contacts.matrix();
            let own = Mat::from_fn(count, shapes.ncols(), |i, j| shapes[(points[i], j)]);
            let mut moved = own.adjoint().to_owned();
            inverse.apply(&mut moved);
            let receptance = own * moved;
            let width = if *order > 0 { 2 } else { 1 };
            // Cosines before sines: c − i s.
            let entry = |i: usize, j: usize| {
                let value = receptance[(i % count, j % count)];
                match (i / count, j / count) {
                    (0, 1) => value.im,
                    (1, 0) => -value.im,
                    _ => value.re,
                }
            };
            let mut matrix = Mat::<f64>::identity(width * count, width * count);
            let mut first = 0;
            for (load, range) in laws().filter(|(load, _)| load.active) {
                let size = range.len() * slots;
                for (p, a) in (0..range.len()).flat_map(|p| (0..width).map(move |a| (p, a))) {
                    for (q, b) in (0..range.len()).flat_map(|q| (0..width).map(move |b| (q, b))) {
                        let tangent =
                            load.tangent[(p * slots + slot + a) * size + q * slots + slot + b];
                        if tangent != 0.0 {
                            for j in 0..width * count {
                                matrix[(a * count + first + p, j)] -=
                                    tangent * entry(b * count + first + q, j);
                            }
                        }
                    }
                }
                first += range.len();
            }
            let places = (0..width).flat_map(|a| (0..count).map(move |i| i * slots + slot + a));
            blocks.push((places.collect(), matrix.partial_piv_lu()));
        }
        Preconditioner { active: self.active.clone(), blocks }
    }
}
