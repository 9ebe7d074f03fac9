//! What solutions and their error estimates cost, as reckoned before any is made.

use super::modal_work::{of_step, products_within, suits, suits_laws};
use super::ring::RingNewton;
use super::solution::Point;
use crate::fourier::Harmonics;
use crate::model::Model;
use crate::structure::Compliance;

/// Effort of an estimate over that of the Newton steps of a solution from nothing, both as reckoned, and over that of
/// its compliances and displacements as long as these are the lesser part; else they cost no more than there. Measured
/// on random chains of 1 to 6 contacts, estimates take 0.33 times as long as the rest in the median, and longer, 1.09
/// times at most, at 2 of 2160.
const ALLOWED: f64 = 1.3;
/// The same of solutions up to this harmonic, whose steps are short of what is not reckoned, by themselves and along a
/// curve.
const FEW: usize = 5;
const ALLOWED_OF_FEW: [f64; 2] = [0.85, 0.9];
/// The same of a few nodes or faces, whose laws and tangents take more than is reckoned.
const ALLOWED_OF_COUPLED: f64 = 2.0;
/// The same of a ring, of which nearly all is reckoned, by itself and along a curve.
const ALLOWED_OF_RING: f64 = 0.85;
/// The same of many contacts, whose products with the modes are reckoned as they are.
const ALLOWED_OF_MANY: f64 = 0.25;
/// The same of many nodes that slip or open, of which nearly all is reckoned.
const ALLOWED_OF_NODES: f64 = 0.8;

/// The same of all others along a curve, over what solutions beside each other take.
const ALLOWED_ALONG: f64 = 1.2;

/// Most that receptances of loads at the points that slip take, over those of all: contacts that begin to slip take as
/// much once more.
const WORTH: f64 = 0.6;

/// Newton steps that the solution of a point with slip takes from the motion without slip, the last ones without a
/// tangent of their own: more, the farther that is, from none to as far as the motion is large. Measured on 500 random
/// chains those at a tenth of that take two or three tangents.
const OF_SOLUTION: [f64; 2] = [3.0, 6.0];
/// The same of few harmonics: with less than this their estimates do not reach the modes that harmonics above them meet.
const OF_FEW: [f64; 2] = [4.5, 6.0];
/// The same of laws without slip, whose tangents are those of the way: half as many, and less than one of a nearly linear
/// motion.
const OF_SMOOTH: [f64; 2] = [0.8, 3.0];

/// Share of a second step of an estimate that looks at what the first one leaves.
const OF_LOOK: f64 = 0.2;

/// Newton steps with a tangent of their own, and evaluations of the laws without, that a solution beside another
/// one takes on coarse curves. That of another method is judged alike.
const BESIDE: f64 = 2.5;
/// The same of laws without slip.
const BESIDE_OF_SMOOTH: f64 = 0.9;

/// Share of the contacts that stick which the first step of an estimate may make slip.
const BEGIN_TO_SLIP: f64 = 0.1;

/// Share of a look for turning points that a contact takes if it sticks: measured, 0.1 to 0.2.
const OF_STICKING: f64 = 0.15;

/// Of a coarse table of samples, over the product of its highest harmonic and that of motions \[ns\].
const OF_TABLE: f64 = 4.0;

/// What a single harmonic takes, over what its parts are reckoned at: measured, 0.6 to 0.7, with some to spare.
const OF_SINGLE: f64 = 0.8;

/// What Newton steps, compliances and displacements of a solution allow an estimate.
pub(super) fn allowance(share: f64, steps: f64, orders: f64) -> f64 {
    share * steps + (share * orders).min(orders.max(steps))
}

/// About the time of a balance on a common processor \[ns\]; its ratios count.
#[derive(Clone, Copy)]
pub(super) struct Effort<'a> {
    model: &'a Model,
    half_wave: bool,
    pub(super) slipping: usize,
    /// Of a compliance for loads at all points, and at those that slip, and of the displacements of the observed
    /// degrees of freedom, at one order.
    of_order: [f64; 3],
    /// Points that a law couples, in the mean.
    coupled: f64,
    /// Whether Jacobians are formed in any case.
    formed: bool,
    /// How far the solution is from the motion without slip: 1 where it is as far as it is large, and where nobody knows.
    far: f64,
}

