//! The linear equations of free motion while all contacts stick, or all slip, in their own modes.
//!
//! Both judge a motion for all time to come. Friction forces are bounded: beyond some amplitude no
//! force within the slip limits keeps an unstable mode of the slipping structure from growing. And
//! a motion that the stuck structure damps, below the onset of slip, stays below it.

use super::contact_state::{Blocks, ContactState};
use super::modal_system::{dot, ModalSystem};
use super::state::State;
use crate::contact::PointState;
use crate::solve::hermitian_eigen;
use crate::Error;
use faer::linalg::solvers::{DenseSolveCore as _, Solve as _};
use faer::{c64, Mat};

/// Rate of growth, relative to the fastest rate, that counts as zero.
const NEUTRAL: f64 = 1e-12;

/// One linear phase `η'' + C η' + K η + (B Φ)ᵀ (f − T u) = 0`, T being the contact stiffness left.
pub(super) struct Phase {
    /// K, modes × modes.
    stiffness: Mat<f64>,
    /// T, points × points [N/m].
    tangent: Blocks,
    /// Scales S of the displacements in the state `(S η, η')`.
    scale: Vec<f64>,
    /// Poles λ [1/s].
    poles: Vec<c64>,
    /// Rows that take a state to its modal coordinates z, with `z' = λ z`.
    left: Mat<c64>,
    /// Displacements η per z.
    right: Mat<c64>,
}

impl Phase {
    /// The phase in which the given points slip, the others stick.
    pub(super) fn new(system: &ModalSystem, points: &[PointState]) -> Result<Self, Error> {
        let n = system.modes();
        let tangent = ContactState::new(system, points).tangent;
        let mut stiffness =
            Mat::from_fn(n, n, |i, j| if i == j { system.omega_squared()[i] } else { 0.0 });
        for a in 0..system.points() {
            for b in system.together_with(a) {
                let t = tangent[(a, b)];
                if t == 0.0 {
                    continue;
                }
                let (left, right) = (system.contact_shape(a), system.contact_shape(b));
                for i in 0..n {
                    for j in 0..n {
                        stiffness[(i, j)] += left[i] * t * right[j];
                    }
                }
            }
        }
        let highest = (0..n).map(|i| stiffness[(i, i)].abs()).fold(0.0, f64::max).sqrt();
        let scale: Vec<f64> = (0..n)
            .map(|i| stiffness[(i, i)].abs().sqrt().max(1e-4 * highest).max(f64::MIN_POSITIVE))
            .collect();
        let state = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => 0.0,
            (true, false) => scale[i] * f64::from(u8::from(i == j - n)),
            (false, true) => -stiffness[(i - n, j)] / scale[j],
            (false, false) => -system.damping.entry(i - n, j - n),
        });
        let failed = || Error::Eigenvalues("damping".to_owned());
        let eigen = state.eigen().map_err(|_| failed())?;
        let vectors = eigen.U().to_owned();
        let left = vectors.partial_piv_lu().inverse();
        let poles: Vec<c64> = (0..2 * n).map(|j| eigen.S()[j]).collect();
        let finite = |z: &c64| z.re.is_finite() && z.im.is_finite();
        let spans = (0..2 * n).all(|i| (0..2 * n).all(|j| finite(&left[(i, j)])));
        if !spans || !poles.iter().all(finite) {
            return Err(failed());
        }
        let right = Mat::from_fn(n, 2 * n, |i, j| vectors[(i, j)] / scale[i]);
        Ok(Self { stiffness, tangent, scale, poles, left, right })
    }

    /// Rate of growth that counts as zero [1/s].
    fn neutral(&self) -> f64 {
        NEUTRAL * self.poles.iter().map(|p| p.norm()).fold(0.0, f64::max)
    }

    /// Modal coordinates of a motion about a displacement.
    fn coordinates(&self, about: &[f64], state: &State) -> Vec<c64> {
        let n = self.scale.len();
        (0..2 * n)
            .map(|k| {
                let mut z = c64::new(0.0, 0.0);
                for (j, about) in about.iter().enumerate() {
                    z += self.left[(k, j)] * (self.scale[j] * (state.displacement[j] - about))
                        + self.left[(k, n + j)] * state.velocity[j];
                }
                z
            })
            .collect()
    }

    /// What of the contact forces is not linear in the displacements now, `f − T u`.
    fn rest(&self, system: &ModalSystem, state: &State) -> Vec<f64> {
        let u = system.contact_displacement(&state.displacement);
        (0..u.len()).map(|i| state.force[i] - self.tangent.times(i, &u)).collect()
    }
}

