//! Backbones of microslip: force against displacement of a first loading.

mod curve;
mod loading_curve;
mod loss;
mod shear_layer;

pub use curve::{Backbone, Table};
pub use loading_curve::LoadingCurve;
pub(crate) use loading_curve::REVERSALS;
pub use shear_layer::Layer;
