//! The condensed equations at one frequency: `R(U) = U − μ U^stuck − G Q(U)`.

use super::evaluation::Evaluated;
use super::linear::{Factor, Linear};
use super::modal_work::{is_large, ByProducts};
use super::solution::{Point, PointStatus};
use super::unknowns::gather_all;
use crate::contact::{ContactLaw, Motion, PointSummary, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::structure::{Quantity, Request};
use crate::timing::Profile;
use crate::Error;
use faer::c64;

/// What a homotopy scales, from easy to the problem at hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Path {
    /// The external load: at small load everything sticks.
    Load,
    /// A loss that all contacts have besides: with much of it everything sticks.
    Loss,
    /// The stiffness of the contacts: soft contacts make a smooth problem.
    Stiffness,
}

/// The equations at one frequency and set of harmonics.
pub struct Condensed<'a> {
    pub(super) model: Evaluated<'a>,
    pub(super) table: &'a SampleTable,
    pub(super) residual: Residual,
    pub(super) linear: Linear,
    /// Whether derivatives in ω are wanted.
    pub(super) slopes: bool,
    /// Whether nothing corrects what is solved with products.
    pub(super) fine: bool,
    pub(super) omega: f64,
    pub(super) stuck: Vec<f64>,
    /// Slip loads and tangents at the last unknowns whose tangents were evaluated.
    pub(super) loads: Vec<SlipLoad>,
    /// Slip loads at later unknowns, if `moved_on`.
    pub(super) values: Vec<SlipLoad>,
    pub(super) moved_on: bool,
    pub(super) path: Path,
    pub(super) load_scale: f64,
    /// Force of the loss over the force of a stuck contact.
    pub(super) loss: f64,
    /// Softened laws and their share of the stiffness, while a homotopy in it is under way.
    pub(super) softened: Option<(f64, Vec<Box<dyn ContactLaw>>)>,
    pub(super) interrupted: Option<&'a dyn Fn() -> bool>,
    /// Work that it may take, as its profile counts it.
    pub(super) granted: f64,
    pub(super) factor: Option<Factor>,
    /// Sizes against which the motion of every point is accurate, as of the last tangents.
    pub(super) sizes: Vec<f64>,
    pub(super) by_products: ByProducts,
    /// Whether nothing holds the mean in the last direction that was asked for.
    pub(super) free: bool,
    /// Whether that direction has a mean that rounding moves: equations that hold say nothing of it.
    pub(super) loose: bool,
    pub(super) profile: Profile,
}

impl<'a> Condensed<'a> {
    /// Equations of a model in the harmonics of a table; call [`Condensed::set_omega`] next.
    pub fn new(
        model: impl Into<Evaluated<'a>>,
        table: &'a SampleTable,
        residual: Residual,
        slopes: bool,
    ) -> Self {
        let model = model.into();
        Self {
            linear: Linear::new(&model, table, slopes),
            slopes,
            fine: slopes,
            loads: vec![SlipLoad::sparing(); model.laws().len()],
            values: vec![SlipLoad::default(); model.laws().len()],
            model,
            table,
            residual,
            omega: f64::NAN,
            stuck: Vec::new(),
            moved_on: false,
            path: Path::Stiffness,
            load_scale: 1.0,
            loss: 0.0,
            softened: None,
            interrupted: None,
            granted: f64::INFINITY,
            factor: None,
            sizes: Vec::new(),
            by_products: ByProducts::default(),
            free: false,
            loose: false,
            profile: Profile::default(),
        }
    }

    /// Evaluates the compliances at a frequency.
    ///
    /// # Errors
    /// Singular static stiffness or an undamped resonance, with the harmonic concerned.
    pub fn set_omega(&mut self, omega: f64) -> Result<(), (usize, Error)> {
        self.set_omega_beside(omega, None)
    }

    /// [`Condensed::set_omega`] beside the equations in other harmonics, whose compliances are taken over.
    pub(super) fn set_omega_beside(
        &mut self,
        omega: f64,
        other: Option<&Self>,
    ) -> Result<(), (usize, Error)> {
        let harmonics = self.table.harmonics();
        let contacts = self.model.compliance().contacts();
        let slots = harmonics.slots();
        self.stuck.clear();
        self.stuck.resize(contacts * slots, 0.0);
        self.factor = None;
        self.omega = omega;
        let (linear, stuck, model) = (&mut self.linear, &mut self.stuck, &self.model);
        Profile::time(&mut self.profile.compliance, || {
            let known = other.map(|other| (&other.linear, other.harmonics()));
            linear.evaluate(model.compliance(), harmonics, omega, known, stuck)
        })
    }

    /// Takes dense receptances in any case, for methods that need the whole Jacobian.
    pub(super) fn densify(&mut self) {
        self.linear.densify(self.table, self.slopes);
    }

