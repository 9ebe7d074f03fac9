//! The condensed equations at one frequency: `R(U) = U − μ U^stuck − G Q(U)`.
//!
//! The Jacobian `I − G ∂Q` has nontrivial columns only for contacts that slip; the Newton
//! direction is found from their block and carried to the stuck contacts by substitution.

use super::unknowns::scatter;
use crate::contact::{FrictionLaw, Motion, Residual, SlipLoad};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::solve::{norm, Parametrised, System};
use crate::structure::Receptance;
use crate::timing::Profile;
use crate::Error;
use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{c64, Mat};

/// Share of the largest contact force below which a contact counts as carrying nothing.
const CARRIES_NOTHING: f64 = 1e-3;

/// What a homotopy scales, from easy to the problem at hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Path {
    /// The external load: at small load everything sticks.
    Load,
    /// The stiffness of the contacts: soft contacts make a smooth problem.
    Stiffness,
}

/// The equations at one frequency and set of harmonics.
pub struct Condensed<'a> {
    model: &'a Model,
    table: &'a SampleTable,
    residual: Residual,
    /// One receptance per kept order.
    receptances: Vec<Receptance>,
    stuck: Vec<f64>,
    loads: Vec<SlipLoad>,
    path: Path,
    load_scale: f64,
    /// Softened laws and their share of the stiffness, while a homotopy in it is under way.
    softened: Option<(f64, Vec<Box<dyn FrictionLaw>>)>,
    interrupted: Option<&'a dyn Fn() -> bool>,
    factor: Option<PartialPivLu<f64>>,
    /// Points of contacts with a tangent, of the last factorisation.
    active: Vec<usize>,
    pub(super) profile: Profile,
}

impl<'a> Condensed<'a> {
    /// Equations of a model in the harmonics of a table; call [`Condensed::set_omega`] next.
    pub fn new(model: &'a Model, table: &'a SampleTable, residual: Residual, slopes: bool) -> Self {
        let blank = Receptance { slope: slopes.then(Default::default), ..Receptance::default() };
        Self {
            model,
            table,
            residual,
            receptances: vec![blank; table.harmonics().orders().count()],
            stuck: Vec::new(),
            loads: vec![SlipLoad::default(); model.laws().len()],
            path: Path::Load,
            load_scale: 1.0,
            softened: None,
            interrupted: None,
            factor: None,
            active: Vec::new(),
            profile: Profile::default(),
        }
    }

    /// Evaluates the compliances at a frequency.
    ///
    /// # Errors
    /// Singular static stiffness or an undamped resonance, with the harmonic concerned.
    pub fn set_omega(&mut self, omega: f64) -> Result<(), (usize, Error)> {
        let harmonics = self.table.harmonics();
        let contacts = self.model.compliance().contacts();
        let slots = harmonics.slots();
        self.stuck.clear();
        self.stuck.resize(contacts * slots, 0.0);
        self.factor = None;
        let (receptances, model) = (&mut self.receptances, self.model);
        Profile::time(&mut self.profile.compliance, || {
            for (receptance, order) in receptances.iter_mut().zip(harmonics.orders()) {
                model
                    .compliance()
                    .receptance(order, omega, receptance)
                    .map_err(|error| (order, error))?;
            }
            Ok(())
        })?;
        for (receptance, order) in self.receptances.iter().zip(harmonics.orders()) {
            scatter(harmonics, order, &receptance.stuck, &mut self.stuck);
        }
        Ok(())
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
        self.loads.iter().flat_map(|load| load.value.iter().copied()).collect()
    }

    /// Whether no contact has a tangent at the last evaluated unknowns.
    pub fn is_linear(&self) -> bool {
        self.loads.iter().all(|load| !load.active)
    }

    /// `out += G q` over all kept harmonics.
    pub fn add_response(&self, slip_load: &[f64], out: &mut [f64]) {
        self.add_product(slip_load, out, |receptance| &receptance.contact);
    }

