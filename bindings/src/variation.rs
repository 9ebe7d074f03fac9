//! What is varied.

use pyo3::prelude::*;
use stickslip_core::model::{ParameterMode, Variation};

/// What is varied: `parameter` is "level" or one of the laws', of contacts or of points.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Varied {
    parameter: String,
    contacts: Vec<(usize, Option<usize>)>,
    factor: bool,
}

impl From<Varied> for Variation {
    fn from(varied: Varied) -> Self {
        let Varied { parameter, contacts, factor } = varied;
        match parameter.as_str() {
            "level" => Self::Level,
            _ => {
                let common = if factor { ParameterMode::Factor } else { ParameterMode::Value };
                Self::Law { parameter, contacts, common }
            }
        }
    }
}
