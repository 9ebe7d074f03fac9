//! What contacts without sliders remember of a periodic motion, as unknowns of its closing condition.
//!
//! In a steady motion all that a contact knows at an instant are reversals of the period before it: the
//! outermost ones, the largest and the least displacement (under half-wave symmetry one of them), and
//! those behind them that no later loop has closed. Their displacements are functions of the motion,
//! smooth ones, so that Newton's method closes orbit and memory together. The period before an instant is
//! put together of pieces: of the segments of multiple shooting, and of a travelling wave, of which a part
//! of the period is followed, of what the sectors behind have done in it. The origin of the first loading
//! says what elements hold that never slip.

use super::remembered_turns::{RememberedTurns, Reversal};
use super::rotation::Rotation;
use crate::contact::{LoadingCurve, PointState, Residual, REVERSALS};
use crate::motion::{
    FlowEvent, LinearPhase, LoopDisturbance, ModalSystem, Propagators, State, Transition, Turn,
};
use faer::Mat;

/// Numbers of one contact.
const PLACES: usize = 1 + REVERSALS;

/// What is known of a span of the motion, of each contact.
#[derive(Debug, Clone, Default)]
struct Piece {
    /// The state that it begins with, and of each contact the numbers of it that its reversals are made of.
    start: Option<State>,
    kept: Vec<Vec<usize>>,
    /// Displacements of its reversals \[m\], and at its end.
    turns: Vec<Vec<f64>>,
    end: Vec<f64>,
    /// Derivative of the reversals in all unknowns at its start, these as displacements.
    slopes: Vec<Vec<Vec<f64>>>,
}

/// The memory of all contacts without sliders.
#[derive(Debug, Clone)]
pub(super) struct LoopMemory {
    half_wave: bool,
    residual: Residual,
    /// Of each contact where its piece of the period before comes from, with the sign of that.
    sources: Option<Vec<(usize, f64)>>,
    /// Parts of the period that the pieces are; 1 but of travelling waves.
    parts: usize,
    curves: Vec<LoadingCurve>,
    /// Factor on the displacements of each contact: their squares are energies.
    scale: Vec<f64>,
    /// The piece that is followed, of so many.
    piece: usize,
    count: usize,
    pieces: Vec<Piece>,
    /// Before the first piece and behind each one, of each contact.
    lists: Vec<Vec<RememberedTurns>>,
}

impl LoopMemory {
    pub(super) fn new(system: &ModalSystem, half_wave: bool) -> Self {
        let curves: Vec<LoadingCurve> =
            system.microslips().iter().map(|own| own.curve.clone()).collect();
        let root = |curve: &LoadingCurve| match curve.stiffness() {
            k if k > 0.0 => k.sqrt(),
            _ => 1.0,
        };
        Self {
            half_wave,
            residual: Residual::Centred,
            sources: None,
            parts: 1,
            scale: curves.iter().map(root).collect(),
            curves,
            piece: 0,
            count: 1,
            pieces: vec![Piece::default()],
            lists: Vec::new(),
        }
    }

    pub(super) fn assume(&mut self, residual: Residual) {
        self.residual = residual;
    }

    /// Takes a span for the part of the period after which sectors have changed their roles.
    pub(super) fn rotate(&mut self, rotation: &Rotation) {
        self.sources = Some(rotation.sources(self.scale.len()));
        (self.parts, self.half_wave) = (rotation.parts, false);
    }

    /// Takes the next span for one of `count` pieces.
    pub(super) fn narrow(&mut self, piece: usize, count: usize) {
        (self.piece, self.count) = (piece, count);
        self.pieces.resize(count, Piece::default());
    }

    /// Number of all unknowns.
    pub(super) fn places(system: &ModalSystem) -> usize {
        PLACES * system.microslips().len()
    }

    /// Leaves elements that never slip out of a derivative: what they keep is not followed.
    pub(super) fn hold_origins(&self, matrix: &mut Mat<f64>) {
        let first = matrix.nrows() - PLACES * self.scale.len();
        for row in (0..self.scale.len()).map(|number| first + number * PLACES) {
            for column in 0..matrix.ncols() {
                // The first way is one from the origin.
                let moved = matrix[(row, column)];
                matrix[(row + 1, column)] += moved;
                matrix[(row, column)] = 0.0;
            }
        }
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
        let blocks = unknowns.chunks_exact(PLACES).zip(&self.scale);
        let values: Vec<f64> =
            blocks.flat_map(|(own, scale)| own.iter().map(move |y| y / scale)).collect();
        state.recall_ways(system, &values)
    }

