//! Products of matrices that leave the processor as fast as it was.
//!
//! The kernels of `private-gemm-x86` 0.1, by which `faer` 0.24 multiplies matrices of more than some thousand products,
//! end without `vzeroupper`. Code for any x86-64 processor, which knows no wider registers than those of SSE, then takes
//! four to five times as long, until the end of the next vector function. Factorisations and solutions end with one.

use faer::linalg::matmul::matmul;
use faer::mat::{AsMatMut, AsMatRef};
use faer::traits::{ComplexField, Conjugate};
use faer::{Accum, Par, Shape};
use pulp::{Arch, Simd, WithSimd};
use std::hint::black_box;

/// `factor a b`, in place of `out` or added to it.
pub(crate) fn multiply<T, A, B, M, N, K>(
    out: impl AsMatMut<T = T, Rows = M, Cols = N>,
    accum: Accum,
    a: impl AsMatRef<T = A, Rows = M, Cols = K>,
    b: impl AsMatRef<T = B, Rows = K, Cols = N>,
    factor: T,
) where
    T: ComplexField,
    A: Conjugate<Canonical = T>,
    B: Conjugate<Canonical = T>,
    M: Shape,
    N: Shape,
    K: Shape,
{
    matmul(out, accum, a, b, factor, Par::Seq);
    settle();
}

/// Clears the upper halves of the vector registers, as every vector function does at its end.
pub(crate) fn settle() {
    Arch::new().dispatch(Shortest(black_box([1.0; 4])));
}

/// The shortest vector function.
struct Shortest([f64; 4]);

impl WithSimd for Shortest {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let (vectors, _) = S::as_mut_simd_f64s(&mut self.0);
        vectors.iter_mut().for_each(|vector| *vector = simd.add_f64s(*vector, *vector));
        black_box(&self.0);
    }
}