    /// Rate of change of the residual with frequency at fixed unknowns, sign reversed.
    pub fn frequency_rate(&self) -> Vec<f64> {
        let harmonics = self.table.harmonics();
        let mut rate = vec![0.0; self.stuck.len()];
        for (receptance, order) in self.receptances.iter().zip(harmonics.orders()) {
            if let Some((_, stuck)) = &receptance.slope {
                scatter(harmonics, order, stuck, &mut rate);
            }
        }
        self.add_product(&self.slip_load(), &mut rate, |receptance| {
            receptance.slope.as_ref().map_or(&[], |(contact, _)| contact)
        });
        rate
    }

    /// `out += ∂Q x` at the last evaluated unknowns.
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

    fn add_product(
        &self,
        slip_load: &[f64],
        out: &mut [f64],
        matrix: impl Fn(&Receptance) -> &[c64],
    ) {
        let harmonics = self.table.harmonics();
        let slots = harmonics.slots();
        let contacts = self.model.compliance().contacts();
        for (receptance, order) in self.receptances.iter().zip(harmonics.orders()) {
            let Some(slot) = harmonics.slot(order) else { continue };
            let g = matrix(receptance);
            if g.is_empty() {
                continue;
            }
            for column in 0..contacts {
                let at = column * slots + slot;
                let q = if order == 0 {
                    c64::new(slip_load[at], 0.0)
                } else {
                    c64::new(slip_load[at], -slip_load[at + 1])
                };
                if q == c64::new(0.0, 0.0) {
                    continue;
                }
                for row in 0..contacts {
                    let u = g[column * contacts + row] * q;
                    out[row * slots + slot] += u.re;
                    if order > 0 {
                        out[row * slots + slot + 1] -= u.im;
                    }
                }
            }
        }
    }

    /// Adds to the slip load of a softened contact what its lost stiffness takes off the force,
    /// `q = (1 − λ) D u + q_λ(u)`: the compliance goes on carrying the full stiffness.
    fn add_lost_stiffness(
        &self,
        index: usize,
        share: f64,
        motion: Motion<'_>,
        load: &mut SlipLoad,
    ) {
        let slots = self.table.harmonics().slots();
        let points = &self.model.points()[index];
        let size = points.len() * slots;
        for (i, row) in points.clone().enumerate() {
            for (j, column) in points.clone().enumerate() {
                let lost = share * self.model.contact_stiffness()[(row, column)];
                for slot in 0..slots {
                    load.value[i * slots + slot] += lost * motion.displacement[j * slots + slot];
                    load.tangent[(i * slots + slot) * size + j * slots + slot] += lost;
                }
            }
        }
        load.active = true;
    }

    /// Assembles and factors `I − G_AA ∂Q_A` of the active points.
    fn factorise(&mut self) {
        let slots = self.table.harmonics().slots();
        self.active.clear();
        for (load, points) in self.loads.iter().zip(self.model.points()) {
            if load.active {
                self.active.extend(points.clone());
            }
        }
        let mut matrix = Mat::<f64>::identity(self.active.len() * slots, self.active.len() * slots);
        let mut first = 0;
        for (load, points) in self.loads.iter().zip(self.model.points()) {
            if load.active {
                self.subtract_contact(load, points.clone(), first, &mut matrix);
                first += points.len();
            }
        }
        self.factor = Some(matrix.partial_piv_lu());
    }

    /// Subtracts `G ∂Q` of one contact, whose first active column block is `first`.
    fn subtract_contact(
        &self,
        load: &SlipLoad,
        points: std::ops::Range<usize>,
        first: usize,
        matrix: &mut Mat<f64>,
    ) {
        let harmonics = self.table.harmonics();
        let slots = harmonics.slots();
        let contacts = self.model.compliance().contacts();
        let size = points.len() * slots;
        for (receptance, order) in self.receptances.iter().zip(harmonics.orders()) {
            let Some(slot) = harmonics.slot(order) else { continue };
            for (row, &point) in self.active.iter().enumerate() {
                let target = row * slots + slot;
                for (local, source) in points.clone().enumerate() {
                    let g = receptance.contact[source * contacts + point];
                    let cosines = &load.tangent[(local * slots + slot) * size..][..size];
                    if order == 0 {
                        for (j, dq) in cosines.iter().enumerate() {
                            matrix[(target, first * slots + j)] -= g.re * dq;
                        }
                        continue;
                    }
                    let sines = &load.tangent[(local * slots + slot + 1) * size..][..size];
                    for (j, (a, b)) in cosines.iter().zip(sines).enumerate() {
                        let column = first * slots + j;
                        matrix[(target, column)] -= g.re * a + g.im * b;
                        matrix[(target + 1, column)] -= g.re * b - g.im * a;
                    }
                }
            }
        }
    }
}

