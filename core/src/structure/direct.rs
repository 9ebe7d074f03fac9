//! Compliance by one factorisation per frequency, for structures whose complex modes are
//! defective. Slower than modes, never wrong.

use super::modes::{complex, modes};
use super::ports::{forced_harmonics, HarmonicLoad};
use super::restraint::store;
use super::{Compliance, Outline, Ports, Quantity, Receptance, Request, Structure};
use crate::Error;
use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{c64, Mat, MatRef};

/// The stuck structure as its matrices, complex in a travelling wave.
#[derive(Debug, Clone)]
pub struct DirectCompliance {
    mass: Mat<c64>,
    damping: Mat<c64>,
    restrained: Mat<c64>,
    rows: Mat<c64>,
    loads: Vec<HarmonicLoad>,
    /// C_neg of a damping `C + r C_neg`, if there is one.
    negative: Option<Mat<c64>>,
    outline: Outline,
}

impl DirectCompliance {
    /// The direct form of a structure with its contacts and loads.
    ///
    /// # Errors
    /// Shapes that do not fit, or an eigenvalue iteration that fails.
    pub fn new(structure: &Structure, ports: &Ports) -> Result<Self, Error> {
        ports.check(structure.dofs())?;
        let restrained = structure.restrained_stiffness(&ports.rows, &ports.stiffness);
        let direct = Self::of(structure, ports, restrained.as_ref());
        let stuck = structure.modes_at(restrained)?.modes.frequencies();
        let free = modes(structure.mass(), structure.stiffness())?.frequencies();
        Ok(direct.with_frequencies(stuck, free))
    }

    /// As [`DirectCompliance::new`], without the natural frequencies.
    pub(super) fn of(structure: &Structure, ports: &Ports, restrained: MatRef<'_, f64>) -> Self {
        let mass = structure.true_mass();
        let matrices = [mass.as_ref(), structure.damping(), restrained].map(complex);
        Self::of_matrices(matrices, complex(ports.rows.as_ref()), ports.loads.clone())
    }

    /// From mass, damping, restrained stiffness, rows of B and loads.
    pub(super) fn of_matrices(
        [mass, damping, restrained]: [Mat<c64>; 3],
        rows: Mat<c64>,
        loads: Vec<HarmonicLoad>,
    ) -> Self {
        let outline = Outline { forced: forced_harmonics(&loads), ..Outline::default() };
        Self { mass, damping, restrained, rows, loads, negative: None, outline }
    }

    /// With a part of the damping whose size is free.
    pub(super) fn with_negative(self, negative: Mat<c64>) -> Self {
        Self { negative: Some(negative), ..self }
    }

    /// With the natural frequencies of the stuck and of the free structure.
    pub(super) fn with_frequencies(self, stuck: Vec<f64>, free: Vec<f64>) -> Self {
        // No mode is known; a hundredth of the lowest frequency resolves ordinary damping.
        let bandwidth = stuck.iter().copied().find(|w| *w > 0.0).unwrap_or(1.0) * 0.01;
        Self { outline: Outline { stuck, free, bandwidth, ..self.outline }, ..self }
    }

    /// Factors `K_s + ikωC − (kω)²M`.
    fn factor(&self, harmonic: usize, omega: f64) -> Result<Factors, Error> {
        let n = self.mass.nrows();
        let excitation = omega;
        let omega = harmonic as f64 * omega;
        let parts = |i: usize, j: usize| {
            let mass = omega * omega * self.mass[(i, j)];
            let damping = c64::new(0.0, omega) * self.damping[(i, j)];
            [self.restrained[(i, j)], -mass, damping]
        };
        // Pivots are compared as DOFs of one size, whatever the units of each.
        let size = |i: usize| parts(i, i).iter().map(|part| part.norm()).sum::<f64>();
        let units = (0..n).map(|i| if size(i) > 0.0 { size(i).sqrt().recip() } else { 1.0 });
        let units: Vec<f64> = units.collect();
        let dynamic =
            Mat::from_fn(n, n, |i, j| parts(i, j).iter().sum::<c64>() * (units[i] * units[j]));
        let lu = dynamic.partial_piv_lu();
        let pivots = (0..n).map(|i| lu.U()[(i, i)].norm());
        let (least, largest) = pivots.fold((f64::MAX, 0.0_f64), |(l, m), p| (l.min(p), m.max(p)));
        if least <= 1e-14 * largest {
            return Err(if harmonic == 0 {
                Error::SingularStiffness {
                    lowest: self.outline.stuck.first().copied().unwrap_or(0.0),
                }
            } else {
                Error::UndampedResonance { omega: excitation, harmonic, natural: omega }
            });
        }
        Ok(Factors { lu, units })
    }

    /// `2k²ωM − ikC`: how fast the dynamic stiffness falls with ω.
    fn softening(&self, harmonic: usize, omega: f64) -> Mat<c64> {
        let (n, order) = (self.mass.nrows(), harmonic as f64);
        Mat::from_fn(n, n, |i, j| {
            2.0 * order * order * omega * self.mass[(i, j)]
                - c64::new(0.0, order) * self.damping[(i, j)]
        })
    }

