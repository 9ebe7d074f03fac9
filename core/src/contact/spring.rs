//! What springs have in common: laws whose force follows from one displacement, without memory.

/// Methods of a [`super::ContactLaw`] that has `force(u)` and `slope(u)` of its own.
macro_rules! law_of_a_spring {
    () => {
        fn displacements(&self) -> usize {
            1
        }

        fn state_size(&self) -> usize {
            0
        }

        fn state_stiffness(&self) -> Mat<f64> {
            Mat::zeros(0, 1)
        }

        /// The force grows with the displacement, but not with the velocity: that does not make the
        /// motion unique.
        fn is_monotone(&self) -> bool {
            false
        }

        fn limits(&self) -> Vec<f64> {
            vec![f64::INFINITY]
        }

        fn return_map(
            &self,
            _before: &[f64],
            after: &[f64],
            _state: &mut [f64],
            force: &mut [f64],
            jacobian: Option<&mut ReturnMapJacobian>,
        ) {
            force[0] = self.force(after[0]);
            let Some(jacobian) = jacobian else { return };
            jacobian.reset(1, 0);
            jacobian.force_by_after[0] = self.slope(after[0]);
        }

        fn closed_form(&self) -> Option<&dyn HarmonicForce> {
            Some(self)
        }
    };
}
pub(super) use law_of_a_spring;

/// Methods of its [`super::law::HarmonicForce`].
macro_rules! harmonics_of_a_spring {
    () => {
        fn summary(&self, _motion: Motion<'_>, out: &mut [PointSummary]) {
            out.fill(PointSummary::default());
        }

        fn state_history(&self, _motion: Motion<'_>, _samples: usize) -> Vec<f64> {
            Vec::new()
        }

        fn force_history(&self, motion: Motion<'_>, samples: usize) -> Vec<f64> {
            let harmonics = motion.table.harmonics();
            let angle = |n: usize| TAU * n as f64 / samples as f64;
            let at = |n: usize| harmonics.jet(motion.displacement, angle(n))[0];
            (0..samples).map(|n| self.force(at(n))).collect()
        }

        fn phases(&self, _motion: Motion<'_>) -> Vec<Phase> {
            vec![Phase { start: 0.0, states: vec![PointState::Stuck] }]
        }
    };
}
pub(super) use harmonics_of_a_spring;
