//! The linear equations of a nonlinear mode, condensed to the slip loads that are left.
//!
//! In the modes of the stuck structure the tangent is `D − Ψᵀ T Ψ`: D is the dynamic stiffness, block by
//! block of every mode where damping couples none, and T the tangent of the slip loads, which vanishes
//! for every contact that sticks. So the modes are eliminated, and unknown are the changes `w = T Ψ y` of
//! the slip loads that are left. Modes at their resonance keep unknowns of their own: there D is
//! made regular, `D + ρ e eᵀ`, and `κ = eᵀ y` takes that back.
//!
//! A contact that slips but never opens changes its tangential slip loads alone, one that sticks at most
//! their means: only rows of T that differ from zero have unknowns.
//!
//! Few slip loads are solved for directly, which tells the orientation of the curve too.
//! Many are solved for by GMRES, with the solution of each harmonic by itself as preconditioner.

use super::equations::{ModeEquations, FLOOR};
use super::preconditioner::Preconditioner;
use crate::solve::{factorised, gmres, KrylovSettings};
use faer::linalg::solvers::{PartialPivLu, Solve as _, SolveCore as _};
use faer::{c64, Conj, Mat};
use std::ops::Range;

/// Unknowns up to which they are solved for directly.
const LARGEST_FORMED: usize = 600;
/// Most products with the tangent per Newton step.
const PRODUCTS: usize = 400;
/// Products, against those with a new preconditioner, from which on it is made anew.
const STALE: usize = 40;
/// Residual up to which a solution leads on.
const USEFUL: f64 = 0.1;

/// `D⁻¹` of one order, made regular.
pub(super) enum Inverse {
    Diagonal(Vec<c64>),
    Coupled(PartialPivLu<c64>),
}

impl Inverse {
    pub(super) fn apply(&self, columns: &mut Mat<c64>) {
        match self {
            Self::Diagonal(inverse) => {
                for j in 0..columns.ncols() {
                    columns.col_mut(j).iter_mut().zip(inverse).for_each(|(x, d)| *x *= d);
                }
            }
            Self::Coupled(factors) => factors.solve_in_place(columns),
        }
    }

    pub(super) fn apply_adjoint(&self, columns: &mut Mat<c64>) {
        match self {
            Self::Diagonal(inverse) => {
                for j in 0..columns.ncols() {
                    columns.col_mut(j).iter_mut().zip(inverse).for_each(|(x, d)| *x *= d.conj());
                }
            }
            Self::Coupled(factors) => {
                factors.solve_transpose_in_place_with_conj(Conj::Yes, columns.as_mut());
            }
        }
    }
}

/// The linear equations at a point that has been evaluated, with one more row.
pub(super) struct Condensed<'e, 'a> {
    pub(super) equations: &'e ModeEquations<'a>,
    pub(super) inverses: Vec<(usize, Inverse)>,
    /// Modes at their resonance: where they stand among the amplitudes, and ρ.
    pub(super) kept: Vec<(usize, f64)>,
    rates: [Vec<f64>; 3],
    pub(super) border: &'e [f64],
    /// Where the slip loads that change stand, point after point.
    pub(super) active: Vec<usize>,
    /// Of every contact with such loads: itself, and their positions in `active`.
    pub(super) own: Vec<(usize, Range<usize>)>,
}

