//! The balance linearised at a solution: exact derivatives of everything it determines.
//!
//! Differentiating the balance leaves its Jacobian in the stuck form, `J = I − G ∂Q`, and on the
//! right what changes at fixed contact displacements:
//!
//! | cause | `J dU =` |
//! |---|---|
//! | frequency | `dU^stuck/dω + dG/dω Q` |
//! | a factor on the loads that vary | `U^stuck` without its mean |
//! | a parameter p of a law | `−G ∂F/∂p` |
//!
//! An amplitude follows by the envelope theorem: at its turning points a motion is stationary, so
//! that only their heights count, not where they move.

use super::condensed::Condensed;
use super::unknowns::{scatter, Unknowns};
use crate::contact::Residual;
use crate::fourier::{amplitude, amplitude_gradient, Measure, SampleTable};
use crate::model::Model;
use crate::solve::System as _;
use crate::structure::Quantity;
use crate::timing::Profile;
use crate::Error;

/// What a solution is differentiated by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// The excitation frequency.
    Frequency,
    /// A factor on the external loads that vary, at its value one; static loads stay as they are.
    Load,
    /// A parameter of a contact's law, both by position.
    Law {
        /// Position of the contact.
        contact: usize,
        /// Position among the parameters of its law.
        parameter: usize,
    },
}

/// What some DOFs do at a solution, with derivatives in frequency.
pub struct FrequencyJets {
    /// Amplitudes, each with its derivative.
    pub amplitudes: Vec<(f64, f64)>,
    /// Series of the displacements, one after the other, …
    pub series: Vec<f64>,
    /// … and their derivatives.
    pub slopes: Vec<f64>,
    /// Derivative of the contact displacements.
    pub rate: Vec<f64>,
}

impl FrequencyJets {
    /// The series of every DOF, of so many coefficients, with its derivative.
    pub fn motions(&self, slots: usize) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.series.chunks_exact(slots).zip(self.slopes.chunks_exact(slots))
    }
}

/// The balance at a solution, with its Jacobian.
pub struct Linearised<'a> {
    equations: Condensed<'a>,
    x: Vec<f64>,
    slip_load: Vec<f64>,
}

impl<'a> Linearised<'a> {
    /// Linearises at a solution in the harmonics of `table`.
    ///
    /// # Errors
    /// As for the solution itself: a singular static stiffness or an undamped resonance.
    pub fn new(
        model: &'a Model,
        table: &'a SampleTable,
        residual: Residual,
        omega: f64,
        solution: &Unknowns,
    ) -> Result<Self, Error> {
        let mut equations = Condensed::new(model, table, residual, true);
        equations.set_omega(omega).map_err(|(_, error)| error)?;
        let x = solution.recast(table.harmonics());
        let mut ignored = vec![0.0; equations.size()];
        equations.residual(&x, &mut ignored);
        let slip_load = equations.slip_load();
        Ok(Self { equations, x, slip_load })
    }

