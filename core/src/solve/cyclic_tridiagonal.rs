//! Block tridiagonal systems that close on themselves: rings of equal parts, each coupled to its
//! two neighbours. The effort grows with the number of blocks, not with its cube.

use super::small_dense::{factorise, solve, subtract_product};

/// One block row: `lower x_{i−1} + own x_i + upper x_{i+1}`, indices modulo the number of blocks;
/// matrices row by row.
#[derive(Debug, Clone)]
pub struct BlockRow {
    /// Coupling to the block before.
    pub lower: Vec<f64>,
    /// The block itself.
    pub own: Vec<f64>,
    /// Coupling to the next block.
    pub upper: Vec<f64>,
}

/// Factors of a cyclic block tridiagonal matrix: the last block is a border of the others, which
/// are eliminated one after the other without pivoting between blocks.
#[derive(Debug, Clone)]
pub struct CyclicTridiagonal {
    size: usize,
    eliminated: Vec<Eliminated>,
    border: Factors,
}

#[derive(Debug, Clone)]
struct Factors {
    lu: Vec<f64>,
    pivots: Vec<usize>,
}

impl Factors {
    fn new(mut matrix: Vec<f64>, size: usize) -> Self {
        let mut pivots = vec![0; size];
        factorise(&mut matrix, size, &mut pivots);
        Self { lu: matrix, pivots }
    }

    fn solve(&self, right: &mut [f64], columns: usize) {
        solve(&self.lu, self.pivots.len(), &self.pivots, right, columns);
    }
}

/// An eliminated block: its pivot, pivot⁻¹ times its coupling to the next block and to the border,
/// and the rows of the next block and of the border in its columns.
#[derive(Debug, Clone)]
struct Eliminated {
    pivot: Factors,
    to_next: Vec<f64>,
    to_border: Vec<f64>,
    from_next: Vec<f64>,
    from_border: Vec<f64>,
}

impl CyclicTridiagonal {
    /// Factors the matrix of these block rows, each block `size` × `size`.
    #[must_use]
    pub fn new(rows: Vec<BlockRow>, size: usize) -> Self {
        let Some((last, inner)) = rows.split_last() else {
            let border = Factors { lu: Vec::new(), pivots: Vec::new() };
            return Self { size: 0, eliminated: Vec::new(), border };
        };
        let mut border = last.own.clone();
        let Some(first) = inner.first() else {
            add(&mut border, &last.lower);
            add(&mut border, &last.upper);
            return Self { size, eliminated: Vec::new(), border: Factors::new(border, size) };
        };
        // The block at hand, and what couples it to the border in either direction.
        let (mut own, mut to_border) = (first.own.clone(), first.lower.clone());
        let mut from_border = last.upper.clone();
        let mut eliminated = Vec::with_capacity(inner.len());
        for (index, row) in inner.iter().enumerate() {
            let next = inner.get(index + 1);
            if next.is_none() {
                // Its next block is the border itself.
                add(&mut to_border, &row.upper);
                add(&mut from_border, &last.lower);
            }
            let pivot = Factors::new(own, size);
            pivot.solve(&mut to_border, size);
            subtract_product(&mut border, &from_border, &to_border, size, size);
            let Some(next) = next else {
                let (to_next, from_next) = (vec![0.0; size * size], Vec::new());
                eliminated.push(Eliminated { pivot, to_next, to_border, from_next, from_border });
                break;
            };
            let mut to_next = row.upper.clone();
            pivot.solve(&mut to_next, size);
            own = next.own.clone();
            subtract_product(&mut own, &next.lower, &to_next, size, size);
            let mut next_to_border = vec![0.0; size * size];
            subtract_product(&mut next_to_border, &next.lower, &to_border, size, size);
            let mut border_from_next = vec![0.0; size * size];
            subtract_product(&mut border_from_next, &from_border, &to_next, size, size);
            let from_next = next.lower.clone();
            eliminated.push(Eliminated { pivot, to_next, to_border, from_next, from_border });
            (to_border, from_border) = (next_to_border, border_from_next);
        }
        Self { size, eliminated, border: Factors::new(border, size) }
    }

    /// Solves for a right-hand side stacked block after block, in place.
    pub fn solve(&self, right: &mut [f64]) {
        let size = self.size;
        let (inner, border) = right.split_at_mut(self.eliminated.len() * size);
        for (index, part) in self.eliminated.iter().enumerate() {
            let (own, rest) = inner[index * size..].split_at_mut(size);
            part.pivot.solve(own, 1);
            subtract_product(border, &part.from_border, own, size, 1);
            if !part.from_next.is_empty() {
                subtract_product(&mut rest[..size], &part.from_next, own, size, 1);
            }
        }
        self.border.solve(border, 1);
        for (index, part) in self.eliminated.iter().enumerate().rev() {
            let (own, rest) = inner[index * size..].split_at_mut(size);
            if rest.len() >= size {
                subtract_product(own, &part.to_next, &rest[..size], size, 1);
            }
            subtract_product(own, &part.to_border, border, size, 1);
        }
    }
}

fn add(sum: &mut [f64], other: &[f64]) {
    sum.iter_mut().zip(other).for_each(|(a, b)| *a += b);
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::linalg::solvers::Solve as _;
    use faer::Mat;

    #[test]
    fn every_number_of_blocks_agrees_with_the_dense_solution() {
        for count in 1..8 {
            let size = 3;
            let mut seed = 0.3_f64;
            let mut random = |shift: f64| -> Vec<f64> {
                (0..size * size)
                    .map(|at| {
                        seed = (seed * 997.0 + 0.123).fract();
                        seed - 0.5 + if at % (size + 1) == 0 { shift } else { 0.0 }
                    })
                    .collect()
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
                    for (at, value) in part.iter().enumerate() {
                        dense[(i * size + at / size, j * size + at % size)] += value;
                    }
                }
            }
            let right = Mat::from_fn(count * size, 1, |i, _| (1.0 + i as f64).sin());
            let expected = dense.partial_piv_lu().solve(&right);
            let mut found: Vec<f64> = (0..count * size).map(|i| right[(i, 0)]).collect();
            CyclicTridiagonal::new(rows, size).solve(&mut found);
            for (i, found) in found.iter().enumerate() {
                assert!((expected[(i, 0)] - found).abs() < 1e-12, "{count}");
            }
        }
    }
}
