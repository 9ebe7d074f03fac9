//! The slider positions of contacts that never slip in both senses, under normal loads that vary.
//!
//! Every position that Coulomb allows closes an orbit of its own: with the traction that it keeps the
//! mean, the normal loads and with them the vibration change. The one of
//! [`crate::contact::Residual`] is found by Newton's method on the positions. Its outer equations are
//! those of the assumption; the derivative of the orbit in a position follows from the transition
//! matrix, with the conserved slip as right-hand side.

use super::planar_sliders::PlanarSliders;
use super::shooting::Shooting;
use crate::contact::Residual;
use crate::motion::{Extremes, FlowEvent, ModalSystem};
use crate::solve::{newton, norm, NewtonSettings, Outcome};
use faer::linalg::solvers::Solve as _;
use faer::Mat;

/// Steps on the positions.
const STEPS: usize = 48;
/// Newton iterations that close the orbit again after a step; one that needs more is too long.
const CLOSING: usize = 12;
/// Newton steps in full; then as many others, as many in full, and shorter ones.
const FULL: usize = 8;
/// Halvings of a step after which the orbit does not close.
const HALVINGS: i32 = 8;
/// Distance from the assumed position that is none, …
const SETTLED: f64 = 1e-10;
/// … distance from a limit that it keeps, so that rounding does not push it, …
const CLEAR: f64 = 1e-9;
/// … distance at which it touches it, …
const TOUCHES: f64 = 1e-7;
/// … and step of differences, all relative to the contact's forces.
const DIFFERENCE: f64 = 1e-6;
/// Further looks for an orbit beside one that touches limits.
const LOOKS: usize = 3;

/// A contact, or one of its directions, whose slider an orbit leaves where it is; positions are scaled by the spring,
/// in N.
struct Kept {
    point: usize,
    /// Root of the spring's stiffness.
    root: f64,
    position: f64,
    /// Positions that Coulomb allows for the whole period.
    allowed: [f64; 2],
    /// The one that is assumed, if it could be chosen freely.
    wanted: f64,
    /// Size of the contact's forces.
    scale: f64,
    /// Whether it is where the motion pushes it in a plane.
    pushed: bool,
}

/// What is assumed of the contacts that leave a choice.
#[derive(Clone, Copy)]
pub(super) struct Assumption<'a> {
    pub(super) residual: Residual,
    /// By how much sliders are displaced that begin at rest, by contact displacement \[m\]; of none
    /// if it is empty.
    pub(super) sliders: &'a [f64],
}

/// How the search for the assumed positions has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Chosen {
    /// No contact leaves a choice, or all of them are where they are assumed.
    Inside,
    /// Some touch their limit: the flow has other derivatives on either side of the orbit.
    Touching,
    /// No orbit with the assumed positions was found.
    Lost,
}

impl Kept {
    /// The assumed position, as far as Coulomb allows it.
    fn target(&self) -> f64 {
        let clear = (CLEAR * self.scale).min(0.25 * (self.allowed[1] - self.allowed[0]));
        self.wanted.clamp(self.allowed[0] + clear, self.allowed[1] - clear)
    }

    fn miss(&self) -> f64 {
        self.target() - self.position
    }

    /// Way to the middle of what Coulomb allows: there nothing slips.
    fn inwards(&self) -> f64 {
        0.5 * (self.allowed[0] + self.allowed[1]) - self.position
    }

    /// A little of it.
    fn little(&self) -> f64 {
        let by = (DIFFERENCE * self.scale).min(self.inwards().abs()).max(SETTLED * self.scale);
        by.copysign(self.inwards())
    }

    fn touches(&self) -> bool {
        let room = TOUCHES * self.scale;
        self.pushed
            || self.position < self.allowed[0] + room
            || self.position > self.allowed[1] - room
    }
}

