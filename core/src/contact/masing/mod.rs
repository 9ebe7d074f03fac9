//! Masing's rules over a backbone: microslip, and Iwan's distribution of sliders.

mod integrals;
mod law;
mod loops;
mod memory;

pub use law::Masing;
