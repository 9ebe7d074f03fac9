//! One harmonic of the motion of a ring of sectors.

use super::Receptance;
use crate::solve::{Block, BlockRow, CyclicScalars, CyclicTridiagonal, ScalarRow};
use faer::{c64, Mat, MatRef};

/// The sectors' receptances at their ports and the couplings of neighbours, with the factors of
/// the equations of the interface: `y_i + A_yy (Z y_{i+1} + Zᵀ y_{i−1}) = A_y f_i + a_y`.
pub struct RingOrder {
    layout: RingLayout,
    receptances: SectorReceptances,
    /// Z_i, which couples sector i to the next one, and its derivative in ω; a single one if all
    /// are the same.
    links: Vec<[Mat<c64>; 2]>,
    interface: Interface,
}

/// Receptances of sectors one behind the other, in buffers that they share.
#[derive(Default)]
pub(super) struct SectorReceptances {
    count: usize,
    contact: Vec<c64>,
    stuck: Vec<c64>,
    /// Derivatives of the two in ω, if they were asked for.
    slope: Option<(Vec<c64>, Vec<c64>)>,
}

impl SectorReceptances {
    pub(super) fn push(&mut self, sector: &Receptance) {
        self.count += 1;
        self.contact.extend_from_slice(&sector.contact);
        self.stuck.extend_from_slice(&sector.stuck);
        if let Some((contact, stuck)) = &sector.slope {
            let (contacts, stucks) = self.slope.get_or_insert_default();
            contacts.extend_from_slice(contact);
            stucks.extend_from_slice(stuck);
        }
    }
}

/// Factors of the equations of the interface.
enum Interface {
    /// One degree of freedom per sector.
    One(CyclicScalars),
    /// Several, or none.
    Several(CyclicTridiagonal),
}

/// Motion and forces at the ports of all sectors, sector after sector, and contact displacements.
#[derive(Debug, Clone)]
pub struct RingMotion {
    /// Port displacements.
    pub port: Vec<c64>,
    /// Forces on the ports.
    pub force: Vec<c64>,
    /// Relative displacements at the contacts.
    pub contact: Vec<c64>,
}

