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
    /// The coefficients behind those of a state, in a regime that is connected.
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
