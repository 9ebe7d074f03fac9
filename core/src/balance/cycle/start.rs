//! Where a branch of limit cycles begins: the stuck mode at the onset of slip.
//!
//! As the negative damping vanishes the limit cycle tends to the linear motion of the stuck
//! structure that just reaches the slip limit of one contact: friction need not dissipate anything.
//! Under static loads, or laws that are not odd, that motion is one about the state at rest.

use super::balance::CycleBalance;
use super::rest::Equilibrium;
use crate::contact::{ContactLaw, Describing};
use crate::fourier::SampleTable;
use crate::model::{stiffness_of, FlutterModel};
use crate::solve::{across, at_parameter};
use crate::structure::StuckMode;
use crate::Error;
use faer::{c64, Mat};
use std::sync::Arc;

/// Newton iterations for the first point.
const ITERATIONS: usize = 40;
/// First ratios, relative to the excess over the onset that is asked for, down to which a start is
/// looked for: closer to the onset the stuck mode is nearer to the solution.
const NEARER: [f64; 7] = [1.0, 0.5, 0.2, 0.05, 0.01, 1e-3, 1e-4];
/// Doublings of the excess over the onset up to which friction is asked to balance a guess: laws that
/// always slip have their onset at next to no force.
const FURTHER: i32 = 50;
/// Motion, relative to that of the onset, of a contact that always slips and of which nothing is to be seen.
const HARDLY: f64 = 1e-3;
/// Halvings of the excess that balances the work.
const HALVINGS: usize = 50;
/// Contact displacement, relative to the largest of all modes, that counts as none.
const STILL: f64 = 1e-9;
/// A frequency, relative to the highest natural one, at which nothing resonates.
const OFF_RESONANCE: f64 = 1.37;

/// Rounds on the springs of nonlinear laws, and their change that counts as none.
const ROUNDS: usize = 50;
const SAME: f64 = 1e-12;

/// The stiffness with laws that never slip as springs of the first harmonic, at the amplitude of a mode at
/// which the first contact slips. The stuck mode then has the frequency that it has there: it is found
/// within a distance that its small damping sets.
fn springs(
    laws: &[Box<dyn ContactLaw>],
    stiffness: &Mat<f64>,
    limits: &[f64],
    own: &StuckMode,
) -> Mat<f64> {
    let force = |i: usize| {
        (0..limits.len()).map(|j| own.contact[j] * stiffness[(i, j)]).sum::<c64>().norm()
    };
    let slips = (0..limits.len()).filter(|&i| limits[i].is_finite() && force(i) > 0.0);
    let amplitude = slips.map(|i| limits[i] / force(i)).fold(f64::INFINITY, f64::min);
    let mut next = stiffness.clone();
    let mut point = 0;
    for law in laws {
        if let (1, true, true) =
            (law.displacements(), limits[point].is_infinite(), amplitude.is_finite())
        {
            let size = amplitude * own.contact[point].norm();
            if let Some(spring) = law.first_harmonic(size) {
                // A stiff spring holds what would move it: the mean of before and after settles.
                next[(point, point)] = 0.5 * (next[(point, point)] + spring.stiffness.re);
            }
        }
        point += law.displacements();
    }
    next
}

/// Whether a contact point slips in motions smaller than that of its onset, too, as laws do that always
/// slip a little; sliders in parallel do not.
fn slips_below(laws: &[Box<dyn ContactLaw>], point: usize, onset: f64) -> bool {
    let mut of_points = laws.iter().flat_map(|law| std::iter::repeat_n(law, law.displacements()));
    let below = of_points.nth(point).and_then(|law| law.first_harmonic(0.5 * onset));
    below.is_none_or(|below| below.stiffness.im != 0.0)
}

