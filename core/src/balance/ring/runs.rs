//! Runs of sectors that stick, between those of a ring that slip or reach a contact that does.
//!
//! A sector that sticks mixes no harmonics: of a ring that is coupled through one degree of freedom, complex
//! numbers eliminate it, harmonic by harmonic, and blocks of all harmonics are left to those that slip.

use super::series::RingSeries;
use crate::structure::{RingLayout, RingOrder};
use faer::c64;

/// Sectors that stick and follow one another, without a load of their own: the motion y of the interface is
/// linear in that of the sectors p and q at the two ends.
pub(super) struct Run {
    first: usize,
    length: usize,
    /// `y = c y_p + d y_next` of a sector; harmonic after harmonic, sector after sector.
    inside: Vec<[c64; 2]>,
    /// `[a, b, c, d]` of a harmonic: `a y_p + b y_q` of the first sector and `c y_p + d y_q` of the last one.
    ends: Vec<[c64; 4]>,
}

/// What the interface of a sector's two neighbours does to it, by its own motion and by those of the sectors
/// that are left on both sides: `own y + ahead y_q + behind y_o`, coupling included.
pub(super) struct Neighbours {
    pub(super) own: c64,
    pub(super) ahead: c64,
    pub(super) behind: c64,
}

impl Run {
    /// Whether a ring has runs.
    pub(super) fn suits(layout: &RingLayout) -> bool {
        layout.interface.len() == 1
    }

    /// Runs behind each of the sectors that are left, in ascending order.
    pub(super) fn behind(series: RingSeries<'_>, layout: &RingLayout, left: &[usize]) -> Vec<Self> {
        let count = series.sectors();
        let next = |at: usize| left[(at + 1) % left.len()];
        let length = |at: usize| (next(at) + count - left[at] - 1) % count;
        (0..left.len())
            .map(|at| Self::new(series, layout, (left[at] + 1) % count, length(at)))
            .collect()
    }

    fn new(series: RingSeries<'_>, layout: &RingLayout, first: usize, length: usize) -> Self {
        let count = series.sectors();
        let (zero, one) = (c64::new(0.0, 0.0), c64::new(1.0, 0.0));
        let (ports, at) = (layout.ports(), layout.first_interface());
        let mut run = Self { first, length, inside: Vec::new(), ends: Vec::new() };
        for (order, ..) in series.slot() {
            // Without a sector the two ends are each other's neighbours.
            let [mut a, mut b, mut c, mut d] = [zero, one, one, zero];
            for sector in (first..first + length).map(|sector| sector % count) {
                let own = order.sector(sector)[at * ports + at];
                let before = own * coupling(order, (sector + count - 1) % count);
                let pivot = (one + before * d).inv();
                (c, d) = (-(pivot * before * c), -(pivot * own * coupling(order, sector)));
                (a, b) = (a + b * c, b * d);
                run.inside.push([c, d]);
            }
            run.ends.push([a, b, c, d]);
        }
        run
    }

    /// What is beside a sector at a harmonic, between the runs before and behind it.
    pub(super) fn beside(
        [before, behind]: [&Self; 2],
        harmonic: usize,
        [to_before, to_next]: [c64; 2],
    ) -> Neighbours {
        let ([a, b, ..], [_, _, c, d]) = (behind.ends[harmonic], before.ends[harmonic]);
        Neighbours { own: to_next * a + to_before * d, ahead: to_next * b, behind: to_before * c }
    }

    /// The sectors of the run.
    pub(super) fn sectors(&self, count: usize) -> impl Iterator<Item = usize> {
        (self.first..self.first + self.length).map(move |sector| sector % count)
    }

    /// Writes the motion of the interface of the run's sectors; that of sector i begins at `place(i)`.
    pub(super) fn fill(
        &self,
        series: RingSeries<'_>,
        place: impl Fn(usize) -> usize,
        motion: &mut [f64],
    ) {
        let count = series.sectors();
        let read = |motion: &[f64], at: usize, oscillates: bool| {
            c64::new(motion[at], if oscillates { -motion[at + 1] } else { 0.0 })
        };
        let before = place((self.first + count - 1) % count);
        let behind = place((self.first + self.length) % count);
        let inside = self.inside.chunks_exact(self.length.max(1));
        for (inside, (_, slot, oscillates)) in inside.zip(series.slot()) {
            let start = read(motion, before + slot, oscillates);
            let mut next = read(motion, behind + slot, oscillates);
            for (index, [c, d]) in inside.iter().enumerate().rev() {
                next = c * start + d * next;
                let at = place((self.first + index) % count) + slot;
                motion[at] = next.re;
                if oscillates {
                    motion[at + 1] = -next.im;
                }
            }
        }
    }
}

/// Coupling of a sector to the next one.
pub(super) fn coupling(order: &RingOrder, sector: usize) -> c64 {
    order.link(sector)[(0, 0)]
}
