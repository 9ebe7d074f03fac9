//! Resonances that nothing bounds: nothing damps the structure with all limited points slipping, and the load
//! brings in more work than friction can take.
//!
//! Modes of one frequency move together: what friction does to each of them by itself says nothing, since some
//! sum of them may move no contact at all.
//!
//! That balance says nothing where forces grow with the motion: of a cubic spring, a stop, friction under a
//! normal load that the motion changes. What such a contact does not see may still be unbounded.

use super::contact_states::{State, MOST_DOFS};
use super::resonances::{driven, square_wave, Bearing, NOISE};
use super::traction::{lines_of_a_traction, most_of_a_traction};
use super::unbalanced::{product, remainder, size, Bounded};
use super::{Model, MOST_UNDAMPED};
use crate::progress::Progress;
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat, Side};

/// Decay, over the highest natural frequency, that is rounding of none.
const UNDAMPED: f64 = 1e-14;
/// Difference of two squared frequencies, over that of the highest and over their own, that is rounding of none.
const EQUAL: [f64; 2] = [1e-14, 1e-12];
/// Excess of a load over friction, relative to it, that is rounding of none.
const EXCESS: f64 = 1e-12;

/// Poles of one frequency whose motion nothing bounds.
pub(super) struct Unbounded {
    pub(super) poles: Vec<usize>,
    /// DOFs that show the motion that grows.
    pub(super) dofs: Vec<usize>,
}

impl Model {
    /// The lowest frequency of the excitation inside `[low, high]` at which nothing bounds each DOF, as far as
    /// that is known; of an analysis that is to end, only what is found by then [rad/s].
    ///
    /// # Errors
    /// An eigenvalue iteration that fails.
    pub fn unbounded(
        &self,
        (low, high): (f64, f64),
        progress: &Progress<'_>,
    ) -> Result<Vec<Option<f64>>, Error> {
        let mut lowest: Vec<Option<f64>> = vec![None; self.structure.dofs()];
        for (omega, dofs) in self.unbounded_resonances(progress)? {
            for dof in dofs.into_iter().filter(|_| (low..=high).contains(&omega)) {
                lowest[dof] = Some(lowest[dof].map_or(omega, |known| known.min(omega)));
            }
        }
        Ok(lowest)
    }

    /// All frequencies of the excitation at which nothing bounds the motion, each with the DOFs that show it.
    ///
    /// # Errors
    /// As [`Model::unbounded`].
    pub(crate) fn unbounded_resonances(
        &self,
        progress: &Progress<'_>,
    ) -> Result<Vec<(f64, Vec<usize>)>, Error> {
        let mut found = Vec::new();
        if !self.affords_its_modes() || self.is_surely_damped() {
            return Ok(found);
        }
        let slips: Vec<bool> = self.slip_limits().map(f64::is_finite).collect();
        let mut last: Option<(usize, State)> = None;
        for harmonic in self.compliance.forced_harmonics().into_iter().filter(|&k| k > 0) {
            if !progress(0.0) {
                break;
            }
            let diameter = self.diameter(harmonic);
            let state = match last.take() {
                Some((known, state)) if known == diameter => state,
                _ => self.state(diameter, &slips, 0.0)?,
            };
            let bearing = Bearing::of(self, harmonic, square_wave(1, 1));
            for one in self.unbounded_by(&bearing, &state) {
                let omega = state.poles.values[one.poles[0]].im / harmonic as f64;
                found.push((omega, one.dofs));
            }
            last = Some((diameter, state));
        }
        Ok(found)
    }

    /// Whether all resonances that nothing bounds are known.
    pub(crate) fn knows_what_is_unbounded(&self) -> bool {
        self.affords_its_modes() || self.is_surely_damped()
    }

    /// Whether damping bounds all motions; of a disk it may not reach every wave.
    fn is_surely_damped(&self) -> bool {
        !self.is_travelling_wave() && self.structure.is_damped()
    }

    /// Whether the modes of the state in which all slips can be found.
    fn affords_its_modes(&self) -> bool {
        let most = if self.structure.is_undamped() { MOST_UNDAMPED } else { MOST_DOFS };
        self.knows_its_states() || self.structure.dofs() <= most
    }

    /// What nothing bounds, neither decay nor any force, in a state in which all slips.
    pub(super) fn unbounded_by(&self, bearing: &Bearing, state: &State) -> Vec<Unbounded> {
        if bearing.load.iter().all(|part| *part == c64::new(0.0, 0.0)) {
            return Vec::new();
        }
        let clusters = undamped_clusters(state);
        if clusters.is_empty() {
            return Vec::new();
        }
        let grows = self.growing_points(state);
        let grown = |poles: Vec<usize>| {
            let dofs = Cluster { state, bearing, grows: &grows, poles: &poles }.unbounded_dofs();
            (!dofs.is_empty()).then_some(Unbounded { poles, dofs })
        };
        clusters.into_iter().filter_map(grown).collect()
    }

