//! The condensed equations as a system for Newton's method and homotopy.
//!
//! The Newton direction is found from the slip loads that depend on the motion: [`SlipJacobian`].

use super::condensed::{Condensed, Path};
use super::krylov_newton::{KrylovNewton, Products, MOST_PRODUCTS};
use super::linear::{Factor, Linear};
use super::ring::{RingNewton, RingSeries};
use super::slip_jacobian::{Answers, Border, Loads, SlipJacobian};
use crate::contact::SlipLoad;
use crate::model::Model;
use crate::solve::{norm, Parametrised, System};
use crate::structure::{Compliance as _, ContactCoordinates, ModalOrders};
use crate::timing::Profile;
use faer::Mat;

/// Share of the largest contact force below which a contact counts as carrying nothing.
const CARRIES_NOTHING: f64 = 1e-3;

/// Loss, relative to the stiffness of contacts, whose end hardly moves a solution any more.
const LEAST_LOSS: f64 = 1e-12;

impl Condensed<'_> {
    /// Residual, with the tangents of the laws or without.
    fn evaluate(&mut self, x: &[f64], tangent: bool, out: &mut [f64]) {
        let mut loads = std::mem::take(if tangent { &mut self.loads } else { &mut self.values });
        if !tangent {
            let known = loads.iter_mut().zip(&self.loads);
            known.for_each(|(own, last)| own.repeated.clone_from(&last.repeated));
        }
        let mut law_time = std::time::Duration::ZERO;
        Profile::time(&mut law_time, || {
            for (index, load) in loads.iter_mut().enumerate() {
                let motion = self.motion(index, x);
                match &self.softened {
                    None => self.write_load(index, motion, tangent, load),
                    Some((share, laws)) => {
                        laws[index].slip_load(motion, tangent, load);
                        load.make_room(tangent);
                        self.add_lost_stiffness(index, 1.0 - share, motion, tangent, load);
                    }
                }
                if self.loss > 0.0 {
                    load.make_room(tangent);
                    self.add_loss(index, motion, tangent, load);
                }
            }
        });
        self.profile.law += law_time;
        self.profile.evaluations += 1;
        self.profile.work += self.work_of_laws(&loads, tangent);
        if tangent {
            self.loads = loads;
            self.factor = None;
            let slots = self.table.harmonics().slots();
            self.sizes = sizes(&self.model, slots, &self.slip_load(), x);
        } else {
            self.values = loads;
        }
        self.moved_on = !tangent;
        self.know_answers();
        out.fill(0.0);
        self.add_response(&self.slip_load(), out);
        for ((r, x), stuck) in out.iter_mut().zip(x).zip(&self.stuck) {
            *r = x - self.load_scale * stuck - *r;
        }
    }

    /// Sees to it that the answers to all slip loads are known, if those at some points are.
    fn know_answers(&mut self) {
        let loads = if self.moved_on { &self.values } else { &self.loads };
        let carries = |load: &&SlipLoad| load.active || load.value.iter().any(|q| *q != 0.0);
        let loaded = loads.iter().zip(self.model.points());
        let loaded =
            loaded.filter(|(load, _)| carries(load)).flat_map(|(_, points)| points.clone());
        let more = self.linear.unknown(loaded);
        if !more.is_empty() {
            let (compliance, harmonics) = (self.model.compliance(), self.table.harmonics());
            self.linear.include(more, compliance, harmonics, self.omega);
        }
    }

    pub(super) fn tangents(&self) -> Loads<'_> {
        let slots = self.table.harmonics().slots();
        Loads { loads: &self.loads, points: self.model.points(), slots }
    }

    /// Assembles and factors the equations of a Newton step.
    fn factorise(&mut self) {
        let harmonics = self.table.harmonics();
        let (active, mut yielding) = (self.active_points(), Vec::new());
        if matches!(self.linear, Linear::Modal(_)) {
            yielding = self.tangents().yielding_points();
        }
        let compliance = self.model.compliance();
        self.factor = match (&mut self.linear, compliance.ring()) {
            (Linear::Modal(orders), _) => {
                let rough = (!self.fine).then_some(&*orders);
                let (points, slots) = (self.model.points(), harmonics.slots());
                let loads = Loads { loads: &self.loads, points, slots };
                let krylov = KrylovNewton::new(compliance, [&active, &yielding], loads, rough);
                Some(Factor::Krylov(krylov))
            }
            (Linear::Ring { orders, .. }, Some(ring)) => {
                Some(if RingNewton::suits(ring, harmonics.slots(), active.len()) {
                    Factor::Ring(Box::new(RingNewton::new(
                        RingSeries::new(orders, harmonics),
                        ring.layout(),
                        &self.loads,
                        self.model.points(),
                    )))
                } else {
                    orders.iter_mut().for_each(|order| order.ask(&active, ring.contacts()));
                    let answers = Answers::of_ring(orders, harmonics, ring.contacts(), &active);
                    Factor::Dense(SlipJacobian::new(self.tangents(), &answers, None))
                })
            }
            (Linear::Dense(receptances), _) => {
                let answers = Answers::new(receptances, harmonics);
                Some(Factor::Dense(SlipJacobian::new(self.tangents(), &answers, None)))
            }
            (Linear::Part { points, receptances }, _) => {
                let contacts = compliance.contacts();
                let answers = Answers::of_part(receptances, harmonics, contacts, points);
                Some(Factor::Dense(SlipJacobian::new(self.tangents(), &answers, None)))
            }
            _ => None,
        };
    }

    /// Solves the equations linearised in the displacements and a parameter of a size, with one more equation
    /// of the coefficients `row`, as `right` says; `rate` is the rate of change of the residual with the
    /// parameter, sign reversed. The sign is that of the determinant, or 0 where no matrix is formed.
    pub(super) fn solve_bordered(
        &mut self,
        (rate, size): (&[f64], f64),
        row: &[f64],
        right: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let start = std::time::Instant::now();
        let border = Border { rate, row, omega: size };
        let (harmonics, loads) = (self.table.harmonics(), self.tangents());
        let (step, sign) = match &self.linear {
            Linear::Dense(receptances) => {
                let answers = Answers::new(receptances, harmonics);
                let factors = SlipJacobian::new(loads, &answers, Some(&border));
                let answer = |q: &[f64], out: &mut [f64]| self.add_response(q, out);
                let solved = factors.solve_bordered(loads, answer, &border, right);
                self.profile.factorisations += 1;
                self.profile.work += self.work_of_factors();
                solved
            }
            Linear::Modal(orders) => {
                let modes = self.model.compliance().contact_modes()?;
                let points = [&self.active_points()[..], &[]];
                let krylov = KrylovNewton::new(self.model.compliance(), points, loads, None);
                let (step, count) =
                    krylov.solve_bordered(self.products(modes, orders), &border, right)?;
                self.profile.products += count;
                (step, 0.0)
            }
            Linear::Ring { .. } | Linear::Part { .. } => return None,
        };
        self.profile.linear_solve += start.elapsed();
        step.iter().all(|s| s.is_finite()).then_some((step, sign))
    }

    /// Points of the contacts that yield.
    pub(super) fn active_points(&self) -> Vec<usize> {
        (self.loads.iter().zip(self.model.points()))
            .filter(|(load, _)| load.active)
            .flat_map(|(_, points)| points.clone())
            .collect()
    }

    pub(super) fn products<'b>(
        &'b self,
        modes: &'b dyn ContactCoordinates,
        orders: &'b ModalOrders,
    ) -> Products<'b> {
        Products {
            modes,
            orders,
            loads: self.tangents(),
            sizes: &self.sizes,
            fine: self.fine,
            most: self.by_products.most.unwrap_or(MOST_PRODUCTS),
            interrupted: self.interrupted,
        }
    }
}