    /// Forces on all DOFs from the slip loads.
    fn of_slip(&self, slip_load: &[c64]) -> Mat<c64> {
        Mat::from_fn(self.mass.nrows(), 1, |dof, _| {
            slip_load.iter().enumerate().map(|(i, q)| self.rows[(i, dof)].conj() * q).sum()
        })
    }

    fn load(&self, harmonic: usize) -> Mat<c64> {
        let load = self.loads.iter().find(|load| load.harmonic == harmonic);
        Mat::from_fn(self.mass.nrows(), 1, |i, _| {
            let amplitude = load.map_or(c64::new(0.0, 0.0), |load| load.amplitude[i]);
            if harmonic == 0 {
                c64::new(amplitude.re, 0.0)
            } else {
                amplitude
            }
        })
    }
}

/// A factored dynamic stiffness, its rows and columns multiplied by units.
struct Factors {
    lu: PartialPivLu<c64>,
    units: Vec<f64>,
}

impl Factors {
    fn solve(&self, mut right: Mat<c64>) -> Mat<c64> {
        self.scale(&mut right);
        self.lu.solve_in_place(&mut right);
        self.scale(&mut right);
        right
    }

    fn scale(&self, columns: &mut Mat<c64>) {
        for j in 0..columns.ncols() {
            let column = columns.col_as_slice_mut(j).iter_mut();
            column.zip(&self.units).for_each(|(entry, unit)| *entry *= *unit);
        }
    }
}

impl Compliance for DirectCompliance {
    fn contacts(&self) -> usize {
        self.rows.nrows()
    }

    fn dofs(&self) -> usize {
        self.mass.nrows()
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn is_direct(&self) -> bool {
        true
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        let contacts = self.contacts();
        out.reset(contacts);
        let lu = self.factor(harmonic, omega)?;
        let rows = &self.rows;
        let of_contacts = lu.solve(rows.adjoint().to_owned());
        let of_load = lu.solve(self.load(harmonic));
        for column in 0..contacts {
            for row in 0..contacts {
                out.contact[column * contacts + row] =
                    (rows.row(row) * of_contacts.col(column)) as c64;
            }
            out.stuck[column] = (rows.row(column) * of_load.col(0)) as c64;
        }
        // dG = −G dA G, with dA = ikC − 2k²ωM in ω and ikω C_neg in r.
        if let Some((contact_slope, stuck_slope)) = &mut out.slope {
            let change = self.softening(harmonic, omega);
            store((rows * lu.solve(&change * &of_contacts)).as_ref(), contact_slope);
            store((rows * lu.solve(&change * &of_load)).as_ref(), stuck_slope);
        }
        if let Some(negative) = &self.negative {
            let driving = faer::Scale(c64::new(0.0, -(harmonic as f64) * omega)) * negative;
            out.by_ratio.resize(contacts * contacts, c64::new(0.0, 0.0));
            store((rows * lu.solve(driving * &of_contacts)).as_ref(), &mut out.by_ratio);
        }
        Ok(())
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        let Request { harmonic, omega, quantity, .. } = *request;
        let lu = self.factor(harmonic, omega)?;
        let slip = self.of_slip(request.slip_load);
        let loaded = quantity != Quantity::OfSlip;
        let mut x = lu.solve(if loaded { self.load(harmonic) + slip } else { slip });
        if quantity == Quantity::Slope {
            x = lu.solve(self.softening(harmonic, omega) * x);
        }
        for (value, &dof) in out.iter_mut().zip(request.observe) {
            *value = x[(dof, 0)];
        }
        Ok(())
    }

    fn effort(&self, _points: usize, _observed: usize) -> [f64; 2] {
        // A factorisation each.
        [1.2 * (self.mass.nrows() as f64).powi(3); 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same chain with DOFs in other units each: pivots of their own sizes are not small.
    #[test]
    fn receptances_do_not_depend_on_the_units_of_the_dofs() {
        let receptance = |units: [f64; 3]| {
            let of = |own: f64, other: f64| {
                Mat::from_fn(3, 3, |i, j| {
                    let entry = match i.abs_diff(j) {
                        0 => own,
                        1 => other,
                        _ => 0.0,
                    };
                    c64::new(entry * units[i] * units[j], 0.0)
                })
            };
            let rows =
                Mat::from_fn(1, 3, |_, j| c64::new(if j == 0 { units[0] } else { 0.0 }, 0.0));
            let load = vec![c64::new(0.0, 0.0), c64::new(0.0, 0.0), c64::new(units[2], 0.0)];
            let loads = vec![HarmonicLoad { harmonic: 1, amplitude: load }];
            let matrices = [of(1.0, 0.1), of(0.02, 0.01), of(2.0, -1.0)];
            let direct = DirectCompliance::of_matrices(matrices, rows, loads);
            let mut out = Receptance::default();
            direct.receptance(1, 0.9, &mut out).unwrap();
            [out.contact[0], out.stuck[0]]
        };
        let expected = receptance([1.0; 3]);
        for units in [[1e-9, 1.0, 1e7], [1.0, 1e-12, 1.0], [1e8; 3]] {
            for (one, same) in receptance(units).iter().zip(expected) {
                assert!((one - same).norm() < 1e-12 * same.norm(), "{one} {same}");
            }
        }
    }
}