impl RingOrder {
    pub(super) fn new(
        layout: RingLayout,
        receptances: SectorReceptances,
        links: Vec<[Mat<c64>; 2]>,
    ) -> Self {
        let (count, ports, first) = (receptances.count, layout.ports(), layout.first_interface());
        let size = layout.interface.len();
        let link = |i: usize| links[i % count % links.len()][0].as_ref();
        let sectors = || receptances.contact.chunks_exact((ports * ports).max(1)).enumerate();
        let interface = if size == 1 {
            let rows: Vec<ScalarRow> = sectors()
                .map(|(i, contact)| {
                    let own = contact[first * ports + first];
                    let (before, next) = (link(i + count - 1)[(0, 0)], link(i)[(0, 0)]);
                    ScalarRow { lower: own * before, own: c64::new(1.0, 0.0), upper: own * next }
                })
                .collect();
            Interface::One(CyclicScalars::new(&rows))
        } else {
            let row = |(i, contact): (usize, &[c64])| {
                // What a force of a neighbour moves, A_yy Z.
                let moved = |link: MatRef<'_, c64>| {
                    real([size, size], |a, b| {
                        let own = |c: usize| contact[(first + c) * ports + first + a];
                        (0..size).map(|c| own(c) * link[(c, b)]).sum()
                    })
                };
                BlockRow {
                    lower: moved(link(i + count - 1).transpose()),
                    own: Block::identity(2 * size),
                    upper: moved(link(i)),
                }
            };
            Interface::Several(CyclicTridiagonal::new(sectors().map(row).collect()))
        };
        Self { layout, receptances, links, interface }
    }

    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.receptances.count
    }

    /// Number of ports of a sector.
    #[must_use]
    pub fn ports(&self) -> usize {
        self.layout.ports()
    }

    /// Whether external loads act.
    #[must_use]
    pub fn is_loaded(&self) -> bool {
        let zero = c64::new(0.0, 0.0);
        self.receptances.stuck.iter().any(|u| *u != zero)
    }

    /// Receptance of the ports of a sector, column after column.
    #[must_use]
    pub fn sector(&self, index: usize) -> &[c64] {
        let size = self.layout.ports().pow(2);
        &self.receptances.contact[index * size..(index + 1) * size]
    }

    /// Coupling of a sector to the next one on the interface.
    #[must_use]
    pub fn link(&self, index: usize) -> MatRef<'_, c64> {
        self.links[index % self.links.len()][0].as_ref()
    }

    /// Response to slip loads at the contacts and, if `loaded`, to the external loads.
    #[must_use]
    pub fn respond(&self, loaded: bool, slip_load: &[c64]) -> RingMotion {
        let RingLayout { contacts, between, .. } = &self.layout;
        let (count, ports) = (self.receptances.count, self.layout.ports());
        let zero = c64::new(0.0, 0.0);
        let mut force = vec![zero; count * ports];
        for i in 0..count {
            let before = (i + count - 1) % count;
            force[i * ports..i * ports + contacts]
                .copy_from_slice(&slip_load[i * contacts..(i + 1) * contacts]);
            for (at, &c) in between.iter().enumerate() {
                force[i * ports + contacts + at] = slip_load[before * contacts + c];
            }
        }
        let mut port = vec![zero; count * ports];
        if loaded {
            port.copy_from_slice(&self.receptances.stuck);
        }
        for i in 0..count {
            self.add_product(i, ports, &force[i * ports..(i + 1) * ports], &mut port);
        }
        self.couple(port, force)
    }

    /// Derivative in ω of a response at fixed loads.
    #[must_use]
    pub fn respond_rate(&self, loaded: bool, motion: &RingMotion) -> RingMotion {
        let (count, ports) = (self.receptances.count, self.layout.ports());
        let zero = c64::new(0.0, 0.0);
        let mut port = vec![zero; count * ports];
        let mut change = vec![zero; count * ports];
        self.add_coupling(1, &motion.port, &mut change);
        for i in 0..count {
            let range = i * ports..(i + 1) * ports;
            if let Some((contact, stuck)) = &self.receptances.slope {
                let contact = &contact[i * ports * ports..(i + 1) * ports * ports];
                for (column, f) in motion.force[range.clone()].iter().enumerate() {
                    for row in 0..ports {
                        port[i * ports + row] += contact[column * ports + row] * f;
                    }
                }
                if loaded {
                    let stuck = &stuck[range.clone()];
                    port[range.clone()].iter_mut().zip(stuck).for_each(|(p, s)| *p += s);
                }
            }
            self.add_product(i, ports, &change[range], &mut port);
        }
        self.couple(port, change)
    }

    /// Lets the neighbours act on one another: `port` holds the motion without them, `force` the
    /// forces that cause it.
    fn couple(&self, mut port: Vec<c64>, mut force: Vec<c64>) -> RingMotion {
        let (count, ports) = (self.receptances.count, self.layout.ports());
        let (first, size) = (self.layout.first_interface(), self.layout.interface.len());
        match &self.interface {
            Interface::One(factors) => {
                let mut interface: Vec<c64> =
                    port.iter().skip(first).step_by(ports).copied().collect();
                factors.solve(&mut interface);
                let own = port.iter_mut().skip(first).step_by(ports);
                own.zip(interface).for_each(|(own, y)| *own = y);
            }
            Interface::Several(factors) => {
                let mut interface = Vec::with_capacity(count * 2 * size);
                for i in 0..count {
                    for y in &port[i * ports + first..(i + 1) * ports] {
                        interface.extend([y.re, y.im]);
                    }
                }
                factors.solve(&mut interface);
                for i in 0..count {
                    for local in 0..size {
                        let at = i * 2 * size + 2 * local;
                        let y = c64::new(interface[at], interface[at + 1]);
                        port[i * ports + first + local] = y;
                    }
                }
            }
        }
        let mut coupling = vec![c64::new(0.0, 0.0); count * ports];
        self.add_coupling(0, &port, &mut coupling);
        // The interface has been solved for; the other ports follow from it.
        for i in 0..count {
            self.add_product(i, first, &coupling[i * ports..(i + 1) * ports], &mut port);
        }
        force.iter_mut().zip(&coupling).for_each(|(f, c)| *f += c);
        let contact = self.contact_displacement(&port);
        RingMotion { port, force, contact }
    }

    /// `u = o_i + w_{i+1}`: what a contact's own sector does, and the next one where it reaches it.
    fn contact_displacement(&self, port: &[c64]) -> Vec<c64> {
        let RingLayout { contacts, between, .. } = &self.layout;
        let (count, ports) = (self.receptances.count, self.layout.ports());
        let mut contact = Vec::with_capacity(count * contacts);
        for i in 0..count {
            contact.extend_from_slice(&port[i * ports..i * ports + contacts]);
            let next = (i + 1) % count;
            for (at, &c) in between.iter().enumerate() {
                contact[i * contacts + c] += port[next * ports + contacts + at];
            }
        }
        contact
    }

    /// Adds the forces `−(Z y_{i+1} + Zᵀ y_{i−1})` of the neighbours, or of the change of Z.
    fn add_coupling(&self, which: usize, port: &[c64], force: &mut [c64]) {
        let (count, ports) = (self.receptances.count, self.layout.ports());
        let (first, size) = (self.layout.first_interface(), self.layout.interface.len());
        for i in 0..count {
            let (next, before) = ((i + 1) % count, (i + count - 1) % count);
            let link = |index: usize| &self.links[index % self.links.len()][which];
            let (ahead, behind) = (link(i), link(before));
            for a in 0..size {
                for b in 0..size {
                    force[i * ports + first + a] -= ahead[(a, b)] * port[next * ports + first + b]
                        + behind[(b, a)] * port[before * ports + first + b];
                }
            }
        }
    }

    /// Adds what forces on the ports of a sector move at the first `rows` of them.
    fn add_product(&self, sector: usize, rows: usize, force: &[c64], port: &mut [c64]) {
        let ports = self.layout.ports();
        let contact = self.sector(sector);
        for (column, f) in force.iter().enumerate() {
            if *f == c64::new(0.0, 0.0) {
                continue;
            }
            for row in 0..rows {
                port[sector * ports + row] += contact[column * ports + row] * f;
            }
        }
    }
}