/// Size of the motion of every point: a stiff contact moves little, and its force is its stiffness
/// times that little. A contact that carries next to nothing is measured against the largest force.
fn sizes(model: &Model, slots: usize, slip_load: &[f64], x: &[f64]) -> Vec<f64> {
    let stiffness = |i: usize| model.contact_stiffness()[(i, i)];
    let force = |i: usize, u: &[f64], q: &[f64]| {
        u.iter().zip(q).map(|(u, q)| (stiffness(i) * u - q).powi(2)).sum::<f64>().sqrt()
    };
    let points = || x.chunks_exact(slots).zip(slip_load.chunks_exact(slots)).enumerate();
    let largest = points().map(|(i, (u, q))| force(i, u, q)).fold(0.0, f64::max);
    let size = norm(x);
    points()
        .map(|(i, (u, _))| {
            let least = CARRIES_NOTHING * largest / stiffness(i).max(f64::MIN_POSITIVE);
            norm(u).max(least.min(size)).max(f64::MIN_POSITIVE)
        })
        .collect()
}

/// Size of a step contact by contact.
fn contactwise(model: &Model, slots: usize, slip_load: &[f64], step: &[f64], x: &[f64]) -> f64 {
    let sizes = sizes(model, slots, slip_load, x);
    step.chunks_exact(slots).zip(sizes).map(|(s, size)| norm(s) / size).fold(0.0, f64::max)
}

