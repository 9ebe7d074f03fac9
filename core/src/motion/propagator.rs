//! Disturbances over a stretch in which the equations are linear: the exponential of their matrix.
//!
//! Strains follow the displacements, `g = r + R η` with a constant r, so that they need no equations of their
//! own: `η'' + C η' + (Ω² + G R) η = −G r`.

use super::contact_state::Springs;
use super::damping::Damping;
use super::exponential::{exponential, Driven};
use super::oscillator::Oscillator;
use super::quadrature::Quadrature;
use crate::solve::{dot, multiply};
use faer::{Accum, Mat};

/// Numbers of all exponentials that are kept, and how many of them.
const ROOM: usize = 1 << 23;
const MOST: usize = 1 << 9;
/// Ratio of the frequencies of two motions from which on exponentials of one serve for the other no more.
const ALIKE: f64 = 2.0;
/// Term of such a series, relative to the states, that is none.
const ROUNDING: f64 = 1e-18;
/// The same where a step of Newton's method is all that disturbances are for.
const ROUGH: f64 = 1e-10;
/// Modes up to which products of matrices of any size cost the same.
const FEW: usize = 8;
/// Columns that such a series takes at a time.
const COLUMNS: usize = 48;

/// The exponential over a stretch.
#[derive(Debug)]
pub(super) struct Propagator {
    springs: Springs,
    strains: Vec<usize>,
    pub(super) duration: f64,
    /// The units of its displacements, s per mode [rad/s].
    pub(super) scale: Vec<f64>,
    pub(super) exponential: Driven,
    /// When it served last.
    served: usize,
}

/// Those of the stretches of some motions: of another one next to them, stretches are a little longer or shorter.
#[derive(Debug, Default)]
pub(crate) struct Propagators {
    known: Vec<Propagator>,
    numbers: usize,
    /// Stretches so far.
    stretches: usize,
    /// The frequency whose motions have the units of displacements that all exponentials have \[rad/s\].
    pub(super) pace: f64,
    pub(super) quadrature: Quadrature,
    /// Whether what disturbances lag by need not be exact to rounding.
    pub(crate) rough: bool,
    /// Room for states: a stretch finds that of the one before in the cache.
    pub(super) spare: Vec<Mat<f64>>,
}

/// How far the end of a step may be from that of its stretch, in units of the fastest rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    /// Stretches up to this length take no step of their own.
    pub(super) short: f64,
    /// Steps that are known serve up to this difference.
    pub(super) close: f64,
}

impl Reach {
    /// Where a power series of all disturbances makes up for it: it takes fewer operations than an exponential.
    pub(super) const CAUGHT_UP: Self = Self { short: 3.0, close: 1.0 };
    /// Where disturbances lag through a change of regime, at the price of a few vectors.
    pub(super) const LAGGING: Self = Self { short: 0.0, close: 16.0 };
}

/// Equations of the disturbances in one state of the contacts, in coordinates `(s η, η')`.
pub(super) struct Equations {
    /// s per mode [rad/s].
    pub(super) scale: Vec<f64>,
    /// Strains that move or are disturbed.
    pub(super) strains: Vec<usize>,
    /// `R / s`, strains × modes.
    pub(super) rates: Mat<f64>,
    /// `(Ω² + G R) / s`, modes × modes.
    pub(super) stiffness: Mat<f64>,
    /// C.
    pub(super) damping: Damping,
    /// `−G`, modes × strains.
    pub(super) input: Mat<f64>,
    /// The contacts.
    pub(super) springs: Springs,
}

impl Equations {
    /// Adds the strains of displacements to others, with a sign.
    pub(super) fn add_strains(&self, sign: f64, states: &Mat<f64>, strains: &mut Mat<f64>) {
        let displaced = states.get(..self.scale.len(), ..);
        multiply(strains.as_mut(), Accum::Add, self.rates.as_ref(), displaced, sign);
    }

