//! Where a model can resonate: the poles of every state of its contacts.
//!
//! A contact that sticks is a spring, one that slips a bounded force. Between the two friction damps
//! a motion as much as it shifts its frequency, so that whatever is narrow lies near a pole of a
//! state in which every point does one or the other, or where the little that slipping points still
//! carry moves it from there.

use super::body::Body;
use super::contact_states::{partial_sets, slip_sets, State, MOST_STATES};
use super::slipping_point::{shift, SlippingPoint};
use super::traction::most_of_a_traction;
use super::Model;
use crate::structure::Poles;
use crate::Error;
use faer::{c64, Mat};
use std::f64::consts::PI;

/// Share of a product of shapes that is rounding of none.
pub(super) const NOISE: f64 = 1e-9;

/// A resonance in one state of the contacts.
#[derive(Debug, Clone)]
pub struct Resonance {
    /// Frequency of the excitation that meets it [rad/s].
    pub omega: f64,
    /// Half-power bandwidth of the excitation [rad/s].
    pub bandwidth: f64,
    /// Displacement of every DOF that the load, helped by all slipping contacts, can cause; infinite
    /// where that is not known.
    pub reach: Option<Vec<f64>>,
    /// DOFs that nothing bounds there: nothing damps, and the load is stronger than friction at all points that
    /// can slip.
    pub unbounded: Vec<usize>,
    /// Whether the load itself excites that harmonic.
    pub forced: bool,
    /// Whether points slip in a part of the period there: where it lies is a guess.
    pub partial: bool,
}

impl Resonance {
    /// One that a load excites, of which no more is known.
    fn at(omega: f64, bandwidth: f64, unbounded: Vec<usize>) -> Self {
        Self { omega, bandwidth, reach: None, unbounded, forced: true, partial: false }
    }
}

impl Model {
    /// Whether the resonances of all states of the contacts are known, or those of the stuck and of
    /// the free structure alone.
    #[must_use]
    pub fn knows_its_states(&self) -> bool {
        !self.states.diameters.is_empty()
    }

    /// Resonances that an excitation inside `[low, high]` [rad/s] meets with one of `harmonics`.
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub fn resonances(
        &self,
        (low, high): (f64, f64),
        harmonics: impl Iterator<Item = usize>,
    ) -> Result<Vec<Resonance>, Error> {
        let forced = self.compliance.forced_harmonics();
        let lowest = forced.iter().copied().find(|&k| k > 0).unwrap_or(1);
        let inside = |omega: f64| (low..=high).contains(&omega);
        let mut found = Vec::new();
        for harmonic in harmonics.filter(|&k| k > 0) {
            let (order, is_forced) = (harmonic as f64, forced.contains(&harmonic));
            let Some(states) = self.states_at(harmonic)? else {
                if is_forced {
                    found.extend(self.natural((low, high), harmonic));
                }
                continue;
            };
            // A slipping contact bears a square wave at most.
            let bearing = Bearing::of(self, harmonic, square_wave(lowest, harmonic));
            // A load of its own moves a resonance as `shift` says.
            for state in states.iter().filter(|state| state.carried == 0.0 || !is_forced) {
                let grown = if state.all { self.unbounded_by(&bearing, state) } else { Vec::new() };
                for (j, pole) in state.poles.values.iter().enumerate() {
                    let driven = bearing.driven(state, j);
                    let decay = pole.re.abs() + bearing.lost(state, j, order);
                    let moved = shift(driven, decay, &|| bearing.points(state, j));
                    let met = [Some(pole.im), moved.map(|by| pole.im + by)].into_iter().flatten();
                    let met: Vec<f64> = met.map(|w| w / order).filter(|&w| inside(w)).collect();
                    // How far it reaches takes most of the time, and most are met elsewhere.
                    if met.is_empty() {
                        continue;
                    }
                    let reach = bearing.reach_beyond(states, state, j, decay);
                    let unbounded = grown.iter().find(|one| one.poles.contains(&j));
                    let unbounded = unbounded.map_or_else(Vec::new, |one| one.dofs.clone());
                    found.extend(met.into_iter().map(|omega| Resonance {
                        omega,
                        bandwidth: 2.0 * decay / order,
                        reach: Some(reach.clone()),
                        unbounded: unbounded.clone(),
                        forced: is_forced,
                        partial: state.carried > 0.0,
                    }));
                }
            }
        }
        if !self.knows_its_states() {
            let grown = self.unbounded_resonances(&|_| true)?.into_iter();
            let grown = grown.filter(|(omega, _)| inside(*omega));
            found.extend(grown.map(|(omega, dofs)| Resonance::at(omega, 0.0, dofs)));
        }
        found.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        Ok(found)
    }

