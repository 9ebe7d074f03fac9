//! A disk whose sectors differ: each sector by itself, and a ring of equations for what couples
//! neighbours.
//!
//! The sectors' own compliances come from their modes. Neighbours see each other through the few
//! DOFs of their coupling alone, so that a response of the whole disk takes one cyclic block
//! tridiagonal solution in these DOFs: the effort grows with the number of sectors.

use super::cyclic::joins_alike;
use super::flexibility::RIGID_BODY;
use super::ports::{forced_harmonics, HarmonicLoad, Ports};
use super::ring_order::{RingLayout, RingOrder, SectorReceptances};
use super::{compliance, Compliance, Outline, Receptance, Structure};
use crate::Error;
use faer::{c64, Mat, MatRef};
use std::sync::OnceLock;

/// Square of what rounding leaves of loads that are the same but for their phase, relative to them.
const ROUNDING: f64 = 1e-18;

/// What couples a sector to the next one: the blocks `A_1` of mass, damping and stiffness; the
/// force on sector i is `A_1 x_{i+1} + A_1ᵀ x_{i−1}`.
#[derive(Debug, Clone)]
pub struct RingCoupling {
    /// Mass block \[kg\].
    pub mass: Mat<f64>,
    /// Damping block [kg/s].
    pub damping: Mat<f64>,
    /// Stiffness block [N/m].
    pub stiffness: Mat<f64>,
}

/// A sector with the rows of its contacts on itself and on the next sector, and its loads.
#[derive(Debug, Clone)]
pub struct RingSector {
    /// Mass, damping and stiffness, its own share of the couplings included; proportional only if a
    /// law made the damping of the couplings too.
    pub structure: Structure,
    /// Rows of B on the sector itself, contacts × N.
    pub own: Mat<f64>,
    /// Rows on the next sector, zero for contacts inside the sector and to ground.
    pub next: Mat<f64>,
    /// Contact stiffness D of the sector's contacts [N/m].
    pub stiffness: Mat<f64>,
    /// Loads of the sector.
    pub loads: Vec<HarmonicLoad>,
}

/// The compliance of a ring of sectors.
pub struct Ring {
    parts: Vec<RingSector>,
    /// Each sector by itself, seen from its ports: its own contacts, those of the sector before
    /// that reach it, and the interface.
    pub(super) sectors: Vec<Box<dyn Compliance>>,
    coupling: RingCoupling,
    /// Stiffness on the interface by which stuck contacts couple each sector to the next one; one for all
    /// where there are none.
    contact_links: Vec<Mat<f64>>,
    pub(super) layout: RingLayout,
    /// By how much loads are ahead from sector to sector, if they travel and contacts join the same points of
    /// neighbours, and the harmonic of these loads.
    pub(super) joined_wave: Option<(usize, f64)>,
    frequencies: OnceLock<[Vec<f64>; 2]>,
    pub(super) highest: f64,
    /// Without the natural frequencies, which take a decomposition of the whole disk.
    pub(super) outline: Outline,
}

