//! Small disturbances of what contacts without sliders remember, along the exact motion.
//!
//! A reversal (u_r, f_r) keeps its disturbance until it is forgotten. As its velocity vanishes there, u_r
//! takes that of the displacement; f is continuous in value and slope at all events, so that nothing jumps.

use super::microslip::{Reversals, Turn};
use super::modal_system::{dot, ModalSystem};
use super::state::State;

/// Disturbances of displacement and force where a branch began, column by column.
type Begun = [Vec<f64>; 2];

/// Disturbances of all contacts without sliders.
#[derive(Debug, Default)]
pub(crate) struct LoopDisturbance {
    /// Columns beyond those of the motion: what the contacts remember.
    pub(super) columns: usize,
    /// Of each contact, of its origin and of the reversals that it remembers.
    stacks: Vec<Vec<Begun>>,
    /// Of each contact, of the displacements of all reversals since the start.
    pub(crate) turns: Vec<Vec<Vec<f64>>>,
    /// Of each contact, of its force at the end of the last stretch.
    pub(super) held: Vec<Vec<f64>>,
}

impl LoopDisturbance {
    /// Disturbances of a state that is made of numbers, [`Reversals::through`]; the motion has so many
    /// coordinates, with these factors on the displacements.
    pub(crate) fn new(
        system: &ModalSystem,
        state: &State,
        kept: &[Vec<usize>],
        motion: usize,
        weight: &[f64],
    ) -> Self {
        let columns = system.microslips().iter().map(|own| own.memory.len()).sum();
        let mut all = Self { columns, ..Self::default() };
        let mut first = motion;
        let size = motion + columns;
        for ((own, reversals), kept) in system.microslips().iter().zip(&state.reversals).zip(kept) {
            let unit = |column: usize| {
                let mut row = vec![0.0; size];
                row[first + column] = 1.0;
                row
            };
            let mut stack: Vec<Begun> = vec![[unit(0), vec![0.0; size]]];
            // A reversal is the sum of all ways to it.
            let mut place = unit(0);
            let mut added = 0;
            let mut partial = Reversals { origin: reversals.origin, turns: Vec::new() };
            for (number, turn) in kept.iter().zip(&reversals.turns) {
                while added <= *number {
                    added += 1;
                    place[first + added] = 1.0;
                }
                let held = follow(own, &partial, turn[0], &stack, &place);
                stack.push([place.clone(), held]);
                partial.turns.push(*turn);
            }
            let shape = system.contact_shape(own.point);
            let mut here = vec![0.0; size];
            here.iter_mut().zip(shape.iter().zip(weight)).for_each(|(to, (b, w))| *to = b / w);
            let u = dot(shape, &state.displacement);
            all.held.push(follow(own, reversals, u, &stack, &here));
            all.stacks.push(stack);
            all.turns.push(Vec::new());
            first += own.memory.len();
        }
        all
    }

    /// Disturbances where the branches began of one column.
    pub(super) fn begun(&self, column: usize) -> Vec<[f64; 2]> {
        let last = |stack: &Vec<Begun>| {
            stack.last().map_or([0.0; 2], |[at, held]| [at[column], held[column]])
        };
        self.stacks.iter().map(last).collect()
    }

    /// Follows an event; `here` is the disturbance of the displacement.
    pub(super) fn turn(&mut self, number: usize, turn: Turn, here: impl FnOnce() -> Vec<f64>) {
        let (stack, turns) = (&mut self.stacks[number], &mut self.turns[number]);
        match turn {
            Turn::Added(_) => {
                let here = here();
                turns.push(here.clone());
                stack.push([here, self.held[number].clone()]);
            }
            Turn::Undone => {
                turns.pop();
                stack.pop();
            }
            Turn::Forgotten(count) => stack.truncate(stack.len() - count),
        }
    }
}

/// Disturbance of the force at a displacement on the last branch.
fn follow(
    own: &super::microslip::Microslip,
    reversals: &Reversals,
    u: f64,
    stack: &[Begun],
    here: &[f64],
) -> Vec<f64> {
    let branch = reversals.branch(reversals.heading(u, 0.0));
    let slope = branch.stiffness(own, u);
    let Some([at, held]) = stack.last() else { return Vec::new() };
    let sums = here.iter().zip(at).zip(held);
    sums.map(|((here, at), held)| held + slope * (here - at)).collect()
}
