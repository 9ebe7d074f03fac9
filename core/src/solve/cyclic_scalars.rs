//! Tridiagonal systems of complex numbers that close on themselves: rings whose parts are coupled through one
//! number each. Blocks of one number cost tens of times their arithmetic.

use faer::c64;

/// One row: `lower x_{i−1} + own x_i + upper x_{i+1}`, indices modulo the number of rows.
#[derive(Debug, Clone, Copy)]
pub struct ScalarRow {
    /// Coupling to the number before.
    pub lower: c64,
    /// The number itself.
    pub own: c64,
    /// Coupling to the next number.
    pub upper: c64,
}

/// Factors of a cyclic tridiagonal matrix: the last row is a border of the others, which are eliminated one
/// after the other without pivoting.
#[derive(Debug, Clone, Default)]
pub struct CyclicScalars {
    eliminated: Vec<Eliminated>,
    /// Inverse pivot of the border; nothing of an empty system.
    border: Option<c64>,
}

/// An eliminated row: the inverse pivot, and with it the couplings to the next row and to the border; what the
/// next row and the border have in its column.
#[derive(Debug, Clone, Copy)]
struct Eliminated {
    inverse: c64,
    to_next: c64,
    to_border: c64,
    from_next: c64,
    from_border: c64,
}

impl CyclicScalars {
    /// Factors the matrix of these rows.
    #[must_use]
    pub fn new(rows: &[ScalarRow]) -> Self {
        let zero = c64::new(0.0, 0.0);
        let Some((last, inner)) = rows.split_last() else { return Self::default() };
        let Some(first) = inner.first() else {
            let border = Some((last.own + last.lower + last.upper).inv());
            return Self { eliminated: Vec::new(), border };
        };
        let (mut border, mut own) = (last.own, first.own);
        let (mut to_border, mut from_border) = (first.lower, last.upper);
        let mut eliminated = Vec::with_capacity(inner.len());
        for (row, next) in inner.iter().zip(&inner[1..]) {
            let inverse = own.inv();
            let part = Eliminated {
                inverse,
                to_next: row.upper * inverse,
                to_border: to_border * inverse,
                from_next: next.lower,
                from_border,
            };
            border -= from_border * part.to_border;
            own = next.own - next.lower * part.to_next;
            from_border = -(from_border * part.to_next);
            to_border = -(next.lower * part.to_border);
            eliminated.push(part);
        }
        // The row that follows the last one left is the border itself.
        to_border += inner[inner.len() - 1].upper;
        from_border += last.lower;
        let inverse = own.inv();
        let part = Eliminated {
            inverse,
            to_next: zero,
            to_border: to_border * inverse,
            from_next: zero,
            from_border,
        };
        border -= from_border * part.to_border;
        eliminated.push(part);
        Self { eliminated, border: Some(border.inv()) }
    }

    /// Solves for a right-hand side in place.
    pub fn solve(&self, right: &mut [c64]) {
        let (Some(inverse), Some((border, inner))) = (self.border, right.split_last_mut()) else {
            return;
        };
        let mut before = c64::new(0.0, 0.0);
        for (part, own) in self.eliminated.iter().zip(&mut *inner) {
            *own = (*own + before) * part.inverse;
            *border -= part.from_border * *own;
            before = -(part.from_next * *own);
        }
        *border *= inverse;
        let mut next = c64::new(0.0, 0.0);
        for (part, own) in self.eliminated.iter().zip(inner).rev() {
            *own -= part.to_next * next + part.to_border * *border;
            next = *own;
        }
    }
}
