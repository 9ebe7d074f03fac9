//! The state at the start of the period of a harmonic balance.

use crate::balance::Point;
use crate::contact::{Motion, Residual, REVERSALS};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::Model;
use crate::motion::{ModalSystem, State};
use faer::c64;

/// A periodic motion that begins at a later angle of its period.
pub(super) fn later(point: &Point, angle: f64) -> Point {
    let (orders, mut later) = (point.harmonics + 1, point.clone());
    for series in [&mut later.displacement, &mut later.contact_displacement] {
        for row in series.chunks_exact_mut(orders) {
            for (order, x) in row.iter_mut().enumerate() {
                *x *= c64::from_polar(1.0, angle * order as f64);
            }
        }
    }
    later
}

/// State at the start of the period of a harmonic balance of all DOFs.
pub(super) fn start_of(
    model: &Model,
    system: &ModalSystem,
    residual: Residual,
    point: &Point,
    half_wave: bool,
) -> State {
    let orders = point.harmonics + 1;
    let at_start = |factor: &dyn Fn(usize) -> c64| -> Vec<f64> {
        point
            .displacement
            .chunks_exact(orders)
            .map(|series| series.iter().enumerate().map(|(k, x)| (factor(k) * x).re).sum())
            .collect()
    };
    let mut state = State::rest(system);
    state.displacement = system.to_modes(&at_start(&|_| c64::new(1.0, 0.0)));
    state.velocity = system.to_modes(&at_start(&|k| c64::new(0.0, k as f64 * point.omega)));
    let table = SampleTable::new(Harmonics::new(point.harmonics, half_wave));
    let mut memory = Vec::new();
    for (law, points) in model.laws().iter().zip(model.points()) {
        let slots = table.harmonics().slots();
        let mut series = vec![0.0; slots * points.len()];
        for (own, out) in points.clone().zip(series.chunks_exact_mut(slots)) {
            let amplitudes = &point.contact_displacement[own * orders..(own + 1) * orders];
            table.harmonics().write_series(amplitudes, out);
        }
        let motion = Motion { table: &table, displacement: &series, residual };
        let known = law.state_history(motion, 1);
        if let Some(curve) = law.loading() {
            // Ways between reversals times the stiffness, of which the outermost are enough.
            let k = curve.stiffness();
            let mut numbers = [0.0; 1 + REVERSALS];
            let ways = numbers[1..].iter_mut().zip(&known);
            ways.filter(|_| k > 0.0).for_each(|(way, known)| *way = known / k);
            memory.extend(numbers);
            continue;
        }
        // What its elements remember is the state of such a law.
        memory.extend(known);
    }
    state.recall(system, &memory);
    state.settle_points(system);
    state
}
