//! One harmonic of the motion of a ring of sectors.

use super::Receptance;
use crate::solve::{Block, BlockRow, CyclicTridiagonal};
use faer::{c64, Mat, MatRef};

/// The sectors' receptances at their ports and the couplings of neighbours, with the factors of
/// the equations of the interface: `y_i + A_yy (Z y_{i+1} + Zᵀ y_{i−1}) = A_y f_i + a_y`.
pub struct RingOrder {
    layout: RingLayout,
    receptances: Vec<Receptance>,
    /// Z_i, which couples sector i to the next one, and its derivative in ω; a single one if all
    /// are the same.
    links: Vec<[Mat<c64>; 2]>,
    interface: CyclicTridiagonal,
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
        receptances: Vec<Receptance>,
        links: Vec<[Mat<c64>; 2]>,
    ) -> Self {
        let (count, ports, first) = (receptances.len(), layout.ports(), layout.first_interface());
        let size = layout.interface.len();
        let rows: Vec<BlockRow> = (0..count)
            .map(|i| {
                let contact = &receptances[i].contact;
                // What a force of a neighbour moves, A_yy Z.
                let moved = |link: MatRef<'_, c64>| {
                    real([size, size], |a, b| {
                        let own = |c: usize| contact[(first + c) * ports + first + a];
                        (0..size).map(|c| own(c) * link[(c, b)]).sum()
                    })
                };
                let before = &links[(i + count - 1) % count % links.len()][0];
                BlockRow {
                    lower: moved(before.transpose()),
                    own: Block::identity(2 * size),
                    upper: moved(links[i % links.len()][0].as_ref()),
                }
            })
            .collect();
        let interface = CyclicTridiagonal::new(rows);
        Self { layout, receptances, links, interface }
    }

    /// Number of sectors.
    #[must_use]
    pub fn sectors(&self) -> usize {
        self.receptances.len()
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
        self.receptances.iter().flat_map(|sector| &sector.stuck).any(|u| *u != zero)
    }

    /// Receptance of the ports of a sector, column after column, and its response to its loads.
    #[must_use]
    pub fn sector(&self, index: usize) -> &Receptance {
        &self.receptances[index]
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
        let (count, ports) = (self.receptances.len(), self.layout.ports());
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
        for i in 0..count {
            if loaded {
                port[i * ports..(i + 1) * ports].copy_from_slice(&self.receptances[i].stuck);
            }
            self.add_product(i, ports, &force[i * ports..(i + 1) * ports], &mut port);
        }
        self.couple(port, force)
    }

    /// Derivative in ω of a response at fixed loads.
    #[must_use]
    pub fn respond_rate(&self, loaded: bool, motion: &RingMotion) -> RingMotion {
        let (count, ports) = (self.receptances.len(), self.layout.ports());
        let zero = c64::new(0.0, 0.0);
        let mut port = vec![zero; count * ports];
        let mut change = vec![zero; count * ports];
        self.add_coupling(1, &motion.port, &mut change);
        for i in 0..count {
            let range = i * ports..(i + 1) * ports;
            if let Some((contact, stuck)) = &self.receptances[i].slope {
                for (column, f) in motion.force[range.clone()].iter().enumerate() {
                    for row in 0..ports {
                        port[i * ports + row] += contact[column * ports + row] * f;
                    }
                }
                if loaded {
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
        let (count, ports) = (self.receptances.len(), self.layout.ports());
        let (first, size) = (self.layout.first_interface(), self.layout.interface.len());
        let mut interface = Vec::with_capacity(count * 2 * size);
        for i in 0..count {
            for y in &port[i * ports + first..(i + 1) * ports] {
                interface.extend([y.re, y.im]);
            }
        }
        self.interface.solve(&mut interface);
        for i in 0..count {
            for local in 0..size {
                let at = i * 2 * size + 2 * local;
                port[i * ports + first + local] = c64::new(interface[at], interface[at + 1]);
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
        let (count, ports) = (self.receptances.len(), self.layout.ports());
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
        let (count, ports) = (self.receptances.len(), self.layout.ports());
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
        let contact = &self.receptances[sector].contact;
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
