//! Block tridiagonal systems that close on themselves: rings of equal parts, each coupled to its
//! two neighbours. The effort grows with the number of blocks, not with its cube.

use super::small_dense::{Block, BlockFactors};

/// One block row: `lower x_{i−1} + own x_i + upper x_{i+1}`, indices modulo the number of blocks.
#[derive(Debug, Clone)]
pub struct BlockRow {
    /// Coupling to the block before.
    pub lower: Block,
    /// The block itself.
    pub own: Block,
    /// Coupling to the next block.
    pub upper: Block,
}

/// Factors of a cyclic block tridiagonal matrix: the last block is a border of the others, which
/// are eliminated one after the other without pivoting between blocks.
#[derive(Debug, Clone, Default)]
pub struct CyclicTridiagonal {
    size: usize,
    eliminated: Vec<Eliminated>,
    border: BlockFactors,
}

/// An eliminated block: its pivot, pivot⁻¹ times its coupling to the border and, beside it, to the
/// next block, and the rows of the next block and of the border in its columns.
#[derive(Debug, Clone)]
struct Eliminated {
    pivot: BlockFactors,
    to_others: Block,
    from_next: Option<Block>,
    from_border: Block,
}

impl CyclicTridiagonal {
    /// Factors the matrix of these block rows.
    #[must_use]
    pub fn new(mut rows: Vec<BlockRow>) -> Self {
        let Some(last) = rows.pop() else { return Self::default() };
        let size = last.own.rows();
        let mut border = last.own;
        let mut inner = rows.into_iter();
        let Some(BlockRow { mut own, lower: mut to_border, mut upper }) = inner.next() else {
            border.add(&last.lower);
            border.add(&last.upper);
            return Self { size, eliminated: Vec::new(), border: BlockFactors::new(border) };
        };
        // What couples the block at hand to the border, in the border's row.
        let mut from_border = last.upper;
        let mut eliminated = Vec::with_capacity(inner.len() + 1);
        for next in inner {
            let pivot = BlockFactors::new(own);
            let mut to_others = Block::beside(&to_border, &upper);
            pivot.solve(&mut to_others);
            let second = to_border.stride();
            let of_border = Block::minus_product(&from_border, &to_others);
            let of_next = Block::minus_product(&next.lower, &to_others);
            border.add_part(&of_border, 0);
            (own, upper) = (next.own, next.upper);
            own.add_part(&of_next, second);
            let from_next = Some(next.lower);
            eliminated.push(Eliminated { pivot, to_others, from_next, from_border });
            to_border = of_next.column_part(0..size);
            from_border = of_border.column_part(second..second + size);
        }
        // The next block of the last one left is the border itself.
        to_border.add(&upper);
        from_border.add(&last.lower);
        let pivot = BlockFactors::new(own);
        pivot.solve(&mut to_border);
        border.subtract_product(&from_border, &to_border);
        let (to_others, from_next) = (to_border, None);
        eliminated.push(Eliminated { pivot, to_others, from_next, from_border });
        Self { size, eliminated, border: BlockFactors::new(border) }
    }

    /// Solves for a right-hand side stacked block after block, in place.
    pub fn solve(&self, right: &mut [f64]) {
        let size = self.size;
        let (inner, border) = right.split_at_mut(self.eliminated.len() * size);
        for (index, part) in self.eliminated.iter().enumerate() {
            let (own, rest) = inner[index * size..].split_at_mut(size);
            part.pivot.solve_vector(own);
            part.from_border.subtract_from(own, border);
            if let Some(from_next) = &part.from_next {
                from_next.subtract_from(own, &mut rest[..size]);
            }
        }
        self.border.solve_vector(border);
        for (index, part) in self.eliminated.iter().enumerate().rev() {
            let (own, rest) = inner[index * size..].split_at_mut(size);
            if part.from_next.is_some() {
                let second = part.to_others.stride() / 2;
                part.to_others.subtract_part_from(second, &rest[..size], own);
            }
            part.to_others.subtract_from(border, own);
        }
    }
}