    /// Natural frequencies of the stuck and of the free structure that a load on a harmonic meets.
    fn natural(
        &self,
        (low, high): (f64, f64),
        harmonic: usize,
    ) -> impl Iterator<Item = Resonance> + '_ {
        let order = harmonic as f64;
        let bandwidth = self.compliance.narrowest_bandwidth() / order;
        let natural =
            move |stuck| self.compliance.frequencies_between(stuck, [low, high].map(|w| w * order));
        let at = [true, false].into_iter().flat_map(natural).map(move |w| w / order);
        let at = at.filter(move |w| (low..=high).contains(w));
        at.map(move |omega| Resonance::at(omega, bandwidth, Vec::new()))
    }

    /// The load of a harmonic on every DOF.
    pub(super) fn load(&self, harmonic: usize) -> Vec<c64> {
        let loads = self.ports.loads.iter().filter(|load| load.harmonic == harmonic);
        let mut sum = vec![c64::new(0.0, 0.0); self.structure.dofs()];
        for load in loads {
            sum.iter_mut().zip(&load.amplitude).for_each(|(sum, p)| *sum += p);
        }
        sum
    }

    /// The nodal diameter that a harmonic sees.
    pub(super) fn diameter(&self, harmonic: usize) -> usize {
        match &self.body {
            Body::Wave { cyclic, .. } => cyclic.diameter(harmonic),
            Body::Whole | Body::Ring(_) => 0,
        }
    }

    /// The states that a harmonic sees, if they are known.
    fn states_at(&self, harmonic: usize) -> Result<Option<&[State]>, Error> {
        let diameter = self.diameter(harmonic);
        let Some(states) = self.states.diameters.get(diameter) else { return Ok(None) };
        match states.get_or_init(|| self.find_states(diameter)) {
            Ok(states) => Ok(Some(states)),
            Err(error) => Err(error.clone()),
        }
    }

    pub(crate) fn slip_limits(&self) -> impl Iterator<Item = f64> + '_ {
        self.laws.iter().flat_map(|law| law.limits())
    }

    fn find_states(&self, diameter: usize) -> Result<Vec<State>, Error> {
        let limits: Vec<f64> = self.slip_limits().collect();
        // The many equal sectors of a ring stick and slip together.
        let most = if matches!(self.body, Body::Ring(_)) { 0 } else { MOST_STATES };
        let whole = slip_sets(&limits, most).into_iter().map(|slips| (slips, 0.0));
        let sets = whole.chain(partial_sets(&limits, most));
        sets.map(|(slips, carried)| self.state(diameter, &slips, carried)).collect()
    }

    pub(super) fn state(
        &self,
        diameter: usize,
        slips: &[bool],
        carried: f64,
    ) -> Result<State, Error> {
        let structure = &self.structure;
        // What carries all of its stiffness sticks.
        let all_stick: Vec<bool> = self.slip_limits().map(|limit| limit == 0.0).collect();
        let parts = [(slips, 1.0 - carried), (&all_stick, carried)];
        let parts = parts.into_iter().filter(|(_, share)| *share > 0.0);
        let (poles, rows) = if let Body::Wave { cyclic, next } = &self.body {
            let rows = cyclic.rows_at(diameter, self.ports.rows.as_ref(), Mat::as_ref(next));
            let [mass, damping, mut restrained] = cyclic.at_diameter(diameter);
            for (slips, share) in parts {
                let (stick, stiffness) = self.condensed_stiffness(slips)?;
                let kept = Mat::from_fn(stick.len(), rows.ncols(), |i, j| rows[(stick[i], j)]);
                let stiffness = Mat::from_fn(stick.len(), stick.len(), |i, j| {
                    c64::new(share * stiffness[(i, j)], 0.0)
                });
                restrained += kept.adjoint() * (stiffness * &kept);
            }
            let matrices = [mass.as_ref(), damping.as_ref(), restrained.as_ref()];
            (Poles::hermitian(matrices)?, rows)
        } else {
            let all = &self.ports.rows;
            let mut restrained = Mat::zeros(structure.dofs(), structure.dofs());
            for (slips, share) in parts {
                let (stick, stiffness) = self.condensed_stiffness(slips)?;
                let kept = Mat::from_fn(stick.len(), all.ncols(), |i, j| all[(stick[i], j)]);
                let part = structure.restrained_stiffness(&kept.into(), &stiffness.into());
                restrained += faer::Scale(share) * part;
            }
            let matrices = [structure.mass(), structure.damping(), restrained.as_ref()];
            let rows = Mat::from_fn(all.nrows(), all.ncols(), |i, j| c64::new(all[(i, j)], 0.0));
            (Poles::real(matrices)?, rows)
        };
        let (all_effects, shown) = (&poles.left * rows.adjoint(), &rows * &poles.right);
        let effects = Mat::from_fn(poles.values.len(), rows.nrows(), |j, i| {
            let noise = NOISE * poles.left.row(j).norm_l2() * rows.row(i).norm_l2();
            let one = all_effects[(j, i)];
            if one.norm() > noise {
                one
            } else {
                c64::new(0.0, 0.0)
            }
        });
        let effect = |j: usize, i: usize| match (effects[(j, i)].norm(), slips[i]) {
            (0.0, _) => [0.0, 0.0],
            (size, true) => [size, shown[(i, j)].norm()],
            (_, false) => [0.0, shown[(i, j)].norm()],
        };
        let contacts = (0..poles.values.len())
            .map(|j| (0..rows.nrows()).map(|i| effect(j, i)).collect())
            .collect();
        let planes: Vec<[usize; 2]> = self.planes().collect();
        let of_plane = |j: usize, [a, b]: [usize; 2]| {
            if slips[a] {
                most_of_a_traction([all_effects[(j, a)], all_effects[(j, b)]])
            } else {
                0.0
            }
        };
        let in_planes = (0..poles.values.len())
            .map(|j| planes.iter().map(|plane| of_plane(j, *plane)).collect())
            .collect();
        let mut limits = self.slip_limits().zip(slips);
        let all = carried == 0.0 && limits.all(|(limit, slips)| *slips || limit.is_infinite());
        Ok(State {
            poles,
            effects,
            contacts,
            planes: in_planes,
            slips: slips.to_vec(),
            carried,
            all,
        })
    }
}

