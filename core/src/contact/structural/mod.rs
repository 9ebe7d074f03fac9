//! Structure-like dampers: elastic bodies that slip at several contacts.

mod damper;
mod increment;
mod law;
mod parameters;
mod slip_series;

pub use damper::StructuralDamper;
