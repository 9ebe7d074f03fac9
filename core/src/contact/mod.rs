//! Friction laws behind one trait: series of u in, series of slip load and tangent out.
//!
//! The contact force is written `f = D u − q`: the stuck spring's force less the *slip load* q,
//! which is what slip takes off it. The stuck structure carries D, so that the balance has to
//! find q alone; it vanishes while a contact sticks. A new law is one file here and one line in
//! [`law`].

mod cycle;
mod derivative;
mod describing;
mod elastic;
mod increment;
mod jenkins;
mod jenkins_parameters;
mod jets;
mod march_rate;
mod marched;
mod parameter;
mod passage;
mod samples;
mod slip_series;
mod slip_set;
mod structural;
mod structural_parameters;
mod transitions;

pub use describing::Describing;
pub use elastic::Elastic;
pub use jenkins::Jenkins;
pub use marched::Marched;
pub use parameter::Parameter;
pub use structural::StructuralDamper;

use crate::fourier::SampleTable;
use crate::Error;
use faer::Mat;
use std::collections::BTreeMap;

/// Force at mid-range of a contact that never slips. Its steady motion does not determine it: it
/// is what the past has left, and has to be assumed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Residual {
    /// The force swings about zero.
    Centred,
    /// The load was raised slowly from rest with an unloaded contact.
    FromRest,
    /// A given force [N], reduced where it would make the contact slip.
    Value(f64),
}

impl Residual {
    /// Whether a motion with half-wave symmetry keeps it under this assumption.
    #[must_use]
    pub fn is_symmetric(self) -> bool {
        !matches!(self, Self::Value(value) if value != 0.0)
    }
}

/// One period of the relative displacements at the points of a contact.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// The harmonics kept, and their samples.
    pub table: &'a SampleTable,
    /// Real coefficients, point after point.
    pub displacement: &'a [f64],
    /// Assumed force at mid-range where the contact never slips.
    pub residual: Residual,
}

/// Fourier coefficients of the slip load of one contact, and their derivative.
#[derive(Debug, Clone, Default)]
pub struct SlipLoad {
    /// q, laid out as the displacement [N].
    pub value: Vec<f64>,
    /// ∂q/∂u, row by row, empty unless it was asked for [N/m].
    pub tangent: Vec<f64>,
    /// Whether the tangent differs from zero: a contact that sticks for good is a linear spring
    /// and drops out of the Newton system.
    pub active: bool,
}

impl SlipLoad {
    pub(crate) fn reset(&mut self, size: usize, tangent: bool) {
        self.value.clear();
        self.value.resize(size, 0.0);
        self.tangent.clear();
        if tangent {
            self.tangent.resize(size * size, 0.0);
        }
        self.active = false;
    }
}

/// What one point of a contact does over a period.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointSummary {
    /// Share of the period in slip.
    pub slip_fraction: f64,
    /// Friction work per period [J].
    pub dissipation: f64,
}

/// What a contact point does at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointState {
    /// It sticks.
    Stuck,
    /// It slips with positive force: the relative displacement grows.
    Forward,
    /// It slips with negative force.
    Backward,
}

impl PointState {
    /// Direction of slip: 1, −1, or 0 in stick.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Stuck => 0.0,
            Self::Forward => 1.0,
            Self::Backward => -1.0,
        }
    }

    /// The state in the mirror image of the motion.
    #[must_use]
    pub fn mirrored(self) -> Self {
        match self {
            Self::Stuck => Self::Stuck,
            Self::Forward => Self::Backward,
            Self::Backward => Self::Forward,
        }
    }

    /// Slip in the direction of `sign`.
    #[must_use]
    pub fn slipping(sign: f64) -> Self {
        if sign > 0.0 {
            Self::Forward
        } else {
            Self::Backward
        }
    }
}

/// A stretch of the period in which no point changes its state.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// Angle θ = ωt from which on, up to the start of the next one.
    pub start: f64,
    /// States of the points. A point without friction counts as stuck: it carries no force.
    pub states: Vec<PointState>,
}

/// Instants at which a law that keeps no account of its phases is asked.
const INSTANTS: usize = 4096;

/// A friction law between one or several relative displacements and their forces.
pub trait FrictionLaw: Send + Sync + std::fmt::Debug {
    /// Number of relative displacements.
    fn points(&self) -> usize;

    /// Whether the opposite motion gives the opposite force. An odd law under odd harmonics keeps
    /// half-wave symmetry.
    fn is_odd(&self) -> bool;

    /// Stiffness D of the stuck contact, points × points, symmetric positive semidefinite [N/m].
    fn stiffness(&self) -> Mat<f64>;

    /// The same law with all its stiffness multiplied by `share`, for homotopies.
    fn softened(&self, share: f64) -> Box<dyn FrictionLaw>;

