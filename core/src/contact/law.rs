//! What a contact law is: one small trait, and the capabilities that a law may have beside it.
//!
//! The contact force is written `f = D u − q`: the stuck spring's force less the *slip load* q,
//! which is what slip takes off it. The stuck structure carries D, so that the balance has to
//! find q alone; it vanishes while a contact sticks.

use super::backbone::LoadingCurve;
use super::lap::{Lap, Repeated};
use super::point_state::Phase;
use super::return_map::ReturnMapJacobian;
use super::slip_element::Element;
use super::{AssumedStart, Describing, Held, Parameter, Residual};
use crate::fourier::{Harmonics, SampleTable};
use crate::Error;
use faer::Mat;

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

impl<'a> Motion<'a> {
    /// The mean of one displacement, and its motion about that, whose digits a large mean does not take.
    pub(super) fn about_mean<'b>(&self, series: &'b mut Vec<f64>) -> (f64, Motion<'b>)
    where
        'a: 'b,
    {
        let harmonics = self.table.harmonics();
        series.clear();
        series.extend_from_slice(self.displacement);
        series[..harmonics.offset()].fill(0.0);
        (harmonics.mean(self.displacement), Motion { displacement: series, ..*self })
    }
}

/// Fourier coefficients of the slip load of one contact, and their derivative.
#[derive(Debug, Clone, Default)]
pub struct SlipLoad {
    /// q, laid out as the displacement \[N\].
    pub value: Vec<f64>,
    /// ∂q/∂u, row by row, empty unless it was asked for, as it may be of a contact that sticks [N/m].
    pub tangent: Vec<f64>,
    /// Whether the tangent differs from zero: a contact that sticks for good is a linear spring
    /// and drops out of the Newton system.
    pub active: bool,
    /// Whether a march gives a tangent of zeros no room: those of thousands of contacts that stick take more time
    /// than all else.
    pub spares_zeros: bool,
    /// The state that a march has repeated, if it is the same whatever the march begins with; the next one
    /// begins with it.
    pub repeated: Option<Repeated>,
    /// Rounds of a march until its state has repeated.
    pub rounds: usize,
    /// Those that its tangent was carried along.
    pub derived: usize,
    /// Panels of slip in two directions in the period that repeats.
    pub panels: usize,
    /// Panels that were solved for until then.
    pub solved: usize,
}

impl SlipLoad {
    /// None yet, whose tangents of zeros take no room.
    pub(crate) fn sparing() -> Self {
        Self { spares_zeros: true, ..Self::default() }
    }

    pub(crate) fn reset(&mut self, size: usize, tangent: bool) {
        self.value.clear();
        self.value.resize(size, 0.0);
        self.tangent.clear();
        if tangent {
            self.tangent.resize(size * size, 0.0);
        }
        self.active = false;
        (self.rounds, self.derived, self.panels, self.solved) = (0, 0, 0, 0);
    }

    /// Gives a tangent of zeros its room.
    pub(crate) fn make_room(&mut self, tangent: bool) {
        if tangent && self.tangent.is_empty() {
            self.tangent.resize(self.value.len().pow(2), 0.0);
        }
    }

    /// See [`Harmonics::halve_means`]; the derivative follows.
    pub(super) fn halve_means(&mut self, harmonics: &Harmonics) {
        harmonics.halve_means(&mut self.value);
        let size = self.value.len();
        if harmonics.has_mean() && !self.tangent.is_empty() {
            let means = self.tangent.chunks_exact_mut(size).step_by(harmonics.slots());
            means.flatten().for_each(|entry| *entry *= 0.5);
        }
    }
}

/// What slip takes off the stuck spring's force of a motion on which nothing slips: it is constant, and
/// varies with where the motion is assumed to begin.
#[derive(Debug, Clone)]
pub struct Unslipped {
    /// `D u − f` \[N\].
    pub value: Vec<f64>,
    /// Its derivative in the coefficients of the motion, row by row; rows may be missing at the end [N/m].
    pub rate: Vec<f64>,
}

/// What one point of a contact does over a period.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PointSummary {
    /// Share of the period in slip.
    pub slip_fraction: f64,
    /// Friction work per period \[J\].
    pub dissipation: f64,
}

/// A law between one or several relative displacements and as many contact forces.
///
/// A law needs no more than what has no default here: the sampled evaluation ([`super::Aft`]) then gives
/// its harmonics. A new law is one file in this folder and one line in its registry.
pub trait ContactLaw: Send + Sync + std::fmt::Debug {
    /// Name in messages and in the registry.
    fn name(&self) -> &'static str;

