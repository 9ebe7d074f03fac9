//! Contact laws behind one trait: series of u in, series of slip load and tangent out.

mod active_set;
mod aft;
mod aft_march;
mod backbone;
mod bouc_wen;
mod coulomb;
mod coulomb_circle;
mod coulomb_constant;
mod coulomb_cycle;
mod coulomb_drive;
mod coulomb_element;
mod coulomb_harmonics;
mod coulomb_period;
mod coulomb_plane;
mod coulomb_play;
mod coulomb_slip;
mod cubic;
mod derivative;
mod described;
mod describing;
mod dual;
mod elastic;
mod increment;
mod jenkins;
mod jets;
mod law;
mod march_rate;
mod masing;
mod masing_integrals;
mod masing_loops;
mod masing_memory;
mod parameter;
mod periodic_march;
mod registry;
mod residual;
mod samples;
mod slider;
mod slider_integrals;
mod slider_parameters;
mod slip_series;
mod stick_slip;
mod stop;
mod structural;
mod structural_law;
mod structural_parameters;
mod transitions;

pub use aft::Aft;
pub use backbone::{Backbone, Table};
pub use bouc_wen::BoucWen;
pub use coulomb::{Closure, Coulomb};
pub use cubic::Cubic;
pub(crate) use described::Described;
pub use describing::Describing;
pub use elastic::Elastic;
pub use jenkins::Jenkins;
pub use law::{
    Bound, ContactLaw, Element, HarmonicForce, Motion, Phase, PointState, PointSummary,
    ReturnMapJacobian, SlipElement, SlipLoad, SlipPlane,
};
pub use masing::Masing;
pub use parameter::{Parameter, Parameters};
pub use registry::law;
pub use residual::{AssumedStart, Residual};
pub use slider::Slider;
pub use stop::Stop;
pub use structural::StructuralDamper;