    /// Work done so far.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.equations.profile
    }

    /// Derivative of the contact displacements; `None` if the Jacobian is singular.
    pub fn contact_rate(&mut self, cause: Cause) -> Option<Vec<f64>> {
        let rhs = match cause {
            Cause::Frequency => self.equations.frequency_rate(),
            Cause::Load => {
                let mut rhs = self.equations.stuck_response().to_vec();
                self.copy_means(None, &mut rhs);
                rhs
            }
            Cause::Law { .. } => {
                let mut rhs = vec![0.0; self.x.len()];
                let mut force = self.explicit(cause);
                force.iter_mut().for_each(|f| *f = -*f);
                self.equations.add_response(&force, &mut rhs);
                rhs
            }
        };
        let mut rate = vec![0.0; rhs.len()];
        self.equations.solve(&rhs, &mut rate).then_some(rate)
    }

    /// `∂F/∂p` at fixed contact displacements.
    fn explicit(&self, cause: Cause) -> Vec<f64> {
        let mut force = vec![0.0; self.x.len()];
        if let Cause::Law { contact, parameter } = cause {
            self.equations.add_force_rate([contact, parameter], &self.x, 1.0, &mut force);
        }
        force
    }

    /// Series of the displacements of DOFs, one after the other.
    ///
    /// # Errors
    /// As [`Linearised::new`].
    pub fn displacement(&self, dofs: &[usize]) -> Result<Vec<f64>, Error> {
        self.series(Quantity::Whole, [&self.x, &self.slip_load], dofs)
    }

    /// Derivatives of the series of the displacements of DOFs, from that of the contacts.
    ///
    /// # Errors
    /// As [`Linearised::new`].
    pub fn displacement_rate(
        &self,
        dofs: &[usize],
        cause: Cause,
        contact_rate: &[f64],
    ) -> Result<Vec<f64>, Error> {
        // The force that leaves the structure: what its stuck spring does not carry, less what the
        // parameter does by itself.
        let mut slip_rate = self.explicit(cause);
        slip_rate.iter_mut().for_each(|f| *f = -*f);
        self.equations.add_tangent_product(contact_rate, &mut slip_rate);
        let quantity = if cause == Cause::Load { Quantity::Whole } else { Quantity::OfSlip };
        let mut rate = self.series(quantity, [contact_rate, &slip_rate], dofs)?;
        if cause == Cause::Load && self.equations.harmonics().has_mean() {
            let of_slip = self.series(Quantity::OfSlip, [contact_rate, &slip_rate], dofs)?;
            self.copy_means(Some(&of_slip), &mut rate);
        }
        if cause == Cause::Frequency {
            let slope = self.series(Quantity::Slope, [&self.x, &self.slip_load], dofs)?;
            rate.iter_mut().zip(&slope).for_each(|(r, s)| *r += s);
        }
        Ok(rate)
    }

    /// Takes the means of series, if there are any, from others or makes them zero.
    fn copy_means(&self, from: Option<&[f64]>, to: &mut [f64]) {
        let harmonics = self.equations.harmonics();
        if harmonics.has_mean() {
            for at in (0..to.len()).step_by(harmonics.slots()) {
                to[at] = from.map_or(0.0, |from| from[at]);
            }
        }
    }

    /// Builds series order by order from contact displacements and slip loads.
    fn series(
        &self,
        quantity: Quantity,
        motion: [&[f64]; 2],
        dofs: &[usize],
    ) -> Result<Vec<f64>, Error> {
        let harmonics = self.equations.harmonics();
        let mut series = vec![0.0; dofs.len() * harmonics.slots()];
        self.equations.displacements(quantity, motion, dofs, |order, values, _, _| {
            scatter(harmonics, order, values, &mut series);
        })?;
        Ok(series)
    }

    /// Amplitude of one DOF, and its derivative in every one of `causes`, not a number where the
    /// Jacobian is singular.
    ///
    /// # Errors
    /// As [`Linearised::new`].
    pub fn amplitude(
        &mut self,
        dof: usize,
        measure: Measure,
        causes: &[Cause],
    ) -> Result<(f64, Vec<f64>), Error> {
        let series = self.displacement(&[dof])?;
        let gradient = amplitude_gradient(self.equations.table, &series, measure);
        let mut slopes = Vec::with_capacity(causes.len());
        for &cause in causes {
            slopes.push(match self.contact_rate(cause) {
                Some(rate) => {
                    let rate = self.displacement_rate(&[dof], cause, &rate)?;
                    gradient.iter().zip(&rate).map(|(g, r)| g * r).sum()
                }
                None => f64::NAN,
            });
        }
        Ok((amplitude(self.equations.table, &series, measure), slopes))
    }

    /// What some DOFs do, with derivatives in frequency; `None` where the Jacobian is singular.
    ///
    /// # Errors
    /// As [`Linearised::new`].
    pub fn frequency_jets(
        &mut self,
        dofs: &[usize],
        measure: Measure,
    ) -> Result<Option<FrequencyJets>, Error> {
        let Some(rate) = self.contact_rate(Cause::Frequency) else { return Ok(None) };
        let slots = self.equations.harmonics().slots();
        let series = self.displacement(dofs)?;
        let slopes = self.displacement_rate(dofs, Cause::Frequency, &rate)?;
        let mut jets = FrequencyJets { amplitudes: Vec::new(), series, slopes, rate };
        let amplitudes = jets.motions(slots).map(|(series, slopes)| {
            let table = self.equations.table;
            let gradient = amplitude_gradient(table, series, measure);
            let slope = gradient.iter().zip(slopes).map(|(g, s)| g * s).sum();
            (amplitude(table, series, measure), slope)
        });
        jets.amplitudes = amplitudes.collect();
        Ok(Some(jets))
    }
}