impl Ring {
    /// The ring of sectors that follow one another, the last one coupled to the first.
    ///
    /// # Errors
    /// No sector, shapes that do not fit, or a failing decomposition.
    pub fn new(parts: Vec<RingSector>, coupling: RingCoupling) -> Result<Self, Error> {
        let Some(first) = parts.first() else {
            return Err(Error::value("sectors", 0.0, "must be at least 1"));
        };
        let (dofs, contacts) = (first.structure.dofs(), first.own.nrows());
        for (index, part) in parts.iter().enumerate() {
            let expected = (dofs, contacts, dofs);
            let fits = (part.structure.dofs(), part.own.nrows(), part.own.ncols()) == expected
                && (part.next.nrows(), part.next.ncols()) == (contacts, dofs)
                && (part.stiffness.nrows(), part.stiffness.ncols()) == (contacts, contacts);
            if !fits {
                return Err(Error::shape(
                    &format!("sector {index}"),
                    format!("{dofs} DOFs and {contacts} contacts, as sector 0"),
                    format!("{} and {}", part.structure.dofs(), part.own.nrows()),
                ));
            }
        }
        let reaches =
            |c: &usize| parts.iter().any(|part| (0..dofs).any(|j| part.next[(*c, j)] != 0.0));
        let mut between: Vec<usize> = (0..contacts).filter(reaches).collect();
        // Points that a contact couples belong together.
        let coupled = |a: usize, b: usize| parts.iter().any(|part| part.stiffness[(a, b)] != 0.0);
        while let Some(more) = (0..contacts)
            .find(|c| !between.contains(c) && between.iter().any(|&other| coupled(*c, other)))
        {
            between.push(more);
        }
        between.sort_unstable();
        let mut interface: Vec<usize> = (0..dofs)
            .filter(|&i| {
                [&coupling.mass, &coupling.damping, &coupling.stiffness]
                    .iter()
                    .any(|block| (0..dofs).any(|j| block[(i, j)] != 0.0 || block[(j, i)] != 0.0))
            })
            .collect();
        // Stuck contacts between neighbours are couplings as well.
        for &c in &between {
            let touched = |j: &usize| {
                parts.iter().any(|part| part.own[(c, *j)] != 0.0 || part.next[(c, *j)] != 0.0)
            };
            interface.extend((0..dofs).filter(touched));
        }
        interface.sort_unstable();
        interface.dedup();
        let layout = RingLayout { dofs, contacts, between, interface };
        let all: Vec<HarmonicLoad> = parts.iter().flat_map(|part| part.loads.clone()).collect();
        let mut forced = forced_harmonics(&all);
        forced.dedup();
        let mut sectors = Vec::with_capacity(parts.len());
        let mut outline = Outline { bandwidth: f64::MAX, forced, ..Outline::default() };
        let mut highest = 0.0_f64;
        for index in 0..parts.len() {
            let before = &parts[(index + parts.len() - 1) % parts.len()];
            let sector = isolated(&parts[index], before, &layout)?;
            let free = free_bandwidth(&parts[index].structure)?;
            outline.bandwidth = outline.bandwidth.min(sector.narrowest_bandwidth()).min(free);
            highest = sector.stuck_frequencies().iter().copied().fold(highest, f64::max);
            sectors.push(sector);
        }
        let different = if layout.between.is_empty() { 1 } else { parts.len() };
        let contact_links =
            parts[..different].iter().map(|part| contact_link(part, &layout)).collect();
        let frequencies = OnceLock::new();
        let joins = joins_alike(first.own.as_ref(), first.next.as_ref());
        let harmonic = outline.forced.iter().copied().find(|&k| k > 0).filter(|_| joins);
        let joined_wave = harmonic.and_then(|k| Some((k, ahead(&parts, k)?)));
        Ok(Self {
            parts,
            sectors,
            coupling,
            contact_links,
            layout,
            joined_wave,
            frequencies,
            highest,
            outline,
        })
    }

    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.sectors.len()
    }

    /// Sizes and port positions.
    #[must_use]
    pub fn layout(&self) -> &RingLayout {
        &self.layout
    }

    /// The equations of the ring for one harmonic of a motion at `omega` [rad/s], with
    /// derivatives in ω if `slopes`.
    ///
    /// # Errors
    /// A sector that nothing holds (harmonic 0), or one that resonates undamped.
    pub fn order(&self, harmonic: usize, omega: f64, slopes: bool) -> Result<RingOrder, Error> {
        let mut own = Receptance { slope: slopes.then(Default::default), ..Receptance::default() };
        let mut receptances = SectorReceptances::default();
        for sector in &self.sectors {
            sector.receptance(harmonic, omega, &mut own)?;
            receptances.push(&own);
        }
        // Couplings are the same all around, contacts between neighbours need not be.
        let links = (0..self.contact_links.len())
            .map(|index| self.link(index, harmonic as f64, omega))
            .collect();
        Ok(RingOrder::new(self.layout.clone(), receptances, links))
    }

    /// Coupling of a sector to the next one on the interface, and its derivative in ω.
    fn link(&self, index: usize, order: f64, omega: f64) -> [Mat<c64>; 2] {
        let interface = &self.layout.interface;
        let RingCoupling { mass, damping, stiffness } = &self.coupling;
        let size = interface.len();
        let w = order * omega;
        let value = Mat::from_fn(size, size, |i, j| {
            let at = (interface[i], interface[j]);
            let stiff = stiffness[at] + self.contact_links[index][(i, j)];
            c64::new(stiff - w * w * mass[at], w * damping[at])
        });
        let slope = Mat::from_fn(size, size, |i, j| {
            let at = (interface[i], interface[j]);
            c64::new(-2.0 * order * order * omega * mass[at], order * damping[at])
        });
        [value, slope]
    }

    /// The same ring with the contact stiffness and the loads of the assembled disk.
    ///
    /// # Errors
    /// As [`Ring::new`].
    pub fn with_ports(&self, ports: &Ports) -> Result<Self, Error> {
        let RingLayout { dofs, contacts, .. } = self.layout;
        let part = |(index, part): (usize, &RingSector)| {
            let at = index * contacts..(index + 1) * contacts;
            let own = |load: &HarmonicLoad| {
                let amplitude = load.amplitude[index * dofs..][..dofs].to_vec();
                HarmonicLoad { harmonic: load.harmonic, amplitude }
            };
            RingSector {
                stiffness: ports.stiffness.get(at.clone(), at).to_owned(),
                loads: ports.loads.iter().map(own).collect(),
                ..part.clone()
            }
        };
        Self::new(self.parts.iter().enumerate().map(part).collect(), self.coupling.clone())
    }

    /// The disk as one structure, with all contacts and loads.
    ///
    /// # Errors
    /// As [`Structure::new`].
    pub fn assembled(&self) -> Result<(Structure, Ports), Error> {
        let (count, RingLayout { dofs, contacts, .. }) = (self.sectors.len(), &self.layout);
        let blank = Mat::<f64>::zeros(count * dofs, count * dofs);
        let [mut mass, mut damping, mut stiffness] = [blank.clone(), blank.clone(), blank];
        let mut rows = Mat::<f64>::zeros(count * contacts, count * dofs);
        let mut of_contacts = Mat::<f64>::zeros(count * contacts, count * contacts);
        let mut loads: Vec<HarmonicLoad> = Vec::new();
        for (index, part) in self.parts.iter().enumerate() {
            let next = (index + 1) % count;
            for (matrix, own, coupling) in [
                (&mut mass, part.structure.mass(), &self.coupling.mass),
                (&mut damping, part.structure.damping(), &self.coupling.damping),
                (&mut stiffness, part.structure.stiffness(), &self.coupling.stiffness),
            ] {
                add(matrix, index, index, own);
                add(matrix, index, next, coupling.as_ref());
                add(matrix, next, index, coupling.transpose());
            }
            add(&mut rows, index, index, part.own.as_ref());
            add(&mut rows, index, next, part.next.as_ref());
            add(&mut of_contacts, index, index, part.stiffness.as_ref());
            for load in &part.loads {
                let at = loads.iter().position(|l| l.harmonic == load.harmonic);
                let at = at.unwrap_or_else(|| {
                    let amplitude = vec![c64::new(0.0, 0.0); count * dofs];
                    loads.push(HarmonicLoad { harmonic: load.harmonic, amplitude });
                    loads.len() - 1
                });
                for (j, p) in load.amplitude.iter().enumerate() {
                    loads[at].amplitude[index * dofs + j] += p;
                }
            }
        }
        let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref())?
            .with_law(self.parts.iter().all(|part| part.structure.is_proportional()));
        let massless = self.parts.iter().enumerate().flat_map(|(index, part)| {
            part.structure.massless().iter().map(move |dof| index * dofs + dof)
        });
        let structure = structure.with_massless(massless.collect());
        Ok((structure, Ports { rows: rows.into(), stiffness: of_contacts.into(), loads }))
    }

    /// Natural frequencies of the disk, stuck and free.
    pub(super) fn natural(&self) -> &[Vec<f64>; 2] {
        self.frequencies.get_or_init(|| {
            let frequencies = |stuck: bool| -> Result<Vec<f64>, Error> {
                let (structure, ports) = self.assembled()?;
                let stiffness = if stuck {
                    structure.restrained_stiffness(&ports.rows, &ports.stiffness)
                } else {
                    structure.stiffness().to_owned()
                };
                Ok(structure.modes_at(stiffness)?.modes.frequencies())
            };
            // The sectors have been decomposed; a disk that cannot be has no stops in a range.
            [true, false].map(|stuck| frequencies(stuck).unwrap_or_default())
        })
    }
}

