//! From the receptance of the free structure to that of the stuck one.

use super::modes::complex;
use super::Receptance;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat, MatRef};

/// Turns the receptance of the free structure into that of the stuck one:
/// `G_s = (I + G D)⁻¹ G`.
pub(super) fn restrain(stiffness: MatRef<'_, f64>, out: &mut Receptance) {
    let contacts = stiffness.nrows();
    if contacts == 1 {
        let d = stiffness[(0, 0)];
        let factor = (1.0 + out.contact[0] * d).inv();
        out.contact[0] *= factor;
        out.stuck[0] *= factor;
        if let Some((contact, stuck)) = &mut out.slope {
            stuck[0] = factor * (stuck[0] - contact[0] * d * out.stuck[0]);
            contact[0] *= factor * factor;
        }
        out.by_ratio.iter_mut().for_each(|change| *change *= factor * factor);
        return;
    }
    let stiffness = complex(stiffness);
    let column_major = |values: &[c64]| {
        Mat::from_fn(contacts, values.len() / contacts.max(1), |i, j| values[j * contacts + i])
    };
    let free = column_major(&out.contact);
    let coupling = Mat::<c64>::identity(contacts, contacts) + &free * &stiffness;
    let lu = coupling.partial_piv_lu();
    let contact = lu.solve(&free);
    let stuck = lu.solve(column_major(&out.stuck));
    store(contact.as_ref(), &mut out.contact);
    store(stuck.as_ref(), &mut out.stuck);
    // dG_s = (I + G D)⁻¹ dG (I − D G_s)
    let kept = Mat::<c64>::identity(contacts, contacts) - &stiffness * &contact;
    if let Some((contact_slope, stuck_slope)) = &mut out.slope {
        let (change, free_stuck) = (column_major(contact_slope), column_major(stuck_slope));
        store(lu.solve(&change * &kept).as_ref(), contact_slope);
        store(lu.solve(free_stuck - change * (&stiffness * &stuck)).as_ref(), stuck_slope);
    }
    if !out.by_ratio.is_empty() {
        let change = column_major(&out.by_ratio);
        store(lu.solve(change * kept).as_ref(), &mut out.by_ratio);
    }
}

/// Column after column.
pub(super) fn store(matrix: MatRef<'_, c64>, values: &mut [c64]) {
    let rows = matrix.nrows();
    for j in 0..matrix.ncols() {
        for i in 0..rows {
            values[j * rows + i] = matrix[(i, j)];
        }
    }
}
