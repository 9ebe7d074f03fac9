//! Block tridiagonal systems that close on themselves: rings of equal parts, each coupled to its
//! two neighbours. The effort grows with the number of blocks, not with its cube.

use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{Mat, MatRef};

/// One block row: `lower x_{i−1} + own x_i + upper x_{i+1}`, indices modulo the number of blocks.
#[derive(Debug, Clone)]
pub struct BlockRow {
    /// Coupling to the block before.
    pub lower: Mat<f64>,
    /// The block itself.
    pub own: Mat<f64>,
    /// Coupling to the next block.
    pub upper: Mat<f64>,
}

/// Factors of a cyclic block tridiagonal matrix: the last block is a border of the others, which
/// are eliminated one after the other.
#[derive(Debug, Clone)]
pub struct CyclicTridiagonal {
    size: usize,
    /// Of each eliminated block: its pivot, what couples it to the next one and to the border,
    /// and how the next block and the border depend on it.
    eliminated: Vec<Eliminated>,
    border: PartialPivLu<f64>,
}

#[derive(Debug, Clone)]
struct Eliminated {
    pivot: PartialPivLu<f64>,
    /// Pivot⁻¹ times the coupling to the next block and to the border.
    to_next: Mat<f64>,
    to_border: Mat<f64>,
    /// Rows of the next block and of the border in the columns of this one.
    from_next: Mat<f64>,
    from_border: Mat<f64>,
}

impl CyclicTridiagonal {
    /// Eliminates the blocks in order, without pivoting between blocks.
    #[must_use]
    pub fn new(rows: Vec<BlockRow>) -> Self {
        let count = rows.len();
        let size = rows.first().map_or(0, |row| row.own.nrows());
        let zero = Mat::<f64>::zeros(size, size);
        let Some((last, inner)) = rows.split_last() else {
            return Self { size, eliminated: Vec::new(), border: zero.partial_piv_lu() };
        };
        let mut border = last.own.clone();
        if count == 1 {
            border += &last.lower + &last.upper;
        }
        let mut own = inner.first().map_or_else(|| zero.clone(), |row| row.own.clone());
        // Couplings of the block at hand with the border, in both directions.
        let mut to_border = inner.first().map_or_else(|| zero.clone(), |row| row.lower.clone());
        let mut from_border = last.upper.clone();
        let mut eliminated = Vec::with_capacity(inner.len());
        for (index, row) in inner.iter().enumerate() {
            let is_last = index + 1 == inner.len();
            if is_last {
                // Its next block is the border itself.
                to_border += &row.upper;
                from_border += &last.lower;
            }
            let pivot = own.partial_piv_lu();
            let by_border = pivot.solve(&to_border);
            border -= &from_border * &by_border;
            let (to_next, from_next) = match inner.get(index + 1) {
                None => (zero.clone(), zero.clone()),
                Some(next) => {
                    let to_next = pivot.solve(&row.upper);
                    own = &next.own - &next.lower * &to_next;
                    let next_to_border = &next.lower * &by_border;
                    let border_from_next = &from_border * &to_next;
                    to_border = -next_to_border;
                    eliminated.push(Eliminated {
                        pivot,
                        to_next,
                        to_border: by_border,
                        from_next: next.lower.clone(),
                        from_border: from_border.clone(),
                    });
                    from_border = -border_from_next;
                    continue;
                }
            };
            eliminated.push(Eliminated {
                pivot,
                to_next,
                to_border: by_border,
                from_next,
                from_border: from_border.clone(),
            });
        }
        Self { size, eliminated, border: border.partial_piv_lu() }
    }

    /// Solves for right-hand sides stacked block after block.
    #[must_use]
    pub fn solve(&self, right: MatRef<'_, f64>) -> Mat<f64> {
        let (size, columns) = (self.size, right.ncols());
        let block = |index: usize| right.get(index * size..(index + 1) * size, ..).to_owned();
        let inner = self.eliminated.len();
        let mut border = block(inner);
        let mut reduced = Vec::with_capacity(inner);
        let mut own = if inner > 0 { block(0) } else { Mat::zeros(size, columns) };
        for (index, part) in self.eliminated.iter().enumerate() {
            let value = part.pivot.solve(&own);
            border -= &part.from_border * &value;
            if index + 1 < inner {
                own = block(index + 1) - &part.from_next * &value;
            }
            reduced.push(value);
        }
        let last = self.border.solve(&border);
        let mut solution = Mat::zeros(right.nrows(), columns);
        solution.get_mut(inner * size..(inner + 1) * size, ..).copy_from(&last);
        let mut next = Mat::zeros(size, columns);
        for (index, part) in self.eliminated.iter().enumerate().rev() {
            let value = &reduced[index] - &part.to_next * &next - &part.to_border * &last;
            solution.get_mut(index * size..(index + 1) * size, ..).copy_from(&value);
            next = value;
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_blocks_agrees_with_the_dense_solution() {
        for count in 1..8 {
            let size = 3;
            let mut seed = 0.3_f64;
            let mut random = |shift: f64| {
                Mat::from_fn(size, size, |i, j| {
                    seed = (seed * 997.0 + 0.123).fract();
                    seed - 0.5 + if i == j { shift } else { 0.0 }
                })
            };
            let rows: Vec<BlockRow> = (0..count)
                .map(|_| BlockRow { lower: random(0.0), own: random(4.0), upper: random(0.0) })
                .collect();
            let mut dense = Mat::<f64>::zeros(count * size, count * size);
            for (i, row) in rows.iter().enumerate() {
                let parts = [
                    (&row.lower, (i + count - 1) % count),
                    (&row.own, i),
                    (&row.upper, (i + 1) % count),
                ];
                for (part, j) in parts {
                    let mut at = dense.get_mut(i * size..(i + 1) * size, j * size..(j + 1) * size);
                    at += part;
                }
            }
            let right =
                Mat::from_fn(count * size, 2, |i, j| (1.0 + i as f64 + 7.0 * j as f64).sin());
            let expected = dense.partial_piv_lu().solve(&right);
            let found = CyclicTridiagonal::new(rows).solve(right.as_ref());
            assert!((expected - found).norm_max() < 1e-12, "{count}");
        }
    }
}
