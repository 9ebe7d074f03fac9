//! Coulomb friction under a normal load that varies, in a line and in a plane, with separation.

mod circle;
mod collocation;
mod constant;
mod corner;
mod cycle;
mod drive;
mod dual;
mod element;
mod grid;
mod harmonics;
mod lap;
mod law;
mod panel;
mod period;
mod plane;
mod play;
mod slip;
mod slip_ends;
mod step;
mod sticking;
mod variation;
mod vectors;

pub use law::{Closure, Coulomb};