    /// Derivatives of states, one column each, times a duration.
    fn rates_of(&self, states: &Mat<f64>, duration: f64) -> Mat<f64> {
        let mut out = Mat::<f64>::zeros(states.nrows(), states.ncols());
        self.write_forces(states, duration, &mut out);
        for j in 0..states.ncols() {
            self.complete(states.col_as_slice(j), duration, out.col_as_slice_mut(j));
        }
        out
    }

    /// Accelerations by the stiffness, and by a damping that couples modes, times a duration.
    fn write_forces(&self, states: &Mat<f64>, duration: f64, out: &mut Mat<f64>) {
        let (displacement, velocity) = states.split_at_row(self.scale.len());
        let mut lower = out.get_mut(self.scale.len().., ..);
        let (own, minus) = (self.stiffness.as_ref(), -duration);
        multiply(lower.as_mut(), Accum::Replace, own, displacement, minus);
        if let Damping::Full(damping) = &self.damping {
            multiply(lower.as_mut(), Accum::Add, damping.as_ref(), velocity, minus);
        }
    }

    /// Velocities, and accelerations by a damping of single modes, times a duration.
    #[inline(always)]
    fn complete(&self, state: &[f64], duration: f64, out: &mut [f64]) {
        let modes = self.scale.len();
        let ((upper, lower), velocity) = (out.split_at_mut(modes), &state[modes..]);
        for ((upper, s), v) in upper.iter_mut().zip(&self.scale).zip(velocity) {
            *upper = duration * s * v;
        }
        if let Damping::Diagonal(damping) = &self.damping {
            for ((lower, c), v) in lower.iter_mut().zip(damping).zip(velocity) {
                *lower -= duration * c * v;
            }
        }
    }

    /// `[M, N]` times a duration.
    fn matrix(&self, duration: f64) -> Driven {
        let modes = self.scale.len();
        let mut rows = Mat::<f64>::zeros(2 * modes, 2 * modes + self.strains.len());
        for (j, s) in self.scale.iter().enumerate() {
            let lower = rows.col_as_slice_mut(j)[modes..].iter_mut();
            lower.zip(self.stiffness.col_as_slice(j)).for_each(|(to, k)| *to = -duration * k);
            let own = rows.col_as_slice_mut(modes + j);
            own[j] = duration * s;
            match &self.damping {
                Damping::Diagonal(damping) => own[modes + j] = -duration * damping[j],
                Damping::Full(damping) => {
                    let lower = own[modes..].iter_mut().zip(damping.col_as_slice(j));
                    lower.for_each(|(to, c)| *to = -duration * c);
                }
            }
        }
        for strain in 0..self.strains.len() {
            let lower = rows.col_as_slice_mut(2 * modes + strain)[modes..].iter_mut();
            lower.zip(self.input.col_as_slice(strain)).for_each(|(to, g)| *to = duration * g);
        }
        Driven::new(rows)
    }

    fn exponential(&self, duration: f64) -> Driven {
        if self.scale.len() <= FEW {
            return self.whole_exponential(duration);
        }
        let own = Oscillator::new(&self.stiffness, &self.scale, &self.damping, duration);
        let found = own.and_then(|own| own.exponential(&self.input, duration));
        found.unwrap_or_else(|| self.whole_exponential(duration))
    }

    /// The same of any equations.
    fn whole_exponential(&self, duration: f64) -> Driven {
        let power = |own: &Driven| Driven::new(self.rates_of(&own.rows, duration));
        let matrix = self.matrix(duration);
        let square = power(&matrix);
        exponential(&matrix, square, power)
    }