impl System for Condensed<'_> {
    fn size(&self) -> usize {
        self.stuck.len()
    }

    fn residual(&mut self, x: &[f64], out: &mut [f64]) {
        self.evaluate(x, true, out);
    }

    fn value(&mut self, x: &[f64], out: &mut [f64]) {
        self.evaluate(x, false, out);
    }

    fn jacobian(&mut self, x: &[f64], residual: &mut [f64], out: &mut Mat<f64>) {
        self.evaluate(x, true, residual);
        let start = std::time::Instant::now();
        *out = self.assemble_all();
        self.profile.linear_solve += start.elapsed();
    }

    fn relative_size(&self, step: &[f64], x: &[f64]) -> f64 {
        let slots = self.table.harmonics().slots();
        contactwise(&self.model, slots, &self.slip_load(), step, x)
    }

    fn interrupted(&self) -> bool {
        self.interrupted.is_some_and(|ask| ask())
    }

    fn is_spent(&self) -> bool {
        self.profile.work >= self.granted
    }

    fn solve(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        let start = std::time::Instant::now();
        step.copy_from_slice(rhs);
        if self.is_linear() {
            return true;
        }
        if self.factor.is_none() {
            self.take_products_again();
            self.factorise();
            self.profile.factorisations += 1;
            self.profile.work += self.work_of_factors();
        }
        if matches!(self.factor, Some(Factor::Krylov(_))) && !self.solve_by_products(rhs, step) {
            if self.interrupted() || !self.form_instead() {
                return false;
            }
            self.factorise();
            self.profile.factorisations += 1;
            self.profile.work += self.work_of_factors();
        }
        let harmonics = self.table.harmonics();
        match (&self.factor, &self.linear) {
            (Some(Factor::Dense(factor)), _) => {
                factor.solve(self.tangents(), |q, out| self.add_response(q, out), rhs, step);
            }
            (Some(Factor::Ring(factor)), Linear::Ring { orders, .. }) => {
                factor.solve(RingSeries::new(orders, harmonics), rhs, step);
            }
            // Found already.
            (Some(Factor::Krylov(_)), Linear::Modal(_)) => {}
            _ => return false,
        }
        self.profile.linear_solve += start.elapsed();
        self.judge_mean(step, norm(rhs));
        if !self.free {
            self.form_if_cheaper();
        }
        !self.free && step.iter().all(|s| s.is_finite())
    }
}

impl Parametrised for Condensed<'_> {
    fn set_scale(&mut self, scale: f64) {
        match self.path {
            Path::Load => self.load_scale = scale,
            Path::Loss => self.loss = LEAST_LOSS * (scale.powi(-4) - 1.0),
            Path::Stiffness => {
                let soften = || {
                    self.model.laws().iter().map(|law| law.with_scaled_stiffness(scale)).collect()
                };
                self.softened = (scale < 1.0).then(|| (scale, soften()));
            }
        }
    }

    /// Whether nothing holds the mean of many contacts in the last direction that was asked for, or products
    /// lead to none and a matrix is too large.
    fn is_lost(&self) -> bool {
        let by_products = matches!(self.linear, Linear::Modal(_));
        let of_many = by_products || self.by_products.replaced;
        of_many && self.free || by_products && self.by_products.are_lost()
    }

    fn easy_start(&self, x: &mut [f64]) {
        match self.path {
            Path::Stiffness => {}
            Path::Load => {
                x.iter_mut().zip(&self.stuck).for_each(|(x, stuck)| *x = self.load_scale * stuck);
            }
            Path::Loss => x.fill(0.0),
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
    use crate::contact::Residual;
    use crate::fourier::{Harmonics, SampleTable};
    use crate::model::Contact;
    use crate::structure::{HarmonicLoad, Structure};
    use faer::c64;
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