impl System for Condensed<'_> {
    fn size(&self) -> usize {
        self.stuck.len()
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        let mut loads = std::mem::take(&mut self.loads);
        let mut law_time = std::time::Duration::ZERO;
        Profile::time(&mut law_time, || {
            for (index, load) in loads.iter_mut().enumerate() {
                let motion = self.motion(index, x);
                match &self.softened {
                    None => self.model.laws()[index].slip_load(motion, true, load),
                    Some((share, laws)) => {
                        laws[index].slip_load(motion, true, load);
                        self.add_lost_stiffness(index, 1.0 - share, motion, load);
                    }
                }
            }
        });
        self.profile.law += law_time;
        self.profile.evaluations += 1;
        self.loads = loads;
        self.factor = None;
        out.fill(0.0);
        self.add_response(&self.slip_load(), out);
        for ((r, x), stuck) in out.iter_mut().zip(x).zip(&self.stuck) {
            *r = x - self.load_scale * stuck - *r;
        }
    }

    /// Contact by contact: a stiff contact moves little, and its force is its stiffness times that
    /// little. A contact that carries next to nothing is measured against the largest force.
    fn relative_size(&self, step: &[f64], x: &[f64]) -> f64 {
        let slots = self.table.harmonics().slots();
        let stiffness = |i: usize| self.model.contact_stiffness()[(i, i)];
        let force = |i: usize, u: &[f64], q: &[f64]| {
            let f: Vec<f64> = u.iter().zip(q).map(|(u, q)| stiffness(i) * u - q).collect();
            norm(&f)
        };
        let slip_load = self.slip_load();
        let points = || {
            let parts = x.chunks_exact(slots).zip(slip_load.chunks_exact(slots));
            parts.zip(step.chunks_exact(slots)).enumerate()
        };
        let largest = points().map(|(i, ((u, q), _))| force(i, u, q)).fold(0.0, f64::max);
        points()
            .map(|(i, ((u, _), step))| {
                let least = CARRIES_NOTHING * largest / stiffness(i).max(f64::MIN_POSITIVE);
                let reference = norm(u).max(least.min(norm(x))).max(f64::MIN_POSITIVE);
                norm(step) / reference
            })
            .fold(0.0, f64::max)
    }

    fn interrupted(&self) -> bool {
        self.interrupted.is_some_and(|ask| ask())
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        let start = std::time::Instant::now();
        let slots = self.table.harmonics().slots();
        step.copy_from_slice(rhs);
        if self.is_linear() {
            return true;
        }
        if self.factor.is_none() {
            self.factorise();
            self.profile.factorisations += 1;
        }
        let Some(factor) = &self.factor else { return false };
        let mut block = Mat::from_fn(self.active.len() * slots, 1, |i, _| {
            rhs[self.active[i / slots] * slots + i % slots]
        });
        factor.solve_in_place(&mut block);
        // Active points take the block's solution; the others follow from step = rhs + G ∂Q step.
        let mut active_step = vec![0.0; step.len()];
        for i in 0..block.nrows() {
            active_step[self.active[i / slots] * slots + i % slots] = block[(i, 0)];
        }
        if self.active.len() * slots < step.len() {
            let mut change = vec![0.0; step.len()];
            self.add_tangent_product(&active_step, &mut change);
            self.add_response(&change, step);
        }
        for &point in &self.active {
            let range = point * slots..(point + 1) * slots;
            step[range.clone()].copy_from_slice(&active_step[range]);
        }
        self.profile.linear_solve += start.elapsed();
        step.iter().all(|s| s.is_finite())
    }
}

