//! Newton directions of a ring of sectors, at an effort that grows with the number of sectors.
//!
//! The slip loads of a contact act on its own sector (and, between neighbours, on the next one),
//! so that `s = r + G ∂Q s` needs no dense G: contacts inside a sector are eliminated in it, and
//! what is left couples neighbours alone, harmonic by harmonic mixed by the tangents.
//!
//! With the receptance A of a sector and the tangent T of the contacts L inside it, the
//! elimination takes one dense solution, `W = (I − T A_LL)⁻¹ T`: the receptance of the other ports
//! R becomes `A_RR + A_RL W A_LR`, and `(I − A_LL T)⁻¹ = I + A_LL W`. Receptances never mix
//! harmonics, so that products with them are cheap.

use super::series::{Part, RingSeries};
use crate::contact::SlipLoad;
use crate::solve::{Block, BlockFactors, BlockRow, CyclicTridiagonal};
use crate::structure::{Ring, RingLayout};
use std::ops::Range;

/// Factors of `I − G ∂Q` for a ring.
pub(crate) struct RingNewton {
    slots: usize,
    layout: RingLayout,
    /// Contacts inside a sector.
    local: Vec<usize>,
    /// A sector's other ports R: its contacts with the next sector, those of the sector before,
    /// the interface.
    rest: Vec<usize>,
    /// Where the three parts of R end.
    ends: [usize; 3],
    sectors: Vec<Sector>,
    chain: CyclicTridiagonal,
}

/// One sector with the contacts L inside it eliminated; R are its other ports.
struct Sector {
    /// W, if any of L slips.
    slip: Option<Block>,
    /// Receptance of R with L free to slip.
    ports: Block,
    /// Tangent of the contacts with the next sector.
    between: Block,
}

impl RingNewton {
    /// Whether to eliminate sector after sector is less work than to solve in the slip loads of the
    /// points that yield, with what a load at each of them moves.
    pub(crate) fn suits(ring: &Ring, slots: usize, active: usize) -> bool {
        let [eliminated, answers] = Self::efforts(ring, slots as f64, active as f64);
        eliminated < answers
    }

    /// About the time of a Newton step, as measured \[ns\].
    pub(crate) fn effort(ring: &Ring, slots: f64, active: f64) -> f64 {
        let [eliminated, answers] = Self::efforts(ring, slots, active);
        eliminated.min(answers)
    }

    fn efforts(ring: &Ring, slots: f64, active: f64) -> [f64; 2] {
        let (sectors, ports) = (ring.sectors() as f64, ring.layout().ports() as f64);
        let answers = active * sectors * slots * (20.0 + 5.0 * ports.powi(2));
        [
            sectors * (800.0 + 0.2 * (ports * slots).powi(3)),
            1e3 + answers + 0.06 * (active * slots).powi(3),
        ]
    }

    /// Factors the system at the tangents of the laws; `points` are the points of each contact.
    pub(crate) fn new(
        series: RingSeries<'_>,
        layout: &RingLayout,
        loads: &[SlipLoad],
        points: &[Range<usize>],
    ) -> Self {
        let (slots, count) = (series.slots(), series.sectors());
        let local: Vec<usize> =
            (0..layout.contacts).filter(|c| !layout.between.contains(c)).collect();
        let rest: Vec<usize> =
            layout.between.iter().copied().chain(layout.contacts..layout.ports()).collect();
        let reach = layout.between.len() * slots;
        let ends = [reach, 2 * reach, rest.len() * slots];
        let mut laws = loads.iter().zip(points).peekable();
        let sectors: Vec<Sector> = (0..count)
            .map(|i| {
                let own = i * layout.contacts..(i + 1) * layout.contacts;
                let mut tangents = Vec::new();
                while let Some(law) = laws.next_if(|(_, points)| points.end <= own.end) {
                    tangents.push(law);
                }
                let mut ports = series.receptance(i, &rest, &rest);
                let slip = tangent(&tangents, own.start, &local, slots).map(|tangent| {
                    let inside = Part { sector: i, rows: &local, columns: &local };
                    let mut matrix = Block::identity(tangent.rows());
                    series.subtract_product_right(&tangent, inside, &mut matrix);
                    let mut slip = tangent;
                    BlockFactors::new(matrix).solve(&mut slip);
                    let from = Part { sector: i, rows: &local, columns: &rest };
                    let to = Part { sector: i, rows: &rest, columns: &local };
                    // Twice subtracted is added.
                    let mut moved = Block::zeros(slip.rows(), ports.columns());
                    series.subtract_product_right(&slip, from, &mut moved);
                    series.subtract_product_left(to, &moved, &mut ports);
                    slip
                });
                let between = tangent(&tangents, own.start, &layout.between, slots);
                let between = between.unwrap_or_else(|| Block::zeros(reach, reach));
                Sector { slip, ports, between }
            })
            .collect();
        let rows = (0..count)
            .map(|i| {
                let before = (i + count - 1) % count;
                sectors[i].row(series, [before, i], &sectors[before].between, ends)
            })
            .collect();
        let chain = CyclicTridiagonal::new(rows);
        Self { slots, layout: layout.clone(), local, rest, ends, sectors, chain }
    }

