//! Steady vibration of structures damped by dry friction.
//!
//! The crate reads from the ground up:
//!
//! | module | what it holds |
//! |---|---|
//! | [`fourier`] | trigonometric series: evaluation, turning points, sums over intervals |
//! | [`structure`] | M, C, K, modes and the compliance of the stuck structure |
//! | [`contact`] | friction laws behind one trait: series of u in, series of slip load and tangent out |
//! | [`model`] | structure, contacts and loads: the problem, before any setting or solver |
//! | [`balance`] | the harmonic balance equations and their sweeps over frequency |
//! | [`design`] | peaks followed along a parameter, and the parameter that makes them least |
//! | [`solve`] | Newton's and Broyden's method and homotopy, which know nothing of friction |
//! | [`motion`] | motion in time: the exact flow between events, Runge-Kutta |
//! | [`orbit`] | exact periodic orbits by shooting, Floquet multipliers |
//!
//! Units are SI throughout; `x(t) = Re Σ X_k exp(i k ω t)`, and a real series is stored as
//! cosine and sine coefficients, `X_k = a_k − i b_k`.

pub mod balance;
pub mod contact;
pub mod design;
pub mod error;
pub mod fourier;
pub mod model;
pub mod motion;
pub mod orbit;
mod parallel;
pub mod progress;
pub mod solve;
pub mod structure;
#[cfg(test)]
mod test_numbers;
pub mod timing;

pub use error::Error;
pub use model::Model;
