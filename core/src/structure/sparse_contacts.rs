//! The contacts of a structure whose matrices hold few numbers, such as a chain: what slip loads displace
//! follows from one sparse factorisation per harmonic and frequency, in time that grows as the
//! structure does. No mode is known, and none is needed.

use super::contact_coordinates::ContactCoordinates;
use super::contact_shapes::{ContactShapes, SparseRows};
use super::flexibility::RIGID_BODY;
use super::matrix::Sparse;
use super::modal_orders::{Inverse, ModalOrders, Order};
use super::modes::resonates;
use super::ports::{HarmonicLoad, Ports};
use super::sparse_matrices::{at, fill, pattern};
use super::sparse_spectrum::squared_between;
use super::Structure;
use crate::Error;
use faer::linalg::solvers::Solve as _;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::SparseColMat;
use faer::{c64, Mat, MatRef};

/// Contacts from which on a structure is seen in this way.
const FEWEST: usize = 128;
/// Numbers in a factor, over contacts times DOFs, up to which solutions are less work than products
/// with the modes: they go through the processor one by one.
const WORTH: f64 = 1.0 / 32.0;
/// Steps that find the lowest mode.
const STEPS: usize = 40;
/// Change of its squared frequency that ends them.
const SETTLED: f64 = 1e-10;
/// Steps that find a mode that resonates within rounding.
const NEAR: usize = 2;

/// The matrices of the stuck structure by their numbers, at common places.
#[derive(Debug)]
pub(super) struct SparseContacts {
    rows: SparseRows,
    places: Vec<(usize, usize)>,
    mass: Sparse,
    damping: Sparse,
    stiffness: Sparse,
    /// Stiffness without contacts.
    free: Sparse,
    factors: SymbolicLu<usize>,
    /// Numbers in a factor.
    fill: usize,
    loads: Vec<HarmonicLoad>,
    /// Of the stuck mode of the lowest frequency, squared, and its damping over its mass.
    lowest: [f64; 2],
    /// Lowest squared frequency without contacts.
    lowest_free: f64,
    /// Highest squared frequency, or about it.
    highest: f64,
}

impl SparseContacts {
    /// Of a damped structure with many contacts and few numbers; nothing for others.
    pub(super) fn new(structure: &Structure, ports: &Ports) -> Option<Self> {
        let contacts = ports.rows.nrows();
        let [mass, damping, free] = structure.matrices();
        let damped = damping.entries().any(|(_, _, c)| c != 0.0);
        if contacts < FEWEST || !damped || !structure.massless().is_empty() {
            return None;
        }
        let restrained = structure.restrained_few(&ports.rows, &ports.stiffness)?;
        let places = pattern(&[mass, damping, &restrained])?;
        let [mass, damping, stiffness] =
            [mass, damping, &restrained].map(|matrix| at(&places, matrix));
        let (mass, damping, stiffness) = (mass?, damping?, stiffness?);
        let fill = fill(&stiffness)?;
        if fill as f64 > WORTH * contacts as f64 * structure.dofs() as f64 {
            return None;
        }
        let mut row_sums = vec![0.0; structure.dofs()];
        places.iter().zip(stiffness.val()).for_each(|(&(i, _), k)| row_sums[i] += k.abs());
        // No mode is faster than the row sums of stiffness over what the diagonal of the mass has beyond its row.
        let mut inertia = vec![0.0; structure.dofs()];
        for (&(i, j), m) in places.iter().zip(mass.val()) {
            inertia[i] += if i == j { *m } else { -m.abs() };
        }
        let highest = row_sums.iter().zip(&inertia).map(|(k, m)| k / m).fold(0.0, f64::max);
        if inertia.iter().any(|m| *m <= 0.0) {
            return None;
        }
        let factors = SymbolicLu::try_new(stiffness.symbolic()).ok()?;
        let mut own = Self {
            rows: SparseRows::of(&ports.rows),
            free: at(&places, free)?,
            loads: ports.loads.clone(),
            lowest: [0.0; 2],
            lowest_free: 0.0,
            places,
            mass,
            damping,
            stiffness,
            factors,
            fill,
            highest,
        };
        own.lowest = own.lowest_mode(&own.stiffness)?;
        if own.lowest[0] <= RIGID_BODY * own.highest {
            return None;
        }
        own.lowest_free = own.lowest_mode(&own.free).map_or(0.0, |[squared, _]| squared);
        Some(own)
    }

