//! Disturbances of a motion over a stretch in which no contact changes its state.

use super::contact_state::ContactState;
use super::propagator::{Equations, Propagators, Reach};
use super::transition::Transition;
use crate::solve::multiply;
use faer::{Accum, Mat};

impl Transition<'_> {
    /// Takes disturbances, column by column, over a duration \[s\], or nearly so; the duration that is left,
    /// which may be negative: a step is longer by a lead. One over which nothing moves far is left as a whole.
    pub(super) fn advance(
        &self,
        regime: &ContactState,
        [duration, lead]: [f64; 2],
        reach: Reach,
        total: &mut Mat<f64>,
        known: &mut Propagators,
    ) -> f64 {
        let fastest = self.system.rate(0.0);
        // What is to go back has a step behind it that was a little too long.
        if (duration + lead) * fastest <= reach.short {
            return duration;
        }
        let close = reach.close / fastest;
        let room = known.spare.pop().unwrap_or_else(Mat::new);
        let (room, left) =
            self.pass(regime, known.pace, total, room, |equations, states, inputs| {
                known.advance(equations, [duration, lead, close], states, inputs)
            });
        known.spare.push(room);
        left
    }

    /// Takes disturbances over a short duration, or back, by power series.
    pub(super) fn catch_up(&self, regime: &ContactState, duration: f64, total: &mut Mat<f64>) {
        let steps = self.steps(duration);
        self.pass(regime, 0.0, total, Mat::new(), |equations, mut states, inputs| {
            for _ in 0..steps {
                equations.correct(&mut states, inputs, duration / steps as f64);
            }
            (states, 0.0)
        });
    }

    /// Takes disturbances along by the equations of a regime. Strains that neither move nor are disturbed,
    /// those of contacts that slip under a constant limit, take no part. States stand in the room that is given; what
    /// has become of it comes back.
    fn pass(
        &self,
        regime: &ContactState,
        pace: f64,
        total: &mut Mat<f64>,
        room: Mat<f64>,
        along: impl FnOnce(&Equations, Mat<f64>, &Mat<f64>) -> (Mat<f64>, f64),
    ) -> (Mat<f64>, f64) {
        let first = 2 * self.weight.len();
        let mut disturbed = vec![false; total.nrows() - first];
        let mut columns = Vec::with_capacity(total.ncols());
        for j in 0..total.ncols() {
            let column = total.col_as_slice(j);
            disturbed.iter_mut().zip(&column[first..]).for_each(|(row, x)| *row |= *x != 0.0);
            if column.iter().any(|x| *x != 0.0) {
                columns.push(j);
            }
        }
        let own = self.equations(regime, pace, &disturbed);
        let factors: Vec<f64> = own.scale.iter().zip(&self.weight).map(|(s, w)| s / w).collect();
        let mut states = room;
        states.resize_with(first, columns.len(), |_, _| 0.0);
        let mut inputs = Mat::zeros(own.strains.len(), columns.len());
        for (j, &column) in columns.iter().enumerate() {
            let (motion, strains) = total.col_as_slice(column).split_at(first);
            let state = states.col_as_slice_mut(j);
            state.copy_from_slice(motion);
            state.iter_mut().zip(&factors).for_each(|(x, factor)| *x *= factor);
            let inputs = inputs.col_as_slice_mut(j).iter_mut().zip(&own.strains);
            inputs.for_each(|(g, strain)| *g = strains[*strain]);
        }
        own.add_strains(-1.0, &states, &mut inputs);
        let left;
        (states, left) = along(&own, states, &inputs);
        own.add_strains(1.0, &states, &mut inputs);
        let factors: Vec<f64> = factors.iter().map(|factor| 1.0 / factor).collect();
        for (j, &column) in columns.iter().enumerate() {
            let (motion, strains) = total.col_as_slice_mut(column).split_at_mut(first);
            motion.copy_from_slice(states.col_as_slice(j));
            motion.iter_mut().zip(&factors).for_each(|(x, factor)| *x *= factor);
            let inputs = inputs.col_as_slice(j).iter().zip(&own.strains);
            inputs.for_each(|(g, strain)| strains[*strain] = *g);
        }
        (states, left)
    }

    /// The equations in one state of the contacts, with all strains that move or are disturbed; in the units of
    /// motions at a pace, or those at hand if it is 0.
    fn equations(&self, regime: &ContactState, pace: f64, disturbed: &[bool]) -> Equations {
        let (system, modes) = (self.system, self.weight.len());
        let springs = self.springs(regime);
        let mut takes_part = disturbed.to_vec();
        springs.moves.iter().for_each(|(strain, _, _)| takes_part[*strain] = true);
        let strains: Vec<usize> = (0..takes_part.len()).filter(|&i| takes_part[i]).collect();
        let mut moves = Mat::<f64>::zeros(strains.len(), modes);
        for (strain, point, rate) in &springs.moves {
            let Ok(row) = strains.binary_search(strain) else { continue };
            for (j, b) in system.contact_shape(*point).iter().enumerate() {
                moves[(row, j)] += rate * b;
            }
        }
        let mut input = Mat::<f64>::zeros(modes, strains.len());
        for body in system.bodies() {
            for (own, strain) in body.strains.clone().enumerate() {
                let Ok(place) = strains.binary_search(&strain) else { continue };
                for (row, i) in body.points.clone().enumerate() {
                    let root = body.elastic.root()[(row, own)];
                    let shape = system.contact_shape(i);
                    input
                        .col_as_slice_mut(place)
                        .iter_mut()
                        .zip(shape)
                        .for_each(|(a, b)| *a -= b * root);
                }
            }
        }
        let mut stiffness = Mat::<f64>::zeros(modes, modes);
        multiply(stiffness.as_mut(), Accum::Replace, input.as_ref(), moves.as_ref(), -1.0);
        for &(point, slope) in &springs.pressing {
            let shape = system.contact_shape(point);
            for (j, b) in shape.iter().enumerate() {
                let column = stiffness.col_as_slice_mut(j).iter_mut();
                column.zip(shape).for_each(|(k, own)| *k += own * slope * b);
            }
        }
        let mut scale = Vec::with_capacity(modes);
        for (j, (square, weight)) in system.omega_squared().iter().zip(&self.weight).enumerate() {
            stiffness[(j, j)] += square;
            let least = if pace > 0.0 { square.abs().sqrt().max(pace) } else { *weight };
            scale.push(stiffness[(j, j)].abs().sqrt().max(least));
        }
        for (j, s) in scale.iter().enumerate() {
            stiffness.col_as_slice_mut(j).iter_mut().for_each(|k| *k /= s);
            moves.col_as_slice_mut(j).iter_mut().for_each(|rate| *rate /= s);
        }
        Equations {
            scale,
            strains,
            rates: moves,
            stiffness,
            damping: system.damping.clone(),
            input,
            springs,
        }
    }

    /// `g' = L⁺ T u'` as strains, points and factors that are not 0.
    pub(super) fn strain_rates(&self, regime: &ContactState) -> Vec<(usize, usize, f64)> {
        let mut all = Vec::new();
        for body in self.system.bodies() {
            for i in body.points.clone() {
                if body.points.clone().all(|r| regime.tangent[(r, i)] == 0.0) {
                    continue;
                }
                let column: Vec<f64> =
                    body.points.clone().map(|r| regime.tangent[(r, i)]).collect();
                let rates = body.elastic.strains(&column);
                let own = body.strains.clone().zip(rates).map(|(strain, rate)| (strain, i, rate));
                all.extend(own.filter(|(_, _, rate)| *rate != 0.0));
            }
        }
        all
    }
}