/// Effect of a load on a pole.
pub(super) fn driven(state: &State, j: usize, load: &[c64]) -> f64 {
    let left = state.poles.left.row(j);
    let size = load.iter().map(|p| p.norm_sqr()).sum::<f64>().sqrt();
    let driven = (0..load.len()).map(|i| left[i] * load[i]).sum::<c64>().norm();
    if driven > NOISE * left.norm_l2() * size {
        driven
    } else {
        0.0
    }
}

/// Most of a slip limit that the force of a point has in a harmonic, if `lowest` is the lowest one.
pub(super) fn square_wave(lowest: usize, harmonic: usize) -> f64 {
    4.0 / PI * (lowest as f64 / harmonic as f64).min(1.0)
}

/// What drives and what slows a resonance at one harmonic.
pub(super) struct Bearing {
    pub(super) load: Vec<c64>,
    pub(super) limits: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
    /// Pairs of points that slip in a plane.
    pub(super) planes: Vec<[usize; 2]>,
    /// Most of a slip limit that a friction force has in this harmonic.
    pub(super) share: f64,
}

impl Bearing {
    /// Of the load of a harmonic, and all contacts.
    pub(super) fn of(model: &Model, harmonic: usize, share: f64) -> Self {
        let limits: Vec<f64> = model.slip_limits().collect();
        let stiffness = model.contact_stiffness();
        let stiffness = (0..limits.len()).map(|i| stiffness[(i, i)]).collect();
        let planes = model.planes().collect();
        Self { load: model.load(harmonic), limits, stiffness, planes, share }
    }

