//! The compliance of a structure whose damping `C + r C_neg` has a part of free size, negative as a
//! rule: the answer of the stuck structure to slip loads with its derivatives in ω and r.
//!
//! | damping and negative damping | form |
//! |---|---|
//! | both diagonal in the modes of the free structure | a sum over modes |
//! | any other; motions with a mean; a travelling wave | one complex factorisation per harmonic |

use super::cyclic::CyclicStructure;
use super::modes::{complex, modes, RealModes};
use super::{
    Compliance, DirectCompliance, HarmonicLoad, ModalCompliance, Outline, Receptance, Request,
    Structure,
};
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::sync::{Arc, OnceLock};

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
    Modes(Box<ModalCompliance>),
    Whole,
    /// By nodal diameter, with the nodal diameter of the fundamental.
    Wave(Vec<Arc<Matrices>>, usize),
}

/// A structure with its contacts and negative damping.
#[derive(Debug, Clone)]
pub struct FlutterCompliance {
    form: Form,
    whole: Arc<Matrices>,
    /// Static loads that stay; none at first.
    loads: Vec<HarmonicLoad>,
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
        let free = modes(structure.mass(), structure.stiffness())?;
        let whole = Arc::new(Matrices {
            mass: complex(structure.mass()),
            damping: complex(structure.damping()),
            negative: complex(negative),
            stiffness: complex(structure.stiffness()),
            rows: complex(rows),
        });
        let law = law && structure.is_proportional();
        let form = separate(&free, structure.damping(), negative, rows, law)
            .map_or(Form::Whole, |modes| Form::Modes(Box::new(modes)));
        Ok(Self { form, whole, loads: Vec::new() })
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
            let negative = negative.clone();
            waves.push(Arc::new(Matrices { mass, damping, negative, stiffness, rows }));
        }
        let fundamental = cyclic.diameter(1);
        let whole = Arc::clone(&waves[fundamental]);
        Ok(Self { form: Form::Wave(waves, fundamental), whole, loads: Vec::new() })
    }

    /// The same for motions with a mean, which free modes do not give, under loads; of a travelling wave
    /// those on sector 0.
    #[must_use]
    pub fn with_means(mut self, loads: Vec<HarmonicLoad>) -> Self {
        if matches!(self.form, Form::Modes(_)) {
            self.form = Form::Whole;
        }
        self.loads = loads;
        self
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
            Form::Whole => "direct",
            Form::Wave(..) => "waves",
        }
    }

    fn matrices(&self, order: usize) -> &Matrices {
        match &self.form {
            Form::Modes(_) | Form::Whole => &self.whole,
            Form::Wave(waves, fundamental) => &waves[(order * fundamental) % waves.len()],
        }
    }

    /// The compliance at a ratio r, with contacts of the stiffness D; its receptances have derivatives
    /// in r.
    #[must_use]
    pub fn at(&self, ratio: f64, stiffness: Mat<f64>) -> Arc<dyn Compliance> {
        match &self.form {
            Form::Modes(modes) => Arc::new(modes.at_ratio(ratio, stiffness)),
            Form::Whole => {
                let loads = self.loads.clone();
                Arc::new(self.whole.at_ratio(ratio, &complex(stiffness.as_ref()), loads))
            }
            Form::Wave(waves, fundamental) => Arc::new(FlutterWaves {
                waves: waves.iter().map(|wave| (Arc::clone(wave), OnceLock::new())).collect(),
                fundamental: *fundamental,
                ratio,
                stiffness: complex(stiffness.as_ref()),
                loads: self.loads.clone(),
                outline: Outline::default(),
            }),
        }
    }

    /// Modes of the stuck structure by rising frequency, with contacts of the stiffness D.
    ///
    /// # Errors
    /// Mass not positive definite, or the eigenvalue iteration fails.
    pub fn stuck_modes(&self, stiffness: MatRef<'_, f64>) -> Result<Vec<StuckMode>, Error> {
        let matrices = self.matrices(1);
        let restrained = matrices.restrained(&complex(stiffness));
        let modes = modes(matrices.mass.as_ref(), restrained.as_ref())?;
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
}

/// The free modes in which both dampings are diagonal, if there are such.
fn separate(
    free: &RealModes,
    damping: MatRef<'_, f64>,
    negative: MatRef<'_, f64>,
    rows: MatRef<'_, f64>,
    law: bool,
) -> Option<ModalCompliance> {
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
    (law || own.is_diagonal() && added.is_diagonal())
        .then(|| ModalCompliance::of_free_modes(modes, own.diagonal(), added.diagonal(), rows))
}

/// A sector in a travelling wave at a ratio r.
struct FlutterWaves {
    /// By nodal diameter, each with its compliance once that is needed.
    waves: Vec<(Arc<Matrices>, OnceLock<DirectCompliance>)>,
    fundamental: usize,
    ratio: f64,
    stiffness: Mat<c64>,
    loads: Vec<HarmonicLoad>,
    outline: Outline,
}

impl FlutterWaves {
    fn wave(&self, harmonic: usize) -> &DirectCompliance {
        let (matrices, wave) = &self.waves[(harmonic * self.fundamental) % self.waves.len()];
        wave.get_or_init(|| matrices.at_ratio(self.ratio, &self.stiffness, self.loads.clone()))
    }
}

impl Compliance for FlutterWaves {
    fn contacts(&self) -> usize {
        self.stiffness.nrows()
    }

    fn dofs(&self) -> usize {
        self.waves[0].0.mass.nrows()
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn receptance(&self, harmonic: usize, omega: f64, out: &mut Receptance) -> Result<(), Error> {
        self.wave(harmonic).receptance(harmonic, omega, out)
    }

    fn displacement(&self, request: &Request<'_>, out: &mut [c64]) -> Result<(), Error> {
        self.wave(request.harmonic).displacement(request, out)
    }
}

impl Matrices {
    /// `K + Bᴴ D B`.
    fn restrained(&self, stiffness: &Mat<c64>) -> Mat<c64> {
        &self.stiffness + self.rows.adjoint() * (stiffness * &self.rows)
    }

    fn at_ratio(
        &self,
        ratio: f64,
        stiffness: &Mat<c64>,
        loads: Vec<HarmonicLoad>,
    ) -> DirectCompliance {
        let damping = &self.damping + faer::Scale(c64::new(ratio, 0.0)) * &self.negative;
        let matrices = [self.mass.clone(), damping, self.restrained(stiffness)];
        DirectCompliance::of_matrices(matrices, self.rows.clone(), loads)
            .with_negative(self.negative.clone())
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