    /// Takes receptances of loads at some points alone, if dense ones are taken at all; those at others follow as
    /// they come to slip.
    pub(super) fn answer(&mut self, points: Vec<usize>) {
        if matches!(self.linear, Linear::Dense(_)) {
            self.linear = Linear::part(self.table, points);
        }
    }

    /// The equations of a curve, with the frequency unknown: by dense receptances unless the whole
    /// Jacobian is too large to be formed.
    pub(super) fn of_curve(
        model: Evaluated<'a>,
        table: &'a SampleTable,
        residual: Residual,
    ) -> Self {
        let mut equations = Self::new(model, table, residual, true);
        equations.fine = false;
        if !is_large(equations.model.compliance(), table.harmonics()) {
            equations.densify();
        }
        equations
    }

    /// Displacements of the DOFs `observe` at every kept order, handed to
    /// `store(order, values, u, q)`, with the contact displacements and slip loads that belong to them:
    /// the amplitudes of the series `x` and `slip_load`. Slopes are those of equations with slopes.
    ///
    /// # Errors
    /// As [`Condensed::set_omega`].
    pub(super) fn displacements(
        &self,
        quantity: Quantity,
        [x, slip_load]: [&[f64]; 2],
        observe: &[usize],
        mut store: impl FnMut(usize, &[c64], &[c64], &[c64]),
    ) -> Result<(), Error> {
        let (harmonics, omega) = (self.table.harmonics(), self.omega);
        let compliance = self.model.compliance();
        let contacts = compliance.contacts();
        let loads = [x, slip_load].map(|series| gather_all(harmonics, series));
        let requests = harmonics.orders().enumerate().map(|(index, harmonic)| {
            let own = index * contacts..(index + 1) * contacts;
            let (contact, slip_load) = (&loads[0][own.clone()], &loads[1][own]);
            Request { harmonic, omega, quantity, contact, slip_load, observe }
        });
        let requests: Vec<_> = requests.collect();
        let mut observed = vec![c64::new(0.0, 0.0); requests.len() * observe.len()];
        if !observe.is_empty() {
            let motion = self.linear.coordinates(compliance, harmonics, quantity, slip_load);
            let (motion, out) = (motion.as_ref(), &mut observed[..]);
            self.linear.displacements(compliance, harmonics, motion, &requests, out)?;
        }
        for (index, request) in requests.iter().enumerate() {
            let own = &observed[index * observe.len()..(index + 1) * observe.len()];
            store(request.harmonic, own, request.contact, request.slip_load);
        }
        Ok(())
    }

    /// Displacements, contact forces and slip shares of a solution, whose slip loads are those
    /// evaluated last.
    ///
    /// # Errors
    /// As [`Condensed::set_omega`].
    pub(super) fn recover(
        &self,
        x: &[f64],
        observe: &[usize],
        status: PointStatus,
    ) -> Result<Point, Error> {
        let (harmonics, model) = (self.harmonics(), &self.model);
        let contacts = model.compliance().contacts();
        let mut point = Point::empty(self.omega, status, observe.len(), contacts);
        point.keep(harmonics.highest());
        let orders = harmonics.highest() + 1;
        let stiffness = model.contact_stiffness();
        let solution = [x, &self.slip_load()];
        self.displacements(Quantity::Whole, solution, observe, |order, observed, u, q| {
            for (i, value) in observed.iter().enumerate() {
                point.displacement[i * orders + order] = *value;
            }
            // A contact's stiffness couples its own points alone.
            let points = model.points().iter().flat_map(|p| p.clone().map(move |i| (i, p)));
            for (i, own) in points {
                let stuck: c64 = own.clone().map(|j| u[j] * stiffness[(i, j)]).sum();
                point.contact_displacement[i * orders + order] = u[i];
                point.contact_force[i * orders + order] = stuck - q[i];
            }
        })?;
        point.contacts.fill(PointSummary::default());
        for (index, law) in model.laws().iter().enumerate() {
            let range = model.points()[index].clone();
            law.summary(self.motion(index, x), &mut point.contacts[range]);
        }
        point.from_stuck = self.apart_from_stuck(x);
        Ok(point)
    }

    /// Largest distance of the vibration of a contact point from that without slip, over its size: soft contacts that
    /// move far say nothing of stiff ones.
    fn apart_from_stuck(&self, x: &[f64]) -> f64 {
        let (slots, offset) = (self.harmonics().slots(), self.harmonics().offset());
        let points = x.chunks_exact(slots).zip(self.stuck.chunks_exact(slots));
        let far = points.map(|(x, stuck)| {
            let apart =
                x[offset..].iter().zip(&stuck[offset..]).map(|(x, stuck)| (x - stuck).powi(2));
            (apart.sum::<f64>() / x[offset..].iter().map(|x| x * x).sum::<f64>()).sqrt()
        });
        far.fold(f64::NAN, f64::max)
    }