/// What friction can hold at most: thresholds of growth of the slipping structure.
pub(super) struct Slipping {
    phase: Phase,
    /// Forces of points that never slip per force of those that do, points × points: what these
    /// leave of the former beside their springs.
    passed: Mat<f64>,
    /// Points that never slip.
    held: Vec<bool>,
    /// `|Lᵀ b|` per unstable pole and point.
    grip: Vec<(usize, Vec<f64>)>,
}

impl Slipping {
    pub(super) fn new(system: &ModalSystem) -> Result<Self, Error> {
        let held: Vec<bool> = system.limits().iter().map(|limit| limit.is_infinite()).collect();
        let states: Vec<PointState> = held
            .iter()
            .map(|held| if *held { PointState::Stuck } else { PointState::Forward })
            .collect();
        let phase = Phase::new(system, &states)?;
        let n = system.modes();
        let neutral = phase.neutral();
        // Nothing is known of friction forces that normal loads bound.
        let bounded = if system.has_normals() { 0 } else { 2 * n };
        let grip = (0..bounded)
            .filter(|&k| phase.poles[k].re > neutral)
            .map(|k| {
                let per_point = |point: usize| {
                    let shape = system.contact_shape(point);
                    let mut sum = c64::new(0.0, 0.0);
                    for (j, b) in shape.iter().enumerate() {
                        sum += phase.left[(k, n + j)] * b;
                    }
                    sum.norm()
                };
                (k, (0..system.points()).map(per_point).collect())
            })
            .collect();
        Ok(Self { passed: passed_on(system, &held), phase, held, grip })
    }

    /// Whether the motion grows for ever, whatever friction does: with `z' = λ z + g` and
    /// `|g| ≤ γ`, |z| grows once `|z| Re λ > γ`.
    pub(super) fn outgrows(&self, system: &ModalSystem, state: &State) -> bool {
        if self.grip.is_empty() {
            return false;
        }
        let rest = self.phase.rest(system, state);
        let points = rest.len();
        let bound: Vec<f64> = (0..points)
            .map(|i| {
                if !self.held[i] {
                    return system.limits()[i];
                }
                let slipping =
                    |j: usize| self.passed[(i, j)] * if self.held[j] { 0.0 } else { 1.0 };
                let now: f64 = (0..points).map(|j| slipping(j) * rest[j]).sum();
                let most: f64 = (0..points)
                    .filter(|&j| !self.held[j])
                    .map(|j| slipping(j).abs() * system.limits()[j])
                    .sum();
                (rest[i] - now).abs() + most
            })
            .collect();
        let z = self.phase.coordinates(&vec![0.0; system.modes()], state);
        self.grip.iter().any(|(k, grip)| {
            let most = dot(grip, &bound);
            z[*k].norm() * self.phase.poles[*k].re > most && z[*k].norm() > 0.0
        })
    }
}

/// `D_HF D_FF⁻¹` of each law, from points F that slip to points H that never do.
fn passed_on(system: &ModalSystem, held: &[bool]) -> Mat<f64> {
    let mut passed = Mat::zeros(held.len(), held.len());
    for body in system.bodies() {
        let (stiffness, range) = (body.law.stiffness(), &body.points);
        let at = |i: usize, j: usize| stiffness[(i - range.start, j - range.start)];
        let (holds, slips): (Vec<usize>, Vec<usize>) = range.clone().partition(|&i| held[i]);
        if holds.is_empty() || slips.is_empty() {
            continue;
        }
        let own = Mat::from_fn(slips.len(), slips.len(), |a, b| at(slips[a], slips[b]));
        let cross = Mat::from_fn(slips.len(), holds.len(), |a, b| at(slips[a], holds[b]));
        let solved = own.partial_piv_lu().solve(&cross);
        for (a, &slip) in slips.iter().enumerate() {
            for (b, &hold) in holds.iter().enumerate() {
                passed[(hold, slip)] = solved[(a, b)];
            }
        }
    }
    passed
}

/// Whether a motion stays below the onset of slip, and dies away there.
pub(super) struct Sticking {
    phase: Phase,
    /// `|T B Φ R|`: force of a point per modal coordinate, point after point; of one that is open what would
    /// press it.
    force: Vec<Vec<f64>>,
    /// Points that are open.
    open: Vec<bool>,
    /// Whether all poles decay.
    pub(super) damped: bool,
}

