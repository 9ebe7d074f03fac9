//! What can be wrong with a problem, said in one line with the remedy.

/// An input that the mathematics refuses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// A matrix or vector does not fit the structure.
    #[error("{entry}: expected {expected}, got {got}")]
    Shape {
        /// The offending entry.
        entry: String,
        /// What would fit.
        expected: String,
        /// What was given.
        got: String,
    },
    /// A number is NaN, infinite or outside its range.
    #[error("{entry} = {}: {remedy}", brief(*value))]
    Value {
        /// The offending entry.
        entry: String,
        /// Its value.
        value: f64,
        /// What would be accepted.
        remedy: String,
    },
    /// The mass matrix has no Cholesky factor.
    #[error(
        "mass: not positive definite; condense massless DOFs out (static condensation) and check its signs"
    )]
    IndefiniteMass,
    /// An eigenvalue iteration did not end.
    #[error("{0}: the eigenvalue iteration did not converge; check the matrix for entries of absurd size")]
    Eigenvalues(String),
    /// The mean displacement is needed, but rigid-body motion leaves it undefined.
    #[error(
        "stiffness: singular although all contacts stick (lowest natural frequency {lowest:.3e} rad/s), so the mean displacement is undefined; ground the structure, or leave out static and even-harmonic forces and a prescribed residual"
    )]
    SingularStiffness {
        /// Lowest natural frequency of the stuck structure in rad/s.
        lowest: f64,
    },
    /// A mode has a negative squared frequency.
    #[error(
        "stiffness: not positive semidefinite (omega^2 = {squared:.6e} in its lowest mode), so the structure is statically unstable and has no natural frequency there; check its signs and supports"
    )]
    Unstable {
        /// Squared natural frequency in (rad/s)².
        squared: f64,
    },
    /// The frequency grid meets a resonance of the stuck structure that nothing damps.
    #[error(
        "omega = {omega:?} rad/s: harmonic {harmonic} hits the undamped natural frequency {natural:.6} rad/s of the stuck structure; add damping or move this frequency"
    )]
    UndampedResonance {
        /// Excitation frequency in rad/s.
        omega: f64,
        /// Harmonic that meets the resonance.
        harmonic: usize,
        /// Natural frequency in rad/s.
        natural: f64,
    },
    /// A contact law that has no events.
    #[error(
        "contact {contact}: the law {law} has no events that an exact motion could be followed by; balance harmonics with forced_response, or follow it by transient with scheme = \"rk4\""
    )]
    NoEvents {
        /// The contact, from 1.
        contact: usize,
        /// Name of its law.
        law: String,
    },
    /// Time-domain analysis of one sector.
    #[error("one sector of a travelling wave has no motion of its own in time; give all sectors")]
    TravellingWave,
    /// A motion that the exact flow would follow in far too many steps.
    #[error(
        "dof {dof}: moves {ratio:.3e} times faster than omega = {omega} rad/s, for it has hardly any mass; condense it statically, or balance harmonics instead"
    )]
    TooFast {
        /// The DOF with the highest rate, from 0.
        dof: usize,
        /// Its rate over the frequency of the period.
        ratio: f64,
        /// Frequency of the period in rad/s.
        omega: f64,
        /// The highest ratio that is followed.
        fastest: f64,
    },
    /// No limit cycle to begin a branch with.
    #[error(
        "mode = {mode}: no limit cycle was found next to the stuck mode of {omega:.6} rad/s, whose damping vanishes at r = {onset:.6}; ask for a ratio closer to it, or fewer harmonics"
    )]
    NoLimitCycle {
        /// Mode of the stuck structure.
        mode: usize,
        /// Ratio r at which its damping vanishes.
        onset: f64,
        /// Its natural frequency in rad/s.
        omega: f64,
    },
    /// A friction law that is not registered.
    #[error("contact law '{name}' is unknown; known laws: {known}")]
    UnknownLaw {
        /// The name that was asked for.
        name: String,
        /// The registered names.
        known: String,
    },
}

/// A number in few digits: very large and very small ones with an exponent.
pub(crate) fn brief(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() || (1e-5..1e15).contains(&size) {
        return value.to_string();
    }
    format!("{value:e}")
}

impl Error {
    pub(crate) fn shape(
        entry: &str,
        expected: impl std::fmt::Display,
        got: impl std::fmt::Display,
    ) -> Self {
        Self::Shape {
            entry: entry.to_owned(),
            expected: expected.to_string(),
            got: got.to_string(),
        }
    }

    pub(crate) fn value(entry: impl Into<String>, value: f64, remedy: &str) -> Self {
        Self::Value { entry: entry.into(), value, remedy: remedy.to_owned() }
    }

    /// Refuses to observe a DOF that a structure of `dofs` of them does not have.
    pub(crate) fn check_dofs(observe: &[usize], dofs: usize) -> Result<(), Self> {
        observe.iter().find(|&&dof| dof >= dofs).map_or(Ok(()), |&dof| {
            Err(Self::value("observe", dof as f64, &format!("the structure has {dofs} DOFs")))
        })
    }

    /// Refuses what is no frequency.
    pub(crate) fn check_frequency(entry: &str, omega: f64) -> Result<(), Self> {
        // Squares of frequencies must stay finite.
        if omega > 0.0 && omega < 1e100 {
            return Ok(());
        }
        Err(Self::value(entry, omega, "must be a finite, positive angular frequency in rad/s"))
    }

    /// Refuses an order of harmonics that cannot be had.
    pub(crate) fn check_order(entry: &str, order: usize, highest: usize) -> Result<(), Self> {
        if (1..=highest).contains(&order) {
            return Ok(());
        }
        Err(Self::value(entry, order as f64, &format!("must lie between 1 and {highest}")))
    }
}