    /// Begins a span.
    pub(super) fn begin(&mut self, state: &mut State, system: &ModalSystem, unknowns: &[f64]) {
        if self.scale.is_empty() {
            return;
        }
        let kept = self.recall(state, system, unknowns);
        let (start, turns) = (Some(state.clone()), vec![Vec::new(); self.scale.len()]);
        self.pieces[self.piece] = Piece { start, kept, turns, ..Piece::default() };
    }

    /// Follows the flow over the span.
    pub(super) fn follow(&mut self, passage: &FlowEvent<'_>) {
        let FlowEvent::Event { turn: Some((number, turn)), .. } = passage else { return };
        let turns = &mut self.pieces[self.piece].turns[*number];
        match turn {
            Turn::Added(u) => turns.push(*u),
            Turn::Undone => {
                turns.pop();
            }
            Turn::Forgotten(_) => {}
        }
    }

    /// The unknowns at the end of the span, with those at its start; of one piece of many what the flow
    /// remembers, until they are joined. Nothing where a contact has not turned round in the period.
    pub(super) fn end(
        &mut self,
        system: &ModalSystem,
        state: &State,
        start: &[f64],
    ) -> Option<Vec<f64>> {
        let at = |own: &crate::motion::Microslip| -> f64 {
            let shape = system.contact_shape(own.point).iter();
            shape.zip(&state.displacement).map(|(b, x)| b * x).sum()
        };
        self.pieces[self.piece].end = system.microslips().iter().map(at).collect();
        if self.count > 1 {
            return Some(self.numbers(state));
        }
        self.join()?;
        Some(self.behind(0, start))
    }

    /// Finds out what is remembered between all pieces; nothing where a contact has not turned round.
    pub(super) fn join(&mut self) -> Option<()> {
        let contacts = 0..self.scale.len();
        let lists = (0..=self.count)
            .map(|instant| contacts.clone().map(|contact| self.list(instant, contact)).collect());
        self.lists = lists.collect::<Option<_>>()?;
        Some(())
    }

    /// Pieces of the period before an instant, from the oldest to the latest, each with its contact and
    /// sign.
    fn history(&self, instant: usize, contact: usize) -> Vec<(usize, usize, f64)> {
        if let Some(sources) = &self.sources {
            let mut at = (contact, 1.0);
            let back = (0..self.parts).map(|_| {
                let (from, sign) = sources[at.0];
                at = (from, sign * at.1);
                (0, at.0, at.1)
            });
            let mut pieces: Vec<_> = back.collect();
            pieces.reverse();
            return pieces;
        }
        let before = if self.half_wave { -1.0 } else { 1.0 };
        let earlier = (instant..self.count).map(|piece| (piece, contact, before));
        earlier.chain((0..instant).map(|piece| (piece, contact, 1.0))).collect()
    }

    /// The reversals that count at an instant.
    fn list(&self, instant: usize, contact: usize) -> Option<RememberedTurns> {
        let history = self.history(instant, contact);
        let turns: Vec<Reversal> = history
            .iter()
            .flat_map(|&(piece, contact, sign)| {
                let all = self.pieces[piece].turns[contact].iter().enumerate();
                all.map(move |(number, at)| Reversal {
                    piece,
                    contact,
                    number,
                    sign,
                    at: sign * at,
                })
            })
            .collect();
        let &(piece, source, sign) = history.last()?;
        let now = sign * self.pieces[piece].end[source];
        RememberedTurns::new(&turns, now, self.half_wave)
    }

    /// Place of a reversal among those that were known where a piece began; none of one of the piece.
    fn place(&self, piece: usize, contact: usize, turn: &Reversal) -> Option<usize> {
        let known = |own: &Reversal| (own.piece, own.number) == (turn.piece, turn.number);
        let earlier = turn.piece != piece && self.sources.is_none();
        earlier.then(|| self.lists[piece][contact].kept.iter().position(known)).flatten()
    }

    /// The origin of a contact, with its derivative in the largest and the least displacement.
    fn origin(&self, contact: usize, outermost: Option<[f64; 2]>) -> [f64; 3] {
        let Some([high, low]) = outermost else { return [0.0; 3] };
        let (middle, half_range) = (0.5 * (high + low), 0.5 * (high - low));
        match self.residual {
            Residual::FromRest => [0.0; 3],
            Residual::Centred => [middle, 0.5, 0.5],
            Residual::Value(force) => {
                let [way, by_range] = self.curves[contact].way_to(half_range, force.abs());
                let by_range = by_range * force.signum();
                let origin = middle - way.copysign(force);
                [origin, 0.5 * (1.0 - by_range), 0.5 * (1.0 + by_range)]
            }
        }
    }