    /// Effect of the load on a pole.
    pub(super) fn driven(&self, state: &State, j: usize) -> f64 {
        driven(state, j, &self.load)
    }

    /// Most that the friction of all slipping points does to a pole.
    pub(super) fn friction(&self, state: &State, j: usize) -> f64 {
        let points = state.contacts[j].iter().zip(&self.limits).enumerate();
        let lines = points.filter(|(i, ([effect, _], _))| {
            *effect > 0.0 && !self.planes.iter().any(|plane| plane.contains(i))
        });
        let lines = lines.map(|(_, ([effect, _], limit))| effect * limit);
        let planes = self.planes.iter().zip(&state.planes[j]).filter(|(_, effect)| **effect > 0.0);
        let planes = planes.map(|(plane, effect)| effect * self.limits[plane[0]]);
        self.share * (lines.sum::<f64>() + planes.sum::<f64>())
    }

    /// Decay of a pole by the points that slip in a part of the period: a motion at a higher harmonic
    /// leaves in each of them, after each stick, a share of its force, 1/(πk) in the mean over all
    /// lengths of the stick.
    fn lost(&self, state: &State, j: usize, order: f64) -> f64 {
        if state.carried == 0.0 {
            return 0.0;
        }
        let points = self.points(state, j);
        points.map(|one| one.effect * one.seen * one.stiffness).sum::<f64>() / (PI * order)
    }

    /// The points of a pole.
    fn points<'s>(
        &'s self,
        state: &'s State,
        j: usize,
    ) -> impl Iterator<Item = SlippingPoint> + 's {
        let points = state.contacts[j].iter().zip(&self.limits).zip(&self.stiffness);
        points.map(|((&[effect, seen], &limit), &stiffness)| SlippingPoint {
            effect,
            seen,
            limit,
            stiffness,
        })
    }

    /// Displacement of every DOF that load and friction can cause in a state.
    fn reach(&self, state: &State, j: usize, decay: f64) -> Vec<f64> {
        let cause = self.driven(state, j) + self.friction(state, j);
        let right = state.poles.right.col(j);
        let (height, shown) = (cause / decay, NOISE * right.norm_l2());
        let seen = |i: usize| match right[i].norm() {
            seen if seen > shown && cause > 0.0 => seen * height,
            _ => 0.0,
        };
        (0..right.nrows()).map(seen).collect()
    }

    /// The same, with that of the resonances on either side in the state in which those points slip,
    /// too, that could not stick: what these uncouple may resonate by itself.
    fn reach_beyond(&self, states: &[State], state: &State, j: usize, decay: f64) -> Vec<f64> {
        let mut reach = self.reach(state, j, decay);
        let pole = state.poles.values[j];
        let cause = self.driven(state, j) + self.friction(state, j);
        let height = if cause > 0.0 { cause / decay } else { 0.0 };
        let tears = |point: &SlippingPoint| point.stiffness * point.seen * height > point.limit;
        let torn: Vec<bool> = self.points(state, j).map(|point| tears(&point)).collect();
        let slips: Vec<bool> = torn.iter().zip(&state.slips).map(|(a, b)| *a || *b).collect();
        if slips == state.slips || state.carried > 0.0 {
            return reach;
        }
        let beyond = states.iter().find(|other| other.slips == slips && other.carried == 0.0);
        let Some(beyond) = beyond.or_else(|| states.iter().find(|other| other.all)) else {
            return reach;
        };
        let values = &beyond.poles.values;
        let below = (0..values.len()).filter(|&i| values[i].im <= pole.im);
        let above = (0..values.len()).filter(|&i| values[i].im > pole.im);
        let by_frequency = |a: &usize, b: &usize| values[*a].im.total_cmp(&values[*b].im);
        for i in [below.max_by(by_frequency), above.min_by(by_frequency)].into_iter().flatten() {
            let other = self.reach(beyond, i, values[i].re.abs());
            reach.iter_mut().zip(other).for_each(|(reach, other)| *reach = reach.max(other));
        }
        reach
    }
}
