//! What an error of a DOF counts against.

use super::solution::Point;
use crate::solve::largest;
use faer::c64;

/// A DOF's truncation error counts relative to its amplitude, but not to less than this share of the
/// largest amplitude it has had; …
pub(super) const OF_HARMONICS: f64 = 1e-3;
/// … that of a straight line between two points not to less than this: an antiresonance needs no
/// points of its own; …
const OF_STEPS: f64 = 0.02;
/// … and neither to less than this share of the largest amplitude of any DOF, below which a motion that
/// symmetry forbids is rounding.
const NOISE: f64 = 1e-6;

/// The largest size each observed DOF has had along a curve.
#[derive(Debug, Clone, Default)]
pub(super) struct Scale {
    largest: Vec<f64>,
    /// Whether the error of each observed DOF counts; empty if those of all do.
    driving: Vec<bool>,
}

impl Scale {
    /// Lets the errors of some observed DOFs alone count; of all if no position is given.
    pub(super) fn of(driving: &[usize], observed: usize) -> Self {
        if driving.is_empty() {
            return Self::default();
        }
        let driving = (0..observed).map(|position| driving.contains(&position)).collect();
        Self { driving, ..Self::default() }
    }

    /// Whether the error of the observed DOF at a position counts.
    pub(super) fn counts(&self, dof: usize) -> bool {
        self.driving.get(dof).copied().unwrap_or(true)
    }

    /// Takes a solved point into account.
    pub(super) fn include(&mut self, point: &Point) {
        let sizes = sizes(point);
        self.largest.resize(sizes.len(), 0.0);
        for (largest, size) in self.largest.iter_mut().zip(sizes) {
            *largest = largest.max(size);
        }
    }

    /// Largest of the errors of the DOFs of `point` that count, each relative to its size or to the share
    /// `floor` of its largest one; infinite if one is not a number.
    pub(super) fn relative(
        &self,
        point: &Point,
        floor: f64,
        errors: impl Iterator<Item = f64>,
    ) -> f64 {
        let counted = errors.zip(self.against(point, floor)).enumerate();
        let counted = counted.filter(|(dof, _)| self.counts(*dof));
        largest(counted.map(|(_, (error, size))| error / size))
    }

    /// Errors of the DOFs of a point above which [`Scale::relative`] is above a share; infinite of those that do not
    /// count.
    pub(super) fn most(&self, point: &Point, floor: f64, share: f64) -> Vec<f64> {
        let sizes = self.against(point, floor).into_iter().enumerate();
        sizes
            .map(|(dof, size)| if self.counts(dof) { share * size } else { f64::INFINITY })
            .collect()
    }

    /// What the errors of the DOFs of a point count against.
    fn against(&self, point: &Point, floor: f64) -> Vec<f64> {
        let mut sizes = sizes(point);
        let known = self.largest.iter().enumerate().chain(sizes.iter().enumerate());
        let counted = known.filter(|(dof, _)| self.counts(*dof));
        let overall = counted.map(|(_, size)| *size).fold(0.0, f64::max);
        for (dof, size) in sizes.iter_mut().enumerate() {
            let own = self.largest.get(dof).copied().unwrap_or(0.0);
            *size = size.max(floor * own).max(NOISE * overall).max(f64::MIN_POSITIVE);
        }
        sizes
    }

    /// Largest of the relative errors of a straight line between the last two of three points along a
    /// curve, from the curvature through all of them; `steps` are their distances.
    pub(super) fn of_line(&self, points: [&Point; 3], [earlier, step]: [f64; 2]) -> f64 {
        let new = points[2];
        let own = |point: &Point, dof: usize, order: usize| {
            let orders = point.harmonics + 1;
            if order < orders {
                point.displacement[dof * orders + order]
            } else {
                c64::new(0.0, 0.0)
            }
        };
        let (bend, ratio) = (0.25 * step / (step + earlier), step / earlier);
        let errors = (0..new.error_estimate.len()).map(|dof| {
            let missed = (1..=new.harmonics).map(|order| {
                let [x, y, z] = points.map(|point| own(point, dof, order));
                (z - y - (y - x) * ratio).norm_sqr()
            });
            bend * missed.sum::<f64>().sqrt()
        });
        self.relative(new, OF_STEPS, errors)
    }
}

/// Size of the oscillation of each observed DOF.
fn sizes(point: &Point) -> Vec<f64> {
    point
        .displacement
        .chunks_exact(point.harmonics + 1)
        .map(|series| series[1..].iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt())
        .collect()
}
