//! The residual traction of a contact that does not slip in both senses in a period.
//!
//! The motion does not determine it: it is what the past has left. One rule assumes it in every
//! evaluation, by harmonics, by samples, and along exact orbits.
//!
//! 1. The slider begins at a position in whose terms the traction is that of [`Residual`] while the
//!    displacement is at mid-range: in the middle of the range of u, or, in two directions, in the
//!    centre of the smallest circle around its path. A given force moves it along the first
//!    tangential direction. From rest it begins where the static loads have left it.
//! 2. From there the periodic motion pushes it, from the start of the period on, until it slips no
//!    more. In one direction that is the nearest position that Coulomb allows for the whole period,
//!    `max (k_t u − μN) ≤ k_t w ≤ min (k_t u + μN)`.
//!
//! A contact that slips in both senses, or opens, forgets where it has begun. One pushed in one sense
//! alone has shaken down: it touches its limit, and keeps the rest of what was assumed.

use super::return_map::ReturnMapJacobian;
use crate::Error;

/// Force at mid-range of a contact that never slips. Its steady motion does not determine it: it
/// is what the past has left, and has to be assumed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Residual {
    /// The force swings about zero.
    Centred,
    /// The load was raised slowly from rest with an unloaded contact.
    FromRest,
    /// A given force \[N\], reduced where it would make the contact slip; of a contact in two
    /// directions along the first.
    Value(f64),
}

impl Residual {
    /// Whether a motion with half-wave symmetry keeps it under this assumption.
    #[must_use]
    pub fn is_symmetric(self) -> bool {
        !matches!(self, Self::Value(value) if value != 0.0)
    }

    /// Refuses a force that is not finite.
    pub(crate) fn check(self) -> Result<(), Error> {
        match self {
            Self::Value(force) if !force.is_finite() => {
                Err(Error::value("residual", force, "must be a finite force in N"))
            }
            _ => Ok(()),
        }
    }

    /// Scaled slider position `k_t w` that is assumed, from that of the displacement at mid-range and
    /// from the one at rest \[N\].
    pub(crate) fn slider<const N: usize>(self, middle: [f64; N], rest: [f64; N]) -> [f64; N] {
        let mut slider = middle;
        match self {
            Self::Centred => {}
            Self::FromRest => slider = rest,
            Self::Value(force) => slider[0] -= force,
        }
        slider
    }

    /// Whether the assumed position moves with the middle of the displacement.
    pub(crate) fn follows_middle(self) -> bool {
        self != Self::FromRest
    }
}

/// A slider that never moves in a periodic motion. Positions are displacements \[m\] from where
/// [`Residual::FromRest`] begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Where it is.
    pub position: f64,
    /// Lowest and highest position that Coulomb allows for the whole period in this motion; of
    /// coupled directions each by itself, so that not all pairs are allowed.
    pub range: [f64; 2],
    /// Whether the motion has pushed it there, so that it touches its limit.
    pub pushed: bool,
}

impl Held {
    /// Distance from the assumed position, relative to the range of a slip force, that is none.
    const SAME: f64 = 1e-9;

    pub(super) fn new(position: f64, assumed: f64, range: [f64; 2], reach: f64) -> Self {
        Self { position, range, pushed: (position - assumed).abs() > Self::SAME * reach }
    }
}

/// Where a law is before it begins a periodic motion.
#[derive(Debug, Clone)]
pub struct AssumedStart {
    /// Displacements from which its first step leads to the start of the period \[m\].
    pub displacement: Vec<f64>,
    /// Its state there.
    pub state: Vec<f64>,
    /// Derivative of these displacements in the coefficients of the motion, row by row; empty if there
    /// is none. The state has none.
    pub rate: Vec<f64>,
}

impl AssumedStart {
    /// Whether the state after a first step follows the motion by where that step has begun.
    pub(crate) fn moves(&self, jacobian: &ReturnMapJacobian) -> bool {
        let count = self.displacement.len();
        let rows = self.rate.chunks_exact((self.rate.len() / count.max(1)).max(1)).enumerate();
        let varies = |row: &[f64]| row.iter().any(|rate| *rate != 0.0);
        let felt = |l: usize| jacobian.by_before.iter().skip(l).step_by(count).any(|by| *by != 0.0);
        rows.into_iter().any(|(l, row)| varies(row) && felt(l))
    }
}
