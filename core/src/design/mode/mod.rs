//! Nonlinear modes: extended periodic motions, their frequency and damping against amplitude.

mod assembly;
mod branch;
mod condensed;
mod equations;
mod feed;
mod harmonics;
mod nonlinear_mode;
mod point;
mod preconditioner;
mod quasi_static;
mod settings;
mod start;
mod tangent;

pub use nonlinear_mode::nonlinear_mode;
pub use point::{Interaction, ModePoint};
pub use settings::{Amplitudes, Corner, ModeEnd, ModeMethod, ModeSettings, NonlinearMode};
