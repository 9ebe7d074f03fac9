//! The registry: laws by the names that study files and Python give them.

use super::{
    BoucWen, ContactLaw, Coulomb, Cubic, Jenkins, Masing, Parameters, Stop, StructuralDamper,
};
use crate::Error;

type Maker = fn(&Parameters) -> Result<Box<dyn ContactLaw>, Error>;

/// Every law by its name.
const LAWS: [(&str, Maker); 9] = [
    ("bouc-wen", |given| Ok(Box::new(BoucWen::from_parameters(given)?))),
    ("coulomb", |given| Ok(Box::new(Coulomb::from_parameters(given)?))),
    ("cubic", |given| Ok(Box::new(Cubic::from_parameters(given)?))),
    ("iwan", |given| Ok(Box::new(Masing::iwan_from_parameters(given)?))),
    ("jenkins", |given| Ok(Box::new(Jenkins::from_parameters(given)?))),
    ("masing", |given| Ok(Box::new(Masing::from_parameters(given)?))),
    ("parallel-jenkins", |given| Ok(Box::new(Jenkins::from_parameters(given)?))),
    ("stop", |given| Ok(Box::new(Stop::from_parameters(given)?))),
    ("structural", |given| Ok(Box::new(StructuralDamper::from_parameters(given)?))),
];

/// The registry: a law from its name and parameters.
///
/// # Errors
/// Unknown name, or parameters the law refuses.
pub fn law(name: &str, parameters: &Parameters) -> Result<Box<dyn ContactLaw>, Error> {
    match LAWS.iter().find(|(known, _)| *known == name) {
        Some((_, make)) => make(parameters),
        None => Err(Error::UnknownLaw {
            name: name.to_owned(),
            known: LAWS.map(|(known, _)| known).join(", "),
        }),
    }
}