    /// Takes states a little further, or back, by a power series: some columns at a time, whose terms stay
    /// in the cache.
    pub(super) fn correct(&self, states: &mut Mat<f64>, inputs: &Mat<f64>, duration: f64) {
        if duration == 0.0 {
            return;
        }
        let modes = self.scale.len();
        // Over a stretch this short the states hardly change their size: terms that are small against it are none.
        let enough = ROUNDING * states.norm_l2();
        let sizes = |count: usize| [(); 2].map(|()| Mat::<f64>::zeros(2 * modes, count));
        let [mut before, mut term] = sizes(COLUMNS.min(states.ncols()));
        for first in (0..states.ncols()).step_by(COLUMNS) {
            let count = COLUMNS.min(states.ncols() - first);
            if count < term.ncols() {
                [before, term] = sizes(count);
            }
            for j in 0..count {
                before.col_as_slice_mut(j).copy_from_slice(states.col_as_slice(first + j));
            }
            let mut power = 1.0;
            loop {
                self.write_forces(&before, duration / power, &mut term);
                if power == 1.0 {
                    let inputs = inputs.get(.., first..first + count);
                    let driven = term.get_mut(modes.., ..);
                    multiply(driven, Accum::Add, self.input.as_ref(), inputs, duration);
                }
                let (before_it, duration) = (&before, duration / power);
                let add = AddTerm {
                    equations: self,
                    before: before_it,
                    duration,
                    term: &mut term,
                    states,
                    first,
                };
                let size = pulp::Arch::new().dispatch(add);
                let goes_on = size > enough && size.is_finite();
                if !goes_on {
                    break;
                }
                power += 1.0;
                std::mem::swap(&mut before, &mut term);
            }
        }
    }
}

/// Completes a term of a power series and adds it to states; its size. A closure would be no part of what
/// vector instructions are chosen for.
struct AddTerm<'a> {
    equations: &'a Equations,
    before: &'a Mat<f64>,
    duration: f64,
    term: &'a mut Mat<f64>,
    states: &'a mut Mat<f64>,
    /// First of the columns of the states.
    first: usize,
}

impl pulp::NullaryFnOnce for AddTerm<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let mut squares = 0.0;
        for j in 0..self.term.ncols() {
            let term = self.term.col_as_slice_mut(j);
            self.equations.complete(self.before.col_as_slice(j), self.duration, term);
            let to = self.states.col_as_slice_mut(self.first + j).iter_mut();
            to.zip(&*term).for_each(|(to, x)| *to += x);
            squares += dot(term, term);
        }
        squares.sqrt()
    }
}

impl Propagators {
    /// Prepares for motions of so many modes at a frequency [rad/s].
    pub(crate) fn serve(&mut self, omega: f64, modes: usize) {
        let ratio = omega / self.pace;
        // Of few modes exponentials are as cheap as the search for them.
        let alike = if modes <= FEW { 1.0 } else { ALIKE };
        if !(1.0 / alike..=alike).contains(&ratio) {
            (self.known, self.numbers, self.pace) = (Vec::new(), 0, omega);
        }
    }

    /// Error of series of disturbances that lag.
    pub(super) fn error(&self) -> f64 {
        if self.rough {
            ROUGH
        } else {
            ROUNDING
        }
    }

    /// Exponentials that are kept.
    #[cfg(test)]
    pub(super) fn count(&self) -> usize {
        self.known.len()
    }

    /// What is known of a stretch by the springs of a regime, or nearly so, to within a length; best longer by a lead.
    pub(super) fn known(
        &mut self,
        strains: &[usize],
        springs: &Springs,
        [duration, lead, close]: [f64; 3],
    ) -> Option<&Propagator> {
        self.stretches += 1;
        let off = |own: &Propagator, from: f64| (own.duration - from).abs();
        let serves = |own: &&mut Propagator| {
            off(own, duration) <= close && own.strains == strains && own.springs == *springs
        };
        let best = duration + lead;
        let closest =
            |a: &&mut Propagator, b: &&mut Propagator| off(a, best).total_cmp(&off(b, best));
        let own = self.known.iter_mut().filter(serves).min_by(closest)?;
        own.served = self.stretches;
        Some(own)
    }

