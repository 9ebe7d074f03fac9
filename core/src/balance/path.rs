//! What the paths of homotopies add to the slip loads.

use super::condensed::Condensed;
use crate::contact::{Motion, SlipLoad};

impl Condensed<'_> {
    /// Adds to the slip load of a contact what the loss takes off the force, `q −= i η D u`.
    pub(super) fn add_loss(
        &self,
        index: usize,
        motion: Motion<'_>,
        tangent: bool,
        load: &mut SlipLoad,
    ) {
        let harmonics = self.table.harmonics();
        let (slots, points) = (harmonics.slots(), &self.model.points()[index]);
        let size = points.len() * slots;
        let turned = harmonics.orders().filter(|&order| order > 0);
        let pairs: Vec<usize> = turned.filter_map(|order| harmonics.slot(order)).collect();
        for (i, row) in points.clone().enumerate() {
            for (j, column) in points.clone().enumerate() {
                let loss = self.loss * self.model.contact_stiffness()[(row, column)];
                for &cosine in &pairs {
                    for (to, from, share) in
                        [(cosine, cosine + 1, -loss), (cosine + 1, cosine, loss)]
                    {
                        let (to, from) = (i * slots + to, j * slots + from);
                        load.value[to] += share * motion.displacement[from];
                        if tangent {
                            load.tangent[to * size + from] += share;
                        }
                    }
                }
            }
        }
        load.active = true;
    }

    /// Adds to the slip load of a softened contact what its lost stiffness takes off the force,
    /// `q = (1 − λ) D u + q_λ(u)`: the compliance goes on carrying the full stiffness.
    pub(super) fn add_lost_stiffness(
        &self,
        index: usize,
        share: f64,
        motion: Motion<'_>,
        tangent: bool,
        load: &mut SlipLoad,
    ) {
        let slots = self.table.harmonics().slots();
        let points = &self.model.points()[index];
        let size = points.len() * slots;
        for (i, row) in points.clone().enumerate() {
            for (j, column) in points.clone().enumerate() {
                let lost = share * self.model.contact_stiffness()[(row, column)];
                for slot in 0..slots {
                    load.value[i * slots + slot] += lost * motion.displacement[j * slots + slot];
                    if tangent {
                        load.tangent[(i * slots + slot) * size + j * slots + slot] += lost;
                    }
                }
            }
        }
        load.active = true;
    }
}
