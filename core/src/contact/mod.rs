//! Contact laws behind one trait: series of u in, series of slip load and tangent out.

mod aft;
mod cycle;
mod derivative;
mod describing;
mod elastic;
mod increment;
mod jenkins;
mod jenkins_parameters;
mod jets;
mod law;
mod march_rate;
mod parameter;
mod passage;
mod registry;
mod samples;
mod slip_series;
mod slip_set;
mod structural;
mod structural_parameters;
mod transitions;

pub use aft::Aft;
pub use describing::Describing;
pub use elastic::Elastic;
pub use jenkins::{Jenkins, Slider};
pub use law::{
    ContactLaw, Element, HarmonicForce, Motion, Phase, PointState, PointSummary, Residual,
    ReturnMapJacobian, SlipElement, SlipLoad,
};
pub use parameter::Parameter;
pub use registry::{law, Parameters};
pub use structural::StructuralDamper;