    /// Takes states over a stretch at these rates, or nearly so, to within a length, and best on by a lead; the
    /// duration that is left.
    pub(super) fn advance(
        &mut self,
        equations: &Equations,
        [duration, lead, close]: [f64; 3],
        states: Mat<f64>,
        inputs: &Mat<f64>,
    ) -> (Mat<f64>, f64) {
        let mut out = self.spare.pop().unwrap_or_else(Mat::new);
        if let Some(own) =
            self.known(&equations.strains, &equations.springs, [duration, lead, close])
        {
            own.exponential.write_applied(states.as_ref(), inputs.as_ref(), &mut out);
            let left = duration - own.duration;
            self.spare.push(states);
            return (out, left);
        }
        let length = duration + lead;
        let exponential = equations.exponential(length);
        exponential.write_applied(states.as_ref(), inputs.as_ref(), &mut out);
        self.spare.push(states);
        self.keep(Propagator {
            springs: equations.springs.clone(),
            strains: equations.strains.clone(),
            duration: length,
            scale: equations.scale.clone(),
            exponential,
            served: self.stretches,
        });
        (out, -lead)
    }

    /// Keeps an exponential in the place of those that have not served for longest.
    fn keep(&mut self, own: Propagator) {
        let numbers =
            |own: &Propagator| own.exponential.rows.nrows() * own.exponential.rows.ncols();
        if numbers(&own) > ROOM {
            return;
        }
        self.numbers += numbers(&own);
        while self.numbers > ROOM || self.known.len() >= MOST {
            let all = self.known.iter().enumerate();
            let Some((oldest, _)) = all.min_by_key(|(_, one)| one.served) else { break };
            self.numbers -= numbers(&self.known.swap_remove(oldest));
        }
        self.known.push(own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(rows: usize, columns: usize, turn: f64) -> Mat<f64> {
        Mat::from_fn(rows, columns, |i, j| (turn + 3.1 * (i * columns + j) as f64).sin())
    }

    /// Modes far apart on springs that push along, or across.
    fn equations(modes: usize, across: bool) -> Equations {
        let (shapes, others) = (numbers(modes, 4, 0.2), numbers(modes, 4, 1.3));
        let other = if across { &others } else { &shapes };
        let mut stiffness = faer::Scale(7.0) * &shapes * other.transpose();
        for j in 0..modes {
            stiffness[(j, j)] += (1.0 + (j * j * j) as f64).powi(2);
        }
        let scale: Vec<f64> = (0..modes).map(|j| stiffness[(j, j)].abs().sqrt()).collect();
        for (j, s) in scale.iter().enumerate() {
            stiffness.col_as_slice_mut(j).iter_mut().for_each(|k| *k /= s);
        }
        let damping = Damping::Diagonal((0..modes).map(|j| 0.02 * (1 + j) as f64).collect());
        let rates = Mat::zeros(3, modes);
        let input = numbers(modes, 3, 0.9);
        let springs = Springs { moves: Vec::new(), pressing: Vec::new() };
        Equations { scale, strains: vec![0, 1, 2], rates, stiffness, damping, input, springs }
    }

    /// The exponential by blocks is that of the whole matrix, also over thousands of turns of the fastest mode.
    #[test]
    fn two_blocks_give_the_whole_exponential() {
        for modes in [1, 2, 9, 15] {
            let own = equations(modes, false);
            for duration in [1e-5, 1e-3, 0.02, 0.3, 4.0] {
                let whole = own.whole_exponential(duration);
                let blocks = Oscillator::new(&own.stiffness, &own.scale, &own.damping, duration)
                    .and_then(|blocks| blocks.exponential(&own.input, duration));
                let blocks = blocks.unwrap();
                let turns = (duration * own.scale[modes - 1]).max(1.0);
                let error = (&whole.rows - &blocks.rows).norm_max();

                assert!(error < 1e-14 * turns, "{modes} {duration} {error:e}");
            }
        }
    }

    /// Springs that push across have no reciprocity.
    #[test]
    fn springs_across_take_the_whole_matrix() {
        let own = equations(9, true);
        assert!(Oscillator::new(&own.stiffness, &own.scale, &own.damping, 0.3).is_none());
    }
}
