//! Natural frequencies inside a band, of matrices that hold few numbers: by Sylvester's law as many
//! squared frequencies lie below σ as `K − σM` has negative pivots.

use super::matrix::Sparse;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw,
    SymmetricOrdering,
};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::SparseColMat;
use faer::{Par, Side};

/// Width of what holds a frequency, squared, relative to it.
const NARROW: f64 = 1e-13;
/// Distance, relative, of a frequency beside one at which a factorisation breaks down.
const BESIDE: f64 = 1e-12;

/// Squared frequencies in `[low, high]`, ascending; nothing where a factorisation fails.
pub(super) fn squared_between(
    mass: &Sparse,
    stiffness: &Sparse,
    [low, high]: [f64; 2],
) -> Option<Vec<f64>> {
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
        ..Default::default()
    };
    let pattern = stiffness.symbolic();
    let symbolic =
        factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, parameters);
    let symbolic = symbolic.ok()?;
    // A pivot may be 0 by chance.
    let below = |squared: f64| {
        let beside = || below(&symbolic, mass, stiffness, squared * (1.0 + BESIDE));
        below(&symbolic, mass, stiffness, squared).or_else(beside)
    };
    let mut found = Vec::new();
    let mut rest = vec![(low, below(low)?, high, below(high)?)];
    while let Some((low, before, high, up_to)) = rest.pop() {
        if up_to <= before {
            continue;
        }
        let middle = 0.5 * (low + high);
        if high - low <= NARROW * high.abs() || middle <= low || middle >= high {
            found.resize(found.len() + up_to - before, middle);
            continue;
        }
        let count = below(middle)?;
        rest.push((middle, count, high, up_to));
        rest.push((low, before, middle, count));
    }
    Some(found)
}

/// Number of squared frequencies below one.
fn below(
    symbolic: &SymbolicCholesky<usize>,
    mass: &Sparse,
    stiffness: &Sparse,
    squared: f64,
) -> Option<usize> {
    let shifted = stiffness.val().iter().zip(mass.val()).map(|(k, m)| k - squared * m).collect();
    let shifted = SparseColMat::new(stiffness.symbolic().to_owned().ok()?, shifted);
    let mut values = vec![0.0; symbolic.len_val()];
    let need = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
    let mut buffer = MemBuffer::try_new(need).ok()?;
    let stack = MemStack::new(&mut buffer);
    let (regular, parameters) = (Default::default(), Default::default());
    let made = symbolic.factorize_numeric_ldlt(
        &mut values,
        shifted.as_ref(),
        Side::Lower,
        regular,
        Par::Seq,
        stack,
        parameters,
    );
    made.ok()?;
    let SymbolicCholeskyRaw::Simplicial(columns) = symbolic.raw() else { return None };
    // A column begins with its pivot.
    let pivots = columns.col_ptr().iter().take(stiffness.ncols());
    Some(pivots.filter(|&&first| values[first] < 0.0).count())
}
