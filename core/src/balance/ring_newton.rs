//! Newton directions of a ring of sectors, at an effort that grows with the number of sectors.
//!
//! The slip loads of a contact act on its own sector (and, between neighbours, on the next one),
//! so that `s = r + G ∂Q s` needs no dense G: contacts inside a sector are eliminated in it, and
//! what is left couples neighbours alone, harmonic by harmonic mixed by the tangents.

use crate::contact::SlipLoad;
use crate::fourier::Harmonics;
use crate::solve::{Block, BlockFactors, BlockRow, CyclicTridiagonal};
use crate::structure::{RingLayout, RingOrder};
use std::ops::Range;

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
    slip: Option<(BlockFactors, Block)>,
    /// A_RL, and `(I − A_LL T_L)⁻¹ A_LR`.
    to_ports: Block,
    from_ports: Block,
    /// Receptance of R with L free to slip.
    ports: Block,
    /// Tangent of the contacts with the next sector.
    between: Block,
    /// Coupling −Z to the next sector on the interface, and its transpose, in real form.
    link: [Block; 2],
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
                let slip = (!tangent.is_zero()).then(|| {
                    let inside = expansion.receptance(i, &local, &local);
                    let mut matrix = Block::identity(inside.rows());
                    matrix.subtract_product(&inside, &tangent);
                    let factors = BlockFactors::new(matrix);
                    factors.solve(&mut from_ports);
                    let slip_load = Block::minus_product(&tangent, &from_ports);
                    ports.subtract_product(&to_ports, &slip_load);
                    (factors, tangent)
                });
                let between = picked(&tangents[i], &layout.between, slots);
                Sector { slip, to_ports, from_ports, ports, between, link: expansion.link(i) }
            })
            .collect();
        let reach = layout.between.len() * slots;
        let ends = [reach, 2 * reach, rest.len() * slots];
        let rows: Vec<BlockRow> =
            (0..count).map(|i| sectors[i].row(&sectors[(i + count - 1) % count], ends)).collect();
        let chain = CyclicTridiagonal::new(&rows);
        Self { slots, layout: layout.clone(), local, ends, sectors, chain }
    }

    /// Solves `(I − G ∂Q) step = rhs`, both laid out as the unknowns of all points.
    pub(super) fn solve(&self, rhs: &[f64], step: &mut [f64]) {
        let (count, per) = (self.sectors.len(), self.layout.contacts * self.slots);
        let [reach, middle, total] = self.ends;
        let given = |i: usize, which: &[usize]| -> Vec<f64> {
            let own = &rhs[i * per..(i + 1) * per];
            which.iter().flat_map(|c| own[c * self.slots..(c + 1) * self.slots].to_vec()).collect()
        };
        let mut ports = vec![0.0; count * total];
        let mut inside = Vec::with_capacity(count);
        for (i, sector) in self.sectors.iter().enumerate() {
            let before = (i + count - 1) % count;
            let mut own = given(i, &self.local);
            let part = &mut ports[i * total..(i + 1) * total];
            if let Some((factors, tangent)) = &sector.slip {
                factors.solve_vector(&mut own);
                let mut slip_load = vec![0.0; own.len()];
                tangent.subtract_from(&own, &mut slip_load);
                sector.to_ports.subtract_from(&slip_load, part);
            }
            inside.push(own);
            if reach > 0 {
                let between = &self.layout.between;
                let mut force = vec![0.0; total];
                self.subtract_slip(
                    i,
                    before,
                    &given(i, between),
                    &given(before, between),
                    &mut force,
                );
                sector.ports.subtract_from(&force, part);
            }
        }
        self.chain.solve(&mut ports);
        let port =
            |i: usize, range: Range<usize>| &ports[i * total + range.start..i * total + range.end];
        let relative = |i: usize| -> Vec<f64> {
            let (own, next) = (port(i, 0..reach), port((i + 1) % count, reach..middle));
            let moved = given(i, &self.layout.between);
            moved.iter().zip(own).zip(next).map(|((r, o), w)| r + o + w).collect()
        };
        for (i, sector) in self.sectors.iter().enumerate() {
            let (before, next) = ((i + count - 1) % count, (i + 1) % count);
            let moved = relative(i);
            // Minus the forces on R.
            let mut force = vec![0.0; total];
            if reach > 0 {
                self.subtract_slip(i, before, &moved, &relative(before), &mut force);
            }
            sector.link[0].subtract_from(port(next, middle..total), &mut force[middle..]);
            let behind = &self.sectors[before].link[1];
            behind.subtract_from(port(before, middle..total), &mut force[middle..]);
            sector.from_ports.subtract_from(&force, &mut inside[i]);
            let out = &mut step[i * per..(i + 1) * per];
            for (which, values) in [(&self.local, &inside[i]), (&self.layout.between, &moved)] {
                for (contact, values) in which.iter().zip(values.chunks_exact(self.slots)) {
                    out[contact * self.slots..(contact + 1) * self.slots].copy_from_slice(values);
                }
            }
        }
    }

    /// Subtracts the slip loads that relative displacements cause at a sector's contacts with the
    /// next one and at those of the sector before.
    fn subtract_slip(
        &self,
        i: usize,
        before: usize,
        own: &[f64],
        behind: &[f64],
        force: &mut [f64],
    ) {
        let [reach, middle, _] = self.ends;
        self.sectors[i].between.subtract_from(own, &mut force[..reach]);
        self.sectors[before].between.subtract_from(behind, &mut force[reach..middle]);
    }
}

