//! Newton directions of a ring of sectors, at an effort that grows with the number of sectors.
//!
//! The slip loads of a contact act on its own sector (and, between neighbours, on the next one),
//! so that `s = r + G ∂Q s` needs no dense G: contacts inside a sector are eliminated in it, and
//! what is left couples neighbours alone, harmonic by harmonic mixed by the tangents.

use crate::contact::SlipLoad;
use crate::fourier::Harmonics;
use crate::solve::{BlockRow, CyclicTridiagonal};
use crate::structure::{RingLayout, RingOrder};
use faer::linalg::solvers::{PartialPivLu, Solve as _};
use faer::{Mat, MatRef};
use std::ops::{AddAssign as _, Range, SubAssign as _};

/// Factors of `I − G ∂Q` for a ring.
pub(super) struct RingNewton {
    slots: usize,
    layout: RingLayout,
    /// Contacts inside a sector.
    local: Vec<usize>,
    /// Where the parts of a sector's other ports R end: its contacts with the next sector, those
    /// of the sector before, the interface.
    ends: [usize; 3],
    sectors: Vec<Sector>,
    chain: CyclicTridiagonal,
}

/// One sector with the contacts L inside it eliminated; R are its other ports.
struct Sector {
    /// `(I − A_LL T_L)` and T_L, if any of L slips.
    slip: Option<(PartialPivLu<f64>, Mat<f64>)>,
    /// A_RL, and `(I − A_LL T_L)⁻¹ A_LR`.
    to_ports: Mat<f64>,
    from_ports: Mat<f64>,
    /// Receptance of R with L free to slip.
    ports: Mat<f64>,
    /// Tangent of the contacts with the next sector.
    between: Mat<f64>,
    /// Coupling Z to the next sector on the interface, and its transpose, in real form.
    link: [Mat<f64>; 2],
}

impl RingNewton {
    /// Factors the system at the tangents of the laws; `points` are the points of each contact.
    pub(super) fn new(
        orders: &[RingOrder],
        harmonics: &Harmonics,
        layout: &RingLayout,
        loads: &[SlipLoad],
        points: &[Range<usize>],
    ) -> Self {
        let slots = harmonics.slots();
        let count = orders.first().map_or(0, RingOrder::sectors);
        let local: Vec<usize> =
            (0..layout.contacts).filter(|c| !layout.between.contains(c)).collect();
        let rest: Vec<usize> =
            layout.between.iter().copied().chain(layout.contacts..layout.ports()).collect();
        let expansion = Expansion { orders, harmonics };
        let tangents = tangents(layout, slots, count, loads, points);
        let sectors: Vec<Sector> = (0..count)
            .map(|i| {
                let tangent = picked(&tangents[i], &local, slots);
                let mut ports = expansion.receptance(i, &rest, &rest);
                let mut from_ports = expansion.receptance(i, &local, &rest);
                let to_ports = expansion.receptance(i, &rest, &local);
                let slip = (tangent.norm_max() > 0.0).then(|| {
                    let inside = expansion.receptance(i, &local, &local);
                    let size = inside.nrows();
                    let lu =
                        (Mat::<f64>::identity(size, size) - inside * &tangent).partial_piv_lu();
                    lu.solve_in_place(&mut from_ports);
                    ports += &to_ports * (&tangent * &from_ports);
                    (lu, tangent)
                });
                let between = picked(&tangents[i], &layout.between, slots);
                Sector { slip, to_ports, from_ports, ports, between, link: expansion.link(i) }
            })
            .collect();
        let reach = layout.between.len() * slots;
        let ends = [reach, 2 * reach, rest.len() * slots];
        let rows = (0..count).map(|i| {
            let before = &sectors[(i + count - 1) % count];
            sectors[i].row(before, ends)
        });
        let chain = CyclicTridiagonal::new(rows.collect(), ends[2]);
        Self { slots, layout: layout.clone(), local, ends, sectors, chain }
    }

