//! The compliance of a structure whose damping `C + r C_neg` has a part of free size, negative as a
//! rule: the answer of the stuck structure to slip loads with its derivatives in ω and r.
//!
//! | damping and negative damping | form |
//! |---|---|
//! | both diagonal in the modes of the free structure | a sum over modes |
//! | any other; a travelling wave | one complex factorisation per harmonic |

use super::cyclic::CyclicStructure;
use super::modal::FREE_FLOOR;
use super::modes::{complex, hermitian_modes, real_modes, RealModes};
use super::Structure;
use crate::Error;
use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{c64, Mat, MatRef};

/// CompliancePartials of the contacts to slip loads at one harmonic: `U = G Q`.
#[derive(Debug, Clone)]
pub struct CompliancePartials {
    /// G, contacts × contacts [m/N].
    pub contact: Mat<c64>,
    /// dG/dω.
    pub by_omega: Mat<c64>,
    /// dG/dr.
    pub by_ratio: Mat<c64>,
}

/// An undamped mode of the stuck structure, scaled to unit modal mass.
#[derive(Debug, Clone)]
pub struct StuckMode {
    /// Natural frequency [rad/s].
    pub omega: f64,
    /// Displacements of the DOFs.
    pub shape: Vec<c64>,
    /// Displacements of the contacts.
    pub contact: Vec<c64>,
    /// Modal damping `φᴴ C φ` [1/s].
    pub damping: f64,
    /// Modal negative damping `φᴴ C_neg φ` [1/s].
    pub negative: f64,
}

/// Real modes of the free structure with their damping.
#[derive(Debug, Clone)]
struct Modes {
    omega_squared: Vec<f64>,
    damping: Vec<f64>,
    negative: Vec<f64>,
    shapes: Mat<f64>,
    /// B Φ.
    contacts: Mat<f64>,
}

/// Matrices that one harmonic sees.
#[derive(Debug, Clone)]
struct Matrices {
    mass: Mat<c64>,
    damping: Mat<c64>,
    negative: Mat<c64>,
    stiffness: Mat<c64>,
    rows: Mat<c64>,
}

#[derive(Debug, Clone)]
enum Form {
    Modes(Modes),
    Whole(Box<Matrices>),
    /// By nodal diameter, with the nodal diameter of the fundamental.
    Wave(Vec<Matrices>, usize),
}

/// A structure with its contacts and negative damping.
#[derive(Debug, Clone)]
pub struct FlutterCompliance {
    form: Form,
    whole: Matrices,
}

impl FlutterCompliance {
    /// Of a structure, the rows B of its contacts and its negative damping, N × N, made by a `law`
    /// that couples no modes without contacts, or any.
    ///
    /// # Errors
    /// A matrix of another shape or with entries that are not finite; an eigenvalue iteration
    /// that fails.
    pub fn new(
        structure: &Structure,
        rows: MatRef<'_, f64>,
        negative: MatRef<'_, f64>,
        law: bool,
    ) -> Result<Self, Error> {
        check(complex(negative).as_ref(), structure.dofs())?;
        let free = real_modes(structure.mass(), structure.stiffness())?;
        let whole = Matrices {
            mass: complex(structure.mass()),
            damping: complex(structure.damping()),
            negative: complex(negative),
            stiffness: complex(structure.stiffness()),
            rows: complex(rows),
        };
        let law = law && structure.is_proportional();
        let form = match Modes::new(&free, structure.damping(), negative, rows, law) {
            Some(modes) => Form::Modes(modes),
            None => Form::Whole(Box::new(whole.clone())),
        };
        Ok(Self { form, whole })
    }