impl Sticking {
    /// With all contacts closed.
    pub(super) fn new(system: &ModalSystem) -> Result<Self, Error> {
        Self::with(system, &vec![false; system.points()])
    }

    /// With those contacts open that are so at rest, if there are any.
    pub(super) fn at_rest(system: &ModalSystem) -> Result<Option<Self>, Error> {
        let state = State::rest(system);
        let open: Vec<bool> = state.points.iter().map(|own| *own == PointState::Open).collect();
        open.contains(&true).then(|| Self::with(system, &open)).transpose()
    }

    fn with(system: &ModalSystem, open: &[bool]) -> Result<Self, Error> {
        // A point without friction slips from the start.
        let states: Vec<PointState> = (system.limits().iter().zip(open))
            .map(|(limit, open)| match open {
                true => PointState::Open,
                false if *limit > 0.0 => PointState::Stuck,
                false => PointState::Forward,
            })
            .collect();
        let phase = Phase::new(system, &states)?;
        let (n, points) = (system.modes(), system.points());
        let per_pole = |point: usize, pole: usize| {
            let mut sum = c64::new(0.0, 0.0);
            for other in system.together_with(point) {
                let would = open[point] && other == point;
                let t = if would {
                    system.normal_stiffness(point)
                } else {
                    phase.tangent[(point, other)]
                };
                for (j, b) in system.contact_shape(other).iter().enumerate() {
                    sum += phase.right[(j, pole)] * (t * b);
                }
            }
            sum.norm()
        };
        let force = (0..points)
            .map(|point| (0..2 * n).map(|pole| per_pole(point, pole)).collect())
            .collect();
        let neutral = phase.neutral();
        Ok(Self {
            force,
            open: open.to_vec(),
            damped: phase.poles.iter().all(|p| p.re < -neutral),
            phase,
        })
    }

    /// Whether no contact slips from now on, and all motion is damped. Rest is, too.
    pub(super) fn keeps(&self, system: &ModalSystem, state: &State) -> bool {
        let still = |values: &[f64]| values.iter().all(|v| *v == 0.0);
        if still(&state.displacement) && still(&state.velocity) && still(&state.force) {
            return true;
        }
        // Without sliders a contact slips however little it moves.
        if !self.damped || !system.microslips().is_empty() {
            return false;
        }
        let rest = self.phase.rest(system, state);
        let n = system.modes();
        let mut right = Mat::<f64>::zeros(n, 1);
        for (point, f) in rest.iter().enumerate() {
            for (j, b) in system.contact_shape(point).iter().enumerate() {
                right[(j, 0)] -= b * f;
            }
        }
        let solved = self.phase.stiffness.partial_piv_lu().solve(&right);
        let about: Vec<f64> = (0..n).map(|j| solved[(j, 0)]).collect();
        if about.iter().any(|x| !x.is_finite()) {
            return false;
        }
        let z = self.phase.coordinates(&about, state);
        let u = system.contact_displacement(&about);
        let mean: Vec<f64> =
            (0..rest.len()).map(|i| rest[i] + self.phase.tangent.times(i, &u)).collect();
        let swing =
            |i: usize| -> f64 { self.force[i].iter().zip(&z).map(|(c, z)| c * z.norm()).sum() };
        let touches = |i: &usize| self.open[*i] && system.pressing(*i, &about) + swing(*i) > 0.0;
        if system.normals.iter().any(touches) {
            return false;
        }
        let lowest: Vec<f64> = (0..rest.len()).map(|i| mean[i] - swing(i)).collect();
        (0..rest.len()).all(|i| {
            let limit = system.limits()[i];
            if self.open[i] {
                return true;
            }
            let closed = !system.normals.contains(&i) || lowest[i] + system.balanced(i) > 0.0;
            let limit = if limit == f64::MAX { system.limit(i, &lowest) } else { limit };
            let most = match system.plane_of(i) {
                Some(plane) => {
                    let [u, v] = plane.points.map(|i| mean[i].abs() + swing(i));
                    u.hypot(v)
                }
                None => mean[i].abs() + swing(i),
            };
            closed && (limit == 0.0 || most < limit)
        })
    }

    /// Undamped modes of the stuck structure, in coordinates η: squared frequencies and shapes.
    pub(super) fn modes(&self) -> Result<(Vec<f64>, Mat<f64>), Error> {
        hermitian_eigen(self.phase.stiffness.as_ref())
            .ok_or_else(|| Error::Eigenvalues("stiffness".to_owned()))
    }
}
