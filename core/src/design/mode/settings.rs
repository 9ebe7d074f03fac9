//! What is asked of a nonlinear mode, and what it gives.

use super::point::{Interaction, ModePoint};
use crate::balance::HarmonicChoice;
use crate::contact::Residual;
use crate::timing::Profile;

/// Which amplitudes are wanted [m √kg].
#[derive(Debug, Clone, PartialEq)]
pub enum Amplitudes {
    /// Exactly these, ascending.
    List(Vec<f64>),
    /// All between two.
    Range(f64, f64),
}

/// What a nonlinear mode is taken to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeMethod {
    /// A periodic motion that a damping −ξM feeds (Krack 2015).
    Periodic,
    /// A periodic motion that the forces of the model feed, in quadrature: phase resonance.
    PhaseResonance,
    /// The loop of a load `M φ α` that is raised without inertia (Lacayo and Allen 2019).
    QuasiStatic,
}

/// Forces that all contacts hold, to one side or the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Number of a combination of sides, from 0: of up to three laws there are all, of more laws eight.
    pub number: usize,
    /// Share of what they can hold at rest, up to 1, where motion pushes them to their limits.
    pub share: f64,
}

/// What is asked of a nonlinear mode.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeSettings {
    /// Which motion stands for the mode.
    pub method: ModeMethod,
    /// Which mode of the structure at rest, from 0.
    pub mode: usize,
    /// At which amplitudes.
    pub amplitudes: Amplitudes,
    /// Harmonics kept.
    pub harmonics: HarmonicChoice,
    /// Relative error of frequency, damping and shape, for automatic harmonics.
    pub tolerance: f64,
    /// Highest harmonic that automatic ones may reach.
    pub max_harmonics: usize,
    /// Assumed force at mid-range of contacts that never slip, …
    pub residual: Residual,
    /// … or what they hold instead.
    pub corner: Option<Corner>,
    /// Largest number of points.
    pub most: usize,
}

/// How a branch ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModeEnd {
    /// At the largest amplitude.
    Range,
    /// It turned back to small amplitudes.
    Returned,
    /// No point ahead was found.
    Stalled,
    /// As many points as allowed.
    Points,
    /// Far more evaluations of the equations than steps need: it crawls.
    Evaluations,
    /// The caller ended the analysis.
    Interrupted,
}

/// A nonlinear mode.
#[derive(Debug, Clone)]
pub struct NonlinearMode {
    /// Points along the branch, or at the amplitudes given.
    pub points: Vec<ModePoint>,
    /// Frequency [rad/s] and damping ratio at rest.
    pub linear: [f64; 2],
    /// Whether only odd harmonics were solved for.
    pub half_wave: bool,
    /// Amplitudes at which the branch turns.
    pub turns: Vec<f64>,
    /// The strongest internal resonance on the way between the points, and its amplitude.
    pub met: Option<(f64, Interaction)>,
    /// How it ended, …
    pub end: ModeEnd,
    /// … and at which amplitude.
    pub end_amplitude: f64,
    /// Where the time went.
    pub profile: Profile,
}