    /// Of a sector in a travelling wave, with its rows on itself and on the next sector, and one
    /// complex matrix of negative damping per nodal diameter 0..n.
    ///
    /// # Errors
    /// Another number of matrices than sectors; as [`FlutterCompliance::new`].
    pub fn travelling(
        cyclic: &CyclicStructure,
        own: MatRef<'_, f64>,
        next: MatRef<'_, f64>,
        negative: &[Mat<c64>],
    ) -> Result<Self, Error> {
        if negative.len() != cyclic.sectors {
            let expected = format!("{} matrices, one per nodal diameter", cyclic.sectors);
            return Err(Error::shape("negative_damping", expected, negative.len()));
        }
        let mut waves = Vec::with_capacity(negative.len());
        for (diameter, negative) in negative.iter().enumerate() {
            check(negative.as_ref(), cyclic.dofs())?;
            let [mass, damping, stiffness] = cyclic.at_diameter(diameter);
            let rows = cyclic.rows_at(diameter, own, next);
            waves.push(Matrices { mass, damping, negative: negative.clone(), stiffness, rows });
        }
        let fundamental = cyclic.diameter(1);
        let whole = waves[fundamental].clone();
        Ok(Self { form: Form::Wave(waves, fundamental), whole })
    }

    /// Number of contact displacements.
    #[must_use]
    pub fn contacts(&self) -> usize {
        self.whole.rows.nrows()
    }

    /// Number of DOFs.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.whole.mass.nrows()
    }

    /// How the compliance is evaluated, in words.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match &self.form {
            Form::Modes(_) => "free modes",
            Form::Whole(_) => "direct",
            Form::Wave(..) => "waves",
        }
    }

    fn matrices(&self, order: usize) -> &Matrices {
        match &self.form {
            Form::Modes(_) => &self.whole,
            Form::Whole(matrices) => matrices,
            Form::Wave(waves, fundamental) => &waves[(order * fundamental) % waves.len()],
        }
    }

    /// The answer at a harmonic of a motion at `omega` [rad/s], with contacts of the stiffness D.
    #[must_use]
    pub fn answer(
        &self,
        order: usize,
        omega: f64,
        ratio: f64,
        stiffness: MatRef<'_, f64>,
    ) -> CompliancePartials {
        let stiffness = complex(stiffness);
        match &self.form {
            Form::Modes(modes) => modes.answer(order, omega, ratio, &stiffness),
            _ => self.matrices(order).answer(order, omega, ratio, &stiffness),
        }
    }

    /// Displacements of all DOFs at a harmonic, from the contact displacements and the slip loads.
    #[must_use]
    #[allow(clippy::too_many_arguments)]
    pub fn displacement(
        &self,
        order: usize,
        omega: f64,
        ratio: f64,
        stiffness: MatRef<'_, f64>,
        contact: &[c64],
        slip_load: &[c64],
    ) -> Vec<c64> {
        match &self.form {
            Form::Modes(modes) => {
                let force = |i: usize| -> c64 {
                    let stuck: c64 =
                        (0..contact.len()).map(|j| contact[j] * stiffness[(i, j)]).sum();
                    slip_load[i] - stuck
                };
                let forces: Vec<c64> = (0..contact.len()).map(force).collect();
                modes.displacement(order as f64 * omega, ratio, &forces)
            }
            _ => {
                let matrices = self.matrices(order);
                let load = Mat::from_fn(contact.len(), 1, |i, _| slip_load[i]);
                let lu = matrices.factor(order as f64 * omega, ratio, &complex(stiffness));
                let x = lu.solve(matrices.rows.adjoint() * load);
                (0..self.dofs()).map(|i| x[(i, 0)]).collect()
            }
        }
    }

    /// Modes of the stuck structure by rising frequency, with contacts of the stiffness D.
    ///
    /// # Errors
    /// Mass not positive definite, or the eigenvalue iteration fails.
    pub fn stuck_modes(&self, stiffness: MatRef<'_, f64>) -> Result<Vec<StuckMode>, Error> {
        let matrices = self.matrices(1);
        let restrained = matrices.restrained(&complex(stiffness));
        let modes = hermitian_modes(matrices.mass.as_ref(), restrained.as_ref())?;
        let [damping, negative] =
            [&matrices.damping, &matrices.negative].map(|c| modes.project(c.as_ref()));
        let contacts = &matrices.rows * &modes.shapes;
        Ok(modes
            .frequencies()
            .into_iter()
            .enumerate()
            .map(|(j, omega)| StuckMode {
                omega,
                shape: (0..self.dofs()).map(|i| modes.shapes[(i, j)]).collect(),
                contact: (0..self.contacts()).map(|i| contacts[(i, j)]).collect(),
                damping: damping[(j, j)].re,
                negative: negative[(j, j)].re,
            })
            .collect())
    }

    /// Modal dampings `(φᴴ C φ, φᴴ C_neg φ)` in the modes without contacts [1/s].
    ///
    /// # Errors
    /// As [`FlutterCompliance::stuck_modes`].
    pub fn free_modes(&self) -> Result<Vec<StuckMode>, Error> {
        self.stuck_modes(Mat::zeros(self.contacts(), self.contacts()).as_ref())
    }
}