    /// Squared frequency and damping of the lowest mode with a stiffness; nothing where nothing holds it.
    fn lowest_mode(&self, stiffness: &Sparse) -> Option<[f64; 2]> {
        let factors = self.factored(stiffness, 0.0)?;
        let mut shape = self.any_shape();
        let mut squared = f64::MAX;
        for _ in 0..STEPS {
            let mut next = self.times(&self.mass, shape.as_ref());
            factors.solve_in_place(next.as_mut());
            let size = self.product(&self.mass, &next).sqrt();
            shape = faer::Scale(c64::new(1.0 / size, 0.0)) * next;
            let before = std::mem::replace(&mut squared, self.product(stiffness, &shape));
            if (squared - before).abs() <= SETTLED * squared.abs() {
                break;
            }
        }
        squared.is_finite().then(|| [squared, self.product(&self.damping, &shape)])
    }

    /// A shape that holds some of every mode.
    fn any_shape(&self) -> Mat<c64> {
        Mat::from_fn(self.rows.dofs, 1, |i, _| c64::new(1.0 + 0.5 * (i as f64).sin(), 0.0))
    }

    /// `A x` of the columns.
    fn times(&self, matrix: &Sparse, x: MatRef<'_, c64>) -> Mat<c64> {
        let mut out = Mat::zeros(x.nrows(), x.ncols());
        for column in 0..x.ncols() {
            for (&(i, j), value) in self.places.iter().zip(matrix.val()) {
                out[(i, column)] += *value * x[(j, column)];
            }
        }
        out
    }

    /// `xᵀ A x` of a real shape.
    fn product(&self, matrix: &Sparse, x: &Mat<c64>) -> f64 {
        let image = self.times(matrix, x.as_ref());
        (0..x.nrows()).map(|i| x[(i, 0)].re * image[(i, 0)].re).sum()
    }

    /// Factors `K + iωC − ω²M`.
    fn factored(&self, stiffness: &Sparse, rate: f64) -> Option<Lu<usize, c64>> {
        let parts = stiffness.val().iter().zip(self.damping.val()).zip(self.mass.val());
        let values = parts.map(|((k, c), m)| c64::new(k - rate * rate * m, rate * c)).collect();
        let symbolic = self.stiffness.symbolic().to_owned().ok()?;
        let dynamic = SparseColMat::new(symbolic, values);
        Lu::try_new_with_symbolic(self.factors.clone(), dynamic.as_ref()).ok()
    }

    /// The factors of a harmonic.
    ///
    /// # Errors
    /// Nothing damps the resonance met.
    pub(super) fn factors(&self, harmonic: usize, omega: f64) -> Result<Lu<usize, c64>, Error> {
        let rate = harmonic as f64 * omega;
        let singular = || {
            if harmonic == 0 {
                return Error::SingularStiffness { lowest: self.lowest[0].sqrt() };
            }
            Error::UndampedResonance { omega, harmonic, natural: rate }
        };
        let factors = self.factored(&self.stiffness, rate).ok_or_else(singular)?;
        if harmonic == 0 {
            return Ok(factors);
        }
        let mut shape = self.any_shape();
        let mut distance = f64::MAX;
        for _ in 0..NEAR {
            let mut next = self.times(&self.mass, shape.as_ref());
            factors.solve_in_place(next.as_mut());
            distance = shape.norm_l2() / next.norm_l2();
            shape = faer::Scale(c64::new(1.0 / next.norm_l2(), 0.0)) * next;
        }
        if resonates(distance, rate * rate, true) || !distance.is_finite() {
            return Err(singular());
        }
        Ok(factors)
    }

    /// `−dZ/dω y` of the columns.
    pub(super) fn softening(&self, harmonic: usize, omega: f64, y: MatRef<'_, c64>) -> Mat<c64> {
        let k = harmonic as f64;
        let inertia = faer::Scale(c64::new(2.0 * k * k * omega, 0.0)) * self.times(&self.mass, y);
        inertia - faer::Scale(c64::new(0.0, k)) * self.times(&self.damping, y)
    }

    /// Forces of a unit load on each contact, and the external load.
    pub(super) fn forces(&self, harmonic: usize) -> [Mat<c64>; 2] {
        let (dofs, contacts) = (self.rows.dofs, self.rows.entries.len());
        let mut unit = Mat::zeros(dofs, contacts);
        for (contact, row) in self.rows.entries.iter().enumerate() {
            row.iter().for_each(|&(dof, share)| unit[(dof, contact)] = c64::new(share, 0.0));
        }
        let load = self.load(harmonic);
        [unit, Mat::from_fn(dofs, 1, |i, _| load.map_or(c64::new(0.0, 0.0), |load| load[i]))]
    }

    /// Amplitudes of the contacts from those of the DOFs.
    pub(super) fn at_contacts(&self, motion: &Mat<c64>) -> Mat<c64> {
        Mat::from_fn(self.rows.entries.len(), motion.ncols(), |i, j| {
            self.rows.entries[i].iter().map(|&(dof, share)| motion[(dof, j)] * share).sum()
        })
    }

