//! Newton directions of rings against those by dense receptances, whichever contacts slip.

#![allow(clippy::unwrap_used)]

use super::{RingNewton, RingSeries};
use crate::balance::condensed::Condensed;
use crate::balance::linear::Linear;
use crate::contact::{Jenkins, Residual};
use crate::fourier::{Harmonics, SampleTable};
use crate::model::{Model, SectorContact};
use crate::solve::System as _;
use crate::structure::{HarmonicLoad, RingCoupling, Structure};
use faer::{c64, mat, Mat};

/// Sectors of two masses, of which `coupled` are coupled to those of the next sector, with a contact to
/// ground that slips in the sectors `inside`, and one with the next sector, which slips in those of `between`,
/// if there are any.
fn ring(count: usize, coupled: &[usize], inside: &[usize], between: Option<&[usize]>) -> Model {
    let limit = |i: usize, slipping: &[usize]| if slipping.contains(&i) { 0.3 } else { 1e6 };
    let contact = |row: [f64; 2], next: [f64; 2], limit: f64| SectorContact {
        law: Box::new(Jenkins::new(60.0, limit).unwrap()),
        own: Mat::from_fn(1, 2, |_, j| row[j]),
        next: Mat::from_fn(1, 2, |_, j| next[j]),
    };
    let contacts = |i: usize| {
        let own = contact([1.0, 0.3], [0.0, 0.0], limit(i, inside));
        let other = between.map(|slip| contact([0.0, 1.0], [0.0, -0.8], limit(i, slip)));
        std::iter::once(own).chain(other).collect()
    };
    let structure = |i: usize| {
        let stiffness = mat![[300.0 + 7.0 * i as f64, -100.0], [-100.0, 250.0]];
        let (mass, damping) = (mat![[2.0, 0.1], [0.1, 1.0]], mat![[0.5, -0.1], [-0.1, 0.4]]);
        Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap()
    };
    let zero = Mat::<f64>::zeros(2, 2);
    let link = |i, j| {
        if coupled.contains(&i) && coupled.contains(&j) {
            -20.0 - 3.0 * (i + 2 * j) as f64
        } else {
            0.0
        }
    };
    let stiffness = Mat::from_fn(2, 2, link);
    let coupling = RingCoupling { mass: zero.clone(), damping: zero, stiffness };
    let load = |i: usize| HarmonicLoad {
        harmonic: 1,
        amplitude: vec![c64::from_polar(4.0, i as f64), c64::new(1.0, -2.0)],
    };
    let all = 0..count;
    let structures = all.clone().map(structure).collect();
    let loads = all.clone().map(|i| vec![load(i)]).collect();
    Model::ring(structures, coupling, all.map(contacts).collect(), loads).unwrap()
}

fn agrees(model: &Model, half_wave: bool) {
    let table = SampleTable::new(Harmonics::new(5, half_wave));
    let equations = || Condensed::new(model, &table, Residual::Centred, false);
    let (mut by_sectors, mut dense) = (equations(), equations());
    dense.densify();
    let ring = model.compliance().ring().unwrap();
    for each in [&mut by_sectors, &mut dense] {
        each.set_omega(11.0).unwrap();
    }
    let size = by_sectors.size();
    let x: Vec<f64> = by_sectors.stuck_response().iter().map(|x| 1.1 * x + 1e-3).collect();
    let mut right = vec![0.0; size];
    by_sectors.residual(&x, &mut right);
    dense.residual(&x, &mut right);
    right.iter_mut().enumerate().for_each(|(i, r)| *r += (i as f64).sin());
    let mut expected = vec![0.0; size];
    assert!(!dense.is_linear() && dense.solve(&right, &mut expected));
    let Linear::Ring { orders, .. } = &by_sectors.linear else { unreachable!() };
    let series = RingSeries::new(orders, table.harmonics());
    let newton = RingNewton::new(series, ring.layout(), &by_sectors.loads, model.points());
    let mut found = vec![0.0; size];
    newton.solve(series, &right, &mut found);
    let largest = expected.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-11 * largest, "{found} {expected}");
    }
}

#[test]
fn runs_of_sectors_that_stick_are_those_of_the_whole_ring() {
    let slipping: [&[usize]; 7] = [&[0], &[6], &[2, 3], &[0, 6], &[1, 4], &[0, 2, 4, 6], &[0, 5]];
    for inside in slipping {
        for half_wave in [true, false] {
            agrees(&ring(7, &[1], inside, None), half_wave);
            agrees(&ring(7, &[1], inside, Some(&[])), half_wave);
            agrees(&ring(7, &[1], &[], Some(inside)), half_wave);
            agrees(&ring(7, &[1], inside, Some(&[1, 5])), half_wave);
            agrees(&ring(7, &[0, 1], inside, None), half_wave);
        }
    }
    for (count, inside) in [(1, 0), (2, 0), (2, 1), (3, 1)] {
        agrees(&ring(count, &[1], &[inside], None), true);
        agrees(&ring(count, &[1], &[], Some(&[inside])), true);
    }
}
