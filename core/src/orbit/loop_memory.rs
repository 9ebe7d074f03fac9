//! What contacts without sliders remember of a periodic motion, as unknowns of its closing condition.
//!
//! In a steady motion all that a contact knows at the end of a period are reversals of that period: the
//! outermost ones, the largest and the least displacement (under half-wave symmetry one of them), and
//! those behind them that no later loop has closed. Their displacements are functions of the motion,
//! smooth ones, so that Newton's method closes orbit and memory together. The origin of the first loading says
//! what elements hold that never slip: the middle of the range, or zero where the motion came from rest.

use crate::contact::{PointState, Residual, REVERSALS};
use crate::motion::{
    FlowEvent, LinearPhase, LoopDisturbance, Microslip, ModalSystem, State, Transition, Turn,
};
use faer::Mat;

/// Reversals of one contact at the end of a span, each by its number among those of the span.
#[derive(Debug, Clone, Default)]
struct List {
    /// Numbers of the outermost reversals, of which the middle is the origin.
    outermost: Option<[usize; 2]>,
    numbers: Vec<usize>,
}

/// The memory of all contacts without sliders.
#[derive(Debug)]
pub(super) struct LoopMemory {
    half_wave: bool,
    centred: bool,
    /// Factor on the displacements of each contact: their squares are energies.
    scale: Vec<f64>,
    start: Option<State>,
    /// Of each contact, the numbers of the start that its reversals are made of.
    kept: Vec<Vec<usize>>,
    /// Of each contact, its reversals since the start.
    turns: Vec<Vec<f64>>,
    lists: Vec<List>,
}

impl LoopMemory {
    pub(super) fn new(system: &ModalSystem, half_wave: bool) -> Self {
        let root = |own: &Microslip| match own.curve.stiffness() {
            k if k > 0.0 => k.sqrt(),
            _ => 1.0,
        };
        Self {
            half_wave,
            centred: true,
            scale: system.microslips().iter().map(root).collect(),
            start: None,
            kept: Vec::new(),
            turns: Vec::new(),
            lists: Vec::new(),
        }
    }

    pub(super) fn assume(&mut self, residual: Residual) {
        self.centred = residual == Residual::Centred;
    }

    /// Number of all unknowns.
    pub(super) fn places(system: &ModalSystem) -> usize {
        (1 + REVERSALS) * system.microslips().len()
    }

