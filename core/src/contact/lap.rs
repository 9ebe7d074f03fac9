//! A lap of a march through a law whose state one motion leads to one place.

/// One lap along displacements at instants, and the lap before. The state is that of a law whose steps bring
/// states nearer to one another, from whatever they begin with: two laps that have met go on as one.
#[derive(Debug)]
pub struct Lap<'a> {
    /// Displacements, instant after instant.
    pub displacement: &'a [f64],
    /// −1 if the next lap mirrors this one.
    pub sign: f64,
    /// State that the lap begins with.
    pub state: &'a [f64],
    /// States at the instants: of the lap before until this one has passed by. Not numbers if there is none.
    pub states: &'a mut [f64],
    /// Forces there.
    pub forces: &'a mut [f64],
    /// State that the lap before has ended with, and then this one, mirrored.
    pub end: &'a mut [f64],
    /// Derivative of what the lap ends with in what it begins with, row by row; of the lap before, if that was
    /// met.
    pub by: &'a mut [f64],
    /// Whether the force has departed from the stuck spring's in a step.
    pub departs: bool,
    /// The last step in which it has done so by more than a touch, which may be one of rounding alone: a slider
    /// that is only touched may lie elsewhere.
    pub departure: Option<usize>,
    /// Largest number of the state.
    pub largest: f64,
    /// Distance of two states, relative to the largest, that is none.
    pub within: f64,
}

impl Lap<'_> {
    /// Whether a state at an instant is that of the lap before.
    #[inline(always)]
    pub(super) fn meets(&self, n: usize, state: &[f64]) -> bool {
        let before = &self.states[n * state.len()..(n + 1) * state.len()];
        let apart = state.iter().zip(before).map(|(a, b)| (a - b).abs());
        let bound = self.within * self.largest;
        apart.into_iter().all(|apart| apart <= bound)
    }
}

/// A state at the first instant that a motion has repeated, whatever it began with: a march along a motion
/// beside it begins with it.
#[derive(Debug, Clone)]
pub struct Repeated {
    /// The state.
    pub state: Vec<f64>,
    /// Change over a lap, relative to the largest number of the state, that counts as none.
    pub within: f64,
}
