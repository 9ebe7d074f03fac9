//! The Jenkins element: a spring and a slider in series.

mod law;
mod parameters;
mod slider;

pub use law::Jenkins;
pub use slider::Slider;
