//! Limit cycles as the caller has them: settings, cycles along a branch, where it turns and where
//! its stability changes.

use crate::balance::{HarmonicChoice, Point, HIGHEST_ORDER};
use crate::motion::Event;
use crate::solve::{largest, End};
use crate::timing::Profile;
use crate::Error;
use faer::c64;

/// Settings of limit cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleSettings {
    /// Mode of the stuck structure that the branch begins with, from 0.
    pub mode: usize,
    /// Values of the scalar at which the cycles are wanted; the whole branch if there are none.
    pub values: Option<Vec<f64>>,
    /// Range of the scalar.
    pub range: (f64, f64),
    /// Exact orbits instead of harmonic balance.
    pub exact: bool,
    /// Harmonics kept by the balance.
    pub harmonics: HarmonicChoice,
    /// Highest order that automatic harmonics may reach.
    pub max_harmonics: usize,
    /// Relative error of the amplitudes that automatic harmonics aim at.
    pub tolerance: f64,
    /// Highest harmonic reported of exact orbits.
    pub reported: usize,
    /// Whether Floquet multipliers are computed.
    pub stability: bool,
    /// Most points of a branch.
    pub most: usize,
}

impl Default for CycleSettings {
    fn default() -> Self {
        Self {
            mode: 0,
            values: None,
            range: (0.01, f64::INFINITY),
            exact: false,
            harmonics: HarmonicChoice::Fixed(31),
            max_harmonics: 255,
            tolerance: 1e-3,
            reported: 32,
            stability: true,
            most: 5000,
        }
    }
}

/// Share of the points, one in so many, that automatic harmonics may leave above the tolerance: at
/// corners of the branch the estimate has no bound.
pub(super) const RARE: usize = 20;
/// Rungs of automatic harmonics.
const LADDER: [usize; 6] = [7, 15, 31, 63, 127, 255];

impl CycleSettings {
    /// Highest harmonics to try, one after the other.
    pub(super) fn rungs(&self) -> Vec<usize> {
        match self.harmonics {
            HarmonicChoice::Fixed(highest) => vec![highest],
            HarmonicChoice::Auto => {
                let most = self.max_harmonics;
                LADDER.iter().copied().filter(|h| *h < most).chain([most]).collect()
            }
        }
    }

    /// Checks the settings.
    ///
    /// # Errors
    /// A setting outside its range.
    pub fn check(&self) -> Result<(), Error> {
        let (entry, kept) = self.harmonics.highest(self.max_harmonics);
        for (entry, order) in [(entry, kept), ("harmonics", self.reported)] {
            Error::check_order(entry, order, HIGHEST_ORDER)?;
        }
        let (low, high) = self.range;
        if !(low > 0.0 && low < high) {
            return Err(Error::value(
                "range: lower end",
                low,
                "must lie above 0 and below its upper end",
            ));
        }
        for value in self.values.iter().flatten() {
            if !(*value > 0.0 && value.is_finite()) {
                return Err(Error::value("values", *value, "must be finite and above 0"));
            }
        }
        Ok(())
    }
}

/// A limit cycle.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// Value of the scalar that is followed.
    pub value: f64,
    /// r.
    pub ratio: f64,
    /// Whether it lies beyond the place where the branch turns for good: it slips mostly.
    pub slipping: bool,
    /// Motion, forces, error estimate, slip and friction work.
    pub response: Point,
    /// Lowest and highest displacement of every DOF \[m\]; of exact orbits only.
    pub range: Vec<[f64; 2]>,
    /// State at the start of the period: displacements and velocities of all DOFs, contact
    /// forces; of exact orbits only.
    pub state: Vec<f64>,
    /// Work lost to viscous damping per period \[J\], negative where it feeds the motion; of exact
    /// orbits only.
    pub viscous: f64,
    /// Events of the period; of exact orbits only.
    pub events: Vec<Event>,
    /// Floquet multipliers over the full period without the one of the phase: exact ones of
    /// contacts that never slip first, then by falling modulus.
    pub multipliers: Vec<c64>,
    /// Number of contacts that never slip.
    pub neutral: usize,
    /// Whether the multipliers are those of an exact orbit, not of the flow along a balance.
    pub closed: bool,
}

/// A place where a branch turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Value of the scalar.
    pub value: f64,
    /// Frequency [rad/s].
    pub omega: f64,
}

/// The limit cycles of a mode.
#[derive(Debug, Clone)]
pub struct LimitCycles {
    /// Along the branch, sticking before slipping.
    pub cycles: Vec<Cycle>,
    /// Where it turns for good.
    pub limit: Option<Turn>,
    /// All places where it turns.
    pub folds: Vec<Turn>,
    /// Where its stability changes; of whole branches.
    pub changes: Vec<Change>,
    /// How either side ended, the sticking one first.
    pub ends: [End; 2],
    /// Values of the scalar at which they ended.
    pub end_values: [f64; 2],
    /// r at which the stuck mode loses its damping.
    pub onset: f64,
    /// Natural frequency of that mode [rad/s].
    pub stuck_omega: f64,
    /// DOF whose maximum is t = 0.
    pub phase_dof: usize,
    /// Places stepped over.
    pub jumps: usize,
    /// Whether the analysis was ended before it was complete.
    pub interrupted: bool,
    /// Where the time went.
    pub profile: Profile,
}

/// Largest error of a DOF against its amplitude, of one that hardly moves against the others; infinite if one
/// is not a number.
pub(super) fn relative(point: &Point) -> f64 {
    let orders = point.harmonics + 1;
    let sizes: Vec<f64> = point
        .displacement
        .chunks_exact(orders)
        .map(|row| row.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt())
        .collect();
    let highest = sizes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let errors = point.error_estimate.iter().zip(&sizes);
    largest(errors.map(|(error, size)| error / size.max(0.02 * highest)))
}

/// What happens where stability changes. The numbers are those that results keep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChangeKind {
    /// A multiplier passes 1: the branch turns.
    Fold = 0,
    /// A complex pair passes the unit circle: quasi-periodic motion branches off.
    ComplexPair = 1,
    /// A multiplier passes 1 with motion that breaks the half-wave symmetry.
    Symmetry = 2,
    /// A multiplier jumps: a contact begins or ceases to slip at a further place of the period.
    Grazing = 3,
    /// A multiplier passes −1: motion of twice the period branches off.
    PeriodDoubling = 4,
}

/// A change of stability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Value of the scalar.
    pub value: f64,
    /// Frequency [rad/s].
    pub omega: f64,
    /// Position of the cycle before it.
    pub after: usize,
    /// What happens.
    pub kind: ChangeKind,
    /// Multipliers outside the unit circle before and after.
    pub unstable: (usize, usize),
}
