//! Compliance by one factorisation per frequency, for structures whose complex modes are
//! defective. Slower than modes, never wrong.

use super::modal::complex;
use super::modes::real_modes;
use super::{Compliance, Ports, Receptance, Structure};
use crate::Error;
use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{c64, Mat, MatRef};

/// The stuck structure as its matrices.
#[derive(Debug, Clone)]
pub struct DirectCompliance {
    structure: Structure,
    restrained: Mat<f64>,
    ports: Ports,
    stuck_frequencies: Vec<f64>,
    free_frequencies: Vec<f64>,
}

impl DirectCompliance {
    /// The direct form of a structure with its contacts and loads.
    ///
    /// # Errors
    /// Shapes that do not fit, or an eigenvalue iteration that fails.
    pub fn new(structure: &Structure, ports: &Ports) -> Result<Self, Error> {
        ports.check(structure.dofs())?;
        let restrained =
            structure.restrained_stiffness(ports.rows.as_ref(), ports.stiffness.as_ref());
        let mut direct = Self::of(structure, ports, restrained.as_ref());
        direct.stuck_frequencies = real_modes(structure.mass(), restrained.as_ref())?.frequencies();
        direct.free_frequencies =
            real_modes(structure.mass(), structure.stiffness())?.frequencies();
        Ok(direct)
    }

    /// As [`DirectCompliance::new`], without the natural frequencies.
    pub(super) fn of(structure: &Structure, ports: &Ports, restrained: MatRef<'_, f64>) -> Self {
        Self {
            structure: structure.clone(),
            restrained: restrained.to_owned(),
            ports: ports.clone(),
            stuck_frequencies: Vec::new(),
            free_frequencies: Vec::new(),
        }
    }

    /// Factors `K_s + ikωC − (kω)²M`.
    fn factor(&self, harmonic: usize, omega: f64) -> Result<PartialPivLu<c64>, Error> {
        let n = self.structure.dofs();
        let excitation = omega;
        let omega = harmonic as f64 * omega;
        let (mass, damping) = (self.structure.mass(), self.structure.damping());
        let dynamic = Mat::from_fn(n, n, |i, j| {
            c64::new(
                self.restrained[(i, j)] - omega * omega * mass[(i, j)],
                omega * damping[(i, j)],
            )
        });
        let lu = dynamic.partial_piv_lu();
        let pivots = (0..n).map(|i| lu.U()[(i, i)].norm());
        let (least, largest) = pivots.fold((f64::MAX, 0.0_f64), |(l, m), p| (l.min(p), m.max(p)));
        if least <= 1e-14 * largest {
            return Err(if harmonic == 0 {
                Error::SingularStiffness {
                    lowest: self.stuck_frequencies.first().copied().unwrap_or(0.0),
                }
            } else {
                Error::UndampedResonance { omega: excitation, harmonic, natural: omega }
            });
        }
        Ok(lu)
    }

    /// `2k²ωM − ikC`: how fast the dynamic stiffness falls with ω.
    fn softening(&self, harmonic: usize, omega: f64) -> Mat<c64> {
        let (n, order) = (self.structure.dofs(), harmonic as f64);
        let (mass, damping) = (self.structure.mass(), self.structure.damping());
        Mat::from_fn(n, n, |i, j| {
            c64::new(2.0 * order * order * omega * mass[(i, j)], -order * damping[(i, j)])
        })
    }

    /// Forces on all DOFs from the slip loads.
    fn of_slip(&self, slip_load: &[c64]) -> Mat<c64> {
        Mat::from_fn(self.structure.dofs(), 1, |dof, _| {
            slip_load.iter().enumerate().map(|(i, q)| self.ports.rows[(i, dof)] * q).sum()
        })
    }

    fn load(&self, harmonic: usize) -> Mat<c64> {
        Mat::from_fn(self.structure.dofs(), 1, |i, _| {
            let amplitude = self.ports.load(harmonic).map_or(c64::new(0.0, 0.0), |load| load[i]);
            if harmonic == 0 {
                c64::new(amplitude.re, 0.0)
            } else {
                amplitude
            }
        })
    }
}

impl Compliance for DirectCompliance {
    fn contacts(&self) -> usize {
        self.ports.rows.nrows()
    }

    fn dofs(&self) -> usize {
        self.structure.dofs()
    }

    fn forced_harmonics(&self) -> Vec<usize> {
        self.ports.forced_harmonics()
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        let contacts = self.contacts();
        out.reset(contacts);
        let lu = self.factor(harmonic, omega)?;
        let rows = complex(self.ports.rows.as_ref());
        let of_contacts = lu.solve(rows.transpose());
        let of_load = lu.solve(self.load(harmonic));
        for column in 0..contacts {
            for row in 0..contacts {
                out.contact[column * contacts + row] =
                    (rows.row(row) * of_contacts.col(column)) as c64;
            }
            out.stuck[column] = (rows.row(column) * of_load.col(0)) as c64;
        }
        if let Some((contact_slope, stuck_slope)) = &mut out.slope {
            // dG = −G (ikC − 2k²ωM) G
            let change = self.softening(harmonic, omega);
            let contact_change = &rows * lu.solve(&change * &of_contacts);
            let load_change = &rows * lu.solve(&change * &of_load);
            for column in 0..contacts {
                for row in 0..contacts {
                    contact_slope[column * contacts + row] = contact_change[(row, column)];
                }
                stuck_slope[column] = load_change[(column, 0)];
            }
        }
        Ok(())
    }

    fn displacement(
        &self,
        harmonic: usize,
        omega: f64,
        _contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let load = self.load(harmonic) + self.of_slip(slip_load);
        observed(self.factor(harmonic, omega)?.solve(load).as_ref(), observe, out);
        Ok(())
    }

    fn slip_displacement(
        &self,
        harmonic: usize,
        omega: f64,
        _contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let x = self.factor(harmonic, omega)?.solve(self.of_slip(slip_load));
        observed(x.as_ref(), observe, out);
        Ok(())
    }

    fn displacement_slope(
        &self,
        harmonic: usize,
        omega: f64,
        _contact: &[c64],
        slip_load: &[c64],
        observe: &[usize],
        out: &mut [c64],
    ) -> Result<(), Error> {
        let lu = self.factor(harmonic, omega)?;
        let x = lu.solve(self.load(harmonic) + self.of_slip(slip_load));
        observed(lu.solve(self.softening(harmonic, omega) * x).as_ref(), observe, out);
        Ok(())
    }

    fn stuck_frequencies(&self) -> &[f64] {
        &self.stuck_frequencies
    }

    fn free_frequencies(&self) -> &[f64] {
        &self.free_frequencies
    }

    fn narrowest_bandwidth(&self) -> f64 {
        // No mode is known; a hundredth of the lowest frequency resolves ordinary damping.
        self.stuck_frequencies.iter().copied().find(|w| *w > 0.0).unwrap_or(1.0) * 0.01
    }
}

fn observed(x: MatRef<'_, c64>, observe: &[usize], out: &mut [c64]) {
    for (value, &dof) in out.iter_mut().zip(observe) {
        *value = x[(dof, 0)];
    }
}