    /// Solves `(I − G ∂Q) step = rhs`, both laid out as the unknowns of all points.
    pub(crate) fn solve(&self, series: RingSeries<'_>, rhs: &[f64], step: &mut [f64]) {
        let count = self.sectors.len();
        let [reach, middle, total] = self.ends;
        let (local, rest) = (&self.local, &self.rest);
        let mut ports = vec![0.0; count * total];
        let mut slip = vec![0.0; local.len() * self.slots];
        let mut force = vec![0.0; total];
        for (i, sector) in self.sectors.iter().enumerate() {
            let part = &mut ports[i * total..(i + 1) * total];
            if let Some(w) = &sector.slip {
                slip.fill(0.0);
                w.subtract_from(&self.given(rhs, i, local), &mut slip);
                series.subtract_from(Part { sector: i, rows: rest, columns: local }, &slip, part);
            }
            if reach > 0 {
                let before = (i + count - 1) % count;
                let between = &self.layout.between;
                let moved = [self.given(rhs, i, between), self.given(rhs, before, between)];
                force.fill(0.0);
                self.subtract_slip([i, before], &moved, &mut force);
                sector.ports.subtract_from(&force, part);
            }
        }
        self.chain.solve(&mut ports);
        let port =
            |i: usize, range: Range<usize>| &ports[i * total + range.start..i * total + range.end];
        let relative = |i: usize| -> Vec<f64> {
            let (own, next) = (port(i, 0..reach), port((i + 1) % count, reach..middle));
            let moved = self.given(rhs, i, &self.layout.between);
            moved.iter().zip(own).zip(next).map(|((r, o), w)| r + o + w).collect()
        };
        let per = self.layout.contacts * self.slots;
        for (i, sector) in self.sectors.iter().enumerate() {
            let (before, next) = ((i + count - 1) % count, (i + 1) % count);
            let moved = relative(i);
            // Minus the forces on R.
            force.fill(0.0);
            if reach > 0 {
                let both = [moved.clone(), relative(before)];
                self.subtract_slip([i, before], &both, &mut force);
            }
            series.add_link(i, false, port(next, middle..total), &mut force[middle..]);
            series.add_link(before, true, port(before, middle..total), &mut force[middle..]);
            let mut inside = self.given(rhs, i, local);
            let from = Part { sector: i, rows: local, columns: rest };
            series.subtract_from(from, &force, &mut inside);
            if let Some(w) = &sector.slip {
                slip.fill(0.0);
                w.subtract_from(&inside, &mut slip);
                let own = Part { sector: i, rows: local, columns: local };
                series.subtract_from(own, &slip, &mut inside);
            }
            let out = &mut step[i * per..(i + 1) * per];
            for (which, values) in [(local, &inside), (&self.layout.between, &moved)] {
                for (contact, values) in which.iter().zip(values.chunks_exact(self.slots)) {
                    out[contact * self.slots..(contact + 1) * self.slots].copy_from_slice(values);
                }
            }
        }
    }

    /// The part of the unknowns that belongs to some contacts of a sector.
    fn given(&self, values: &[f64], sector: usize, which: &[usize]) -> Vec<f64> {
        let per = self.layout.contacts * self.slots;
        let own = &values[sector * per..(sector + 1) * per];
        let mut part = Vec::with_capacity(which.len() * self.slots);
        which.iter().for_each(|c| part.extend_from_slice(&own[c * self.slots..][..self.slots]));
        part
    }

    /// Subtracts the slip loads that relative displacements cause at a sector's contacts with the
    /// next one and at those of the sector before.
    fn subtract_slip(&self, sectors: [usize; 2], moved: &[Vec<f64>; 2], force: &mut [f64]) {
        let [reach, middle, _] = self.ends;
        self.sectors[sectors[0]].between.subtract_from(&moved[0], &mut force[..reach]);
        self.sectors[sectors[1]].between.subtract_from(&moved[1], &mut force[reach..middle]);
    }
}

impl Sector {
    /// Block row of the ports R: `z = e + A F` with slip loads `T (o_i + w_{i+1})` and
    /// `T' (o_{i−1} + w_i)`, and coupling forces `−(Z y_{i+1} + Z'ᵀ y_{i−1})`.
    fn row(
        &self,
        series: RingSeries<'_>,
        [before, own]: [usize; 2],
        between_before: &Block,
        [reach, middle, total]: [usize; 3],
    ) -> BlockRow {
        let mut row = BlockRow {
            lower: Block::zeros(total, total),
            own: Block::identity(total),
            upper: Block::zeros(total, total),
        };
        if reach > 0 {
            let own_slip = Block::minus_product(&self.ports.column_part(0..reach), &self.between);
            let behind = self.ports.column_part(reach..middle);
            let behind_slip = Block::minus_product(&behind, between_before);
            row.own.add_columns(0, &own_slip);
            row.own.add_columns(reach, &behind_slip);
            row.upper.add_columns(reach, &own_slip);
            row.lower.add_columns(0, &behind_slip);
        }
        series.add_product_link(&self.ports, middle, own, false, &mut row.upper);
        series.add_product_link(&self.ports, middle, before, true, &mut row.lower);
        row
    }
}

/// Tangents of a sector's laws on the coefficients of some of its points, whose first one is
/// `first`; `None` if they are zero.
fn tangent(
    laws: &[(&SlipLoad, &Range<usize>)],
    first: usize,
    which: &[usize],
    slots: usize,
) -> Option<Block> {
    let place = |point: usize| which.iter().position(|&c| c + first == point);
    let mut block: Option<Block> = None;
    for (load, points) in laws.iter().filter(|(load, _)| load.active) {
        let size = which.len() * slots;
        for (local, row) in (*points).clone().enumerate() {
            let Some(to_row) = place(row) else { continue };
            let block = block.get_or_insert_with(|| Block::zeros(size, size));
            for (other, column) in (*points).clone().enumerate() {
                let Some(to_column) = place(column) else { continue };
                for slot in 0..slots {
                    let from = (local * slots + slot) * points.len() * slots + other * slots;
                    block.row_mut(to_row * slots + slot)[to_column * slots..][..slots]
                        .copy_from_slice(&load.tangent[from..from + slots]);
                }
            }
        }
    }
    block
}