    /// Solves `(I − G ∂Q) step = rhs`, both laid out as the unknowns of all points.
    pub(super) fn solve(&self, rhs: &[f64], step: &mut [f64]) {
        let (count, per) = (self.sectors.len(), self.layout.contacts * self.slots);
        let [reach, middle, total] = self.ends;
        let given = |i: usize, which: &[usize]| {
            let own = &rhs[i * per..(i + 1) * per];
            Mat::from_fn(which.len() * self.slots, 1, |at, _| {
                own[which[at / self.slots] * self.slots + at % self.slots]
            })
        };
        let mut right = Mat::<f64>::zeros(count * total, 1);
        let mut inside = Vec::with_capacity(count);
        for (i, sector) in self.sectors.iter().enumerate() {
            let before = (i + count - 1) % count;
            let mut own = given(i, &self.local);
            let mut part = right.get_mut(i * total..(i + 1) * total, ..);
            if let Some((lu, tangent)) = &sector.slip {
                lu.solve_in_place(&mut own);
                part += &sector.to_ports * (tangent * &own);
            }
            inside.push(own);
            let force = self.slip_force(
                i,
                before,
                given(i, &self.layout.between),
                given(before, &self.layout.between),
            );
            part += sector.ports.get(.., ..middle) * force;
        }
        let mut solved: Vec<f64> = (0..count * total).map(|i| right[(i, 0)]).collect();
        self.chain.solve(&mut solved);
        let ports = MatRef::from_column_major_slice(&solved, count * total, 1);
        let port = |i: usize, range: Range<usize>| {
            ports.get(i * total + range.start..i * total + range.end, ..)
        };
        let relative = |i: usize| {
            given(i, &self.layout.between)
                + port(i, 0..reach)
                + port((i + 1) % count, reach..middle)
        };
        for (i, sector) in self.sectors.iter().enumerate() {
            let (before, next) = ((i + count - 1) % count, (i + 1) % count);
            let mut force = Mat::<f64>::zeros(total, 1);
            let slip = self.slip_force(i, before, relative(i), relative(before));
            force.get_mut(..middle, ..).copy_from(slip);
            let coupling = &sector.link[0] * port(next, middle..total)
                + &self.sectors[before].link[1] * port(before, middle..total);
            force.get_mut(middle.., ..).copy_from(-coupling);
            let moved = &inside[i] + &sector.from_ports * force;
            let out = &mut step[i * per..(i + 1) * per];
            for (which, values) in [(&self.local, moved), (&self.layout.between, relative(i))] {
                for (at, contact) in which.iter().enumerate() {
                    for slot in 0..self.slots {
                        out[contact * self.slots + slot] = values[(at * self.slots + slot, 0)];
                    }
                }
            }
        }
    }

    /// Slip loads that relative displacements cause at a sector's contacts with the next one and
    /// at those of the sector before.
    fn slip_force(&self, i: usize, before: usize, own: Mat<f64>, behind: Mat<f64>) -> Mat<f64> {
        let [reach, middle, _] = self.ends;
        let mut force = Mat::<f64>::zeros(middle, 1);
        if reach > 0 {
            force.get_mut(..reach, ..).copy_from(&self.sectors[i].between * own);
            force.get_mut(reach.., ..).copy_from(&self.sectors[before].between * behind);
        }
        force
    }
}