    /// The unknowns behind a piece, with those at its start.
    pub(super) fn behind(&self, piece: usize, start: &[f64]) -> Vec<f64> {
        let first = start.len() - PLACES * self.scale.len();
        self.numbers_behind(piece, |contact, turn| {
            let own = &start[first + contact * PLACES..first + (contact + 1) * PLACES];
            let place = self.place(piece, contact, turn)?;
            Some(own[..2 + place].iter().sum::<f64>() / self.scale[contact])
        })
    }

    /// The unknowns behind a piece as the reversals of all pieces say.
    pub(super) fn settled(&self, piece: usize) -> Vec<f64> {
        self.numbers_behind(piece, |_, _| None)
    }

    /// The unknowns behind a piece; of reversals at their start, what is known of them.
    fn numbers_behind(
        &self,
        piece: usize,
        known: impl Fn(usize, &Reversal) -> Option<f64>,
    ) -> Vec<f64> {
        let mut unknowns = Vec::with_capacity(PLACES * self.scale.len());
        for (contact, (list, scale)) in self.lists[piece + 1].iter().zip(&self.scale).enumerate() {
            let at = |turn: &Reversal| known(contact, turn).unwrap_or(turn.at);
            let outermost = list.outermost.map(|[high, low]| [at(&high), at(&low)]);
            let [origin, ..] = self.origin(contact, outermost);
            let mut block = [0.0; PLACES];
            block[0] = scale * origin;
            let mut from = origin;
            for (way, turn) in block[1..].iter_mut().zip(&list.kept) {
                let to = at(turn);
                *way = scale * (to - from);
                from = to;
            }
            unknowns.extend(block);
        }
        unknowns
    }

    /// Derivative of all unknowns at the end of the span in those at its start; of one piece of many
    /// without what is remembered, until they are joined.
    pub(super) fn along(
        &mut self,
        coordinates: &Transition<'_>,
        phases: &[LinearPhase],
        held: &[PointState],
        force: &[f64],
        known: &mut Propagators,
    ) -> Mat<f64> {
        let Piece { start, kept, .. } = &self.pieces[self.piece];
        let Some(start) = start else {
            return coordinates.along(phases, held, force, &mut LoopDisturbance::default(), known);
        };
        let (system, size) = (coordinates.system(), coordinates.size());
        // The disturbances are of displacements, the unknowns have factors.
        let weight = coordinates.weight();
        let mut loops = LoopDisturbance::new(system, start, kept, size, weight);
        let motion = coordinates.along(phases, held, force, &mut loops, known);
        let all = size + Self::places(system);
        let mut matrix = Mat::zeros(all, all);
        matrix.get_mut(..size, ..).copy_from(&motion);
        for (column, scale) in self.scales(size) {
            (0..size).for_each(|row| matrix[(row, column)] /= scale);
        }
        self.pieces[self.piece].slopes = loops.turns;
        if self.count == 1 {
            self.derive(0, &mut matrix);
        }
        matrix
    }

    /// Columns of what is remembered, each with its factor.
    fn scales(&self, first: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let all = self.scale.iter().flat_map(|scale| [*scale; PLACES]);
        all.enumerate().map(move |(column, scale)| (first + column, scale))
    }

    /// Completes the derivative of the unknowns behind a piece in those at its start.
    pub(super) fn derive(&self, piece: usize, matrix: &mut Mat<f64>) {
        let all = matrix.nrows();
        let size = all - PLACES * self.scale.len();
        for (contact, (list, scale)) in self.lists[piece + 1].iter().zip(&self.scale).enumerate() {
            let first = size + contact * PLACES;
            let slope = |turn: &Reversal| -> Vec<f64> {
                if let Some(place) = self.place(piece, contact, turn) {
                    let own = first..first + 2 + place;
                    return (0..all).map(|j| f64::from(u8::from(own.contains(&j)))).collect();
                }
                match self.pieces[turn.piece].slopes.get(turn.contact) {
                    Some(own) if turn.piece == piece => {
                        own[turn.number].iter().map(|slope| turn.sign * slope).collect()
                    }
                    _ => vec![0.0; all],
                }
            };
            let mut from = vec![0.0; all];
            if let Some([high, low]) = &list.outermost {
                let [_, by_high, by_low] = self.origin(contact, Some([high.at, low.at]));
                let sums = from.iter_mut().zip(slope(high)).zip(slope(low));
                sums.for_each(|((to, a), b)| *to = by_high * a + by_low * b);
            }
            (0..all).for_each(|column| matrix[(first, column)] = scale * from[column]);
            for (place, turn) in list.kept.iter().enumerate() {
                let to = slope(turn);
                for column in 0..all {
                    matrix[(first + 1 + place, column)] = scale * (to[column] - from[column]);
                }
                from = to;
            }
            for row in first..first + PLACES {
                for (column, scale) in self.scales(size) {
                    matrix[(row, column)] /= scale;
                }
            }
        }
    }
}
