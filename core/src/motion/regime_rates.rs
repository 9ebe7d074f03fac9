//! The equations of disturbances in one regime, `y' = A y` in the coordinates of [`Transition`], and power series of
//! their solutions: products of A with a vector are those of modes and contacts.

use super::contact_state::{ContactState, Springs};
use super::damping::Damping;
use super::modal_system::ModalSystem;
use super::projection::Projection;
use super::transition::Transition;
use crate::solve::dot;
use faer::Mat;

/// Term of a power series that is none, relative to the largest, and most terms: over the longest series fewer do.
const ROUNDING: f64 = 1e-18;
const TERMS: usize = 60;
/// Most length of a series, in units of the fastest rate.
const LENGTH: f64 = 8.0;

/// The equations of a regime in the coordinates of disturbances.
pub(super) struct Rates<'a> {
    pub(super) of: &'a Transition<'a>,
    pub(super) springs: Springs,
    /// What strains do to accelerations: strain, point, factor.
    roots: &'a [(usize, usize, f64)],
}

impl Transition<'_> {
    /// `g = Σ root f` of all strains.
    pub(super) fn roots(&self) -> Vec<(usize, usize, f64)> {
        let mut roots = Vec::new();
        for body in self.system.bodies() {
            for (own, strain) in body.strains.clone().enumerate() {
                let points = body.points.clone().enumerate();
                let parts = points.map(|(row, i)| (strain, i, body.elastic.root()[(row, own)]));
                roots.extend(parts.filter(|(_, _, root)| *root != 0.0));
            }
        }
        roots
    }

    pub(super) fn rates<'a>(
        &'a self,
        regime: &ContactState,
        roots: &'a [(usize, usize, f64)],
    ) -> Rates<'a> {
        Rates { of: self, springs: self.springs(regime), roots }
    }

    /// Number of power series one after the other over a duration: the rounding of each grows with its exponential.
    pub(super) fn steps(&self, duration: f64) -> usize {
        (duration.abs() * self.system.rate(0.0) / LENGTH).ceil().max(1.0) as usize
    }

    /// The contacts in a regime.
    pub(super) fn springs(&self, regime: &ContactState) -> Springs {
        let slope = |&i: &usize| (i, regime.tangent[(i, i)]);
        let pressing = self.system.normals.iter().map(slope).filter(|(_, slope)| *slope != 0.0);
        Springs { moves: self.strain_rates(regime), pressing: pressing.collect() }
    }
}