/// A stuck mode that negative damping can excite.
#[derive(Debug, Clone)]
pub struct Onset {
    /// The mode.
    pub mode: StuckMode,
    /// Ratio r at which its damping vanishes with all contacts stuck.
    pub ratio: f64,
    /// Modal amplitude at which the first contact begins to slip, or leaves the state it has at rest
    /// [m √kg].
    pub amplitude: f64,
    /// That contact point; about a state at rest, the one that bears most.
    pub point: usize,
    /// Of each contact point its law, if that has a describing function.
    laws: Vec<Option<Arc<dyn ContactLaw>>>,
    /// Its force there \[N\].
    pub limit: f64,
    /// How many times further that contact slips as a whole: 1 unless it slips little by little from the
    /// least motion on.
    pub whole: f64,
    /// DOF that moves most, of those that no contact restrains, if there are any.
    pub dof: usize,
    /// The state at rest, if motions are not symmetric.
    rest: Option<Equilibrium>,
}

impl Onset {
    /// The onset of a mode, counted from 0 by rising frequency of the stuck structure, or of that with
    /// its contacts as they are at rest, at a value of what is followed.
    ///
    /// # Errors
    /// No such mode; a mode that moves no contact or that the negative damping does not excite; no state
    /// at rest, or one that the smallest motion leaves.
    pub fn new(family: &FlutterModel<'_>, mode: usize, value: f64) -> Result<Self, Error> {
        let laws = family.laws_at(value)?;
        let model = family.model();
        let mut stiffness = stiffness_of(&laws).into_full();
        let limits: Vec<f64> = laws.iter().flat_map(|law| law.onsets()).collect();
        let mut modes = family.compliance().stuck_modes(stiffness.as_ref())?;
        let mut rest = None;
        if !family.is_symmetric() {
            let beside = modes.last().map_or(1.0, |highest| OFF_RESONANCE * highest.omega);
            let found = Equilibrium::new(family, value, beside).ok_or_else(|| {
                let remedy = "the static loads have no equilibrium that contacts bear";
                Error::value("mode", mode as f64, remedy)
            })?;
            stiffness = found.stiffness(&stiffness);
            modes = family.compliance().stuck_modes(stiffness.as_ref())?;
            rest = Some(found);
        }
        if rest.is_none() {
            for _ in 0..ROUNDS {
                let Some(next) =
                    modes.get(mode).map(|own| springs(&laws, &stiffness, &limits, own))
                else {
                    break;
                };
                let change = (&next - &stiffness).norm_max();
                stiffness = next;
                if change <= SAME * stiffness.norm_max() {
                    break;
                }
                modes = family.compliance().stuck_modes(stiffness.as_ref())?;
            }
        }
        let largest = modes.iter().flat_map(|m| &m.contact).map(|u| u.norm()).fold(0.0, f64::max);
        let Some(own) = modes.get(mode) else {
            let remedy = format!("the structure has modes 0 to {}", modes.len().saturating_sub(1));
            return Err(Error::value("mode", mode as f64, &remedy));
        };
        let force = |i: usize| -> f64 {
            let sum: c64 = (0..own.contact.len()).map(|j| own.contact[j] * stiffness[(i, j)]).sum();
            sum.norm()
        };
        let moved = (0..limits.len()).filter(|&i| own.contact[i].norm() > STILL * largest);
        let onset = if let Some(rest) = &rest {
            let stuck = stiffness_of(&laws).into_full().norm_max();
            let bears = |i: usize| stuck * own.contact[i].norm();
            let most = moved.max_by(|a, b| bears(*a).total_cmp(&bears(*b)));
            most.and_then(|i| Some((rest.reach(family, value, own, bears(i))?, i)))
        } else {
            moved
                .filter(|&i| limits[i].is_finite())
                .map(|i| (limits[i] / force(i), i))
                .filter(|(amplitude, _)| amplitude.is_finite() && *amplitude > 0.0)
                .min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let Some((amplitude, point)) = onset else {
            let remedy = if rest.is_some() {
                "moves no contact that can slip or open, or one that touches without a load"
            } else {
                "moves no contact that can slip, so that friction cannot bound it"
            };
            return Err(Error::value("mode", mode as f64, remedy));
        };
        let rounding = 1e-12 * own.omega;
        if own.negative >= -rounding {
            let text = format!(
                "is not excited: its modal negative damping is {:.3e} 1/s, which must be below 0; \
                 mind the sign of negative_damping",
                own.negative
            );
            return Err(Error::value("mode", mode as f64, &text));
        }
        let ratio = (-own.damping / own.negative).max(0.0);
        let restrained = |dof: usize| {
            (0..model.ports().rows.nrows()).any(|i| model.ports().rows[(i, dof)] != 0.0)
        };
        let size = |dof: &usize| own.shape[*dof].norm();
        let moves = |a: &usize, b: &usize| size(a).total_cmp(&size(b));
        let dofs = 0..own.shape.len();
        let most = dofs.clone().max_by(moves).unwrap_or(0);
        let dof = dofs
            .filter(|dof| !restrained(*dof) && size(dof) > 0.01 * size(&most))
            .max_by(moves)
            .unwrap_or(most);
        let gross = laws.iter().flat_map(|law| law.limits()).nth(point).filter(|f| f.is_finite());
        let size = amplitude * own.contact[point].norm();
        let whole = gross
            .filter(|_| rest.is_none() && slips_below(&laws, point, size))
            .map_or(1.0, |gross| gross / limits[point]);
        let describing = laws.iter().flat_map(|law| {
            let own = law.first_harmonic(1.0).map(|_| Arc::from(law.with_scaled_forces(1.0)));
            std::iter::repeat_n(own, law.displacements())
        });
        // What never slips is a spring of the mode already.
        let describing = describing.zip(&limits).map(|(law, f)| law.filter(|_| f.is_finite()));
        Ok(Self {
            mode: own.clone(),
            ratio,
            amplitude,
            point,
            laws: describing.collect(),
            limit: if rest.is_some() { amplitude * force(point) } else { limits[point] },
            whole,
            dof,
            rest,
        })
    }

    /// A limit cycle at the ratio r asked for, or as near to the onset as needed, about a state at rest
    /// near the onset in any case: unknowns of [`CycleBalance`]. Nothing if Newton's method finds none.
    pub fn first_point(
        &self,
        family: &FlutterModel<'_>,
        table: &SampleTable,
        ratio: f64,
        interrupted: &dyn Fn() -> bool,
    ) -> Option<Vec<f64>> {
        if let Some(rest) = &self.rest {
            let wanted = [self.amplitude, ratio];
            return rest.first_point(family, table, &self.mode, wanted, interrupted);
        }
        // Where friction takes more off the least motion, the stuck mode has nothing to begin with.
        let ratio = ratio.max(self.ratio_at(1.0));
        for share in NEARER {
            for factor in [1.0, 0.7, 1.5, 0.3, 3.0] {
                let ratio = self.ratio + share * (ratio - self.ratio);
                let Some((guess, excess)) = self.guess(table, ratio, factor) else { continue };
                let mut curve = CycleBalance::new(family, table, &guess, interrupted);
                let Some((z, _)) = at_parameter(&mut curve, &guess, ratio, ITERATIONS) else {
                    if interrupted() {
                        return None;
                    }
                    continue;
                };
                let near = z[z.len() - 2] / self.mode.omega;
                let slots = table.harmonics().slots();
                let moved = table.harmonics().fundamental(&z[self.point * slots..][..slots]);
                let expected = self.amplitude * self.mode.contact[self.point].norm();
                // Motions of a contact that slips little by little may grow by decades within a percent
                // of r: there the guess tells no more than that it hardly slips.
                let (least, most) = if self.whole > 1.0 {
                    (HARDLY * expected, (0.1 * self.whole).max(2.0 * (1.0 + excess)) * expected)
                } else {
                    (0.5 * expected, 1.5 * (1.0 + excess).max(2.0) * expected)
                };
                if (0.7..1.3).contains(&near) && moved > least && moved < most {
                    return Some(z);
                }
            }
        }
        // Such motions are determined by their size rather than by r.
        let least = if self.whole > 1.0 { self.ratio_at(1.0) } else { return None };
        let guess = self.motion(table, 1.0, least);
        let mut before = guess.clone();
        let moved = guess.len() - 2;
        before[..moved].iter_mut().for_each(|u| *u *= 0.9);
        let mut curve = CycleBalance::new(family, table, &guess, interrupted);
        across(&mut curve, &before, &guess, 1.0).filter(|z| z[z.len() - 1] > 0.0)
    }

    /// What slip takes off the stiffness of all contacts in the stuck mode beyond the onset of slip, by
    /// their first harmonics.
    fn softening(&self, excess: f64) -> c64 {
        let stroke = |point: usize| self.mode.contact[point].norm();
        let size = |point: usize| (1.0 + excess) * stroke(point) * self.amplitude;
        let known = self.laws.iter().enumerate().filter_map(|(point, law)| {
            let law = law.as_ref().filter(|_| size(point) > 0.0)?;
            let own =
                law.first_harmonic(0.0)?.stiffness - law.first_harmonic(size(point))?.stiffness;
            Some(stroke(point).powi(2) * own)
        });
        let known = known.sum::<c64>();
        if self.laws[self.point].is_some() {
            return known;
        }
        let stiffness = self.limit / (stroke(self.point) * self.amplitude);
        let own = Describing::of_jenkins(stiffness, self.limit, size(self.point)).stiffness;
        known + stroke(self.point).powi(2) * (stiffness - own)
    }

    /// Ratio r at which friction balances the stuck mode so far beyond the onset of slip, if it always
    /// slips a little; otherwise that of the onset.
    fn ratio_at(&self, excess: f64) -> f64 {
        if self.whole > 1.0 {
            let lost = self.softening(excess).im / self.mode.omega;
            (lost - self.mode.damping) / self.mode.negative
        } else {
            self.ratio
        }
    }

    /// The stuck mode beyond the onset of slip by what makes friction dissipate the work of the
    /// negative damping, by the first harmonic of all contacts, and by which share of the
    /// amplitude at the onset it lies beyond; nothing if it cannot.
    fn guess(&self, table: &SampleTable, ratio: f64, factor: f64) -> Option<(Vec<f64>, f64)> {
        let mode = &self.mode;
        let damping = mode.damping + ratio * mode.negative;
        // The dissipation of one element grows with the excess up to twice the amplitude at its
        // onset; that of several ones further.
        let left = |excess: f64| mode.omega * damping - self.softening(excess).im;
        let mut reached = (0..FURTHER).map(|doubled| 2f64.powi(doubled));
        let mut high = reached.find(|excess| left(*excess) >= 0.0)?;
        let mut low = 0.0;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if left(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some((self.motion(table, factor * high, ratio), high))
    }

    /// The stuck mode so far beyond the onset of slip, at a ratio r: unknowns of [`CycleBalance`].
    fn motion(&self, table: &SampleTable, excess: f64, ratio: f64) -> Vec<f64> {
        let (harmonics, mode) = (table.harmonics(), &self.mode);
        let omega = (mode.omega * mode.omega - self.softening(excess).re).max(0.0).sqrt();
        let q = self.amplitude * (1.0 + excess);
        let slots = harmonics.slots();
        let mut z = vec![0.0; mode.contact.len() * slots];
        if let Some(slot) = harmonics.slot(1) {
            for (i, u) in mode.contact.iter().enumerate() {
                z[i * slots + slot] = q * u.re;
                z[i * slots + slot + 1] = -q * u.im;
            }
        }
        z.extend([omega, ratio]);
        z
    }
}