/// Solution, the sign of the determinant or 0 where it is not known, products with the tangent and
/// factorisations.
pub(super) struct Solved {
    pub(super) step: Vec<f64>,
    pub(super) sign: f64,
    pub(super) products: usize,
    pub(super) factorisations: usize,
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
        let (mut active, mut own) = (Vec::new(), Vec::new());
        let laws = equations.loads.iter().zip(equations.model.points()).enumerate();
        for (index, (load, points)) in laws.filter(|(_, (load, _))| load.active) {
            let (first, size) = (active.len(), points.len() * slots);
            let changes =
                |row: &usize| load.tangent[row * size..][..size].iter().any(|t| *t != 0.0);
            active.extend((0..size).filter(changes).map(|row| points.start * slots + row));
            own.push((index, first..active.len()));
        }
        Self { equations, inverses, kept, rates: equations.scalar_rates(z), border, active, own }
    }

    pub(super) fn size(&self) -> usize {
        self.active.len() + self.kept.len() + 3
    }

    /// Changes of the slip loads that change, by changes of the contact displacements.
    fn changes(&self, moved: &[f64]) -> Vec<f64> {
        let slots = self.equations.harmonics().slots();
        let mut out = Vec::with_capacity(self.active.len());
        for (index, range) in &self.own {
            let points = &self.equations.model.points()[*index];
            let (first, size) = (points.start * slots, points.len() * slots);
            let (tangent, moved) = (&self.equations.loads[*index].tangent, &moved[first..][..size]);
            for at in &self.active[range.clone()] {
                let row = &tangent[(at - first) * size..][..size];
                out.push(row.iter().zip(moved).map(|(t, u)| t * u).sum());
            }
        }
        out
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
        self.divide(&mut rows, Inverse::apply);
        rows
    }

    /// What the condensed equations make of the unknowns with these amplitudes.
    fn rows(&self, unknowns: &[f64], amplitudes: &[f64]) -> Vec<f64> {
        let equations = self.equations;
        let moved = equations.at_contacts(amplitudes, 1.0, false);
        let (loads, rest) = unknowns.split_at(self.active.len());
        let (kappa, scalars) = rest.split_at(self.kept.len());
        let range = equations.range(1);
        let own = &amplitudes[range.clone()];
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut out: Vec<f64> =
            loads.iter().zip(self.changes(&moved)).map(|(w, change)| w - change).collect();
        out.extend(kappa.iter().zip(&self.kept).map(|(kappa, (at, _))| kappa - amplitudes[*at]));
        let border = dot(self.border, amplitudes) + dot(&self.border[amplitudes.len()..], scalars);
        out.extend([dot(&equations.at[range], own), dot(&equations.phase, own), border]);
        out
    }

    pub(super) fn product(&self, unknowns: &[f64]) -> Vec<f64> {
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
        let (unknowns, sign, [products, factorisations]) = if size <= LARGEST_FORMED {
            let mut matrix = self.matrix();
            let (unknowns, sign) = factorised(&mut matrix, &rhs, &vec![1.0; size])?;
            (unknowns, sign, [0, 1])
        } else {
            let (unknowns, effort) = self.iterate(&rhs, preconditioner)?;
            (unknowns, 0.0, effort)
        };
        let mut step = self.amplitudes(&unknowns, Some(&right[..modes]));
        step.extend(&unknowns[size - 3..]);
        step.iter().all(|s| s.is_finite()).then_some(Solved {
            step,
            sign,
            products,
            factorisations,
        })
    }

    /// GMRES with the preconditioner that is there, or a new one; products and factorisations.
    fn iterate(
        &self,
        rhs: &[f64],
        preconditioner: &mut Option<Preconditioner>,
    ) -> Option<(Vec<f64>, [usize; 2])> {
        let mut wasted = 0;
        if let Some(blocks) = preconditioner.take() {
            let (unknowns, residual, products) = self.preconditioned(rhs, &blocks)?;
            if residual < USEFUL {
                *preconditioner = Some(blocks).filter(|own| products < own.products + STALE);
                return Some((unknowns, [products, 0]));
            }
            wasted = products;
        }
        let mut blocks = self.preconditioner();
        let (unknowns, residual, products) = self.preconditioned(rhs, &blocks)?;
        blocks.products = products;
        *preconditioner = Some(blocks);
        (residual < USEFUL).then_some((unknowns, [wasted + products, 1]))
    }

    /// Solution, its residual, and the products that it took.
    fn preconditioned(
        &self,
        rhs: &[f64],
        blocks: &Preconditioner,
    ) -> Option<(Vec<f64>, f64, usize)> {
        let (size, few) = (self.size(), self.kept.len() + 3);
        let split = self.active.len();
        let (blocks, rows) = (blocks.fitted(&self.active), self.last_rows());
        // The last columns as they are; the rest of the last rows follows from them.
        let mut columns = Vec::with_capacity(few);
        let mut corner = Mat::zeros(few, few);
        for j in 0..few {
            let mut unit = vec![0.0; size];
            unit[split + j] = 1.0;
            let column = self.product(&unit);
            let mut solved = column[..split].to_vec();
            blocks.apply(&mut solved);
            for (i, row) in rows.iter().enumerate() {
                let through: f64 = row.iter().zip(&solved).map(|(row, w)| row * w).sum();
                corner[(i, j)] = column[split + i] - through;
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
            KrylovSettings { tolerance: self.equations.linear, max_products: PRODUCTS },
        );
        report.residual.is_finite().then(|| (apply(&x), report.residual, report.products))
    }

    /// Applies inverses, or their adjoints, to rows of modes in place.
    pub(super) fn divide(&self, rows: &mut [f64], by: impl Fn(&Inverse, &mut Mat<c64>)) {
        for (order, inverse) in &self.inverses {
            let own = self.equations.part(rows, *order);
            let mut column = Mat::from_fn(own.nrows(), 1, |j, _| {
                c64::new(own[(j, 0)], if *order > 0 { -own[(j, 1)] } else { 0.0 })
            });
            by(inverse, &mut column);
            let (range, modes) = (self.equations.range(*order), column.nrows());
            for (i, row) in rows[range].iter_mut().enumerate() {
                *row = if i < modes { column[(i, 0)].re } else { -column[(i - modes, 0)].im };
            }
        }
    }
}
