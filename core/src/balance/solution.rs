//! What a forced response returns.

use super::settings::Resolution;
use super::unknowns::Unknowns;
use crate::contact::PointSummary;
use crate::fourier::{amplitude, Harmonics, Measure, SampleTable};
use crate::timing::Profile;
use faer::c64;
use std::sync::Arc;

/// How the solution at one frequency ended. The numbers are those that results keep; 5 is an
/// orbit that did not close, which is a stall here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointStatus {
    /// Solved.
    Converged = 0,
    /// Newton's method and both homotopies failed.
    Stalled = 1,
    /// The equations are singular: an undamped resonance at an unforced harmonic.
    Singular = 2,
    /// The analysis was ended before.
    NotComputed = 3,
    /// Solved, but automatic harmonics reached their limit above the tolerance.
    HarmonicsLimit = 4,
    /// Solved, but automatic samples reached their limit above their share of the tolerance.
    SamplesLimit = 6,
    /// Solved, but more harmonics, or an exact orbit, would have cost far more than the tolerance is
    /// worth.
    EffortLimit = 8,
    /// An exact orbit was not found within the steps of the flow that it is granted.
    StepsLimit = 7,
    /// Not solved: at a motion on the way contacts yield until nothing holds the mean position of a
    /// body that they alone hold.
    Free = 9,
    /// Not solved, though there are exact orbits: contacts that never slip keep one of many tractions, and
    /// which one depends on how the motion was reached.
    History = 10,
    /// Not solved: the work that a point is granted was spent before any harmonics were solved. 11 is an orbit of
    /// another motion, which is none here.
    WorkLimit = 12,
}

impl PointStatus {
    /// Whether the balance equations hold.
    #[must_use]
    pub fn is_solved(self) -> bool {
        !matches!(
            self,
            Self::Stalled
                | Self::Singular
                | Self::Free
                | Self::History
                | Self::NotComputed
                | Self::StepsLimit
                | Self::WorkLimit
        )
    }
}

/// Whether a vibration depends on the tractions that the past has left in its contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Uniqueness {
    /// It does not.
    Unique,
    /// It does: contacts that stick could keep others.
    Residual,
    /// It does, and the motion itself has pushed a contact in one sense until it slips no more.
    Shakedown,
    /// An orbit with other residual tractions was not found.
    NotFound,
    /// No other vibration was found, but the search had to end before it was through.
    NotDecided,
}

/// Bounds of the half ranges of the observed DOFs over all residual tractions that Coulomb allows.
#[derive(Debug, Clone, PartialEq)]
pub struct AmplitudeBounds {
    /// Least half range found, DOF after DOF \[m\].
    pub lower: Vec<f64>,
    /// Largest one \[m\].
    pub upper: Vec<f64>,
    /// What they depend on.
    pub unique: Uniqueness,
    /// Whether theory excludes others; else they are inner bounds.
    pub proved: bool,
}

impl AmplitudeBounds {
    /// Those of the only vibration.
    pub(crate) fn unique(amplitude: Vec<f64>, proved: bool) -> Self {
        Self { lower: amplitude.clone(), upper: amplitude, unique: Uniqueness::Unique, proved }
    }

    /// The same, found by a search that was `cut` short: an only vibration may have others beside it.
    #[must_use]
    pub(crate) fn by_search(mut self, cut: bool) -> Self {
        if cut && self.unique == Uniqueness::Unique {
            self.unique = Uniqueness::NotDecided;
        }
        self
    }

    /// Those of so many DOFs that were not found.
    pub(crate) fn not_found(dofs: usize) -> Self {
        let none = vec![f64::NAN; dofs];
        Self { lower: none.clone(), upper: none, unique: Uniqueness::NotFound, proved: false }
    }
}