/// By how much the loads of a harmonic are ahead from sector to sector, if they travel round the ring.
fn ahead(parts: &[RingSector], harmonic: usize) -> Option<f64> {
    let load = |part: &RingSector| {
        part.loads.iter().find(|load| load.harmonic == harmonic).map(|load| load.amplitude.clone())
    };
    let loads: Vec<Vec<c64>> = parts.iter().map(load).collect::<Option<_>>()?;
    let product = |one: &[c64], next: &[c64]| -> c64 {
        one.iter().zip(next).map(|(one, next)| one.conj() * next).sum()
    };
    let turn = product(&loads[0], &loads[1 % loads.len()]);
    let turn = turn / turn.norm();
    let mut pairs = loads.iter().zip(loads.iter().cycle().skip(1));
    let travels = |(one, next): (&Vec<c64>, &Vec<c64>)| {
        let left = one.iter().zip(next).map(|(one, next)| (next - one * turn).norm_sqr());
        left.sum::<f64>() <= ROUNDING * product(one, one).re
    };
    pairs.all(travels).then(|| turn.im.atan2(turn.re))
}

/// `Bᵀ D B'` on the interface, of the stuck contacts between a sector and the next one.
fn contact_link(part: &RingSector, layout: &RingLayout) -> Mat<f64> {
    let RingLayout { between, interface, .. } = layout;
    let on = |rows: &Mat<f64>| {
        Mat::from_fn(between.len(), interface.len(), |a, i| rows[(between[a], interface[i])])
    };
    let size = between.len();
    let stiffness = Mat::from_fn(size, size, |a, b| part.stiffness[(between[a], between[b])]);
    on(&part.own).transpose() * (stiffness * on(&part.next))
}

