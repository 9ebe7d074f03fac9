//! Modes seen at the contacts: `u = B Φ η`, and `(B Φ)ᵀ f` back.

/// Points whose displacements are summed side by side, in registers.
const LANES: usize = 16;

/// B Φ in blocks of points, each mode after mode, for products with vector instructions.
#[derive(Debug, Clone)]
pub(super) struct Projection {
    modes: usize,
    /// Block after block, [`LANES`] points per mode; missing points are zeros.
    blocks: Vec<f64>,
}

impl Projection {
    /// From the rows of B Φ, point after point.
    pub(super) fn new(rows: &[f64], modes: usize) -> Self {
        let points = rows.len() / modes.max(1);
        let mut blocks = vec![0.0; points.next_multiple_of(LANES) * modes];
        for (point, row) in rows.chunks_exact(modes.max(1)).enumerate() {
            let first = point / LANES * LANES * modes + point % LANES;
            let places = blocks[first..].iter_mut().step_by(LANES);
            places.zip(row).for_each(|(place, b)| *place = *b);
        }
        Self { modes, blocks }
    }

    /// Displacements of all points, in whole blocks; each is the sum over the modes in their order.
    pub(super) fn displacements(&self, modal: &[f64], out: &mut Vec<f64>) {
        out.clear();
        pulp::Arch::new().dispatch(|| {
            for block in self.blocks.chunks_exact(LANES * self.modes) {
                let mut sums = [0.0; LANES];
                for (row, x) in block.chunks_exact(LANES).zip(modal) {
                    for (sum, b) in sums.iter_mut().zip(row) {
                        *sum += b * x;
                    }
                }
                out.extend_from_slice(&sums);
            }
        });
    }
}

/// Takes the modal forces `f b` of a point off.
pub(super) fn take_off(shape: &[f64], force: f64, out: &mut [f64]) {
    pulp::Arch::new().dispatch(|| {
        for (out, b) in out.iter_mut().zip(shape) {
            *out -= b * force;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacements_are_the_products_with_the_rows() {
        for (points, modes) in [(1, 1), (3, 5), (16, 2), (37, 7)] {
            let rows: Vec<f64> = (0..points * modes).map(|i| (i as f64).sin()).collect();
            let modal: Vec<f64> = (0..modes).map(|i| (i as f64).cos()).collect();
            let mut found = Vec::new();
            Projection::new(&rows, modes).displacements(&modal, &mut found);
            for (row, found) in rows.chunks_exact(modes).zip(&found) {
                let expected: f64 = row.iter().zip(&modal).map(|(b, x)| b * x).sum();
                assert_eq!(*found, expected);
            }
        }
    }
}
