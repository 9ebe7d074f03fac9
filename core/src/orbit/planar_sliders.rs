//! The sliders of contacts in two directions along an orbit, as their laws tell them of the harmonics of its
//! displacements: what is assumed of them is the same for an orbit and for a balance.

use crate::contact::{Held, Residual};
use crate::fourier::{sampled_amplitudes, Harmonics, SampleTable};
use crate::motion::{Body, FlowSegment, ModalSystem};

/// Harmonics of displacements, which fall with the fourth power of the order, …
const HIGHEST: usize = 64;
/// … and instants that tell them.
const INSTANTS: usize = 256;

/// What all contacts in two directions do over a period.
pub(super) struct PlanarSliders<'a> {
    system: &'a ModalSystem,
    bodies: Vec<&'a Body>,
    /// Between two instants \[s\].
    step: f64,
    /// Displacements of the points of all bodies, instant after instant.
    samples: Vec<f64>,
    instants: usize,
}

impl<'a> PlanarSliders<'a> {
    pub(super) fn new(system: &'a ModalSystem, period: f64) -> Self {
        let in_plane = |body: &Body| {
            let root = body.elastic.root();
            // Directions that share no spring.
            body.remembered.len() == 2
                && body.elastic.rank() == 2
                && root[(0, 1)] == 0.0
                && root[(1, 0)] == 0.0
        };
        // Those of bodies that contacts alone hold stay where they are.
        let grounded = system.rigid_modes().is_empty();
        let bodies = system.bodies().iter().filter(|body| grounded && in_plane(body)).collect();
        Self { system, bodies, step: period / INSTANTS as f64, samples: Vec::new(), instants: 0 }
    }

    /// Hears of a stretch of the motion.
    pub(super) fn follow(&mut self, segment: &FlowSegment<'_>) {
        let (end, modes) = (segment.start + segment.duration(), self.system.modes());
        while !self.bodies.is_empty() && self.instants < INSTANTS {
            let time = self.instants as f64 * self.step;
            if time > end {
                return;
            }
            let tau = (time - segment.start) * segment.series.rate();
            let (mut modal, mut velocity) = (vec![0.0; modes], vec![0.0; modes]);
            segment.series.motion_at(tau, &mut modal, &mut velocity);
            let displacement = self.system.contact_displacement(&modal);
            let points = self.bodies.iter().flat_map(|body| body.points.clone());
            self.samples.extend(points.map(|point| displacement[point]));
            self.instants += 1;
        }
    }

    /// The sliders that the motion leaves where they are, with the point and the body of each; `moved` says by
    /// how much one is displaced that begins at rest.
    pub(super) fn held(
        &self,
        residual: Residual,
        moved: impl Fn(usize) -> f64,
    ) -> Vec<(usize, &'a Body, Held)> {
        let mut held = Vec::new();
        if self.instants < INSTANTS {
            return held;
        }
        let table = SampleTable::new(Harmonics::new(HIGHEST, false));
        let slots = table.harmonics().slots();
        let points = self.samples.len() / INSTANTS;
        let amplitudes = sampled_amplitudes(&self.samples, points, HIGHEST);
        let mut rows = amplitudes.chunks_exact(HIGHEST + 1);
        for &body in &self.bodies {
            let mut series = vec![0.0; body.points.len() * slots];
            let own = series.chunks_exact_mut(slots).zip(&mut rows);
            for ((own, amplitudes), point) in own.zip(body.points.clone()) {
                table.harmonics().write_series(amplitudes, own);
                own[0] -= moved(point);
            }
            let own = body.law.held(&table, &series, residual);
            for (one, &point) in own.iter().zip(&body.remembered) {
                let by = moved(point);
                held.extend(one.map(|one| {
                    let range = one.range.map(|end| end + by);
                    (point, body, Held { position: one.position + by, range, ..one })
                }));
            }
        }
        held
    }
}
