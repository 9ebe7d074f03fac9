//! The numbers of a law: those that it is built of, and those of them that can be varied.

use crate::Error;
use std::collections::BTreeMap;

/// A number of a law that can be varied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// The contact point that it belongs to; nothing if it is the whole contact's.
    pub point: Option<usize>,
    /// Its value.
    pub value: f64,
    /// Whether it is a factor on what the law was built with, and no quantity with a unit.
    pub factor: bool,
}

impl Parameter {
    /// Name of a slip limit.
    pub const SLIP_FORCE: &'static str = "slip_force";

    /// Slip limit of a point \[N\].
    pub(super) fn slip_force(point: usize, value: f64) -> Self {
        Self { name: Self::SLIP_FORCE, point: Some(point), value, factor: false }
    }

    /// Gap of the whole contact \[m\].
    pub(super) fn gap(value: f64) -> Self {
        Self { name: "gap", point: None, value, factor: false }
    }

    /// Stiffness of the whole contact [N/m].
    pub(super) fn stiffness(value: f64) -> Self {
        Self { name: "stiffness", point: None, value, factor: false }
    }
}

/// Parameters of a law by name.
pub type Parameters = BTreeMap<String, Vec<f64>>;

/// The number a law expects under `name`.
pub(super) fn number(law: &str, parameters: &Parameters, name: &str) -> Result<f64, Error> {
    match numbers(law, parameters, name)? {
        [one] => Ok(*one),
        several => Err(Error::shape(&format!("{law}: {name}"), "one number", several.len())),
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