    /// Adds `share` times the derivative of the contact forces in a parameter of a law at fixed
    /// displacements `x`.
    pub(super) fn add_force_rate(
        &self,
        [contact, parameter]: [usize; 2],
        x: &[f64],
        share: f64,
        out: &mut [f64],
    ) {
        let (slots, points) = (self.table.harmonics().slots(), &self.model.points()[contact]);
        let own = &mut out[points.start * slots..points.end * slots];
        let mut slope = vec![0.0; own.len()];
        self.model.laws()[contact].parameter_slope(self.motion(contact, x), parameter, &mut slope);
        own.iter_mut().zip(slope).for_each(|(rate, slope)| *rate += share * slope);
    }

    /// Has the iterations ask whether to end the analysis.
    pub fn watch(&mut self, interrupted: &'a dyn Fn() -> bool) {
        self.interrupted = Some(interrupted);
    }

    /// Chooses what the next homotopy scales.
    pub fn choose(&mut self, path: Path) {
        self.path = path;
    }

    /// The stuck response, which is the solution as long as nothing slips.
    pub fn stuck_response(&self) -> &[f64] {
        &self.stuck
    }

    /// Harmonics of the equations.
    pub fn harmonics(&self) -> &'a Harmonics {
        self.table.harmonics()
    }

    /// Motion of the points of contact `index`.
    pub fn motion<'b>(&'b self, index: usize, x: &'b [f64]) -> Motion<'b> {
        let slots = self.table.harmonics().slots();
        let points = &self.model.points()[index];
        Motion {
            table: self.table,
            displacement: &x[points.start * slots..points.end * slots],
            residual: self.residual,
        }
    }

    /// Slip load of all points at the last evaluated unknowns.
    pub fn slip_load(&self) -> Vec<f64> {
        let loads = if self.moved_on { &self.values } else { &self.loads };
        let mut slip_load = Vec::with_capacity(self.stuck.len());
        loads.iter().for_each(|load| slip_load.extend_from_slice(&load.value));
        slip_load
    }

    /// Whether no contact has a tangent at the unknowns whose tangents were evaluated last.
    pub fn is_linear(&self) -> bool {
        self.loads.iter().all(|load| !load.active)
    }

    /// Whether the contacts that slip at other unknowns are those that slip where the tangents are known.
    pub(super) fn keeps_states(&self, x: &[f64]) -> bool {
        let mut load = SlipLoad::default();
        self.model.laws().iter().enumerate().all(|(index, law)| {
            let motion = self.motion(index, x);
            let slips = law.surely_slips(motion).unwrap_or_else(|| {
                law.slip_load(motion, false, &mut load);
                load.active
            });
            slips == self.loads[index].active
        })
    }

    /// `out += G q` over all kept harmonics.
    pub fn add_response(&self, slip_load: &[f64], out: &mut [f64]) {
        self.linear.add_response(self.model.compliance(), self.table.harmonics(), slip_load, out);
    }

    /// Rate of change of the residual with frequency at fixed unknowns, sign reversed.
    pub fn frequency_rate(&self) -> Vec<f64> {
        let mut rate = vec![0.0; self.stuck.len()];
        let (compliance, harmonics) = (self.model.compliance(), self.table.harmonics());
        self.linear.add_rate(compliance, harmonics, &self.slip_load(), &mut rate);
        rate
    }

    /// The same with the ratio r of negative damping.
    pub fn ratio_rate(&self) -> Vec<f64> {
        let mut rate = vec![0.0; self.stuck.len()];
        self.linear.add_ratio_rate(self.table.harmonics(), &self.slip_load(), &mut rate);
        rate
    }

    /// `out += ∂Q x` at the unknowns whose tangents were evaluated last.
    pub fn add_tangent_product(&self, x: &[f64], out: &mut [f64]) {
        let slots = self.table.harmonics().slots();
        for (load, points) in self.loads.iter().zip(self.model.points()) {
            if !load.active {
                continue;
            }
            let range = points.start * slots..points.end * slots;
            let rows = load.tangent.chunks_exact(range.len());
            for (row, value) in rows.zip(&mut out[range.clone()]) {
                *value += row.iter().zip(&x[range.clone()]).map(|(t, x)| t * x).sum::<f64>();
            }
        }
    }

    /// Writes the slip load of a contact. Of one that surely sticks zeros are not worth their room: those of
    /// thousands take more time than all else.
    pub(super) fn write_load(
        &self,
        index: usize,
        motion: Motion<'_>,
        tangent: bool,
        load: &mut SlipLoad,
    ) {
        let law = &self.model.laws()[index];
        let sticks = self.loss == 0.0 && law.surely_sticks(motion);
        law.slip_load(motion, tangent && !sticks, load);
    }
}