    /// Number n of relative displacements, and of contact forces.
    fn displacements(&self) -> usize;

    /// Number m of numbers that the law remembers.
    fn state_size(&self) -> usize;

    /// The same law with so many places for what it remembers, if it has a choice: a transient has more
    /// reversals than a period.
    fn with_memory(&self, _places: usize) -> Option<Box<dyn ContactLaw>> {
        None
    }

    /// Stiffness D of the stuck contact, n × n, symmetric positive semidefinite [N/m].
    fn stiffness(&self) -> Mat<f64>;

    /// Stiffness of the state of the stuck contact, `∂z/∂u`, m × n.
    fn state_stiffness(&self) -> Mat<f64>;

    /// Whether the opposite motion gives the opposite force. An odd law under odd harmonics keeps
    /// half-wave symmetry.
    fn is_odd(&self) -> bool;

    /// Whether the force is a monotone operator of the motion. A passive structure with laws that
    /// all are has one steady motion.
    fn is_monotone(&self) -> bool;

    /// Whether one thread at a time alone can evaluate the law, so that several would wait for one another.
    fn is_serial(&self) -> bool {
        false
    }

    /// Largest force that every component can have \[N\]: 0 if it never carries any, infinite if it
    /// never slips.
    fn limits(&self) -> Vec<f64>;

    /// Pairs of components whose forces are one traction: its length has the limit that both have.
    fn planes(&self) -> Vec<[usize; 2]> {
        Vec::new()
    }

    /// Whether a growing displacement of a component may take forces of the law beyond their limits, or off the
    /// stuck spring where they have none. A law that does not say so may be anything.
    fn grows(&self) -> Vec<bool> {
        vec![true; self.displacements()]
    }

    /// Force of every component at which slip begins \[N\].
    fn onsets(&self) -> Vec<f64> {
        self.limits()
    }

    /// Whether the contact slips in a periodic motion, as far as its amplitudes alone show it.
    fn surely_slips(&self, _motion: Motion<'_>) -> Option<bool> {
        None
    }

    /// Whether the amplitudes of a periodic motion alone show that the contact sticks for good: no more than that,
    /// of a law that looks at instants to see slip.
    fn surely_sticks(&self, motion: Motion<'_>) -> bool {
        self.surely_slips(motion) == Some(false)
    }

