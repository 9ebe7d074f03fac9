//! The harmonic balance equations, condensed to the relative contact displacements:
//! `U_k = U_k^stuck + G_k Q_k(U)` for every kept harmonic k.

mod account;
mod accuracy;
mod at_rest;
mod attempts;
mod condensed;
mod cycle;
mod effort;
mod enough;
mod estimate;
#[cfg(test)]
mod estimate_tests;
mod evaluation;
mod extension;
mod forced;
mod formed;
mod from_orbit;
mod history;
mod jacobian;
mod kept;
mod krylov_newton;
#[cfg(test)]
mod krylov_tests;
mod limit_load;
mod linear;
mod linearised;
mod modal_work;
mod neighbour;
mod open_mean;
mod path;
mod price;
mod ring;
mod sweep;

mod resolution_control;
mod resonances;
mod rough_start;
mod rounded_tangents;
mod sampling;
mod scale;
mod settings;
mod single_harmonic;
mod slider_start;
mod slip_jacobian;
mod smooth_piece;
mod solution;
mod statics;
mod tangent;
mod unknowns;
mod without_bound;
mod work;

pub use at_rest::{AtRest, RestStatus};
pub(crate) use attempts::is_balanced;
pub(crate) use cycle::oscillation;
pub use cycle::{CycleBalance, Onset};
pub(crate) use evaluation::Evaluated;
pub use forced::ForcedBalance;
pub(crate) use forced::WarmStart;
pub(crate) use history::history_of;
pub use history::with_history;
pub(crate) use kept::{keep, keep_instead};
pub use kept::{without_gap, Kept};
pub(crate) use limit_load::{is_carried_away, is_let_go};
pub use linearised::{Cause, FrequencyJets, Linearised};
pub(crate) use price::{work_of_given, MUCH};
pub use settings::{
    Evaluation, HarmonicChoice, Method, Resolution, SampleChoice, Settings, HIGHEST_ORDER,
};
pub use single_harmonic::single_harmonic;
pub(crate) use slider_start::{HeldMotion, SliderBalance};
pub use solution::{AmplitudeBounds, CurveEnd, Point, PointStatus, Solution, Uniqueness};
pub use statics::static_response;
pub(crate) use statics::{slip_load, Level, Loading};
pub(crate) use sweep::{
    branch_piece, check_range, join_branches, join_smooth, seam, seams, smooth_piece, Course, Piece,
};
pub(crate) use sweep::{check_frequencies, over_frequencies};
pub use sweep::{sweep, sweep_range};
pub use unknowns::Unknowns;

pub use crate::progress::Progress;

/// Exact orbits that a balance may turn to.
pub trait ExactOrbits {
    /// The orbit at a frequency [rad/s] with its harmonics up to `highest`, if there is one.
    fn orbit(&self, omega: f64, highest: usize) -> Option<Point>;

    /// The same where others are possible, from the first motion that is given at the frequency: it is sought once.
    fn orbit_of(&self, _motion: &Unknowns, omega: f64, highest: usize) -> Option<Point> {
        self.orbit(omega, highest)
    }

    /// Floating-point operations that it takes if contacts change their states `events` times per
    /// period; `None` if there is no such orbit.
    fn price(&self, omega: f64, events: usize, highest: usize) -> Option<f64>;

    /// Whether the last orbit, of this frequency, is one of many: contacts that never slip could keep other
    /// tractions.
    fn is_one_of_many(&self, omega: f64) -> bool;

    /// Contact displacements of a motion that settles in time where there are no exact orbits, their
    /// amplitudes up to `highest`, contact after contact.
    fn settled(&self, omega: f64, highest: usize) -> Option<Vec<faer::c64>>;

    /// Whether a body that contacts alone hold walks at a frequency [rad/s]: no motion repeats there.
    fn walks(&self, _omega: f64) -> bool {
        false
    }

    /// Work of all orbits that were sought so far \[ns\].
    fn work(&self) -> f64 {
        0.0
    }

    /// Has a search from here on take no more work than this, or a little if it is next to none \[ns\].
    fn allow(&self, _work: f64) {}
}