impl Rates<'_> {
    /// Writes `Σ (A t)ⁿ y / n!` at some times t as columns from a place on, or of the transposed matrix; terms of an
    /// error, relative to the largest, are none.
    pub(super) fn write_series(
        &self,
        start: Vec<f64>,
        times: &[f64],
        across: bool,
        (out, place): (&mut Mat<f64>, usize),
        error: f64,
    ) {
        pulp::Arch::new().dispatch(Series { rates: self, start, times, across, out, place, error });
    }

    /// Adds to a difference what the motion `y` changes by over a duration, by itself or under loads of a frequency
    /// from a time on; terms as small as `nothing` are none.
    pub(super) fn go_on(
        &self,
        y: Vec<f64>,
        loads: Option<[f64; 2]>,
        duration: f64,
        difference: &mut [f64],
        nothing: f64,
    ) {
        let loads = loads.map(|at| Loads::new(self.of.system, at)).unwrap_or_default();
        let way = Way { rates: self, y, loads, duration, terms: TERMS, nothing, difference };
        pulp::Arch::new().dispatch(way);
    }

    /// `y'` under loads of a frequency at a time.
    pub(super) fn rate(&self, y: Vec<f64>, at: [f64; 2]) -> Vec<f64> {
        let (loads, mut rate) = (Loads::new(self.of.system, at), vec![0.0; y.len()]);
        let difference = &mut rate;
        pulp::Arch::new().dispatch(Way {
            rates: self,
            y,
            loads,
            duration: 1.0,
            terms: 1,
            nothing: 0.0,
            difference,
        });
        rate
    }

    /// `factor A y`.
    #[inline(always)]
    fn apply(&self, y: &[f64], factor: f64, out: &mut [f64], room: &mut Room) {
        let (system, weight) = (self.of.system, &self.of.weight);
        let modes = weight.len();
        let ((x, rest), (to_x, to_rest)) = (y.split_at(modes), out.split_at_mut(modes));
        let ((v, g), (to_v, to_g)) = (rest.split_at(modes), to_rest.split_at_mut(modes));
        let squares = system.omega_squared();
        for (((to_x, to_v), (x, v)), (w, square)) in
            to_x.iter_mut().zip(&mut *to_v).zip(x.iter().zip(v)).zip(weight.iter().zip(squares))
        {
            (*to_x, *to_v) = (factor * w * v, -factor * square / w * x);
        }
        damp(&system.damping, v, -factor, to_v, false);
        room.force.clear();
        room.force.resize(system.points(), 0.0);
        for &(strain, point, root) in self.roots {
            room.force[point] -= factor * root * g[strain];
        }
        for &(point, slope) in &self.springs.pressing {
            let parts = system.contact_shape(point).iter().zip(weight).zip(x);
            let displaced: f64 = parts.map(|((b, w), x)| b / w * x).sum();
            room.force[point] -= factor * slope * displaced;
        }
        room.press(&system.projection, to_v);
        to_g.fill(0.0);
        system.projection.displacement(v, &mut room.speed);
        for &(strain, point, rate) in &self.springs.moves {
            to_g[strain] += factor * rate * room.speed[0][point];
        }
    }

    /// `factor Aᵀ y`.
    #[inline(always)]
    fn apply_across(&self, y: &[f64], factor: f64, out: &mut [f64], room: &mut Room) {
        let (system, weight) = (self.of.system, &self.of.weight);
        let modes = weight.len();
        let ((x, rest), (to_x, to_rest)) = (y.split_at(modes), out.split_at_mut(modes));
        let ((v, g), (to_v, to_g)) = (rest.split_at(modes), to_rest.split_at_mut(modes));
        let squares = system.omega_squared();
        for (((to_x, to_v), (x, v)), (w, square)) in
            to_x.iter_mut().zip(&mut *to_v).zip(x.iter().zip(v)).zip(weight.iter().zip(squares))
        {
            (*to_x, *to_v) = (-factor * square / w * v, factor * w * x);
        }
        damp(&system.damping, v, -factor, to_v, true);
        room.force.clear();
        room.force.resize(system.points(), 0.0);
        for &(strain, point, rate) in &self.springs.moves {
            room.force[point] += factor * rate * g[strain];
        }
        room.press(&system.projection, to_v);
        system.projection.displacement(v, &mut room.speed);
        for &(point, slope) in &self.springs.pressing {
            let by = -factor * slope * room.speed[0][point];
            let parts = to_x.iter_mut().zip(system.contact_shape(point).iter().zip(weight));
            parts.for_each(|(to, (b, w))| *to += by * b / w);
        }
        to_g.fill(0.0);
        for &(strain, point, root) in self.roots {
            to_g[strain] -= factor * root * room.speed[0][point];
        }
    }
}

/// Room for what forces do to modes, and modes to points.
#[derive(Default)]
struct Room {
    force: Vec<f64>,
    acting: Vec<(usize, [f64; 1])>,
    modal: [Vec<f64>; 1],
    speed: [Vec<f64>; 1],
}

impl Room {
    /// Adds the modal forces of the forces at the points.
    fn press(&mut self, projection: &Projection, out: &mut [f64]) {
        let acting = self.force.iter().map(|force| [*force]).enumerate();
        self.acting.clear();
        self.acting.extend(acting.filter(|(_, force)| force[0] != 0.0));
        projection.modal_forces(&self.acting, &mut self.modal);
        out.iter_mut().zip(&self.modal[0]).for_each(|(out, force)| *out += force);
    }
}

/// Adds `factor C v`, or of the transposed matrix.
#[inline(always)]
fn damp(damping: &Damping, v: &[f64], factor: f64, out: &mut [f64], across: bool) {
    match damping {
        Damping::Diagonal(own) => {
            let parts = out.iter_mut().zip(own).zip(v);
            parts.for_each(|((out, c), v)| *out += factor * c * v);
        }
        Damping::Full(own) if across => {
            let columns = out.iter_mut().enumerate();
            columns.for_each(|(j, out)| *out += factor * dot(own.col_as_slice(j), v));
        }
        Damping::Full(own) => {
            let columns = v.iter().enumerate();
            columns.for_each(|(j, v)| add(out, factor * v, own.col_as_slice(j)));
        }
    }
}