/// Solution at one frequency.
#[derive(Debug, Clone)]
pub struct Point {
    /// Excitation frequency [rad/s].
    pub omega: f64,
    /// How it ended.
    pub status: PointStatus,
    /// Highest harmonic kept.
    pub harmonics: usize,
    /// Samples per period of marched laws.
    pub samples: Option<usize>,
    /// Residual, relative to the contact displacements.
    pub residual: f64,
    /// Largest distance of the vibration of a contact point from that without slip, over its size; not a number where
    /// nobody knows.
    pub(super) from_stuck: f64,
    /// Newton iterations, homotopy included.
    pub iterations: usize,
    /// Amplitudes X_k of the observed DOFs, DOF after DOF, k = 0..=harmonics.
    pub displacement: Vec<c64>,
    /// Amplitudes U_k of the contact displacements, laid out likewise.
    pub contact_displacement: Vec<c64>,
    /// Amplitudes F_k of the contact forces, laid out likewise.
    pub contact_force: Vec<c64>,
    /// What the discarded harmonics, and more samples, could change at each observed DOF \[m\].
    pub error_estimate: Vec<f64>,
    /// The part of it that is due to the samples; zero of laws evaluated as they are \[m\].
    pub sampling_error: Vec<f64>,
    /// Whether the estimate says no more than that harmonics or samples lack.
    pub(super) partial: bool,
    /// Slip share and friction work per contact point.
    pub contacts: Vec<PointSummary>,
    /// Whether the curve turns back in frequency here.
    pub fold: bool,
    /// Whether the sweep has come here from another branch.
    pub jump: bool,
    /// Whether it is not known that it lies on the branch of the point before.
    pub astray: bool,
    /// Whether a further branch begins here, which the curve before does not come by.
    pub further: bool,
    /// Whether the motion is stable, if that is decided.
    pub stable: Option<bool>,
    /// Bounds over the residual tractions, if they were asked for.
    pub bounds: Option<AmplitudeBounds>,
    pub(super) unknowns: Option<Unknowns>,
}

impl Point {
    /// Contact displacements in the layout of the balance, if there are any.
    #[must_use]
    pub fn unknowns(&self) -> Option<&Unknowns> {
        self.unknowns.as_ref()
    }

    /// Whether the balance equations hold.
    #[must_use]
    pub fn is_solved(&self) -> bool {
        self.status.is_solved()
    }

    /// What it resolves.
    #[must_use]
    pub fn resolution(&self) -> Resolution {
        Resolution { harmonics: self.harmonics, samples: self.samples }
    }

    /// Half ranges of the observed DOFs \[m\].
    pub(crate) fn half_ranges(&self) -> Vec<f64> {
        let table = SampleTable::new(Harmonics::new(self.harmonics, false));
        let mut series = vec![0.0; table.harmonics().slots()];
        let of_dof = self.displacement.chunks_exact(self.harmonics + 1);
        of_dof
            .map(|amplitudes| {
                table.harmonics().write_series(amplitudes, &mut series);
                amplitude(&table, &series, Measure::HalfRange)
            })
            .collect()
    }

    /// Makes room for harmonics up to `highest`.
    pub(crate) fn keep(&mut self, highest: usize) {
        self.harmonics = highest;
        for series in
            [&mut self.displacement, &mut self.contact_displacement, &mut self.contact_force]
        {
            *series = vec![c64::new(0.0, 0.0); series.len() * (highest + 1)];
        }
    }

    pub(crate) fn empty(omega: f64, status: PointStatus, observed: usize, contacts: usize) -> Self {
        Self {
            omega,
            status,
            harmonics: 0,
            samples: None,
            residual: f64::NAN,
            from_stuck: f64::NAN,
            iterations: 0,
            displacement: vec![c64::new(f64::NAN, 0.0); observed],
            contact_displacement: vec![c64::new(f64::NAN, 0.0); contacts],
            contact_force: vec![c64::new(f64::NAN, 0.0); contacts],
            error_estimate: vec![f64::NAN; observed],
            sampling_error: vec![f64::NAN; observed],
            partial: false,
            contacts: vec![
                PointSummary { slip_fraction: f64::NAN, dissipation: f64::NAN };
                contacts
            ],
            fold: false,
            jump: false,
            astray: false,
            further: false,
            stable: None,
            bounds: None,
            unknowns: None,
        }
    }
}

/// How a curve over a range ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum CurveEnd {
    /// At the far end of the range.
    #[default]
    Range,
    /// At the end of the range where it began.
    Returned,
    /// No point ahead was found.
    Stalled,
    /// As many points as allowed.
    Points,
    /// Where it began: it is closed.
    Closed,
    /// The caller ended the analysis.
    Interrupted,
}

/// A whole curve.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Points in the order of the sweep; of one that was ended early those that were computed, or
    /// else the first, which says so.
    pub points: Vec<Arc<Point>>,
    /// Whether only odd harmonics were solved for.
    pub half_wave: bool,
    /// Whether the analysis was ended before its last point.
    pub interrupted: bool,
    /// How a curve over a range ended.
    pub end: CurveEnd,
    /// How many further branches end inside the range.
    pub cut: usize,
    /// Where the time went.
    pub profile: Profile,
}