impl Sector {
    /// Block row of the ports R: `z = e + A F` with slip loads `T (o_i + w_{i+1})` and
    /// `T' (o_{i−1} + w_i)`, and coupling forces `−(Z y_{i+1} + Z'ᵀ y_{i−1})`.
    fn row(&self, before: &Self, [reach, middle, total]: [usize; 3]) -> BlockRow {
        let own_slip = self.ports.get(.., ..reach) * &self.between;
        let behind_slip = self.ports.get(.., reach..middle) * &before.between;
        let coupling = self.ports.get(.., middle..);
        let zero = Mat::<f64>::zeros(total, total);
        let (mut lower, mut own, mut upper) =
            (zero.clone(), Mat::<f64>::identity(total, total), zero);
        own.get_mut(.., ..reach).sub_assign(&own_slip);
        own.get_mut(.., reach..middle).sub_assign(&behind_slip);
        upper.get_mut(.., reach..middle).sub_assign(&own_slip);
        upper.get_mut(.., middle..).add_assign(coupling * &self.link[0]);
        lower.get_mut(.., ..reach).sub_assign(&behind_slip);
        lower.get_mut(.., middle..).add_assign(coupling * &before.link[1]);
        let [lower, own, upper] = [lower, own, upper].map(|matrix| row_major(&matrix));
        BlockRow { lower, own, upper }
    }
}

/// Complex matrices of all harmonics as real ones on the coefficients of series.
struct Expansion<'a> {
    orders: &'a [RingOrder],
    harmonics: &'a Harmonics,
}

impl Expansion<'_> {
    /// Receptance of a sector between some of its ports.
    fn receptance(&self, sector: usize, rows: &[usize], columns: &[usize]) -> Mat<f64> {
        self.expand(rows.len(), columns.len(), |order, i, j| {
            let contact = &order.sector(sector).contact;
            let ports = order.ports();
            contact[columns[j] * ports + rows[i]]
        })
    }

    /// Coupling to the next sector, and its transpose.
    fn link(&self, sector: usize) -> [Mat<f64>; 2] {
        let size = self.orders.first().map_or(0, |order| order.link(sector).nrows());
        [
            self.expand(size, size, |order, i, j| order.link(sector)[(i, j)]),
            self.expand(size, size, |order, i, j| order.link(sector)[(j, i)]),
        ]
    }

    fn expand(
        &self,
        rows: usize,
        columns: usize,
        of: impl Fn(&RingOrder, usize, usize) -> faer::c64,
    ) -> Mat<f64> {
        let slots = self.harmonics.slots();
        let mut matrix = Mat::<f64>::zeros(rows * slots, columns * slots);
        for (order, k) in self.orders.iter().zip(self.harmonics.orders()) {
            let Some(slot) = self.harmonics.slot(k) else { continue };
            for j in 0..columns {
                for i in 0..rows {
                    let g = of(order, i, j);
                    let (row, column) = (i * slots + slot, j * slots + slot);
                    matrix[(row, column)] = g.re;
                    if k > 0 {
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
}

/// Tangents of all laws of each sector, on the coefficients of its points.
fn tangents(
    layout: &RingLayout,
    slots: usize,
    count: usize,
    loads: &[SlipLoad],
    points: &[Range<usize>],
) -> Vec<Mat<f64>> {
    let size = layout.contacts * slots;
    let mut tangents = vec![Mat::<f64>::zeros(size, size); count];
    for (load, points) in loads.iter().zip(points) {
        if !load.active || layout.contacts == 0 {
            continue;
        }
        let (sector, first) = (points.start / layout.contacts, points.start % layout.contacts);
        let width = points.len() * slots;
        for (i, row) in load.tangent.chunks_exact(width).enumerate() {
            for (j, value) in row.iter().enumerate() {
                tangents[sector][(first * slots + i, first * slots + j)] = *value;
            }
        }
    }
    tangents
}

/// The part of a tangent that belongs to some points.
fn picked(tangent: &Mat<f64>, which: &[usize], slots: usize) -> Mat<f64> {
    let at = |i: usize| which[i / slots] * slots + i % slots;
    Mat::from_fn(which.len() * slots, which.len() * slots, |i, j| tangent[(at(i), at(j))])
}

fn row_major(matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.nrows())
        .flat_map(|i| (0..matrix.ncols()).map(move |j| (i, j)))
        .map(|at| matrix[at])
        .collect()
}