    /// Return map of one step: takes the state through a change of the displacements and gives the
    /// force after it. All states are zero where the displacements are and nothing has slipped.
    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    );

    /// Takes a step that the stuck spring takes, from its begin to its end, and says so; nothing is taken
    /// of any other. The derivative of all these steps is the same, that of the spring; a law without this
    /// shortcut takes every step by [`Self::return_map`].
    fn springs(
        &self,
        _before: &[f64],
        _after: &[f64],
        _state: &mut [f64],
        _force: &mut [f64],
    ) -> bool {
        false
    }

    /// Takes a lap at once, of a law whose steps bring states nearer to one another: a motion on which it
    /// slips then has one state that repeats. Nothing is taken of any other.
    fn lap(&self, _lap: &mut Lap<'_>) -> bool {
        false
    }

    /// The displacements and the state from which a motion begins that has no history but its loads':
    /// all zero unless the law says otherwise.
    fn beginning(&self) -> (Vec<f64>, Vec<f64>) {
        (vec![0.0; self.displacements()], vec![0.0; self.state_size()])
    }

    /// Where a periodic motion begins whose residual traction is assumed by [`Residual`]; nothing of a
    /// law that has no such rule, or under half-wave symmetry, which leaves nothing to assume: it
    /// begins at its [`Self::beginning`].
    fn assumed(&self, _motion: Motion<'_>) -> Option<AssumedStart> {
        None
    }

    /// What slip takes off the stuck spring's force of a march from a start through displacements,
    /// instant after instant, on which nothing slips or opens. Nothing if something may; a law that
    /// cannot tell is marched.
    fn unslipped(&self, _begun: &AssumedStart, _displacement: &[f64]) -> Option<Unslipped> {
        None
    }

    /// The same as far as the amplitudes of a motion alone show it, without any instant.
    fn surely_unslipped(&self, _begun: &AssumedStart, _motion: Motion<'_>) -> Option<Unslipped> {
        None
    }

    /// The same law with motions that begin elsewhere, as under static loads; nothing of a law whose
    /// friction does not depend on it beyond its residual force.
    fn with_history(&self, _displacement: &[f64], _state: &[f64]) -> Option<Box<dyn ContactLaw>> {
        None
    }

    /// The sliders that a periodic motion leaves where they are, component by component: none of a
    /// component that has no slider, that forgets its start, or whose start is not varied.
    fn held(&self, _motion: Motion<'_>) -> Vec<Option<Held>> {
        vec![None; self.displacements()]
    }

    /// Slip load of a contact of one displacement that stays between `low` and `high` without slip,
    /// with its derivatives in the two; `None` if it slips. Laws of several displacements have no
    /// such rule: a march of them starts without slip.
    fn stuck_load(&self, _residual: Residual, _low: f64, _high: f64) -> Option<[f64; 3]> {
        None
    }

    /// The same law with all its stiffness multiplied by `share`, for homotopies.
    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw>;

    /// The same law with all its forces multiplied by `factor` and its stiffness kept: at `factor`
    /// times the displacements its force is `factor` times as large.
    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw>;

    /// The parameters, each addressed by its position; none by default.
    fn parameters(&self) -> Vec<Parameter> {
        Vec::new()
    }

    /// The same law with another value of one parameter.
    ///
    /// # Errors
    /// A value that the law refuses.
    fn with_parameter(&self, index: usize, value: f64) -> Result<Box<dyn ContactLaw>, Error> {
        let _ = index;
        Err(Error::value("parameter", value, "the law has no parameters"))
    }

    /// An evaluation of its own for periodic motions, if the law has one: exact Fourier integrals.
    fn closed_form(&self) -> Option<&dyn HarmonicForce> {
        None
    }

    /// The laws that this one is the sum of, if it is one: each remembers its own motion.
    fn parts(&self) -> Vec<Box<dyn ContactLaw>> {
        Vec::new()
    }

    /// The elements whose events exact motions are followed by, if the law is made of such.
    fn elements(&self) -> Option<Vec<Element>> {
        None
    }

    /// The force of first loading of a law of one displacement that slips little by little, if it follows
    /// by Masing's rule and return-point memory: exact motions go from reversal to reversal.
    fn loading(&self) -> Option<LoadingCurve> {
        None
    }

    /// Describing function of a law of one displacement under a harmonic one of the given
    /// amplitude, if it has one in closed form.
    fn describing(&self, _amplitude: f64) -> Option<Describing> {
        None
    }
}

/// Time of an evaluation that takes so long by itself, per coefficient, and per entry of its tangent \[ns\].
pub(crate) fn effort_of([own, each, entry]: [f64; 3], coefficients: usize, tangent: bool) -> f64 {
    let coefficients = coefficients as f64;
    let entries = if tangent { coefficients.powi(2) } else { 0.0 };
    own + each * coefficients + entry * entries
}

/// The harmonics of the contact force of a periodic motion, and what belongs to them.
pub trait HarmonicForce {
    /// Slip load of a periodic motion and, if asked for, its tangent. Both belong to each other
    /// exactly: the tangent is the derivative of this value, history included.
    fn slip_load(&self, motion: Motion<'_>, tangent: bool, out: &mut SlipLoad);

    /// Highest harmonic that the evaluation resolves; all of them where it is exact.
    fn resolves(&self) -> usize {
        usize::MAX
    }

    /// Time that an evaluation usually takes that has led to a load, with its tangent or without, in so many
    /// coefficients per component \[ns\]: work is counted by it.
    fn effort(&self, slots: usize, _load: &SlipLoad, tangent: bool) -> f64 {
        effort_of([1e3, 60.0, 4.0], slots, tangent)
    }

    /// Slip share and friction work of every component.
    fn summary(&self, motion: Motion<'_>, out: &mut [PointSummary]);

    /// States at `samples` equidistant instants, instant after instant.
    fn state_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64>;

    /// Contact forces at `samples` equidistant instants, instant after instant \[N\].
    fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64>;

    /// What the components do over a period, from change to change.
    fn phases(&self, motion: Motion<'_>) -> Vec<Phase>;

    /// Series of the derivative of the contact force in parameter `index` at fixed displacement,
    /// laid out as the displacement.
    fn parameter_slope(&self, motion: Motion<'_>, index: usize, out: &mut [f64]);
}
