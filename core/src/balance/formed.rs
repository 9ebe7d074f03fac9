//! The whole Jacobian, formed: for methods that ask for it, and where products with the modes do not lead to a
//! direction. Contacts much stiffer than the structure leave next to nothing of `I − G ∂Q` once they slip, and
//! the Krylov space that would tell one of them from the other is nearly the whole one.

use super::condensed::Condensed;
use super::linear::{Factor, Linear};
use super::modal_work::{is_cheaper_formed, may_be_formed, ByProducts};
use crate::contact::SlipLoad;
use faer::Mat;

impl Condensed<'_> {
    /// Newton's direction by products with the modes, if they lead to one.
    pub(super) fn solve_by_products(&mut self, rhs: &[f64], step: &mut [f64]) -> bool {
        let (Some(Factor::Krylov(factor)), Linear::Modal(orders)) = (&self.factor, &self.linear)
        else {
            return false;
        };
        let Some(modes) = self.model.compliance().contact_modes() else { return false };
        let found = factor.solve(self.products(modes, orders), rhs, step);
        self.by_products.last = found.unwrap_or(0);
        self.profile.products += self.by_products.last;
        found.is_some()
    }

    /// Takes dense receptances from here on, as products lead to no direction; `false` if they are too many.
    pub(super) fn form_instead(&mut self) -> bool {
        self.by_products.failures += 1;
        self.form()
    }

    /// Whether products led to no last direction, which is no sign of a singular Jacobian.
    pub(super) fn lacks_direction(&self) -> bool {
        let ByProducts { last, failures, .. } = self.by_products;
        matches!(self.linear, Linear::Modal(_)) && failures > 0 && last == 0
    }

    /// Takes dense receptances from the next Jacobian on, if the last direction took so many products that
    /// these cost more.
    pub(super) fn form_if_cheaper(&mut self) {
        let (slots, slipping) = (self.table.harmonics().slots(), self.active_points().len());
        let compliance = self.model.compliance();
        if matches!(self.factor, Some(Factor::Krylov(_)))
            && is_cheaper_formed(compliance, slots, slipping, self.by_products.last)
        {
            self.form();
        }
    }

    /// Has directions take at most so many products, and no Jacobian formed in their place.
    pub(super) fn hold_to_products(&mut self, most: usize) {
        self.by_products.most = Some(most);
    }

    fn form(&mut self) -> bool {
        let (slots, slipping) = (self.table.harmonics().slots(), self.active_points().len());
        if self.by_products.most.is_some()
            || !may_be_formed(self.model.compliance(), slots, slipping)
        {
            return false;
        }
        self.by_products.replaced = self.take(Linear::dense(self.table, self.slopes));
        self.by_products.replaced
    }

    /// Takes products again, where more points have come to slip than a matrix of them may have.
    pub(super) fn take_products_again(&mut self) {
        let (slots, slipping) = (self.table.harmonics().slots(), self.active_points().len());
        let compliance = self.model.compliance();
        if self.by_products.replaced && !may_be_formed(compliance, slots, slipping) {
            let products = Linear::new(&self.model, self.table, self.slopes);
            self.by_products.replaced = !self.take(products);
        }
    }

    /// Takes another form of the receptances at this frequency; `false` if it has none.
    fn take(&mut self, mut linear: Linear) -> bool {
        // The response of the stuck structure is known.
        let mut stuck = vec![0.0; self.stuck.len()];
        let (compliance, harmonics) = (self.model.compliance(), self.table.harmonics());
        if linear.evaluate(compliance, harmonics, self.omega, None, &mut stuck).is_err() {
            return false;
        }
        (self.linear, self.factor) = (linear, None);
        true
    }

    /// Assembles `I − G ∂Q` of all points.
    pub(super) fn assemble_all(&self) -> Mat<f64> {
        let size = self.stuck.len();
        let mut matrix = Mat::<f64>::identity(size, size);
        for (load, points) in self.loads.iter().zip(self.model.points()) {
            if load.active {
                self.subtract_contact(load, points.clone(), &mut matrix);
            }
        }
        matrix
    }

    /// Subtracts `G ∂Q` of one contact.
    fn subtract_contact(
        &self,
        load: &SlipLoad,
        points: std::ops::Range<usize>,
        matrix: &mut Mat<f64>,
    ) {
        let harmonics = self.table.harmonics();
        let slots = harmonics.slots();
        let contacts = self.model.compliance().contacts();
        let size = points.len() * slots;
        let Linear::Dense(receptances) = &self.linear else { return };
        for (receptance, order) in receptances.iter().zip(harmonics.orders()) {
            let Some(slot) = harmonics.slot(order) else { continue };
            for point in 0..contacts {
                let target = point * slots + slot;
                for (local, source) in points.clone().enumerate() {
                    let g = receptance.contact[source * contacts + point];
                    let cosines = &load.tangent[(local * slots + slot) * size..][..size];
                    if order == 0 {
                        for (j, dq) in cosines.iter().enumerate() {
                            matrix[(target, points.start * slots + j)] -= g.re * dq;
                        }
                        continue;
                    }
                    let sines = &load.tangent[(local * slots + slot + 1) * size..][..size];
                    for (j, (a, b)) in cosines.iter().zip(sines).enumerate() {
                        let column = points.start * slots + j;
                        matrix[(target, column)] -= g.re * a + g.im * b;
                        matrix[(target + 1, column)] -= g.re * b - g.im * a;
                    }
                }
            }
        }
    }
}
