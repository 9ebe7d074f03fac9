//! The coefficients of a linear motion of a few modes, which the springs of the contacts couple: with these among
//! the stiffness of the modes each power follows from the two before, and contacts follow behind all of them.

use super::modal_system::ModalSystem;
use super::polynomial::DEGREE;
use super::power_series::PowerSeries;

/// Modes of which this takes less than products mode after mode and contact after contact.
pub(super) const FEW: usize = 8;

/// Stiffness and damping of W modes or less, column after column, in units of the series.
struct Coupled<const W: usize> {
    stiffness: [[f64; W]; W],
    damping: [[f64; W]; W],
}

impl PowerSeries {
    /// As [`PowerSeries::expand_many`], of a linear motion of few modes.
    pub(super) fn expand_few(&mut self, system: &ModalSystem, loads: &mut [(f64, [f64; 2])]) {
        if self.modes <= FEW / 2 {
            self.expand_coupled::<{ FEW / 2 }>(system, loads);
        } else {
            self.expand_coupled::<FEW>(system, loads);
        }
        for point in (0..system.points()).filter(|point| system.is_felt(*point)) {
            let shape = system.contact_shape(point);
            let series = self.contact[point * (DEGREE + 1)..].iter_mut();
            for (u, modal) in series.zip(self.modal.chunks_exact(self.modes)) {
                *u = shape.iter().zip(modal).map(|(b, x)| b * x).sum();
            }
        }
        (1..=DEGREE).for_each(|power| self.load_contacts(power));
    }

    fn expand_coupled<const W: usize>(
        &mut self,
        system: &ModalSystem,
        loads: &mut [(f64, [f64; 2])],
    ) {
        let (n, square) = (self.modes, self.rate * self.rate);
        let own = self.coupled::<W>(system);
        // The forces at the start are those of the state.
        let mut held = [0.0; W];
        for (point, force) in self.force.chunks_exact(DEGREE + 1).enumerate() {
            let shape = system.contact_shape(point);
            held.iter_mut().zip(shape).for_each(|(held, b)| *held -= b * force[0] / square);
        }
        let (mut here, mut ahead) = ([0.0; W], [0.0; W]);
        here[..n].copy_from_slice(&self.modal[..n]);
        ahead[..n].copy_from_slice(&self.modal[n..2 * n]);
        for (power, next) in self.modal[2 * n..].chunks_exact_mut(n).enumerate() {
            let order = (power + 1) as f64;
            let mut sum = [0.0; W];
            if power == 0 {
                sum = held;
                let parts = sum.iter_mut().zip(&self.stiffness).zip(&here);
                parts.for_each(|((sum, w), x)| *sum -= w * x);
            } else {
                subtract(&own.stiffness[..n], &here, &mut sum);
            }
            let speed = ahead.map(|v| order * v);
            subtract(&own.damping[..n], &speed, &mut sum);
            for ((_, load), (frequency, wave)) in system.loads.iter().zip(&mut *loads) {
                let [re, im] = wave.map(|part| part / square);
                sum.iter_mut().zip(load).for_each(|(sum, p)| *sum += p.re * re - p.im * im);
                let step = *frequency / order;
                *wave = [-step * wave[1], step * wave[0]];
            }
            let share = 1.0 / (order * (order + 1.0));
            (here, ahead) = (ahead, sum.map(|sum| share * sum));
            next.copy_from_slice(&ahead[..n]);
        }
    }

    fn coupled<const W: usize>(&self, system: &ModalSystem) -> Coupled<W> {
        let [mut stiffness, mut damping] = [[[0.0; W]; W]; 2];
        for (j, w) in self.stiffness.iter().enumerate() {
            stiffness[j][j] = *w;
            for (i, own) in damping[j][..self.modes].iter_mut().enumerate() {
                *own = system.damping.entry(i, j) / self.rate;
            }
        }
        for &(to, from, k) in &self.springs {
            let (k, shape) = (k / (self.rate * self.rate), system.contact_shape(to));
            for (column, b) in stiffness.iter_mut().zip(system.contact_shape(from)) {
                column.iter_mut().zip(shape).for_each(|(own, to)| *own += k * b * to);
            }
        }
        Coupled { stiffness, damping }
    }
}

