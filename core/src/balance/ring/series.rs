//! Receptances and links of a ring as matrices on the real coefficients of series: block-diagonal
//! in the harmonics, which products with them make use of.

use super::answers::RingAnswers;
use crate::fourier::Harmonics;
use crate::solve::Block;
use crate::structure::RingOrder;
use faer::c64;

/// The harmonics of a ring.
#[derive(Clone, Copy)]
pub(crate) struct RingSeries<'a> {
    orders: &'a [RingAnswers],
    harmonics: &'a Harmonics,
}

/// The receptance of a sector between some of its ports.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) sector: usize,
    pub(super) rows: &'a [usize],
    pub(super) columns: &'a [usize],
}

impl<'a> RingSeries<'a> {
    pub(crate) fn new(orders: &'a [RingAnswers], harmonics: &'a Harmonics) -> Self {
        Self { orders, harmonics }
    }

    pub(super) fn slots(&self) -> usize {
        self.harmonics.slots()
    }

    pub(super) fn sectors(&self) -> usize {
        self.orders.first().map_or(0, |order| order.order().sectors())
    }

    /// Every kept harmonic with the position of its first coefficient, and whether it has two.
    pub(super) fn slot(&self) -> impl Iterator<Item = (&'a RingOrder, usize, bool)> + 'a {
        let offset = self.harmonics.offset();
        self.orders.iter().enumerate().map(move |(index, order)| {
            let slot = if offset == 0 { 2 * index } else { (2 * index).saturating_sub(1) };
            (order.order(), slot, index >= offset)
        })
    }

    /// The receptance between ports as a matrix.
    pub(super) fn receptance(&self, sector: usize, rows: &[usize], columns: &[usize]) -> Block {
        let slots = self.slots();
        let mut matrix = Block::zeros(rows.len() * slots, columns.len() * slots);
        for (order, slot, oscillates) in self.slot() {
            for (j, column) in columns.iter().enumerate() {
                for (i, row) in rows.iter().enumerate() {
                    let g = receptance(order, sector, *row, *column);
                    let (row, column) = (i * slots + slot, j * slots + slot);
                    matrix[(row, column)] = g.re;
                    if oscillates {
                        // X = a − i b.
                        matrix[(row, column + 1)] = g.im;
                        matrix[(row + 1, column)] = -g.im;
                        matrix[(row + 1, column + 1)] = g.re;
                    }
                }
            }
        }
        matrix
    }

    /// `out −= matrix A`.
    pub(super) fn subtract_product_right(&self, matrix: &Block, part: Part<'_>, out: &mut Block) {
        let slots = self.slots();
        for (order, slot, oscillates) in self.slot() {
            for (l, from) in part.rows.iter().enumerate() {
                for (j, to) in part.columns.iter().enumerate() {
                    let g = -receptance(order, part.sector, *from, *to);
                    let at = [l * slots + slot, j * slots + slot];
                    add_columns(matrix, g, at, oscillates, out);
                }
            }
        }
    }

    /// `out −= A matrix`.
    pub(super) fn subtract_product_left(&self, part: Part<'_>, matrix: &Block, out: &mut Block) {
        let slots = self.slots();
        for (order, slot, oscillates) in self.slot() {
            for (l, from) in part.columns.iter().enumerate() {
                for (i, to) in part.rows.iter().enumerate() {
                    let g = receptance(order, part.sector, *to, *from);
                    let (row, source) = (i * slots + slot, l * slots + slot);
                    subtract_row(out.row_mut(row), g.re, matrix.row(source));
                    if oscillates {
                        subtract_row(out.row_mut(row), g.im, matrix.row(source + 1));
                        subtract_row(out.row_mut(row + 1), -g.im, matrix.row(source));
                        subtract_row(out.row_mut(row + 1), g.re, matrix.row(source + 1));
                    }
                }
            }
        }
    }

    /// `out −= A x`.
    pub(super) fn subtract_from(&self, part: Part<'_>, x: &[f64], out: &mut [f64]) {
        let slots = self.slots();
        for (order, slot, oscillates) in self.slot() {
            for (j, column) in part.columns.iter().enumerate() {
                for (i, row) in part.rows.iter().enumerate() {
                    let g = -receptance(order, part.sector, *row, *column);
                    add_entry(g, x, j * slots + slot, oscillates, out, i * slots + slot);
                }
            }
        }
    }

    /// Adds the coupling Z of a sector to the next one times the motion there, or its transpose.
    pub(super) fn add_link(&self, sector: usize, transposed: bool, y: &[f64], out: &mut [f64]) {
        let slots = self.slots();
        for (order, slot, oscillates) in self.slot() {
            let size = order.link(sector).nrows();
            for a in 0..size {
                for b in 0..size {
                    let z = link(order, sector, transposed, a, b);
                    if z != c64::new(0.0, 0.0) {
                        add_entry(z, y, b * slots + slot, oscillates, out, a * slots + slot);
                    }
                }
            }
        }
    }

    /// Adds to the columns of the interface in `out`, from `first` on, those in `matrix` times a coupling, whose
    /// entries `link` tells of every harmonic and its position.
    pub(super) fn add_product_link(
        &self,
        matrix: &Block,
        first: usize,
        link: impl Fn(usize, &RingOrder, usize, usize) -> c64,
        out: &mut Block,
    ) {
        let slots = self.slots();
        for (index, (order, slot, oscillates)) in self.slot().enumerate() {
            let size = order.link(0).nrows();
            for a in 0..size {
                for b in 0..size {
                    let z = link(index, order, a, b);
                    if z != c64::new(0.0, 0.0) {
                        let at = [first + a * slots + slot, first + b * slots + slot];
                        add_columns(matrix, z, at, oscillates, out);
                    }
                }
            }
        }
    }
}

fn receptance(order: &RingOrder, sector: usize, row: usize, column: usize) -> c64 {
    order.sector(sector)[column * order.ports() + row]
}

pub(super) fn link(order: &RingOrder, sector: usize, transposed: bool, a: usize, b: usize) -> c64 {
    order.link(sector)[if transposed { (b, a) } else { (a, b) }]
}

/// Adds the columns of `matrix` at the first position times one entry of a harmonic to those of
/// `out` at the second one.
fn add_columns(matrix: &Block, g: c64, [from, to]: [usize; 2], oscillates: bool, out: &mut Block) {
    for i in 0..matrix.rows() {
        let row = matrix.row(i);
        let target = out.row_mut(i);
        if oscillates {
            let (a, b) = (row[from], row[from + 1]);
            target[to] += a * g.re - b * g.im;
            target[to + 1] += a * g.im + b * g.re;
        } else {
            target[to] += row[from] * g.re;
        }
    }
}

/// Adds one entry of a harmonic times the coefficients at `from` to those at `to`.
fn add_entry(g: c64, x: &[f64], from: usize, oscillates: bool, out: &mut [f64], to: usize) {
    if oscillates {
        out[to] += g.re * x[from] + g.im * x[from + 1];
        out[to + 1] += g.re * x[from + 1] - g.im * x[from];
    } else {
        out[to] += g.re * x[from];
    }
}

fn subtract_row(out: &mut [f64], factor: f64, row: &[f64]) {
    out.iter_mut().zip(row).for_each(|(x, r)| *x -= factor * r);
}