/// Moves a closed orbit to the one whose contacts keep what is assumed of them; its iterations are
/// added. Systems of constant limits have their own way, see [`super::residual`].
pub(super) fn choose(
    shooting: &mut Shooting<'_>,
    assumption: Assumption<'_>,
    y: &mut Vec<f64>,
    settings: NewtonSettings,
    iterations: &mut usize,
) -> Chosen {
    let system = shooting.coordinates.system();
    let most = settings.max_iterations.min(CLOSING);
    let settings = NewtonSettings { max_iterations: most, ..settings };
    if !system.has_normals() {
        return Chosen::Inside;
    }
    if !system.rigid_modes().is_empty() {
        return leave(shooting, assumption, y, settings, iterations);
    }
    for number in 0..STEPS {
        let Some(kept) = kept(shooting, assumption, y) else { return Chosen::Lost };
        if kept.iter().all(|one| one.miss().abs() <= SETTLED * one.scale) {
            let touches = kept.iter().any(Kept::touches);
            return if touches { Chosen::Touching } else { Chosen::Inside };
        }
        // Newton's method may go round in circles where the assumed positions move faster than the sliders: these
        // come after them, as in time. So it may where states change on the way: a shorter step ends that.
        let follows = (FULL..2 * FULL).contains(&number);
        let step = step(shooting, assumption, y, &kept, follows);
        let Some(step) = step else { return Chosen::Lost };
        let first = i32::from(number >= 3 * FULL);
        let found = (first..HALVINGS).find_map(|n| {
            let share = 0.5_f64.powi(n);
            let mut next: Vec<f64> = y.iter().zip(&step).map(|(y, by)| y + share * by).collect();
            let report = newton(shooting, &mut next, settings);
            *iterations += report.iterations;
            (report.outcome == Outcome::Converged).then_some(next)
        });
        let Some(next) = found else { return Chosen::Lost };
        *y = next;
    }
    Chosen::Lost
}

/// Leaves the sliders of bodies that contacts alone hold where they are: at most a little away from limits
/// that they touch, where rounding decides whether they slip for an instant.
fn leave(
    shooting: &mut Shooting<'_>,
    assumption: Assumption<'_>,
    y: &mut Vec<f64>,
    settings: NewtonSettings,
    iterations: &mut usize,
) -> Chosen {
    let kept = kept(shooting, assumption, y).unwrap_or_default();
    if !kept.iter().any(Kept::touches) {
        return Chosen::Inside;
    }
    let mut clear = inwards(shooting, y, &kept);
    let report = newton(shooting, &mut clear, settings);
    *iterations += report.iterations;
    if report.outcome == Outcome::Converged {
        *y = clear;
    }
    Chosen::Touching
}

/// The orbit with the sliders that touch their limit moved by a little to the side on which nothing slips.
fn inwards(shooting: &Shooting<'_>, y: &[f64], kept: &[Kept]) -> Vec<f64> {
    let mut inside = y.to_vec();
    for one in kept.iter().filter(|one| one.touches()) {
        let by = (DIFFERENCE * one.scale).min(one.inwards().abs()).copysign(one.inwards());
        if let Some(strain) = strain(shooting, one.point) {
            inside[strain] -= by / one.root;
        }
    }
    inside
}

/// The coordinate of an orbit that is the strain of a contact.
fn strain(shooting: &Shooting<'_>, point: usize) -> Option<usize> {
    let system = shooting.coordinates.system();
    let first = shooting.coordinates.size() - system.strains();
    let mut bodies = system.bodies().iter();
    bodies.find_map(|body| {
        let direction = body.remembered.iter().position(|own| *own == point)?;
        Some(first + body.strains.start + direction)
    })
}