#[inline(always)]
fn add(out: &mut [f64], factor: f64, row: &[f64]) {
    out.iter_mut().zip(row).for_each(|(out, row)| *out += factor * row);
}

/// A power series at some times. A closure would be no part of what vector instructions are chosen for.
struct Series<'a> {
    rates: &'a Rates<'a>,
    start: Vec<f64>,
    times: &'a [f64],
    across: bool,
    out: &'a mut Mat<f64>,
    place: usize,
    error: f64,
}

impl pulp::NullaryFnOnce for Series<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { rates, start: mut begin, times, across, out, place, error } = self;
        let longest =
            times.iter().fold(0.0_f64, |most, t| if t.abs() > most.abs() { *t } else { most });
        let steps = rates.of.steps(longest);
        let step = longest / steps as f64;
        let step_of = |t: f64| ((t / step) as usize).min(steps - 1);
        let [mut next, mut end] = [(); 2].map(|()| vec![0.0; begin.len()]);
        let (mut shares, mut room) = (Vec::new(), Room::default());
        for number in 0..steps {
            shares.clear();
            let own = times.iter().enumerate().filter(|(_, t)| step_of(**t) == number);
            shares.extend(own.map(|(k, t)| (k, t / step - number as f64, 1.0)));
            let goes_on = number + 1 < steps;
            end.fill(0.0);
            let (term, mut most) = (&mut begin, 0.0_f64);
            for order in 1..TERMS {
                let size = dot(term, term).sqrt();
                most = most.max(size);
                if size <= error * most {
                    break;
                }
                for (k, share, power) in &mut shares {
                    add(out.col_as_slice_mut(place + *k), *power, term);
                    *power *= *share;
                }
                if goes_on {
                    add(&mut end, 1.0, term);
                }
                let factor = step / order as f64;
                if across {
                    rates.apply_across(term, factor, &mut next, &mut room);
                } else {
                    rates.apply(term, factor, &mut next, &mut room);
                }
                std::mem::swap(term, &mut next);
            }
            std::mem::swap(&mut begin, &mut end);
        }
    }
}

/// Waves of the loads: of each its angular frequency, and a term of the power series of `exp(ik ω t)`.
#[derive(Default)]
struct Loads(Vec<(f64, [f64; 2])>);

impl Loads {
    fn new(system: &ModalSystem, [omega, time]: [f64; 2]) -> Self {
        let wave = |order: usize| {
            let (sin, cos) = (order as f64 * omega * time).sin_cos();
            (order as f64 * omega, [cos, sin])
        };
        Self(system.loads.iter().map(|(order, _)| wave(*order)).collect())
    }

    /// Adds a multiple of the terms to the accelerations among rates.
    #[inline(always)]
    fn add(&self, system: &ModalSystem, factor: f64, rates: &mut [f64]) {
        for ((_, load), (_, [re, im])) in system.loads.iter().zip(&self.0) {
            let accelerations = rates[system.modes()..].iter_mut().zip(load);
            accelerations.for_each(|(a, p)| *a += factor * (p.re * re - p.im * im));
        }
    }

    /// Goes on to the next terms over a duration per order.
    #[inline(always)]
    fn advance(&mut self, factor: f64) {
        for (frequency, [re, im]) in &mut self.0 {
            let step = *frequency * factor;
            (*re, *im) = (-step * *im, step * *re);
        }
    }
}

/// The change of a motion by a power series. A closure would be no part of what vector instructions are chosen for.
struct Way<'a> {
    rates: &'a Rates<'a>,
    y: Vec<f64>,
    loads: Loads,
    duration: f64,
    /// Most terms behind the first one.
    terms: usize,
    nothing: f64,
    difference: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Way<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { rates, y: mut term, mut loads, duration, terms, nothing, difference } = self;
        let (mut next, mut room) = (vec![0.0; term.len()], Room::default());
        let mut most = dot(&term, &term).sqrt();
        for order in 1..=terms {
            let factor = duration / order as f64;
            rates.apply(&term, factor, &mut next, &mut room);
            loads.add(rates.of.system, factor, &mut next);
            loads.advance(factor);
            std::mem::swap(&mut term, &mut next);
            add(difference, 1.0, &term);
            let size = dot(&term, &term).sqrt();
            most = most.max(size);
            if size <= nothing.max(ROUNDING * most) {
                break;
            }
        }
    }
}
