//! Numbers at the nodes of a rule, all at once: plain loops that the compiler turns into vector
//! instructions where they are called from a place that has them.

/// Nodes of a panel.
pub const NODES: usize = 24;

/// A number at every node.
pub type Lanes = [f64; NODES];

/// Terms of the series of cosine and sine beyond the first.
const TERMS: usize = 10;
/// Largest angle at which what they leave out is below rounding.
pub(crate) const SERIES: f64 = 1.625;

/// Cosines and sines by their series about zero, of angles up to [`SERIES`].
#[inline(always)]
pub(crate) fn cos_sin<const N: usize>(angle: &[f64; N]) -> [[f64; N]; 2] {
    let (mut cos, mut sin) = ([1.0; N], [1.0; N]);
    let mut square = *angle;
    for i in 0..N {
        square[i] *= angle[i];
    }
    for n in (1..=TERMS).rev() {
        let even = -1.0 / ((2 * n - 1) * 2 * n) as f64;
        let odd = -1.0 / (2 * n * (2 * n + 1)) as f64;
        for i in 0..N {
            cos[i] = 1.0 + even * square[i] * cos[i];
            sin[i] = 1.0 + odd * square[i] * sin[i];
        }
    }
    for i in 0..N {
        sin[i] *= angle[i];
    }
    [cos, sin]
}

/// Sum of all lanes.
#[inline(always)]
pub(crate) fn sum<const N: usize>(lanes: &[f64; N]) -> f64 {
    let mut four = [0.0; 4];
    for part in lanes.chunks_exact(4) {
        (0..4).for_each(|i| four[i] += part[i]);
    }
    (four[0] + four[1]) + (four[2] + four[3])
}

/// Cosines and sines of twice the angles.
#[inline(always)]
pub(crate) fn doubled<const N: usize>(cos: &[f64; N], sin: &[f64; N]) -> [[f64; N]; 2] {
    let mut out = [[0.0; N]; 2];
    for i in 0..N {
        out[0][i] = (cos[i] - sin[i]) * (cos[i] + sin[i]);
        out[1][i] = 2.0 * sin[i] * cos[i];
    }
    out
}

/// Turns every lane by its step.
#[inline(always)]
pub(crate) fn rotate<const N: usize>(
    cos: &mut [f64; N],
    sin: &mut [f64; N],
    [cos_step, sin_step]: &[[f64; N]; 2],
) {
    for i in 0..N {
        let (c, s) = (cos[i], sin[i]);
        cos[i] = c * cos_step[i] - s * sin_step[i];
        sin[i] = s * cos_step[i] + c * sin_step[i];
    }
}
