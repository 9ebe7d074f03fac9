//! From the receptance of the free structure to that of the stuck one.

use super::modes::complex;
use super::Receptance;
use faer::linalg::solvers::Solve as _;
use faer::{c64, Mat, MatRef};

/// Contacts up to which elimination by hand is faster than a library's, and a size at which its tables take less time
/// to clear.
pub(super) const FEW: usize = 12;
const FEWEST: usize = 4;

/// Turns the receptance of the free structure into that of the stuck one, `G_s = (I + G D)⁻¹ G`, for loads at all
/// points or, without derivatives, at some alone.
pub(super) fn restrain(stiffness: MatRef<'_, f64>, points: Option<&[usize]>, out: &mut Receptance) {
    let contacts = stiffness.nrows();
    let sloped = out.slope.is_some() || !out.by_ratio.is_empty();
    if contacts == 1 && points.is_none() {
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
    if contacts == 0 {
        return;
    }
    if contacts <= FEWEST && !sloped {
        return restrain_few::<FEWEST>(stiffness, points, out);
    }
    if contacts <= FEW && !sloped {
        return restrain_few::<FEW>(stiffness, points, out);
    }
    let stiffness = complex(stiffness);
    let column_major = |values: &[c64]| {
        Mat::from_fn(contacts, values.len() / contacts.max(1), |i, j| values[j * contacts + i])
    };
    let free = column_major(&out.contact);
    let coupling = Mat::<c64>::identity(contacts, contacts) + &free * &stiffness;
    let lu = coupling.partial_piv_lu();
    if let Some(points) = points {
        out.keep(points);
        for loaded in [&mut out.contact, &mut out.stuck] {
            store(lu.solve(column_major(loaded)).as_ref(), loaded);
        }
        return;
    }
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

/// The same of up to `MOST` contacts, without derivatives, by elimination with row pivoting.
fn restrain_few<const MOST: usize>(
    stiffness: MatRef<'_, f64>,
    points: Option<&[usize]>,
    out: &mut Receptance,
) {
    let n = stiffness.nrows();
    let mut table = [[c64::new(0.0, 0.0); MOST]; MOST];
    let mut inverses = [c64::new(0.0, 0.0); MOST];
    let coupling = &mut table.as_flattened_mut()[..n * n];
    for j in 0..n {
        for k in 0..n {
            let d = stiffness[(k, j)];
            if d != 0.0 {
                (0..n).for_each(|i| coupling[j * n + i] += out.contact[k * n + i] * d);
            }
        }
        coupling[j * n + j] += 1.0;
    }
    if let Some(points) = points {
        out.keep(points);
    }
    let columns = |out: &mut Receptance, change: &mut dyn FnMut(&mut [c64])| {
        out.contact.chunks_exact_mut(n).chain([&mut out.stuck[..]]).for_each(change);
    };
    for pivot in 0..n {
        let size = |i: &usize| coupling[pivot * n + i].norm_sqr();
        let best = (pivot..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(pivot);
        (0..n).for_each(|j| coupling.swap(j * n + pivot, j * n + best));
        let inverse = coupling[pivot * n + pivot].inv();
        inverses[pivot] = inverse;
        let mut factors = [c64::new(0.0, 0.0); MOST];
        (pivot + 1..n).for_each(|i| factors[i] = coupling[pivot * n + i] * inverse);
        let mut eliminate = |column: &mut [c64]| {
            column.swap(pivot, best);
            let own = column[pivot];
            (pivot + 1..n).for_each(|i| column[i] -= factors[i] * own);
        };
        columns(out, &mut eliminate);
        for j in pivot + 1..n {
            let own = coupling[j * n + pivot];
            (pivot + 1..n).for_each(|i| coupling[j * n + i] -= factors[i] * own);
        }
    }
    columns(out, &mut |column| {
        for i in (0..n).rev() {
            let known: c64 = (i + 1..n).map(|j| coupling[j * n + i] * column[j]).sum();
            column[i] = (column[i] - known) * inverses[i];
        }
    });
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