    /// Pairs of contact points that slip in a plane.
    pub(super) fn planes(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let mut first = 0;
        self.laws.iter().flat_map(move |law| {
            let own = first;
            first += law.displacements();
            law.planes().into_iter().map(move |plane| plane.map(|i| own + i))
        })
    }

    /// Whether every point belongs to a contact that may carry more than its limits.
    fn growing_points(&self, state: &State) -> Vec<bool> {
        let grows: Vec<bool> = self.laws.iter().flat_map(|law| law.grows()).collect();
        let mut points = Vec::with_capacity(grows.len());
        for law in &self.laws {
            let own = points.len()..points.len() + law.displacements();
            let beyond = own.clone().any(|i| grows[i] && self.moves(state, i, &grows));
            points.resize(own.end, beyond);
        }
        points
    }

    /// Whether loads, or slip of contacts whose forces do not grow, move a contact point.
    fn moves(&self, state: &State, point: usize, grows: &[bool]) -> bool {
        let mut poles = state.contacts.iter().enumerate();
        poles.any(|(pole, contacts)| {
            let slips =
                || contacts.iter().zip(grows).any(|([effect, _], grows)| *effect > 0.0 && !grows);
            let loaded =
                || self.ports.loads.iter().any(|load| driven(state, pole, &load.amplitude) > 0.0);
            contacts[point][1] > 0.0 && (slips() || loaded())
        })
    }
}

/// Undamped poles, those of one frequency together.
fn undamped_clusters(state: &State) -> Vec<Vec<usize>> {
    let values = &state.poles.values;
    let highest = values.iter().map(|s| s.norm()).fold(0.0, f64::max);
    let undamped = |&j: &usize| values[j].re.abs() <= UNDAMPED * highest;
    let mut poles: Vec<usize> = (0..values.len()).filter(undamped).collect();
    poles.sort_by(|a, b| values[*a].im.total_cmp(&values[*b].im));
    let mut clusters: Vec<Vec<usize>> = Vec::new();
    for j in poles {
        let joins = |last: &Vec<usize>| {
            last.last().is_some_and(|&i| {
                let [a, b] = [i, j].map(|pole| values[pole].im.powi(2));
                b - a <= (EQUAL[0] * highest.powi(2)).max(EQUAL[1] * b)
            })
        };
        match clusters.last_mut() {
            Some(last) if joins(last) => last.push(j),
            _ => clusters.push(vec![j]),
        }
    }
    clusters
}

/// Undamped poles of one frequency, under what drives and slows them: a motion that grows without a bound makes
/// square waves of its own harmonic, whatever the lowest one is.
struct Cluster<'a> {
    state: &'a State,
    bearing: &'a Bearing,
    /// Points whose forces may grow without a limit.
    grows: &'a [bool],
    poles: &'a [usize],
}