impl<'a> Effort<'a> {
    /// Of balances with half-wave symmetry or without, with so many points that slip and so many observed
    /// degrees of freedom.
    pub(super) fn new(model: &'a Model, half_wave: bool, slipping: usize, observed: usize) -> Self {
        let compliance = model.compliance();
        let [whole, displacement] = compliance.effort(compliance.contacts(), observed);
        // Nodes carry loads without slip: what presses them.
        let nodes: usize =
            model.laws().iter().map(|law| law.displacements()).filter(|n| *n > 1).sum();
        let loaded = (slipping + nodes).min(compliance.contacts());
        let part = compliance.effort(loaded, observed)[0];
        let part = if part < WORTH * whole { part } else { whole };
        let of_order = [whole, part, displacement];
        let coupled = coupled_points(model);
        Self { model, half_wave, slipping, of_order, coupled, formed: false, far: 1.0 }
    }

    /// The same for the solution that a point has, by how far it is from the motion without slip. Estimates
    /// of rings take no more than their solutions without that.
    pub(super) fn of(&self, point: &Point) -> Self {
        let ring = self.compliance().ring().is_some();
        Self { far: if ring { 1.0 } else { point.from_stuck.min(1.0) }, ..*self }
    }

    /// The same where Jacobians are formed in any case.
    pub(super) fn formed(&self) -> Self {
        Self { formed: true, ..*self }
    }

    /// Whether Jacobians are formed in any case.
    pub(super) fn is_formed(&self) -> bool {
        self.formed
    }

    /// Whether some law couples several points.
    pub(super) fn is_of_nodes(&self) -> bool {
        self.coupled > 1.0
    }

    /// Whether products serve up to an order.
    pub(super) fn takes_products(&self, order: usize) -> bool {
        !self.formed && suits_laws(self.model, &Harmonics::new(order, self.half_wave))
    }

