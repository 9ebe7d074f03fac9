//! The work of a point whose receptances are never formed, and whether it is less than with them.

use crate::fourier::Harmonics;
use crate::model::Model;
use crate::structure::Compliance;

/// Unknowns of the largest Jacobian that is formed where products with the modes would do.
const LARGEST_FORMED: usize = 2000;
/// The same of all contacts, whose receptances are formed with it.
const LARGEST_OF_ALL: usize = 8000;
/// Products with all contacts that the solution of a point takes.
const PRODUCTS: f64 = 60.0;
/// Of them a Newton step takes these, with the contacts that slip, …
const PRODUCTS_OF_STEP: f64 = 8.0;
/// … or as many as these if laws couple several points, with all that is orthogonalised: 100 to 280 where
/// nodes slip or open, …
const PRODUCTS_OF_COUPLED: f64 = 800.0;
/// … at so much an operation, …
const PER_OPERATION: f64 = 0.1;
/// … and so much an entry of their tangents, which come from memory \[ns\].
const PER_ENTRY: f64 = 0.8;
/// Operations per unknown by which a product is made orthogonal to those before it, twice, in a basis that is
/// begun anew at 80.
const ORTHOGONALISED: f64 = 320.0;
/// Factorisations that it takes, and the share of the contacts that slip, as a rule.
const FACTORISATIONS: f64 = 4.0;
const SLIPPING: f64 = 0.5;
/// How many times less work it has to be: many small products are slower than one factorisation.
const WORTH: f64 = 4.0;

/// Products of a step of nodes that open: 40 to 70 of 45 nodes.
const PRODUCTS_OF_NODES: f64 = 60.0;
/// How many times less work they have to be. Measured with 45 nodes, of 3 and 5 harmonics, an operation takes as long
/// as one of a factorisation.
const WORTH_OF_NODES: f64 = 2.0;

/// Whether products with the modes are less work than dense receptances and a factorisation.
pub(super) fn suits(compliance: &dyn Compliance, harmonics: &Harmonics) -> bool {
    let Some(modes) = compliance.contact_modes() else { return false };
    let (contacts, slots) = (compliance.contacts() as f64, harmonics.slots() as f64);
    let count = modes.size() as f64;
    let formed = 2.0 * slots * count * contacts * contacts;
    let block = SLIPPING * contacts * slots;
    let dense = formed + FACTORISATIONS * 2.0 / 3.0 * block.powi(3);
    dense > WORTH * PRODUCTS * modes.work(contacts, slots)
}

/// The same of a solution under laws of which some couple several points. Nodes that open yield all together:
/// then a step takes so many products, and both ways are large ones.
pub(super) fn suits_laws(model: &Model, harmonics: &Harmonics) -> bool {
    let compliance = model.compliance();
    let Some(modes) = compliance.contact_modes() else { return false };
    if suits(compliance, harmonics) {
        return true;
    }
    let (contacts, slots) = (compliance.contacts() as f64, harmonics.slots() as f64);
    let laws = model.laws().iter().map(|law| law.displacements() as f64);
    let yielding: f64 = laws.filter(|points| *points > 1.0).sum();
    let factored = 2.0 / 3.0 * (yielding * slots).powi(3);
    factored > WORTH_OF_NODES * PRODUCTS_OF_NODES * modes.work(contacts, slots)
}

/// Whether the whole Jacobian is too large to be formed, along a curve too.
pub(super) fn is_large(compliance: &dyn Compliance, harmonics: &Harmonics) -> bool {
    suits(compliance, harmonics) && compliance.contacts() * harmonics.slots() > LARGEST_FORMED
}

/// About the time of a Newton step of some contacts that slip, on a common processor \[ns\]; a law couples so
/// many of them.
pub(super) fn of_step(compliance: &dyn Compliance, slots: f64, slipping: f64, coupled: f64) -> f64 {
    let products = if coupled > 1.0 { PRODUCTS_OF_COUPLED } else { PRODUCTS_OF_STEP };
    let of = of_products(compliance, slots, slipping, coupled);
    of.map_or(0.0, |[whole, product]| whole + products * product)
}

/// Products of a Newton step that takes so long, its laws left out \[ns\].
pub(super) fn products_within(
    time: f64,
    compliance: &dyn Compliance,
    slots: f64,
    slipping: f64,
    coupled: f64,
) -> f64 {
    let of = of_products(compliance, slots, slipping, coupled);
    of.map_or(0.0, |[whole, product]| (time - whole) / product)
}

/// Of the products of a step with all contacts, and of one with those that slip.
fn of_products(
    compliance: &dyn Compliance,
    slots: f64,
    slipping: f64,
    coupled: f64,
) -> Option<[f64; 2]> {
    let modes = compliance.contact_modes()?;
    let [whole, product] = [compliance.contacts() as f64, slipping]
        .map(|contacts| PER_OPERATION * modes.work(contacts, slots));
    let tangents = if coupled > 1.0 { PER_ENTRY * slipping * coupled * slots * slots } else { 0.0 };
    Some([2.0 * whole, product + tangents])
}

/// Whether the Jacobian of so many points that slip, among all, may be formed after all.
pub(super) fn may_be_formed(compliance: &dyn Compliance, slots: usize, slipping: usize) -> bool {
    let all = compliance.contacts() * slots;
    slipping * slots <= LARGEST_FORMED && all <= LARGEST_OF_ALL
}

/// Whether so many products cost more than to form the Jacobian and to factor it.
pub(super) fn is_cheaper_formed(
    compliance: &dyn Compliance,
    slots: usize,
    slipping: usize,
    products: usize,
) -> bool {
    let Some(modes) = compliance.contact_modes() else { return false };
    let (slots, slipping) = (slots as f64, slipping as f64);
    let formed = 2.0 * slots * modes.size() as f64 * (compliance.contacts() as f64).powi(2);
    let factored = 2.0 / 3.0 * (slots * slipping).powi(3);
    let product = modes.work(slipping, slots) + ORTHOGONALISED * slots * slipping;
    WORTH * products as f64 * product > formed + factored
}

/// Directions that products did not lead to after which a search for the solution is given up.
const MOST_FAILURES: usize = 8;

/// What products with the modes have led to.
#[derive(Debug, Default)]
pub(super) struct ByProducts {
    /// Products of the last direction.
    pub(super) last: usize,
    /// Directions that they did not lead to.
    pub(super) failures: usize,
    /// Most of a direction, if no Jacobian may be formed in their place.
    pub(super) most: Option<usize>,
    /// Whether dense receptances have taken their place.
    pub(super) replaced: bool,
}

impl ByProducts {
    /// Whether they are given up.
    pub(super) fn are_lost(&self) -> bool {
        self.failures >= MOST_FAILURES
    }
}
