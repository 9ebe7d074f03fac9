//! A curve of solutions as equations: what a continuation asks of them.

/// Equations that leave one degree of freedom. The last of the unknowns is the parameter.
pub trait Curve {
    /// Number of unknowns, one more than equations.
    fn unknowns(&self) -> usize;

    /// Position from which on the unknowns of `z` are compared one by one, the parameter among them;
    /// those before are one motion, compared as a whole and wherever it begins in time.
    fn scalars(&self, z: &[f64]) -> usize {
        z.len() - 1
    }

    /// Residual at `z`, of the order of the relative error of the unknowns; not a number where it
    /// is not defined.
    fn residual(&mut self, z: &[f64], out: &mut [f64]);

    /// Solves the equations linearised at `z` with one more row, `border x = last of right`; tells the
    /// sign of their determinant, too, or 0 where it is not known. Nothing where they are singular.
    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        weights: &[f64],
    ) -> Option<(Vec<f64>, f64)>;

    /// What the unknowns are multiplied by to be compared with each other, about `z`.
    fn weights(&self, z: &[f64]) -> Vec<f64>;

    /// Has a point become part of the curve, for what is defined relative to the last one.
    fn accept(&mut self, z: &[f64]);

    /// Number of unknowns that suits the equations about the point `z`: more than it has where they
    /// are too sensitive to those.
    fn suitable_unknowns(&mut self, z: &[f64]) -> usize {
        z.len()
    }

    /// The same point in another number of unknowns.
    fn resample(&mut self, z: &[f64], unknowns: usize) -> Option<Vec<f64>> {
        (z.len() == unknowns).then(|| z.to_vec())
    }

    /// How much later the motion of a point had better begin, where its begin comes close to an instant
    /// across which the unknowns jump.
    fn better_begin(&mut self, _z: &[f64]) -> Option<f64> {
        None
    }

    /// The same point with its motion begun later.
    fn begin_later(&mut self, z: &[f64], _by: f64) -> Option<Vec<f64>> {
        Some(z.to_vec())
    }

    /// Two points in the same unknowns, as many as the larger number of them, and in step.
    fn matched(&mut self, a: &[f64], b: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let unknowns = a.len().max(b.len());
        Some((self.resample(a, unknowns)?, self.resample(b, unknowns)?))
    }

    /// Whether the caller wants to end the analysis.
    fn interrupted(&self) -> bool {
        false
    }
}