impl Cluster<'_> {
    /// DOFs that nothing bounds.
    fn unbounded_dofs(&self) -> Vec<usize> {
        let load = self.load();
        if size(&load) == 0.0 {
            return Vec::new();
        }
        if let [pole] = self.poles {
            let held = (0..self.grows.len()).any(|i| self.grows[i] && self.sees(i));
            let grown = !held && size(&load) > self.friction(&[c64::new(1.0, 0.0)]);
            let shape = Mat::from_fn(self.state.poles.right.nrows(), 1, |i, _| {
                self.state.poles.right[(i, *pole)]
            });
            return if grown { shown(&shape, &[c64::new(1.0, 0.0)], 0.0) } else { Vec::new() };
        }
        let basis = self.orthonormal();
        let to_basis = basis.partial_piv_lu();
        let turned = |vector: Vec<c64>| -> Vec<c64> {
            let column = Mat::from_fn(vector.len(), 1, |j, _| vector[j]);
            let solved = to_basis.solve(&column);
            (0..vector.len()).map(|j| solved[(j, 0)]).collect()
        };
        let load = turned(load);
        let forces: Vec<Bounded> = self
            .forces()
            .into_iter()
            .map(|force| Bounded { effect: turned(force.effect), most: force.most })
            .collect();
        let left = remainder(&load, &forces);
        // Along the remainder in the coordinates of the poles: `v = T⁻ᴴ r`.
        let rest = Mat::from_fn(left.parts.len(), 1, |j, _| left.parts[j]);
        let along = basis.adjoint().partial_piv_lu().solve(&rest);
        let along: Vec<c64> = (0..left.parts.len()).map(|j| along[(j, 0)]).collect();
        let brought = product(&along, &self.load()).re;
        if size(&left.parts) <= left.doubt || brought <= (1.0 + EXCESS) * self.friction(&along) {
            return Vec::new();
        }
        let right = &self.state.poles.right;
        let shapes =
            Mat::from_fn(right.nrows(), self.poles.len(), |i, j| right[(i, self.poles[j])]);
        shown(&(shapes * basis), &left.parts, left.doubt)
    }

    /// Effect of the load on every pole.
    fn load(&self) -> Vec<c64> {
        let left = &self.state.poles.left;
        let effect = |&j: &usize| match self.bearing.driven(self.state, j) {
            0.0 => c64::new(0.0, 0.0),
            _ => self.bearing.load.iter().enumerate().map(|(i, p)| left[(j, i)] * p).sum(),
        };
        self.poles.iter().map(effect).collect()
    }

    /// Effects of a point on the poles.
    fn effects(&self, point: usize) -> Vec<c64> {
        self.poles.iter().map(|&j| self.state.effects[(j, point)]).collect()
    }

    fn sees(&self, point: usize) -> bool {
        self.poles.iter().any(|&j| self.state.contacts[j][point][1] > 0.0)
    }

    /// Points that slip along a line, those of contacts that grow excepted.
    fn lines(&self) -> impl Iterator<Item = usize> + '_ {
        let planes = &self.bearing.planes;
        let counts = |i: &usize| self.state.slips[*i] && !self.grows[*i];
        let points = (0..self.grows.len()).filter(counts);
        points.filter(|i| !planes.iter().any(|plane| plane.contains(i)))
    }

    /// Pairs of points that slip in a plane, those of contacts that grow excepted.
    fn planes(&self) -> impl Iterator<Item = &[usize; 2]> + '_ {
        self.bearing.planes.iter().filter(|[a, _]| self.state.slips[*a] && !self.grows[*a])
    }

    /// The forces of all points: those of contacts that grow have no limit.
    fn forces(&self) -> Vec<Bounded> {
        let most = |i: usize| square_wave(1, 1) * self.bearing.limits[i];
        let growing = (0..self.grows.len()).filter(|&i| self.grows[i] && self.sees(i));
        let growing = growing.map(|i| Bounded { effect: self.effects(i), most: f64::INFINITY });
        let lines = self.lines().map(|i| Bounded { effect: self.effects(i), most: most(i) });
        let mut forces: Vec<Bounded> = growing.chain(lines).collect();
        for &[a, b] in self.planes() {
            let (first, second) = (self.effects(a), self.effects(b));
            forces.extend(lines_of_a_traction().map(|([cos, sin], share)| Bounded {
                effect: first.iter().zip(&second).map(|(a, b)| a * cos + b * sin).collect(),
                most: share * most(a),
            }));
        }
        forces
    }

    /// Most that friction does along a sum of the poles.
    fn friction(&self, along: &[c64]) -> f64 {
        let does = |i: usize| product(along, &self.effects(i));
        let limit = |i: usize| self.bearing.limits[i];
        let lines = self.lines().map(|i| does(i).norm() * limit(i));
        let planes = self.planes().map(|&[a, b]| most_of_a_traction([does(a), does(b)]) * limit(a));
        square_wave(1, 1) * (lines.sum::<f64>() + planes.sum::<f64>())
    }

    /// The basis T of the poles in which their shapes R T have equal modal masses and none between them: the
    /// motion that grows is the nearest remainder in it. With `L = S Rᴴ`, `S = T Tᴴ` but for a factor.
    fn orthonormal(&self) -> Mat<c64> {
        let (poles, count) = (&self.state.poles, self.poles.len());
        let size = poles.right.nrows();
        let right = Mat::from_fn(size, count, |i, j| poles.right[(i, self.poles[j])]);
        let left = Mat::from_fn(count, size, |j, i| poles.left[(self.poles[j], i)]);
        let turn = c64::new(0.0, 2.0 * poles.values[self.poles[0]].im);
        let gram = right.adjoint() * &right;
        let crossed = (left * &right).adjoint().to_owned();
        let solved = gram.partial_piv_lu().solve(&crossed);
        let metric = Mat::from_fn(count, count, |i, j| {
            0.5 * (turn * solved[(j, i)].conj() + (turn * solved[(i, j)].conj()).conj())
        });
        match metric.llt(Side::Lower) {
            Ok(factor) => factor.L().to_owned(),
            // Poles that damping elsewhere mixes beyond that: any basis gives the verdict.
            Err(_) => Mat::identity(count, count),
        }
    }
}

/// DOFs that show a motion beyond what is unknown of it.
fn shown(shapes: &Mat<c64>, motion: &[c64], doubt: f64) -> Vec<usize> {
    let (whole, length) = (shapes.norm_l2(), size(motion));
    let shows = |&i: &usize| {
        let row: Vec<c64> = (0..motion.len()).map(|j| shapes[(i, j)]).collect();
        let seen = row.iter().zip(motion).map(|(shape, part)| shape * part).sum::<c64>().norm();
        seen > NOISE * whole * length + doubt * size(&row)
    };
    (0..shapes.nrows()).filter(shows).collect()
}