/// A complex matrix as a real one of pairs (real part, imaginary part).
fn real([rows, columns]: [usize; 2], entry: impl Fn(usize, usize) -> c64) -> Block {
    let mut real = Block::zeros(2 * rows, 2 * columns);
    for i in 0..rows {
        for j in 0..columns {
            let z = entry(i, j);
            real[(2 * i, 2 * j)] = z.re;
            real[(2 * i + 1, 2 * j + 1)] = z.re;
            real[(2 * i, 2 * j + 1)] = -z.im;
            real[(2 * i + 1, 2 * j)] = z.im;
        }
    }
    real
}

/// Sizes and port positions that all sectors of a ring share.
#[derive(Debug, Clone)]
pub struct RingLayout {
    /// DOFs per sector.
    pub dofs: usize,
    /// Contacts per sector; they are the first ports of a sector.
    pub contacts: usize,
    /// Contacts with a part on the next sector, where they are the next ports.
    pub between: Vec<usize>,
    /// DOFs through which neighbours are coupled, the last ports.
    pub interface: Vec<usize>,
}

impl RingLayout {
    /// Number of ports of a sector.
    #[must_use]
    pub fn ports(&self) -> usize {
        self.contacts + self.between.len() + self.interface.len()
    }

    /// First port of the interface.
    #[must_use]
    pub fn first_interface(&self) -> usize {
        self.contacts + self.between.len()
    }
}
