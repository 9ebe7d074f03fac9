//! The registry: laws by the names that study files and Python give them.

use super::{ContactLaw, Cubic, Jenkins, Parameters, Stop, StructuralDamper};
use crate::Error;

/// The registry: a law from its name and parameters.
///
/// # Errors
/// Unknown name, or parameters the law refuses.
pub fn law(name: &str, parameters: &Parameters) -> Result<Box<dyn ContactLaw>, Error> {
    match name {
        "jenkins" | "parallel-jenkins" => Ok(Box::new(Jenkins::from_parameters(parameters)?)),
        "cubic" => Ok(Box::new(Cubic::from_parameters(parameters)?)),
        "stop" => Ok(Box::new(Stop::from_parameters(parameters)?)),
        "structural" => Ok(Box::new(StructuralDamper::from_parameters(parameters)?)),
        other => Err(Error::UnknownLaw {
            name: other.to_owned(),
            known: "jenkins, parallel-jenkins, structural, stop, cubic".to_owned(),
        }),
    }
}