    /// Slip load of a periodic motion and, if asked for, its tangent. Both belong to each other
    /// exactly: the tangent is the derivative of this value, history included.
    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad);

    /// Highest harmonic that the evaluation resolves; all of them where it is exact.
    fn resolves(&self) -> usize {
        usize::MAX
    }

    /// Slip load of a contact of one point whose displacement stays between `low` and `high` without
    /// slip, with its derivatives in the two; `None` if it slips. Laws of several points have no
    /// such rule: a march of them starts without slip.
    fn stuck_load(&self, _residual: Residual, _low: f64, _high: f64) -> Option<[f64; 3]> {
        None
    }

    /// Describing function of a law of one point under a harmonic displacement of the given
    /// amplitude, if it has one in closed form.
    fn describing(&self, _amplitude: f64) -> Option<Describing> {
        None
    }

    /// Return map of one increment: takes the contact forces through a change `du` of the relative
    /// displacements. `gain`, if asked for, is the derivative of the new forces in the trial forces
    /// `f + D du`, points × points, row by row.
    fn advance(&self, du: &[f64], force: &mut [f64], gain: Option<&mut [f64]>);

    /// Slip limit of every point [N]: 0 if it never carries a force, infinite if it never slips.
    fn limits(&self) -> Vec<f64>;

    /// `∂f/∂u` while the points are in these states, points × points [N/m]. The law is linear
    /// between two changes of them.
    fn tangent(&self, points: &[PointState]) -> Mat<f64>;

    /// Slip per relative displacement, `s' = R u'`, while the points are in these states,
    /// points × points; rows of points that stick are zero.
    fn slip_rate(&self, points: &[PointState]) -> Mat<f64>;

    /// Slip share and friction work of every point.
    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]);

    /// Contact forces at `samples` equidistant instants, instant after instant [N].
    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64>;

    /// What the points do over a period, from change to change; from the forces at instants unless
    /// the law knows better.
    fn phases(&self, motion: Motion<'_>) -> Vec<Phase> {
        let points = self.points();
        let limits = self.limits();
        let mut phases: Vec<Phase> = Vec::new();
        let forces = self.force_history(motion, INSTANTS);
        for (n, force) in forces.chunks_exact(points).enumerate() {
            let states: Vec<PointState> = force
                .iter()
                .zip(&limits)
                .map(|(f, limit)| match *limit {
                    limit if limit > 0.0 && f.abs() >= limit => PointState::slipping(*f),
                    _ => PointState::Stuck,
                })
                .collect();
            let start = std::f64::consts::TAU * n as f64 / INSTANTS as f64;
            if phases.last().is_none_or(|last| last.states != states) {
                phases.push(Phase { start, states });
            }
        }
        phases
    }

    /// The parameters, each addressed by its position; none by default.
    fn parameters(&self) -> Vec<Parameter> {
        Vec::new()
    }

    /// The same law with another value of one parameter.
    ///
    /// # Errors
    /// A value that the law refuses.
    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn FrictionLaw>, Error> {
        let _ = index;
        Err(Error::value("parameter", value, "the law has no parameters"))
    }

    /// The same law with all its forces multiplied by `factor` and its stiffness kept: at `factor`
    /// times the displacements its force is `factor` times as large.
    fn magnified(&self, factor: f64) -> Box<dyn FrictionLaw>;

    /// Series of the derivative of the contact force in parameter `index` at fixed displacement,
    /// laid out as the displacement.
    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]) {
        let _ = (motion, index);
        out.fill(0.0);
    }
}

/// Parameters of a law by name.
pub type Parameters = BTreeMap<String, Vec<f64>>;

/// The registry: a law from its name and parameters.
///
/// # Errors
/// Unknown name, or parameters the law refuses.
pub fn law(name: &str, parameters: &Parameters) -> Result<Box<dyn FrictionLaw>, Error> {
    match name {
        "jenkins" => Ok(Box::new(Jenkins::from_parameters(parameters)?)),
        "structural" => Ok(Box::new(StructuralDamper::from_parameters(parameters)?)),
        other => Err(Error::UnknownLaw {
            name: other.to_owned(),
            known: "jenkins, structural".to_owned(),
        }),
    }
}

/// The numbers a law expects under `name`.
fn numbers<'a>(law: &str, parameters: &'a Parameters, name: &str) -> Result<&'a [f64], Error> {
    let found = parameters.get(name).map(Vec::as_slice);
    found.ok_or_else(|| Error::shape(&format!("{law}: {name}"), "numbers", "nothing"))
}

/// The single number a law expects under `name`.
fn scalar(law: &str, parameters: &Parameters, name: &str) -> Result<f64, Error> {
    match parameters.get(name).map(Vec::as_slice) {
        Some([value]) => Ok(*value),
        Some(values) => Err(Error::shape(
            &format!("{law}: {name}"),
            "one number",
            format!("{} numbers", values.len()),
        )),
        None => Err(Error::shape(&format!("{law}: {name}"), "one number", "nothing")),
    }
}