/// `out −= Σ column x`.
#[inline(always)]
fn subtract<const W: usize>(columns: &[[f64; W]], x: &[f64; W], out: &mut [f64; W]) {
    for (column, x) in columns.iter().zip(x) {
        out.iter_mut().zip(column).for_each(|(out, a)| *out -= a * x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Jenkins, PointState, StructuralDamper};
    use crate::model::{Contact, Model};
    use crate::motion::{ContactState, State};
    use crate::structure::{HarmonicLoad, Structure};
    use faer::{c64, mat, Mat};

    const OMEGA: f64 = 1.3;
    /// Of terms that grow to some hundred times their sum.
    const ROUNDING: f64 = 1e-13;

    /// Masses on springs, three of them joined by a damper and one on an element of its own; damping of any kind.
    fn model(size: usize, coupled: bool) -> Model {
        let damping = Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => 0.3 + 0.1 * i as f64,
            1 if coupled => -0.1,
            _ => 0.0,
        });
        let stiffness = Mat::from_fn(size, size, |i, j| if i == j { 1.0 + i as f64 } else { 0.0 });
        let mass = Mat::<f64>::identity(size, size);
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
        let damper = mat![[3.0, -2.4, -0.5], [-2.4, 3.4, -0.8], [-0.5, -0.8, 1.5]];
        let law = StructuralDamper::new(damper.as_ref(), &[0.2, 0.5, 0.3]).unwrap();
        let rows =
            |count, first| Mat::from_fn(count, size, |i, j| f64::from(u8::from(i + first == j)));
        let contacts = vec![
            Contact { law: Box::new(law), rows: rows(3, 0) },
            Contact { law: Box::new(Jenkins::new(2.0, 0.4).unwrap()), rows: rows(1, size - 1) },
        ];
        let amplitude = (0..size).map(|i| c64::new(1.0, i as f64)).collect();
        let loads = vec![HarmonicLoad { harmonic: 3, amplitude }];
        Model::new(structure.unwrap(), contacts, loads).unwrap()
    }

    /// In every state of the contacts the coefficients are those that mode after mode and contact after contact give.
    #[test]
    fn a_few_modes_together_have_the_coefficients_of_each() {
        for (size, coupled) in [(3, false), (4, true), (5, true), (8, false)] {
            let model = model(size, coupled);
            let system = ModalSystem::new(&model).unwrap();
            let mut state = State::rest(&system);
            state.time = 0.4;
            state
                .displacement
                .iter_mut()
                .enumerate()
                .for_each(|(j, x)| *x = (j as f64 + 1.0).sin());
            state.velocity.iter_mut().enumerate().for_each(|(j, v)| *v = (2.0 * j as f64).cos());
            state.force.copy_from_slice(&[0.1, -0.5, 0.2, 0.4]);
            for slipping in 0..16 {
                for (i, point) in state.points.iter_mut().enumerate() {
                    let slips = slipping >> i & 1 == 1;
                    *point = if slips { PointState::slipping(1.0) } else { PointState::Stuck };
                }
                let regime = ContactState::new(&system, &state.points);
                let (sin, cos) = (3.0 * OMEGA * state.time).sin_cos();
                let mut both = [(); 2].map(|()| PowerSeries::new(&system, OMEGA));
                for (number, own) in both.iter_mut().enumerate() {
                    let mut loads = [(3.0 * OMEGA / own.rate(), [cos, sin])];
                    own.begin([&state.displacement, &state.velocity, &state.force]);
                    own.connect(&system, &regime);
                    if number == 0 {
                        own.expand_few(&system, &mut loads);
                    } else {
                        own.expand_many(&system, &mut loads);
                    }
                }
                let [few, many] = &both;
                for (few, many) in [
                    (&few.modal, &many.modal),
                    (&few.contact, &many.contact),
                    (&few.force, &many.force),
                ] {
                    let largest = many.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
                    let off = few.iter().zip(many).map(|(a, b)| (a - b).abs());
                    let off = off.fold(0.0, f64::max);
                    assert!(off <= ROUNDING * largest, "{size} {slipping} {off:e}");
                }
                let end = DEGREE * size;
                assert!(many.modal[end..].iter().any(|a| *a != 0.0));
            }
        }
    }
}
