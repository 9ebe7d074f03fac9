//! The registry: laws by the names that study files and Python give them.

use super::{ContactLaw, Jenkins, StructuralDamper};
use crate::Error;
use std::collections::BTreeMap;

/// Parameters of a law by name.
pub type Parameters = BTreeMap<String, Vec<f64>>;

/// The registry: a law from its name and parameters.
///
/// # Errors
/// Unknown name, or parameters the law refuses.
pub fn law(name: &str, parameters: &Parameters) -> Result<Box<dyn ContactLaw>, Error> {
    match name {
        "jenkins" | "parallel-jenkins" => Ok(Box::new(Jenkins::from_parameters(parameters)?)),
        "structural" => Ok(Box::new(StructuralDamper::from_parameters(parameters)?)),
        other => Err(Error::UnknownLaw {
            name: other.to_owned(),
            known: "jenkins, parallel-jenkins, structural".to_owned(),
        }),
    }
}

/// The numbers a law expects under `name`.
pub(super) fn numbers<'a>(
    law: &str,
    parameters: &'a Parameters,
    name: &str,
) -> Result<&'a [f64], Error> {
    let found = parameters.get(name).map(Vec::as_slice);
    found.ok_or_else(|| Error::shape(&format!("{law}: {name}"), "numbers", "nothing"))
}