    fn load(&self, harmonic: usize) -> Option<&[c64]> {
        let own = self.loads.iter().find(|load| load.harmonic == harmonic);
        own.map(|load| load.amplitude.as_slice())
    }

    /// Half-power bandwidth of the lowest mode [rad/s].
    pub(super) fn bandwidth(&self) -> f64 {
        self.lowest[1]
    }

    /// Highest natural frequency, or about it [rad/s].
    pub(super) fn highest(&self) -> f64 {
        self.highest.sqrt()
    }

    /// Lowest natural frequencies of the stuck structure and of that without contacts [rad/s].
    pub(super) fn lowest(&self) -> [f64; 2] {
        [self.lowest[0], self.lowest_free].map(|squared| squared.max(0.0).sqrt())
    }

    /// Natural frequencies in a band, all contacts stuck or none there [rad/s].
    pub(super) fn between(&self, stuck: bool, band: [f64; 2]) -> Option<Vec<f64>> {
        let stiffness = if stuck { &self.stiffness } else { &self.free };
        let squared = squared_between(&self.mass, stiffness, band.map(|w| w * w))?;
        Some(squared.into_iter().map(f64::sqrt).collect())
    }

    /// Mass and stiffness, all contacts stuck or none there.
    pub(super) fn dense(&self, stuck: bool) -> [Mat<f64>; 2] {
        [&self.mass, if stuck { &self.stiffness } else { &self.free }]
            .map(|matrix| matrix.to_dense())
    }

    /// Number of DOFs.
    pub(super) fn dofs(&self) -> usize {
        self.rows.dofs
    }
}

impl ContactCoordinates for SparseContacts {
    fn size(&self) -> usize {
        self.rows.dofs
    }

    fn contacts(&self) -> usize {
        self.rows.entries.len()
    }

    fn work(&self, _contacts: f64, slots: f64) -> f64 {
        // Two factors of complex numbers for two slots, number by number.
        slots * self.fill as f64 / (2.0 * WORTH)
    }

    fn effort(&self) -> f64 {
        200.0 * self.fill as f64
    }

    fn excite(&self, load: MatRef<'_, f64>) -> Mat<f64> {
        self.rows.excite(load)
    }

    fn displace(&self, coordinates: MatRef<'_, f64>) -> Mat<f64> {
        self.rows.displace(coordinates)
    }

    fn part(&self, contacts: &[usize]) -> ContactShapes {
        ContactShapes::Few(self.rows.part(contacts))
    }

    fn add_load(&self, at: &ModalOrders, forces: &mut Mat<f64>) {
        at.add(|harmonic| self.load(harmonic), forces);
    }

    fn orders(
        &self,
        harmonics: &[(usize, usize)],
        omega: f64,
    ) -> Result<ModalOrders, (usize, Error)> {
        let order = |&(harmonic, slot): &(usize, usize)| {
            let factors = self.factors(harmonic, omega).map_err(|error| (harmonic, error))?;
            let rate = harmonic as f64 * omega;
            Ok(Order { harmonic, slot, rate, inverse: Inverse::Factors(Box::new(factors)) })
        };
        Ok(ModalOrders { orders: harmonics.iter().map(order).collect::<Result<_, _>>()? })
    }

    fn answer(&self, at: &ModalOrders, forces: &mut Mat<f64>, _tolerance: f64) {
        at.divide(forces);
    }

    fn answer_rate(&self, at: &ModalOrders, coordinates: &mut Mat<f64>, _tolerance: f64) {
        for Order { harmonic, slot, rate, .. } in &at.orders {
            if *harmonic == 0 {
                (0..coordinates.ncols()).for_each(|j| coordinates[(*slot, j)] = 0.0);
                continue;
            }
            let y = Mat::from_fn(coordinates.ncols(), 1, |j, _| {
                c64::new(coordinates[(*slot, j)], -coordinates[(slot + 1, j)])
            });
            let change = self.softening(*harmonic, rate / *harmonic as f64, y.as_ref());
            for (j, change) in change.col_as_slice(0).iter().enumerate() {
                (coordinates[(*slot, j)], coordinates[(slot + 1, j)]) = (change.re, -change.im);
            }
        }
        at.divide(coordinates);
    }

    fn observe(
        &self,
        harmonic: usize,
        slot: usize,
        coordinates: &Mat<f64>,
        observe: &[usize],
        out: &mut [c64],
    ) {
        for (x, &dof) in out.iter_mut().zip(observe) {
            let sine = if harmonic == 0 { 0.0 } else { coordinates[(slot + 1, dof)] };
            *x = c64::new(coordinates[(slot, dof)], -sine);
        }
    }
}