impl Modes {
    /// The free modes in which both dampings are diagonal, if there are such.
    fn new(
        free: &RealModes,
        damping: MatRef<'_, f64>,
        negative: MatRef<'_, f64>,
        rows: MatRef<'_, f64>,
        law: bool,
    ) -> Option<Self> {
        // A sum of both is diagonal where both are, and only there if its factor is no special one.
        let [own, added] = [damping, negative].map(|c| free.damping(c));
        let largest = |c: Vec<f64>| c.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let ratio = largest(own.diagonal()) / largest(added.diagonal());
        let factor = if ratio > 0.0 && ratio.is_finite() { 0.618 * ratio } else { 1.0 };
        let (modes, _) = own.plus(factor, &added).separated(free.to_hermitian(), law)?;
        let size = modes.omega_squared.len();
        let shapes = Mat::from_fn(size, size, |i, j| modes.shapes[(i, j)].re);
        let modes = RealModes { omega_squared: modes.omega_squared, shapes };
        let [own, added] = [damping, negative].map(|c| modes.damping(c));
        (law || own.is_diagonal() && added.is_diagonal()).then(|| Self {
            damping: own.diagonal(),
            negative: added.diagonal(),
            contacts: rows * &modes.shapes,
            omega_squared: modes.omega_squared,
            shapes: modes.shapes,
        })
    }

    /// Weight of a mode with its derivatives in its frequency and in r.
    fn weight(&self, j: usize, omega: f64, ratio: f64) -> [c64; 3] {
        let squared = omega * omega;
        let damping = self.damping[j] + ratio * self.negative[j];
        let mut denominator = c64::new(self.omega_squared[j] - squared, omega * damping);
        // As in `Spectrum::weight`: a free mode met exactly is no resonance of the stuck structure.
        if denominator.norm() < FREE_FLOOR * squared {
            denominator = c64::new(0.0, FREE_FLOOR * squared);
        }
        let weight = denominator.inv();
        let by_omega = weight * weight * c64::new(2.0 * omega, -damping);
        let by_ratio = weight * weight * c64::new(0.0, -omega * self.negative[j]);
        [weight, by_omega, by_ratio]
    }

