//! A contact law that a user wrote in Python: a return map of many nodes at once.
//!
//! What Python raises stays with the Python object, which then answers with nothing: the law has no
//! numbers any more, and the analysis that calls it raises the error when it ends.

use crate::arrays::{matrix, Array2, Array3};
use numpy::{PyArray1, PyArrayMethods as _};
use pyo3::prelude::*;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use stickslip_core::contact::{ContactLaw, ReturnMapJacobian};

type Mat = faer::Mat<f64>;
/// Forces and states of all nodes, and the five derivatives of `ReturnMapJacobian`, node by node.
type Answer<'py> = (Array2<'py, f64>, Array2<'py, f64>, Option<Vec<Array3<'py, f64>>>);

/// The law `f(u) = b F(a u)` of a Python object with the return map F.
#[derive(Debug, Clone)]
pub struct PythonLaw {
    law: Arc<Py<PyAny>>,
    name: &'static str,
    nodes: usize,
    /// Displacements of a node, and numbers of its state.
    sizes: [usize; 2],
    /// Of the stuck object itself, of force and state.
    stiffness: Mat,
    state_stiffness: Mat,
    odd: bool,
    monotone: bool,
    /// Factor a on displacements.
    closer: f64,
    /// Factor b on forces.
    stronger: f64,
    /// Factor on the stiffness: a b, also where there is no force left.
    stiffer: f64,
}

impl PythonLaw {
    /// Asks the object for all that stays the same.
    pub fn new(law: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (stiffness, state_stiffness): (Array2<'_, f64>, Array2<'_, f64>) =
            law.call_method0("_stuck")?.extract()?;
        Ok(Self {
            name: kept(law.getattr("law")?.extract()?),
            nodes: law.getattr("points")?.extract()?,
            sizes: [law.getattr("directions")?.extract()?, law.getattr("state_size")?.extract()?],
            stiffness: matrix(&stiffness),
            state_stiffness: matrix(&state_stiffness),
            odd: law.getattr("odd")?.extract()?,
            monotone: law.getattr("monotone")?.extract()?,
            law: Arc::new(law.clone().unbind()),
            closer: 1.0,
            stronger: 1.0,
            stiffer: 1.0,
        })
    }

    /// One step of all nodes; `None` once Python has raised an error.
    fn step(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        jacobian: Option<&mut ReturnMapJacobian>,
    ) -> Option<()> {
        Python::attach(|py| {
            let [displacements, states] = self.sizes;
            let moved = |u: &[f64], width: usize, factor: f64| {
                PyArray1::from_iter(py, u.iter().map(|u| factor * u)).reshape([self.nodes, width])
            };
            let given = (
                moved(before, displacements, self.closer).ok()?,
                moved(after, displacements, self.closer).ok()?,
                moved(state, states, 1.0).ok()?,
                jacobian.is_some(),
            );
            let answer = self.law.bind(py).call_method1("_step", given).ok()?;
            let (forces, new, tangents): Answer<'_> = answer.extract().ok()?;
            state.iter_mut().zip(new.as_array()).for_each(|(old, new)| *old = *new);
            force
                .iter_mut()
                .zip(forces.as_array())
                .for_each(|(old, new)| *old = self.stronger * new);
            let Some(jacobian) = jacobian else { return Some(()) };
            jacobian.reset(force.len(), state.len());
            let [a, b] = [self.closer, self.stronger];
            let parts = [
                (&mut jacobian.by_state, 1.0),
                (&mut jacobian.by_before, a),
                (&mut jacobian.by_after, a),
                (&mut jacobian.force_by_state, b),
                (&mut jacobian.force_by_after, a * b),
            ];
            for ((whole, factor), blocks) in parts.into_iter().zip(tangents?) {
                let blocks = blocks.as_array();
                let (rows, columns) = (blocks.shape()[1], blocks.shape()[2]);
                for ((node, i, j), slope) in blocks.indexed_iter() {
                    whole[(node * rows + i) * columns * self.nodes + node * columns + j] =
                        factor * slope;
                }
            }
            self.slips(jacobian);
            Some(())
        })
    }

    /// What does not go with the stiffness of the stuck law slips.
    fn slips(&self, jacobian: &mut ReturnMapJacobian) {
        let (stuck, of_state) = (self.stiffness(), self.state_stiffness());
        let (count, states) = (stuck.nrows(), of_state.nrows());
        for i in 0..count {
            let moves = (0..count).any(|j| {
                let through: f64 = (0..states)
                    .map(|k| {
                        jacobian.force_by_state[i * states + k] * jacobian.by_after[k * count + j]
                    })
                    .sum();
                let slope = jacobian.force_by_after[i * count + j] + through;
                (slope - stuck[(i, j)]).abs() > 1e-9 * stuck[(i, i)].abs()
            });
            jacobian.slipping[i] = f64::from(u8::from(moves));
        }
    }

    fn scaled(&self, closer: f64, stronger: f64, stiffer: f64) -> Box<dyn ContactLaw> {
        Box::new(Self {
            closer: closer * self.closer,
            stronger: stronger * self.stronger,
            stiffer: stiffer * self.stiffer,
            ..self.clone()
        })
    }
}

impl ContactLaw for PythonLaw {
    fn name(&self) -> &'static str {
        self.name
    }

    fn displacements(&self) -> usize {
        self.nodes * self.sizes[0]
    }

    fn state_size(&self) -> usize {
        self.nodes * self.sizes[1]
    }

    fn stiffness(&self) -> Mat {
        &self.stiffness * faer::Scale(self.stiffer)
    }

    fn state_stiffness(&self) -> Mat {
        &self.state_stiffness * faer::Scale(self.closer)
    }

    fn is_odd(&self) -> bool {
        self.odd
    }

    fn is_monotone(&self) -> bool {
        self.monotone
    }

    /// The interpreter works for one thread at a time.
    fn is_serial(&self) -> bool {
        true
    }

    /// Nothing is known of them: there may be some.
    fn limits(&self) -> Vec<f64> {
        vec![f64::MAX; self.displacements()]
    }

    fn return_map(
        &self,
        before: &[f64],
        after: &[f64],
        state: &mut [f64],
        force: &mut [f64],
        mut jacobian: Option<&mut ReturnMapJacobian>,
    ) {
        if self.step(before, after, state, force, jacobian.as_deref_mut()).is_none() {
            force.fill(f64::NAN);
            state.fill(f64::NAN);
            if let Some(jacobian) = jacobian {
                jacobian.reset(force.len(), state.len());
            }
        }
    }

    /// At the displacement a u the spring is a times as stiff, and slips at the same force.
    fn with_scaled_stiffness(&self, share: f64) -> Box<dyn ContactLaw> {
        self.scaled(share, 1.0, share)
    }

    fn with_scaled_forces(&self, factor: f64) -> Box<dyn ContactLaw> {
        let closer = if factor == 0.0 { 1.0 } else { factor.recip() };
        self.scaled(closer, factor, 1.0)
    }
}

/// A name for as long as the program runs, each kept once.
fn kept(name: String) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name.as_str()) {
        return known;
    }
    let known: &'static str = Box::leak(name.into_boxed_str());
    names.insert(known);
    known
}