/// Change of the orbit that leads the sliders to the assumed positions, to first order: to those that come of it, or
/// to those of now if the sliders follow.
fn step(
    shooting: &mut Shooting<'_>,
    assumption: Assumption<'_>,
    y: &[f64],
    kept: &[Kept],
    follows: bool,
) -> Option<Vec<f64>> {
    let (size, count) = (y.len(), kept.len());
    let moved = responses(shooting, y, kept)?;
    let mut change = Mat::from_fn(count, 1, |i, _| kept[i].miss());
    if !follows {
        answers(shooting, assumption, y, kept, &moved)?
            .partial_piv_lu()
            .solve_in_place(&mut change);
    }
    let step: Vec<f64> =
        (0..size).map(|i| (0..count).map(|j| change[(j, 0)] * moved[(i, j)]).sum()).collect();
    (norm(&step).is_finite()).then_some(step)
}

/// By how much each slider comes nearer to the assumed position, which moves with the orbit, by how much each is
/// moved; columns are those that are moved.
fn answers(
    shooting: &mut Shooting<'_>,
    assumption: Assumption<'_>,
    y: &[f64],
    kept: &[Kept],
    moved: &Mat<f64>,
) -> Option<Mat<f64>> {
    let count = kept.len();
    // Differences are taken where nothing slips: away from the limits that are touched.
    let inside = beside(y, kept, moved);
    let here = self::kept(shooting, assumption, &inside)?;
    let target = |of: &[Kept], point: usize| {
        of.iter().find(|one| one.point == point).map_or(f64::NAN, Kept::target)
    };
    let mut matrix = Mat::<f64>::identity(count, count);
    for (j, one) in kept.iter().enumerate() {
        let by = one.little();
        let aside: Vec<f64> =
            inside.iter().enumerate().map(|(i, y)| y + by * moved[(i, j)]).collect();
        let aside = self::kept(shooting, assumption, &aside)?;
        for (i, own) in kept.iter().enumerate() {
            let slope = (target(&aside, own.point) - target(&here, own.point)) / by;
            // One that leaves no choice there answers to nothing.
            matrix[(i, j)] -= if slope.is_finite() { slope } else { 0.0 };
        }
    }
    Some(matrix)
}

/// Derivative of the closed orbit in the positions of the sliders, column by column.
fn responses(shooting: &mut Shooting<'_>, y: &[f64], kept: &[Kept]) -> Option<Mat<f64>> {
    let mut inside = inwards(shooting, y, kept);
    let mut moved = derivative(shooting, &inside, kept)?;
    // A slider moved by itself sets the body going, and may come to its limit again: the orbit goes with it.
    for _ in 0..LOOKS {
        if !kept.iter().any(|one| shooting.slipped()[one.point]) {
            break;
        }
        inside = beside(y, kept, &moved);
        moved = derivative(shooting, &inside, kept)?;
    }
    Some(moved)
}

/// The orbit whose sliders that touch their limit are a little inside, to first order.
fn beside(y: &[f64], kept: &[Kept], moved: &Mat<f64>) -> Vec<f64> {
    let mut inside = y.to_vec();
    for (j, one) in kept.iter().enumerate().filter(|(_, one)| one.touches()) {
        let by = one.little();
        inside.iter_mut().enumerate().for_each(|(i, y)| *y += by * moved[(i, j)]);
    }
    inside
}

/// [`responses`] with the transition matrix at a state.
fn derivative(shooting: &mut Shooting<'_>, y: &[f64], kept: &[Kept]) -> Option<Mat<f64>> {
    let size = y.len();
    shooting.image(y)?;
    let mut matrix = shooting.derivative();
    (0..size).for_each(|i| matrix[(i, i)] -= 1.0);
    let mut slipped = shooting.slipped().to_vec();
    kept.iter().for_each(|one| slipped[one.point] = false);
    let coordinates = &shooting.coordinates;
    let mut right = Mat::zeros(size, kept.len());
    for (target, row) in coordinates.conserved(&slipped) {
        (0..size).for_each(|j| matrix[(target, j)] = row.get(j).copied().unwrap_or(0.0));
        for (column, one) in kept.iter().enumerate() {
            right[(target, column)] =
                if strain(shooting, one.point) == Some(target) { 1.0 / one.root } else { 0.0 };
        }
    }
    matrix.partial_piv_lu().solve_in_place(&mut right);
    Some(right)
}

