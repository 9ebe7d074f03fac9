//! Newton directions of a ring of sectors, at an effort that grows with the number of sectors.
//!
//! The slip loads of a contact act on its own sector (and, between neighbours, on the next one),
//! so that `s = r + G ∂Q s` needs no dense G: contacts inside a sector are eliminated in it, and
//! what is left couples neighbours alone, harmonic by harmonic mixed by the tangents. Sectors that stick
//! mix none, and runs of them take complex numbers (`runs.rs`).
//!
//! With the receptance A of a sector and the tangent T of the contacts L inside it, the
//! elimination takes one dense solution, `W = (I − T A_LL)⁻¹ T`: the receptance of the other ports
//! R becomes `A_RR + A_RL W A_LR`, and `(I − A_LL T)⁻¹ = I + A_LL W`. Receptances never mix
//! harmonics, so that products with them are cheap.

use super::runs::{coupling, Run};
use super::series::{link, Part, RingSeries};
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
    /// The sectors that the chain is of, ascending: all but those of runs that stick.
    left: Vec<usize>,
    /// Behind each of them, if there are runs.
    runs: Vec<Run>,
    chain: CyclicTridiagonal,
}

/// One sector with the contacts L inside it eliminated; R are its other ports.
struct Sector {
    /// W, if any of L slips.
    slip: Option<Block>,
    /// Receptance of R with L free to slip; nothing of a sector in a run.
    ports: Block,
    /// Tangent of the contacts with the next sector, if any slips.
    between: Option<Block>,
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