impl Sector {
    /// Block row of the ports R: `z = e + A F` with slip loads `T (o_i + w_{i+1})` and
    /// `T' (o_{i−1} + w_i)`, and coupling forces `−(Z y_{i+1} + Z'ᵀ y_{i−1})`.
    fn row(&self, before: &Self, [reach, middle, total]: [usize; 3]) -> BlockRow {
        let (mut lower, mut own, mut upper) =
            (Block::zeros(total, total), Block::identity(total), Block::zeros(total, total));
        if reach > 0 {
            let own_slip = Block::minus_product(&self.ports.column_part(0..reach), &self.between);
            let behind_slip =
                Block::minus_product(&self.ports.column_part(reach..middle), &before.between);
            own.add_columns(0, &own_slip);
            own.add_columns(reach, &behind_slip);
            upper.add_columns(reach, &own_slip);
            lower.add_columns(0, &behind_slip);
        }
        let coupling = self.ports.column_part(middle..total);
        upper.add_columns(middle, &Block::minus_product(&coupling, &self.link[0]));
        lower.add_columns(middle, &Block::minus_product(&coupling, &before.link[1]));
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
    fn receptance(&self, sector: usize, rows: &[usize], columns: &[usize]) -> Block {
        self.expand(rows.len(), columns.len(), |order, i, j| {
            let contact = &order.sector(sector).contact;
            let ports = order.ports();
            contact[columns[j] * ports + rows[i]]
        })
    }

    /// Minus the coupling to the next sector, and its transpose.
    fn link(&self, sector: usize) -> [Block; 2] {
        let size = self.orders.first().map_or(0, |order| order.link(sector).nrows());
        [
            self.expand(size, size, |order, i, j| -order.link(sector)[(i, j)]),
            self.expand(size, size, |order, i, j| -order.link(sector)[(j, i)]),
        ]
    }

    fn expand(
        &self,
        rows: usize,
        columns: usize,
        of: impl Fn(&RingOrder, usize, usize) -> faer::c64,
    ) -> Block {
        let slots = self.harmonics.slots();
        let mut matrix = Block::zeros(rows * slots, columns * slots);
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
) -> Vec<Block> {
    let size = layout.contacts * slots;
    let mut tangents = vec![Block::zeros(size, size); count];
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
fn picked(tangent: &Block, which: &[usize], slots: usize) -> Block {
    let size = which.len() * slots;
    let at = |i: usize| which[i / slots] * slots + i % slots;
    let mut part = Block::zeros(size, size);
    for i in 0..size {
        for j in 0..size {
            part[(i, j)] = tangent[(at(i), at(j))];
        }
    }
    part
}