/// The contacts that an orbit leaves a choice: never open, and never pushed from both sides. `None` if
/// the motion cannot be followed.
fn kept(shooting: &mut Shooting<'_>, assumption: Assumption<'_>, y: &[f64]) -> Option<Vec<Kept>> {
    let system = shooting.coordinates.system();
    let mut state = shooting.state(y);
    let displacement = system.contact_displacement(&state.displacement);
    let begun = state.force.clone();
    let position = |spring: f64, point: usize| spring * displacement[point] - begun[point];
    let moved = |point: usize| -> f64 {
        assumption.sliders.get(system.components()[point]).copied().unwrap_or(0.0)
    };
    let (mut found, mut shapes) = (Vec::new(), Vec::new());
    for body in system.bodies() {
        let [point] = body.remembered[..] else { continue };
        if body.elastic.rank() == 0 || system.limits()[point] == 0.0 {
            continue;
        }
        let root = body.elastic.root()[(point - body.points.start, 0)];
        let spring = root * root;
        let mut slope = system.limit_slope(point);
        slope.resize(system.modes(), 0.0);
        let pull: Vec<f64> = system.contact_shape(point).iter().map(|b| spring * b).collect();
        let wall = |sign: f64| pull.iter().zip(&slope).map(|(k, m)| k + sign * m).collect();
        shapes.extend([wall(0.0), wall(-1.0), wall(1.0), slope.clone()]);
        let rest = spring * (body.law.slider_at_rest()[0] + moved(point));
        found.push((point, root, position(spring, point), rest));
    }
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; shapes.len()];
    let mut extremes = Extremes::default();
    let mut planar = PlanarSliders::new(system, shooting.period);
    let followed = shooting.follow_period(&mut state, &mut |passage| {
        if let FlowEvent::Segment(segment) = &passage {
            extremes.follow(segment, &shapes, &mut ranges);
            planar.follow(segment);
        }
    });
    followed.then(|| {
        let all = found.into_iter().zip(ranges.chunks_exact(4));
        let kept = all.filter_map(|((point, root, position, rest), range)| {
            one(system, assumption.residual, (point, root, position, rest), range)
        });
        let in_planes =
            planar.held(assumption.residual, moved).into_iter().map(|(point, body, held)| {
                let direction = point - body.points.start;
                let root = body.elastic.root()[(direction, direction)];
                let (spring, rest) = (root * root, body.law.slider_at_rest()[direction]);
                let [low, wanted, high] =
                    [held.range[0], held.position, held.range[1]].map(|w| spring * (w + rest));
                Kept {
                    point,
                    root,
                    position: position(spring, point),
                    allowed: [low, high],
                    wanted,
                    scale: high - low + system.limit_at_rest(point).abs(),
                    pushed: held.pushed,
                }
            });
        kept.chain(in_planes).collect()
    })
}

/// A contact by the ranges of K, K − M, K + M and M, the last three without what M is at rest; nothing if
/// it leaves no choice.
fn one(
    system: &ModalSystem,
    residual: Residual,
    (point, root, position, rest): (usize, f64, f64, f64),
    range: &[[f64; 2]],
) -> Option<Kept> {
    let at_rest = system.limit_at_rest(point);
    let [pull, lower, upper, limit] = [0, 1, 2, 3].map(|i| range[i]);
    let allowed = [lower[1] - at_rest, upper[0] + at_rest];
    let [wanted] = residual.slider([0.5 * (pull[0] + pull[1])], [rest]);
    let scale = pull[1] - pull[0] + at_rest.abs() + limit[1] - limit[0];
    let closed = limit[0] + at_rest >= 0.0;
    // One that cannot slip at all is a spring.
    let chooses = closed && allowed[0] <= allowed[1] && scale > 0.0 && scale < f64::MAX;
    chooses.then_some(Kept { point, root, position, allowed, wanted, scale, pushed: false })
}