    fn answer(
        &self,
        order: usize,
        omega: f64,
        ratio: f64,
        stiffness: &Mat<c64>,
    ) -> CompliancePartials {
        let contacts = self.contacts.nrows();
        let order = order as f64;
        let mut sums = [(); 3].map(|()| Mat::<c64>::zeros(contacts, contacts));
        for j in 0..self.omega_squared.len() {
            let weights = self.weight(j, order * omega, ratio);
            for column in 0..contacts {
                let left = self.contacts[(column, j)];
                if left == 0.0 {
                    continue;
                }
                for row in 0..contacts {
                    let product = self.contacts[(row, j)] * left;
                    for (sum, weight) in sums.iter_mut().zip(weights) {
                        sum[(row, column)] += weight * product;
                    }
                }
            }
        }
        let [free, by_omega, by_ratio] = sums;
        // G = (I + G_free D)⁻¹ G_free and dG = (I + G_free D)⁻¹ dG_free (I − D G).
        let coupling = Mat::<c64>::identity(contacts, contacts) + &free * stiffness;
        let lu = coupling.partial_piv_lu();
        let contact = lu.solve(&free);
        let kept = Mat::<c64>::identity(contacts, contacts) - stiffness * &contact;
        let by_omega = lu.solve(faer::Scale(c64::new(order, 0.0)) * &by_omega * &kept);
        let by_ratio = lu.solve(&by_ratio * &kept);
        CompliancePartials { contact, by_omega, by_ratio }
    }

    fn displacement(&self, omega: f64, ratio: f64, forces: &[c64]) -> Vec<c64> {
        let coordinate = |j: usize| -> c64 {
            let load: c64 = forces.iter().enumerate().map(|(i, f)| f * self.contacts[(i, j)]).sum();
            self.weight(j, omega, ratio)[0] * load
        };
        let modal: Vec<c64> = (0..self.omega_squared.len()).map(coordinate).collect();
        (0..self.shapes.nrows())
            .map(|dof| modal.iter().enumerate().map(|(j, c)| c * self.shapes[(dof, j)]).sum())
            .collect()
    }
}

impl Matrices {
    /// `K + Bᴴ D B`.
    fn restrained(&self, stiffness: &Mat<c64>) -> Mat<c64> {
        &self.stiffness + self.rows.adjoint() * (stiffness * &self.rows)
    }

    fn factor(&self, omega: f64, ratio: f64, stiffness: &Mat<c64>) -> PartialPivLu<c64> {
        let restrained = self.restrained(stiffness);
        let size = self.mass.nrows();
        let dynamic = Mat::from_fn(size, size, |i, j| {
            restrained[(i, j)] - omega * omega * self.mass[(i, j)]
                + c64::new(0.0, omega) * (self.damping[(i, j)] + ratio * self.negative[(i, j)])
        });
        dynamic.partial_piv_lu()
    }

    fn answer(
        &self,
        order: usize,
        omega: f64,
        ratio: f64,
        stiffness: &Mat<c64>,
    ) -> CompliancePartials {
        let (order, size) = (order as f64, self.mass.nrows());
        let frequency = order * omega;
        let lu = self.factor(frequency, ratio, stiffness);
        let of_contacts = lu.solve(self.rows.adjoint().to_owned());
        // dG = −B A⁻¹ dA A⁻¹ Bᴴ
        let softening = Mat::from_fn(size, size, |i, j| {
            2.0 * order * frequency * self.mass[(i, j)]
                - c64::new(0.0, order) * (self.damping[(i, j)] + ratio * self.negative[(i, j)])
        });
        let driving = faer::Scale(c64::new(0.0, -frequency)) * &self.negative;
        CompliancePartials {
            contact: &self.rows * &of_contacts,
            by_omega: &self.rows * lu.solve(softening * &of_contacts),
            by_ratio: &self.rows * lu.solve(driving * &of_contacts),
        }
    }
}

fn check(negative: MatRef<'_, c64>, size: usize) -> Result<(), Error> {
    if (negative.nrows(), negative.ncols()) != (size, size) {
        return Err(Error::shape(
            "negative_damping",
            format!("{size} x {size}"),
            format!("{} x {}", negative.nrows(), negative.ncols()),
        ));
    }
    for j in 0..size {
        for i in 0..size {
            let entry = negative[(i, j)];
            if !(entry.re.is_finite() && entry.im.is_finite()) {
                let at = format!("negative_damping[{i}, {j}]");
                return Err(Error::value(at, entry.re, "every entry must be finite"));
            }
        }
    }
    Ok(())
}