    pub(super) fn compliance(&self) -> &'a dyn Compliance {
        self.model.compliance()
    }

    /// What the harmonics that loads have are multiples of; those that friction answers with are, too.
    pub(super) fn common_harmonic(&self) -> usize {
        common_divisor(&self.compliance().forced_harmonics())
    }

    /// What a solution with harmonics up to `highest` that starts from its neighbour allows the estimates along their
    /// curve.
    pub(super) fn earned(&self, highest: usize) -> f64 {
        let beside = if self.slips() { BESIDE } else { BESIDE_OF_SMOOTH };
        let steps = beside * (self.step(highest) + self.values(highest));
        let ring = self.compliance().ring().is_some();
        let share = match highest {
            _ if ring => ALLOWED_OF_RING,
            ..=FEW => ALLOWED_OF_FEW[1],
            _ => ALLOWED_ALONG,
        };
        allowance(share, steps, self.orders(highest))
    }

    /// Of a solution with harmonics up to `highest` that starts close to it: one Newton step, and the evaluation of
    /// the laws that ends it.
    pub(super) fn closely(&self, highest: usize) -> f64 {
        self.step(highest) + self.values(highest) + self.orders(highest)
    }

    /// Effort of an estimate up to the last order over that of the steps of the solution up to the first.
    pub(super) fn allowed(&self, [highest, order]: [usize; 2]) -> f64 {
        let coupled = self.is_of_nodes();
        if self.compliance().ring().is_some() {
            ALLOWED_OF_RING
        } else if coupled && self.is_of_many(order) {
            ALLOWED_OF_NODES
        } else if self.is_of_many(highest) {
            ALLOWED_OF_MANY
        } else if coupled {
            ALLOWED_OF_COUPLED
        } else if highest > FEW {
            ALLOWED
        } else {
            ALLOWED_OF_FEW[0]
        }
    }

    /// Of the compliances and displacements of a solution up to an order.
    pub(super) fn orders(&self, highest: usize) -> f64 {
        self.count(highest) * (self.compliance_for(self.of_order[0], highest) + self.of_order[2])
    }

    /// Of the displacements up to an order, and of the compliances between the last two.
    pub(super) fn extended(&self, highest: usize, order: usize) -> [f64; 2] {
        let discarded = self.count(order) - self.count(highest);
        let compliance = self.compliance_for(self.of_order[1], order);
        [self.count(order) * self.of_order[2], discarded * compliance]
    }

    /// Whether receptances of loads at the points that slip take less than those of all.
    pub(super) fn takes_part(&self) -> bool {
        self.of_order[1] < self.of_order[0]
    }

    fn count(&self, highest: usize) -> f64 {
        (if self.half_wave { highest.div_ceil(2) } else { highest + 1 }) as f64
    }

    /// Of one compliance of a balance up to an order, if receptances take so much.
    fn compliance_for(&self, receptance: f64, highest: usize) -> f64 {
        match self.compliance().contact_modes() {
            Some(modes) if self.is_of_many(highest) => modes.effort(),
            _ => receptance,
        }
    }

    /// Whether receptances are not formed.
    fn is_of_many(&self, highest: usize) -> bool {
        let compliance = self.compliance();
        !self.formed
            && compliance.contact_modes().is_some()
            && suits(compliance, &Harmonics::new(highest, self.half_wave))
    }

    fn slots(&self, highest: usize) -> f64 {
        if self.half_wave {
            2.0 * highest.div_ceil(2) as f64
        } else {
            2.0 * highest as f64 + 1.0
        }
    }

    /// Of the laws without their tangents.
    fn values(&self, highest: usize) -> f64 {
        let slots = self.slots(highest);
        let (contacts, slipping) = (self.compliance().contacts() as f64, self.slipping as f64);
        // Every law looks for turning points, unless amplitudes alone show that it sticks; one that slips
        // integrates.
        let sticking = if self.compliance().ring().is_some() { 0.0 } else { contacts - slipping };
        let looks = slipping + OF_STICKING * sticking.max(0.0);
        looks * (600.0 + 40.0 * slots) + slipping * (600.0 + 80.0 * slots)
    }

    /// Products that a Newton step in the harmonics up to `order` may take, if it may take so long and those up to
    /// `highest` take none.
    pub(super) fn products_within(&self, time: f64, [highest, order]: [usize; 2]) -> Option<usize> {
        let takes = |order| suits_laws(self.model, &Harmonics::new(order, self.half_wave));
        if self.formed || takes(highest) || !takes(order) {
            return None;
        }
        let (slots, slipping) = (self.slots(order), self.slipping as f64);
        let left = time - self.laws(order);
        Some(products_within(left, self.compliance(), slots, slipping, self.coupled).max(1.0)
            as usize)
    }

    /// Of the laws with their tangents.
    fn laws(&self, highest: usize) -> f64 {
        self.values(highest) + self.slipping as f64 * 2.5 * self.slots(highest).powi(2)
    }

    /// The same after a step that makes contacts slip.
    pub(super) fn with_more_slip(&self) -> Self {
        let sticking = self.compliance().contacts().saturating_sub(self.slipping) as f64;
        Self { slipping: self.slipping + (BEGIN_TO_SLIP * sticking) as usize, ..*self }
    }

    /// Of what a single harmonic would change in a solution up to `highest`: a table of its own, the laws as they are
    /// and once more for each direction of a contact, and few equations.
    pub(super) fn of_resonance(&self, highest: usize, order: usize) -> f64 {
        let table = OF_TABLE * (highest * order) as f64;
        let laws = (1.0 + self.coupled) * self.values(order);
        let step = formed_step(2.0 * self.slipping as f64);
        OF_SINGLE * (table + laws + self.of_order[1] + self.of_order[2] + step)
    }

    fn slips(&self) -> bool {
        self.model.slip_limits().any(f64::is_finite)
    }

    /// Of the Newton steps of a solution from the motion without slip.
    pub(super) fn steps(&self, highest: usize) -> f64 {
        let [near, far] = match highest {
            _ if !self.slips() => OF_SMOOTH,
            ..=FEW => OF_FEW,
            _ => OF_SOLUTION,
        };
        (near + (far - near) * self.far) * self.step(highest)
    }

    /// Share of a second step that an estimate takes: the look at what the first one leaves, and the more often all of
    /// it, the farther the solution is from the motion without slip.
    pub(super) fn of_second(&self) -> f64 {
        OF_LOOK + (1.0 - OF_LOOK) * self.far
    }

    /// Of a Newton step in the harmonics up to `highest`.
    pub(super) fn step(&self, highest: usize) -> f64 {
        let (compliance, slots) = (self.compliance(), self.slots(highest));
        let slipping = self.slipping as f64;
        let linear = match compliance.ring() {
            Some(ring) => RingNewton::effort(ring, slots, slipping),
            None if self.is_of_many(highest) => of_step(compliance, slots, slipping, self.coupled),
            None => formed_step(slipping * slots),
        };
        self.laws(highest) + linear
    }
}

/// Of a factorisation in so many unknowns, and of what leads to it.
fn formed_step(unknowns: f64) -> f64 {
    1.3e3 + unknowns * (190.0 + unknowns * (4.0 + 0.03 * unknowns))
}

/// Greatest common divisor of numbers, 1 of none.
fn common_divisor(numbers: &[usize]) -> usize {
    let divisor = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    numbers.iter().copied().fold(0, divisor).max(1)
}

/// Points of a law that couples several, in the mean over those of all such laws; 1 if there are none.
fn coupled_points(model: &Model) -> f64 {
    let sizes = || model.laws().iter().map(|law| law.displacements() as f64);
    let coupled = || sizes().filter(|size| *size > 1.0);
    let points: f64 = coupled().sum();
    if points > 0.0 {
        coupled().map(|size| size * size).sum::<f64>() / points
    } else {
        1.0
    }
}