    /// Of elimination sector after sector, and of answers to loads at single points: fits to measured times.
    fn efforts(ring: &Ring, slots: f64, active: f64) -> [f64; 2] {
        let (layout, sectors) = (ring.layout(), ring.sectors() as f64);
        let [between, interface] = [&layout.between, &layout.interface].map(|of| of.len() as f64);
        let [inside, rest] = [layout.contacts as f64 - between, 2.0 * between + interface];
        let (inside, rest, unknowns) = (inside * slots, rest * slots, active * slots);
        let slipping = (active / layout.contacts as f64).min(sectors);
        let (left, runs) = if Run::suits(layout) {
            // A contact with the next sector has two of them left.
            let reach = if between > 0.0 { 2.0 } else { 1.0 };
            ((reach * active).min(sectors), sectors * (100.0 + 5.0 * slots))
        } else {
            (sectors, 0.0)
        };
        let row = 330.0 + 85.0 * (inside + rest) + 0.35 * rest.powi(3);
        let of_sector = 2.5 * layout.ports() as f64 + interface * (22.0 + 2.3 * interface);
        let answer = 90.0 + sectors * of_sector;
        [
            left * row + slipping * 0.2 * inside.powi(3) + runs,
            600.0 + unknowns * (answer + 2.0 * unknowns + 0.01 * unknowns.powi(2)),
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
        let mut sectors: Vec<Sector> = (0..count)
            .map(|i| {
                let own = i * layout.contacts..(i + 1) * layout.contacts;
                let mut tangents = Vec::new();
                while let Some(law) = laws.next_if(|(_, points)| points.end <= own.end) {
                    tangents.push(law);
                }
                let of = |which: &[usize]| tangent(&tangents, own.start, which, slots);
                Sector { slip: of(&local), ports: Block::default(), between: of(&layout.between) }
            })
            .collect();
        let slips = |i: usize| sectors[i].slip.is_some() || sectors[i].between.is_some();
        let reached = |i: usize| sectors[(i + count - 1) % count].between.is_some();
        let mut left: Vec<usize> = (0..count).filter(|&i| slips(i) || reached(i)).collect();
        let has_runs = Run::suits(layout) && !left.is_empty();
        if !has_runs {
            left = (0..count).collect();
        }
        for &i in &left {
            sectors[i].eliminate(series, i, [&local, &rest]);
        }
        let runs = if has_runs { Run::behind(series, layout, &left) } else { Vec::new() };
        let rows = (0..left.len())
            .map(|at| {
                let (own, before) = (left[at], (left[at] + count - 1) % count);
                let between_before = sectors[before].between.as_ref();
                let mut row = sectors[own].row(between_before, ends);
                let (middle, ports) = (ends[1], &sectors[own].ports);
                if has_runs {
                    let both = [&runs[(at + left.len() - 1) % left.len()], &runs[at]];
                    let beside = |index, order: &_| {
                        Run::beside(both, index, [before, own].map(|i| coupling(order, i)))
                    };
                    let (upper, lower) = (&mut row.upper, &mut row.lower);
                    let own = |k, order: &_, _, _| beside(k, order).own;
                    series.add_product_link(ports, middle, own, &mut row.own);
                    let ahead = |k, order: &_, _, _| beside(k, order).ahead;
                    series.add_product_link(ports, middle, ahead, upper);
                    let behind = |k, order: &_, _, _| beside(k, order).behind;
                    series.add_product_link(ports, middle, behind, lower);
                } else {
                    let ahead = |_, order: &_, a, b| link(order, own, false, a, b);
                    series.add_product_link(ports, middle, ahead, &mut row.upper);
                    let behind = |_, order: &_, a, b| link(order, before, true, a, b);
                    series.add_product_link(ports, middle, behind, &mut row.lower);
                }
                row
            })
            .collect();
        let chain = CyclicTridiagonal::new(rows);
        Self { slots, layout: layout.clone(), local, rest, ends, sectors, left, runs, chain }
    }

    /// Solves `(I − G ∂Q) step = rhs`, both laid out as the unknowns of all points.
    pub(crate) fn solve(&self, series: RingSeries<'_>, rhs: &[f64], step: &mut [f64]) {
        let count = self.sectors.len();
        let [reach, middle, total] = self.ends;
        let (local, rest) = (&self.local, &self.rest);
        let mut ports = vec![0.0; count * total];
        let mut slip = vec![0.0; local.len() * self.slots];
        let mut force = vec![0.0; total];
        let mut chain = vec![0.0; self.left.len() * total];
        // Nothing loads a sector that sticks.
        for (&i, part) in self.left.iter().zip(chain.chunks_exact_mut(total.max(1))) {
            let sector = &self.sectors[i];
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
        self.chain.solve(&mut chain);
        for (&i, part) in self.left.iter().zip(chain.chunks_exact(total.max(1))) {
            ports[i * total..(i + 1) * total].copy_from_slice(part);
        }
        for run in &self.runs {
            run.fill(series, |i| i * total + middle, &mut ports);
        }
        if reach > 0 {
            let (to, from) = (&rest[..2 * self.layout.between.len()], &self.layout.interface);
            let first = self.layout.first_interface();
            let columns: Vec<usize> = (first..first + from.len()).collect();
            for i in self.runs.iter().flat_map(|run| run.sectors(count)) {
                let (before, next) = ((i + count - 1) % count, (i + 1) % count);
                let interface = |of: usize| &ports[of * total + middle..(of + 1) * total];
                force.fill(0.0);
                series.add_link(i, false, interface(next), &mut force[middle..]);
                series.add_link(before, true, interface(before), &mut force[middle..]);
                let part = &mut ports[i * total..i * total + middle];
                let between = Part { sector: i, rows: to, columns: &columns };
                series.subtract_from(between, &force[middle..], part);
            }
        }
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
        for (at, range) in [0..reach, reach..middle].into_iter().enumerate() {
            if let Some(between) = &self.sectors[sectors[at]].between {
                between.subtract_from(&moved[at], &mut force[range]);
            }
        }
    }
}

impl Sector {
    /// Eliminates the contacts L inside the sector, whose tangents are in `slip`.
    fn eliminate(&mut self, series: RingSeries<'_>, sector: usize, [local, rest]: [&[usize]; 2]) {
        self.ports = series.receptance(sector, rest, rest);
        let Some(slip) = &mut self.slip else { return };
        let inside = Part { sector, rows: local, columns: local };
        let mut matrix = Block::identity(slip.rows());
        series.subtract_product_right(slip, inside, &mut matrix);
        BlockFactors::new(matrix).solve(slip);
        let from = Part { sector, rows: local, columns: rest };
        let to = Part { sector, rows: rest, columns: local };
        // Twice subtracted is added.
        let mut moved = Block::zeros(slip.rows(), self.ports.columns());
        series.subtract_product_right(slip, from, &mut moved);
        series.subtract_product_left(to, &moved, &mut self.ports);
    }

    /// Block row of the ports R, `z = e + A F`, without the coupling of the interface: slip loads are
    /// `T (o_i + w_{i+1})` and `T' (o_{i−1} + w_i)`.
    fn row(&self, between_before: Option<&Block>, [reach, middle, total]: [usize; 3]) -> BlockRow {
        let mut row = BlockRow {
            lower: Block::zeros(total, total),
            own: Block::identity(total),
            upper: Block::zeros(total, total),
        };
        if let Some(between) = &self.between {
            let slip = Block::minus_product(&self.ports.column_part(0..reach), between);
            row.own.add_columns(0, &slip);
            row.upper.add_columns(reach, &slip);
        }
        if let Some(between) = between_before {
            let slip = Block::minus_product(&self.ports.column_part(reach..middle), between);
            row.own.add_columns(reach, &slip);
            row.lower.add_columns(0, &slip);
        }
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