fn add(matrix: &mut Mat<f64>, row: usize, column: usize, block: MatRef<'_, f64>) {
    let (rows, columns) = (block.nrows(), block.ncols());
    let mut target =
        matrix.get_mut(row * rows..(row + 1) * rows, column * columns..(column + 1) * columns);
    target += block;
}

/// Half-power bandwidth of the least damped mode of a sector without its contacts, rigid motions excepted [rad/s].
fn free_bandwidth(structure: &Structure) -> Result<f64, Error> {
    let modes = structure.modes_at(structure.stiffness().to_owned())?.modes;
    let damping = modes.project(structure.damping());
    let squared = &modes.omega_squared;
    let rigid = RIGID_BODY * squared.last().copied().unwrap_or(0.0);
    let moved = squared.iter().enumerate().filter(|(_, squared)| **squared > rigid);
    Ok(moved.map(|(j, _)| damping[(j, j)].abs()).fold(f64::MAX, f64::min))
}

/// A sector with its neighbours held still, as its ports see it.
fn isolated(
    part: &RingSector,
    before: &RingSector,
    layout: &RingLayout,
) -> Result<Box<dyn Compliance>, Error> {
    let RingLayout { dofs, contacts, between, interface } = layout;
    let ports = layout.ports();
    // Contacts of the sector before stick to this one with their part on it.
    let mut held = part.structure.stiffness().to_owned();
    held += before.next.transpose() * (&before.stiffness * &before.next);
    // No law knows of contacts that hold the sector.
    let structure = Structure::new(part.structure.mass(), part.structure.damping(), held.as_ref())?
        .with_law(part.structure.is_proportional() && between.is_empty())
        .with_massless(part.structure.massless().to_vec());
    let rows = Mat::from_fn(ports, *dofs, |i, j| {
        if i < *contacts {
            part.own[(i, j)]
        } else if i < contacts + between.len() {
            before.next[(between[i - contacts], j)]
        } else {
            f64::from(u8::from(interface[i - contacts - between.len()] == j))
        }
    });
    let stiffness = Mat::from_fn(ports, ports, |i, j| {
        if i < *contacts && j < *contacts {
            part.stiffness[(i, j)]
        } else {
            0.0
        }
    });
    let ports = Ports { rows: rows.into(), stiffness: stiffness.into(), loads: part.loads.clone() };
    Ok(compliance(&structure, &ports)?.0)
}
