//! The elements of all contacts, one after the other.

use crate::contact::{Elastic, SlipElement};
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

/// The elements of all contacts, and the contact displacement that each of their points acts on.
pub(super) fn elements(model: &Model) -> Result<(Vec<Body>, Vec<usize>), Error> {
    let (mut bodies, mut components) = (Vec::<Body>::new(), Vec::new());
    for (contact, (law, range)) in model.laws().iter().zip(model.points()).enumerate() {
        let elements = law
            .elements()
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
