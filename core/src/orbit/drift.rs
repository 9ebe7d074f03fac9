//! The exact motion of oscillators over a step of time.

use faer::linalg::solvers::Solve as _;
use faer::Mat;

/// The exact motion of the modes over a step, with half a step of coupled damping on either side.
pub(super) struct Drift {
    /// New displacement and velocity by the old ones, mode after mode.
    pub(super) modes: Vec<[f64; 4]>,
    pub(super) coupled: Option<Mat<f64>>,
}

impl Drift {
    /// Over a time h of modes with their squared frequencies and dampings, and what couples them.
    pub(super) fn new(modes: [&[f64]; 2], coupled: Option<&Mat<f64>>, h: f64) -> Self {
        let [omega_squared, damping] = modes;
        let modes = omega_squared.iter().zip(damping);
        let coupled = coupled.map(|damping| {
            // (I + h C/4)⁻¹ (I − h C/4): symmetric in time.
            let quarter = faer::Scale(0.25 * h) * damping;
            let unit = Mat::<f64>::identity(damping.nrows(), damping.nrows());
            (&unit + &quarter).partial_piv_lu().solve(&unit - &quarter)
        });
        Self { modes: modes.map(|(w, c)| oscillator(*w, *c, h)).collect(), coupled }
    }
}

/// `η'' + c η' + ω² η = 0` over a time h.
fn oscillator(omega_squared: f64, damping: f64, h: f64) -> [f64; 4] {
    let rate = 0.5 * damping;
    let square = omega_squared - rate * rate;
    let turn = square.abs().sqrt() * h;
    let (cos, sinc) = if turn < 1e-4 {
        let t = square * h * h;
        let decay = (-rate * h).exp();
        (decay * (1.0 - t / 2.0 + t * t / 24.0), decay * h * (1.0 - t / 6.0 + t * t / 120.0))
    } else if square > 0.0 {
        let decay = (-rate * h).exp();
        (decay * turn.cos(), decay * h * turn.sin() / turn)
    } else {
        let (up, down) = ((turn - rate * h).exp(), (-turn - rate * h).exp());
        (0.5 * (up + down), 0.5 * h * (up - down) / turn)
    };
    [cos + rate * sinc, sinc, -omega_squared * sinc, cos - rate * sinc]
}