impl Parametrised for Condensed<'_> {
    fn set_scale(&mut self, scale: f64) {
        match self.path {
            Path::Load => self.load_scale = scale,
            Path::Stiffness => {
                let soften = || self.model.laws().iter().map(|law| law.softened(scale)).collect();
                self.softened = (scale < 1.0).then(|| (scale, soften()));
            }
        }
    }

    fn easy_start(&self, x: &mut [f64]) {
        if self.path == Path::Load {
            x.iter_mut().zip(&self.stuck).for_each(|(x, stuck)| *x = self.load_scale * stuck);
        }
    }

    fn predict(&self, growth: f64, x: &mut [f64]) {
        // Beyond the onset of slip a solution grows roughly with its load.
        if self.path == Path::Load {
            x.iter_mut().for_each(|x| *x *= growth);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Jenkins;
    use crate::model::Contact;
    use crate::structure::{HarmonicLoad, Structure};
    use faer::mat;

    /// Two masses with one contact that slips, one between the masses and one that sticks.
    fn model(static_load: f64) -> Model {
        let mass = mat![[2.0, 0.1], [0.1, 1.0]];
        let stiffness = mat![[300.0, -100.0], [-100.0, 150.0]];
        let damping = mat![[0.5, -0.1], [0.2, 0.4]];
        let structure =
            Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
        let contact = |row: [f64; 2], stiffness, slip_force| Contact {
            law: Box::new(Jenkins::new(stiffness, slip_force).unwrap()),
            rows: Mat::from_fn(1, 2, |_, j| row[j]),
        };
        let contacts = vec![
            contact([1.0, 0.0], 80.0, 0.3),
            contact([1.0, -1.0], 200.0, 0.2),
            contact([0.0, 1.0], 50.0, 1e4),
        ];
        let load = |harmonic, force: f64| HarmonicLoad {
            harmonic,
            amplitude: vec![c64::new(force, 0.2 * force), c64::new(-0.3 * force, 0.0)],
        };
        Model::new(structure, contacts, vec![load(1, 4.0), load(0, static_load)]).unwrap()
    }

    #[test]
    fn newton_directions_match_differences_of_the_residual() {
        for (static_load, half_wave) in [(0.0, true), (3.0, false)] {
            let model = model(static_load);
            let table = SampleTable::new(Harmonics::new(5, half_wave));
            let mut equations = Condensed::new(&model, &table, Residual::Centred, false);
            equations.set_omega(9.0).unwrap();
            let size = equations.size();
            let x: Vec<f64> =
                (0..size).map(|i| 0.02 * (1.0 + i as f64).sin() / (1.0 + i as f64 / 3.0)).collect();
            let (mut ahead, mut behind) = (vec![0.0; size], vec![0.0; size]);
            let rhs: Vec<f64> = (0..size).map(|i| (0.7 * i as f64).cos()).collect();
            let mut step = vec![0.0; size];
            equations.residual(&x, &mut ahead);
            assert!(equations.loads[0].active && equations.loads[1].active);
            assert_eq!(equations.loads[2].active, !half_wave);
            assert!(equations.solve(&rhs, &mut step));
            let h = 1e-7 / norm_max(&step);
            let shifted = |sign: f64| -> Vec<f64> {
                x.iter().zip(&step).map(|(x, s)| x + sign * h * s).collect()
            };
            equations.residual(&shifted(1.0), &mut ahead);
            equations.residual(&shifted(-1.0), &mut behind);
            for ((a, b), expected) in ahead.iter().zip(&behind).zip(&rhs) {
                let difference = (a - b) / (2.0 * h);
                assert!((difference - expected).abs() < 1e-6, "{difference} {expected}");
            }
        }
    }

    fn norm_max(x: &[f64]) -> f64 {
        x.iter().map(|v| v.abs()).fold(0.0, f64::max)
    }
}