    /// Rows of the origins behind so many others.
    pub(super) fn origins(&self, first: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.scale.len()).map(move |number| first + number * (1 + REVERSALS))
    }

    /// The unknowns of a state.
    pub(super) fn numbers(&self, state: &State) -> Vec<f64> {
        let all = state.reversals.iter().zip(&self.scale);
        all.flat_map(|(own, scale)| own.numbers().map(|number| scale * number)).collect()
    }

    /// Has a state remember what the unknowns say.
    pub(super) fn recall(
        &self,
        state: &mut State,
        system: &ModalSystem,
        unknowns: &[f64],
    ) -> Vec<Vec<usize>> {
        if self.scale.is_empty() {
            return Vec::new();
        }
        let blocks = unknowns.chunks_exact(1 + REVERSALS).zip(&self.scale);
        let values: Vec<f64> =
            blocks.flat_map(|(own, scale)| own.iter().map(move |y| y / scale)).collect();
        state.recall_ways(system, &values)
    }

    /// Begins a span.
    pub(super) fn begin(&mut self, state: &mut State, system: &ModalSystem, unknowns: &[f64]) {
        if self.scale.is_empty() {
            return;
        }
        self.kept = self.recall(state, system, unknowns);
        self.start = Some(state.clone());
        self.turns = vec![Vec::new(); self.scale.len()];
    }

    /// Follows the flow over the span.
    pub(super) fn follow(&mut self, passage: &FlowEvent<'_>) {
        let FlowEvent::Event { turn: Some((number, turn)), .. } = passage else { return };
        match turn {
            Turn::Added(u) => self.turns[*number].push(*u),
            Turn::Undone => {
                self.turns[*number].pop();
            }
            Turn::Forgotten(_) => {}
        }
    }

    /// The unknowns at the end of the span; nothing where a contact has not turned round in it.
    pub(super) fn end(&mut self, system: &ModalSystem, state: &State) -> Option<Vec<f64>> {
        let mut unknowns = Vec::with_capacity(Self::places(system));
        self.lists.clear();
        for (own, (turns, scale)) in
            system.microslips().iter().zip(self.turns.iter().zip(&self.scale))
        {
            let shape = system.contact_shape(own.point).iter();
            let now: f64 = shape.zip(&state.displacement).map(|(b, x)| b * x).sum();
            let list = self.list(turns, now)?;
            let origin = list.outermost.map_or(0.0, |[a, b]| 0.5 * (turns[a] + turns[b]));
            let mut block = [0.0; 1 + REVERSALS];
            block[0] = origin;
            let mut from = origin;
            for (way, number) in block[1..].iter_mut().zip(&list.numbers) {
                *way = turns[*number] - from;
                from = turns[*number];
            }
            unknowns.extend(block.iter().map(|value| scale * value));
            self.lists.push(list);
        }
        Some(unknowns)
    }

    /// The reversals of a span that count at its end.
    fn list(&self, turns: &[f64], now: f64) -> Option<List> {
        let most = |of: &dyn Fn(f64) -> f64| {
            (0..turns.len()).max_by(|a, b| of(turns[*a]).total_cmp(&of(turns[*b])))
        };
        let (mut numbers, outermost, next) = if self.half_wave {
            let largest = most(&f64::abs)?;
            (vec![largest], None, largest + 1)
        } else {
            let (high, low) = (most(&|u| u)?, most(&|u| -u)?);
            if high == low {
                return None;
            }
            let (first, second) = (high.min(low), high.max(low));
            (vec![first, second], self.centred.then_some([first, second]), second + 1)
        };
        let outer = numbers.len();
        let close = |numbers: &mut Vec<usize>, u: f64| {
            while numbers.len() > outer.max(1) {
                let [.., before, last] = numbers[..] else { break };
                let sign = 1.0_f64.copysign(turns[before] - turns[last]);
                if sign * (u - turns[before]) < 0.0 || numbers.len() < outer + 2 {
                    break;
                }
                numbers.truncate(numbers.len() - 2);
            }
        };
        for (number, turn) in turns.iter().enumerate().skip(next) {
            close(&mut numbers, *turn);
            numbers.push(number);
        }
        close(&mut numbers, now);
        while numbers.len() > REVERSALS {
            let way = |i: usize| (turns[numbers[i + 1]] - turns[numbers[i]]).abs();
            let inner = outer..numbers.len() - 1;
            let least = inner.min_by(|a, b| way(*a).total_cmp(&way(*b)))?;
            numbers.drain(least..least + 2);
        }
        Some(List { outermost, numbers })
    }

    /// Derivative of all unknowns at the end of the span in those at its start.
    pub(super) fn along(
        &self,
        coordinates: &Transition<'_>,
        phases: &[LinearPhase],
        held: &[PointState],
        force: &[f64],
    ) -> Mat<f64> {
        let Some(start) = &self.start else {
            return coordinates.along(phases, held, force, &mut LoopDisturbance::default());
        };
        let (system, size) = (coordinates.system(), coordinates.size());
        // The disturbances are of displacements, the unknowns have factors.
        let weight = coordinates.weight();
        let mut loops = LoopDisturbance::new(system, start, &self.kept, size, weight);
        let motion = coordinates.along(phases, held, force, &mut loops);
        let all = size + Self::places(system);
        let mut matrix = Mat::zeros(all, all);
        matrix.get_mut(..size, ..).copy_from(&motion);
        for (number, (list, turns)) in self.lists.iter().zip(&loops.turns).enumerate() {
            let first = size + number * (1 + REVERSALS);
            let scale = self.scale[number];
            let zero = vec![0.0; all];
            let origin: Vec<f64> = match list.outermost {
                Some([a, b]) => {
                    turns[a].iter().zip(&turns[b]).map(|(a, b)| 0.5 * (a + b)).collect()
                }
                None => zero,
            };
            let mut from = &origin;
            for (column, value) in origin.iter().enumerate() {
                matrix[(first, column)] = scale * value;
            }
            for (place, turn) in list.numbers.iter().enumerate() {
                for column in 0..all {
                    matrix[(first + 1 + place, column)] =
                        scale * (turns[*turn][column] - from[column]);
                }
                from = &turns[*turn];
            }
        }
        for (number, scale) in self.scale.iter().enumerate() {
            let first = size + number * (1 + REVERSALS);
            for column in first..first + 1 + REVERSALS {
                (0..all).for_each(|row| matrix[(row, column)] /= scale);
            }
        }
        matrix
    }
}
