//! The elements of all contacts, one after the other.

use super::spring::Spring;
use crate::contact::{Elastic, Element, SlipElement};
use crate::model::Model;
use crate::Error;
use std::ops::Range;
use std::sync::Arc;

/// An element of a contact: its law, its points and what deforms in it.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    pub(crate) law: Arc<dyn SlipElement>,
    /// Position of its contact.
    pub(crate) contact: usize,
    /// Its points among those of all elements.
    pub(crate) points: Range<usize>,
    /// Its strains among those of the model.
    pub(crate) strains: Range<usize>,
    pub(crate) elastic: Elastic,
}

/// The elements of all contacts, and the contact displacement that each of their points acts on. Laws
/// without memory have elements where forces are sampled, with the unit that `sampled` gives.
pub(super) fn elements(
    model: &Model,
    sampled: Option<&dyn Fn(usize) -> f64>,
) -> Result<(Vec<Body>, Vec<usize>), Error> {
    let (mut bodies, mut components) = (Vec::<Body>::new(), Vec::new());
    for (contact, (law, range)) in model.laws().iter().zip(model.points()).enumerate() {
        let spring = |unit: &dyn Fn(usize) -> f64| {
            let law = Spring { law: law.with_scaled_forces(1.0), unit: unit(range.start) };
            vec![Element { components: (0..range.len()).collect(), law: Arc::new(law) }]
        };
        let own = law.elements();
        let elements = own
            .or_else(|| sampled.filter(|_| law.state_size() == 0).map(spring))
            .ok_or_else(|| Error::NoEvents { contact: contact + 1, law: law.name().to_owned() })?;
        for element in elements {
            let elastic = Elastic::new(element.law.stiffness().as_ref())?;
            let first = bodies.last().map_or(0, |body| body.strains.end);
            let strains = first..first + elastic.rank();
            let start = components.len();
            components.extend(element.components.iter().map(|own| range.start + own));
            let points = start..components.len();
            bodies.push(Body { law: element.law, contact, points, strains, elastic });
        }
    }
    Ok((bodies, components))
}

pub(super) fn limits_of(bodies: &[Body]) -> Vec<f64> {
    bodies.iter().flat_map(|body| body.law.limits()).collect()
}
