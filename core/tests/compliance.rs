//! The modal compliance against direct solution, for every kind of damping.

#![allow(clippy::unwrap_used)]

mod common;

use common::{beam_pair, snecma_beam, System};
use faer::{c64, mat, Mat};
use stickslip_core::structure::{
    compliance, natural_frequencies, Compliance, DirectCompliance, HarmonicLoad, Ports, Quantity,
    Receptance, Request, Structure,
};
use stickslip_core::Error;

fn parts(system: &System) -> (Structure, Ports) {
    let structure =
        Structure::new(system.mass.as_ref(), system.damping.as_ref(), system.stiffness.as_ref())
            .unwrap();
    let count = system.dampers.len();
    let rows = Mat::from_fn(count, system.dofs(), |i, j| system.rows(i)[(0, j)]);
    let stiffness =
        Mat::from_fn(count, count, |i, j| if i == j { system.dampers[i].2 } else { 0.0 });
    let amplitude = (0..system.dofs()).map(|i| c64::new(1.0 + i as f64, 0.5)).collect();
    let loads = vec![
        HarmonicLoad { harmonic: 1, amplitude },
        HarmonicLoad { harmonic: 0, amplitude: vec![c64::new(3.0, 0.0); system.dofs()] },
    ];
    (structure, Ports { rows: rows.into(), stiffness: stiffness.into(), loads })
}

fn with_damping(mut system: System, damping: Mat<f64>) -> System {
    system.damping = damping;
    system
}

fn kinds() -> Vec<(&'static str, System)> {
    let pair = beam_pair(1.0);
    let free = pair.clone();
    let unsymmetric = Mat::from_fn(6, 6, |i, j| {
        pair.damping[(i, j)] + 20.0 * f64::from(u8::from(i < j)) - 7.0 * f64::from(u8::from(i > j))
    });
    let local = Mat::from_fn(6, 6, |i, j| if i == 1 && j == 1 { 40.0 } else { 0.0 });
    vec![
        ("stuck modes", with_damping(free.clone(), faer::Scale(9.0) * &free.mass)),
        ("stuck modes", with_damping(free.clone(), Mat::zeros(6, 6))),
        ("free modes", free.clone()),
        ("complex modes", with_damping(free.clone(), unsymmetric)),
        ("complex modes", with_damping(free, local)),
    ]
}

#[test]
fn every_modal_base_reproduces_the_direct_solution() {
    for (expected, system) in kinds() {
        let (structure, ports) = parts(&system);
        let (modal, base) = compliance(&structure, &ports).unwrap();
        assert_eq!(base, expected);
        let direct = DirectCompliance::new(&structure, &ports).unwrap();
        let observe: Vec<usize> = (0..system.dofs()).collect();
        for (harmonic, omega) in
            [(0, 100.0), (1, 37.0), (1, 190.0), (2, 160.0), (7, 300.0), (15, 290.0)]
        {
            let (mut a, mut b) = (Receptance::default(), Receptance::default());
            modal.receptance(harmonic, omega, &mut a).unwrap();
            direct.receptance(harmonic, omega, &mut b).unwrap();
            compare(base, &a.contact, &b.contact);
            compare(base, &a.stuck, &b.stuck);
            let slip: Vec<c64> = (0..3).map(|i| c64::new(2.0, -(i as f64))).collect();
            // Displacements must belong to the slip loads: u = u_stuck + G q.
            let contact: Vec<c64> = (0..3)
                .map(|i| b.stuck[i] + (0..3).map(|j| b.contact[j * 3 + i] * slip[j]).sum::<c64>())
                .collect();
            let mut x = vec![c64::new(0.0, 0.0); observe.len()];
            let mut y = x.clone();
            let (contact, slip_load, observe) = (&contact[..], &slip[..], &observe[..]);
            let quantity = Quantity::Whole;
            let request = Request { harmonic, omega, quantity, contact, slip_load, observe };
            modal.displacement(&request, &mut x).unwrap();
            direct.displacement(&request, &mut y).unwrap();
            let (x, y): (Vec<_>, Vec<_>) = if harmonic == 0 {
                (
                    x.iter().map(|z| c64::new(z.re, 0.0)).collect(),
                    y.iter().map(|z| c64::new(z.re, 0.0)).collect(),
                )
            } else {
                (x, y)
            };
            compare(base, &x, &y);
        }
    }
}

/// A chain with a contact at every mass, held at one end.
fn chain(count: usize, damping: &str) -> (Structure, Ports) {
    let between = |i: usize| 900.0 + 300.0 * (i as f64).sin();
    let stiffness = Mat::from_fn(count, count, |i, j| match i.abs_diff(j) {
        0 => between(i) + between(i + 1),
        1 => -between(i.max(j)),
        _ => 0.0,
    });
    let mass = Mat::from_fn(count, count, |i, j| match i.abs_diff(j) {
        0 => 1.0 + 0.3 * (3.0 * i as f64).cos(),
        1 => 0.1,
        _ => 0.0,
    });
    let damping = match damping {
        "mass" => faer::Scale(0.6) * &mass,
        "local" => Mat::from_fn(count, count, |i, j| if i == j && i < 9 { 2.0 } else { 0.0 }),
        _ => faer::Scale(0.4) * &mass + faer::Scale(2e-3) * &stiffness,
    };
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let rows = Mat::from_fn(count - 1, count, |i, j| match (i % 3, j.wrapping_sub(i)) {
        (_, 0) => 1.0,
        (0, 1) => -1.0,
        _ => 0.0,
    });
    let stiffness = Mat::from_fn(count - 1, count - 1, |i, j| match i.abs_diff(j) {
        0 => 70.0 + i as f64,
        1 if i.min(j) % 2 == 0 => 5.0,
        _ => 0.0,
    });
    let amplitude = (0..count).map(|i| c64::new((i as f64).sin(), 0.5)).collect();
    let loads = vec![
        HarmonicLoad { harmonic: 1, amplitude },
        HarmonicLoad { harmonic: 0, amplitude: vec![c64::new(3.0, 0.0); count] },
    ];
    (structure, Ports { rows: rows.into(), stiffness: stiffness.into(), loads })
}

#[test]
fn sparse_factors_reproduce_the_direct_solution() {
    for damping in ["mass", "local", "rayleigh"] {
        let (structure, ports) = chain(200, damping);
        let (sparse, base) = compliance(&structure, &ports).unwrap();
        assert_eq!(base, "sparse factors");
        let direct = DirectCompliance::new(&structure, &ports).unwrap();
        let contacts = ports.rows.nrows();
        let slip: Vec<c64> = (0..contacts).map(|i| c64::new(2.0, -(i as f64).cos())).collect();
        let observe = [0, 3, 150, 199];
        for (harmonic, omega) in [(0, 5.0), (1, 7.0), (3, 11.0), (9, 14.0)] {
            let of = |form: &dyn Compliance| {
                let mut own = Receptance { slope: Some(Default::default()), ..Default::default() };
                form.receptance(harmonic, omega, &mut own).unwrap();
                own
            };
            let (a, b) = (of(sparse.as_ref()), of(&direct));
            compare(base, &a.contact, &b.contact);
            compare(base, &a.stuck, &b.stuck);
            if let (Some(a), Some(b)) = (&a.slope, &b.slope) {
                compare(base, &a.0, &b.0);
                compare(base, &a.1, &b.1);
            }
            for quantity in [Quantity::Whole, Quantity::OfSlip, Quantity::Slope] {
                let (contact, slip_load, observe) = (&[][..], &slip[..], &observe[..]);
                let request = Request { harmonic, omega, quantity, contact, slip_load, observe };
                let mut x = vec![c64::new(0.0, 0.0); observe.len()];
                let mut y = x.clone();
                sparse.displacement(&request, &mut x).unwrap();
                direct.displacement(&request, &mut y).unwrap();
                // A mean has no phase.
                if harmonic == 0 {
                    x.iter_mut().chain(&mut y).for_each(|z| z.im = 0.0);
                }
                compare(base, &x, &y);
            }
        }
        let close = |a: &[f64], b: &[f64]| {
            assert_eq!(a.len(), b.len());
            a.iter().zip(b).for_each(|(a, b)| assert!((a - b).abs() <= 1e-9 * b, "{a} {b}"));
        };
        for (stuck, all) in [(true, direct.stuck_frequencies()), (false, direct.free_frequencies())]
        {
            let own: Vec<f64> = all.iter().copied().filter(|w| (30.0..=40.0).contains(w)).collect();
            assert!(own.len() > 5);
            close(&sparse.frequencies_between(stuck, [30.0, 40.0]), &own);
        }
        close(sparse.stuck_frequencies(), direct.stuck_frequencies());
        close(sparse.free_frequencies(), direct.free_frequencies());
        let highest = direct.highest_frequency();
        assert!((0.5..2.0).contains(&(sparse.highest_frequency() / highest)));
        let lowest = sparse.lowest_frequencies().unwrap();
        // About: they tell a body that only contacts hold.
        assert!((lowest[0] / direct.stuck_frequencies()[0] - 1.0).abs() < 1e-4);
        assert!((lowest[1] / direct.free_frequencies()[0] - 1.0).abs() < 1e-4);
    }
}

#[test]
fn chains_without_damping_or_support_are_seen_by_their_modes() {
    let (structure, ports) = chain(200, "mass");
    let none = Mat::zeros(200, 200);
    let undamped = Structure::new(structure.mass(), none.as_ref(), structure.stiffness()).unwrap();
    assert_eq!(compliance(&undamped, &ports).unwrap().1, "stuck modes");
    let loose = Mat::from_fn(200, 200, |i, j| match i.abs_diff(j) {
        0 if i == 0 || i == 199 => 900.0,
        0 => 1800.0,
        1 => -900.0,
        _ => 0.0,
    });
    let damping = structure.damping();
    let loose = Structure::new(structure.mass(), damping, loose.as_ref()).unwrap();
    // Every contact lies between two masses.
    let rows = Mat::from_fn(199, 200, |i, j| match j.wrapping_sub(i) {
        0 => 1.0,
        1 => -1.0,
        _ => 0.0,
    });
    let ports = Ports { rows: rows.into(), ..ports };
    assert_eq!(compliance(&loose, &ports).unwrap().1, "stuck modes");
}

#[test]
fn frequencies_without_contacts_follow_from_the_stuck_modes() {
    let (held, ports) = chain(200, "mass");
    let none = Mat::zeros(200, 200);
    let loose = Mat::from_fn(200, 200, |i, j| match i.abs_diff(j) {
        0 if i == 0 || i == 199 => 900.0,
        0 => 1800.0,
        1 => -900.0,
        _ => 0.0,
    });
    for (name, stiffness) in [("held", held.stiffness()), ("loose", loose.as_ref())] {
        let structure = Structure::new(held.mass(), none.as_ref(), stiffness).unwrap();
        let (modal, _) = compliance(&structure, &ports).unwrap();
        let direct = DirectCompliance::new(&structure, &ports).unwrap();
        let lowest = modal.lowest_frequencies().unwrap();
        assert_eq!(lowest[0], modal.stuck_frequencies()[0], "{name}");
        let first = direct.free_frequencies()[0];
        // A body that only contacts hold is known by it.
        let close = if name == "loose" {
            lowest[1] < 1e-5 * lowest[0]
        } else {
            (lowest[1] / first - 1.0).abs() < 1e-4
        };
        assert!(close, "{name}: {} {first}", lowest[1]);
        let (own, all) = (modal.free_frequencies(), direct.free_frequencies());
        assert_eq!(own.len(), all.len(), "{name}");
        let highest = all[199] * all[199];
        for (a, b) in own.iter().zip(all) {
            assert!((a * a - b * b).abs() <= 1e-12 * highest, "{name}: {a} {b}");
        }
    }
}

fn compare(name: &str, got: &[c64], want: &[c64]) {
    let scale = want.iter().map(|z| z.norm()).fold(0.0, f64::max);
    for (a, b) in got.iter().zip(want) {
        assert!((a - b).norm() <= 1e-9 * scale, "{name}: {a} {b}");
    }
}

#[test]
fn frequency_derivatives_match_differences() {
    for (_, system) in kinds() {
        let (structure, ports) = parts(&system);
        let (modal, base) = compliance(&structure, &ports).unwrap();
        let direct = DirectCompliance::new(&structure, &ports).unwrap();
        for form in [modal.as_ref(), &direct as &dyn Compliance] {
            let (omega, step) = (130.0, 1e-4);
            let mut exact = Receptance { slope: Some(Default::default()), ..Default::default() };
            let (mut ahead, mut behind) = (Receptance::default(), Receptance::default());
            form.receptance(3, omega, &mut exact).unwrap();
            form.receptance(3, omega + step, &mut ahead).unwrap();
            form.receptance(3, omega - step, &mut behind).unwrap();
            let (slope, _) = exact.slope.unwrap();
            let scale = slope.iter().map(|z| z.norm()).fold(0.0, f64::max);
            for ((a, b), s) in ahead.contact.iter().zip(&behind.contact).zip(&slope) {
                assert!(((a - b) / (2.0 * step) - s).norm() < 1e-6 * scale, "{base}");
            }
            form.receptance(1, omega, &mut ahead).unwrap();
            let mut exact = Receptance { slope: Some(Default::default()), ..Default::default() };
            form.receptance(1, omega, &mut exact).unwrap();
            form.receptance(1, omega + step, &mut ahead).unwrap();
            form.receptance(1, omega - step, &mut behind).unwrap();
            let (_, slope) = exact.slope.unwrap();
            let scale = slope.iter().map(|z| z.norm()).fold(0.0, f64::max);
            for ((a, b), s) in ahead.stuck.iter().zip(&behind.stuck).zip(&slope) {
                assert!(((a - b) / (2.0 * step) - s).norm() < 1e-6 * scale, "{base}");
            }
        }
    }
}

#[test]
fn natural_frequencies_of_the_beam() {
    let beam = snecma_beam(1.0);
    let slipping = natural_frequencies(beam.mass.as_ref(), beam.stiffness.clone(), &[]).unwrap();
    let model = beam.model();
    let stuck = model.natural_frequencies(&[]).unwrap();
    for (got, want) in slipping.iter().zip([159.5927, 901.7589, 2167.5410]) {
        assert!((got - want).abs() < 1e-4, "{got} {want}");
    }
    for (got, want) in stuck.iter().zip([225.6623, 1404.3759, 3273.7922]) {
        assert!((got - want).abs() < 1e-4, "{got} {want}");
    }
    assert_eq!(model.natural_frequencies(&[(0, 0)]).unwrap(), slipping);
    assert!(model.natural_frequencies(&[(1, 0)]).is_err());
}

#[test]
fn rigid_body_motion_is_refused_where_the_mean_matters() {
    // Two masses on one spring; a general damping makes its undamped rigid-body pair defective.
    let free = |damping: Mat<f64>| System {
        mass: mat![[1.0, 0.0], [0.0, 2.0]],
        stiffness: mat![[100.0, -100.0], [-100.0, 100.0]],
        damping,
        dampers: vec![(0, Some(1), 30.0, 1.0)],
        forces: vec![(0, 1, 1.0, 0.0)],
    };
    for damping in
        [Mat::zeros(2, 2), mat![[0.4, -0.4], [-0.4, 0.4]], mat![[0.4, -0.1], [-0.4, 0.4]]]
    {
        let system = free(damping);
        let (structure, ports) = parts(&system);
        let (form, _) = compliance(&structure, &ports).unwrap();
        let direct = DirectCompliance::new(&structure, &ports).unwrap();
        let (mut a, mut b) = (Receptance::default(), Receptance::default());
        form.receptance(1, 4.0, &mut a).unwrap();
        direct.receptance(1, 4.0, &mut b).unwrap();
        compare("free-free", &a.contact, &b.contact);
        let refused = form.receptance(0, 4.0, &mut a);
        assert!(matches!(refused, Err(Error::SingularStiffness { .. })), "{refused:?}");
        assert!(system.model().static_singular());
    }
}

#[test]
fn an_unstable_structure_has_no_natural_frequencies() {
    let refused = natural_frequencies(mat![[1.0]].as_ref(), mat![[-4.0]], &[]);
    assert!(matches!(refused, Err(Error::Unstable { squared }) if (squared + 4.0).abs() < 1e-12));
}

#[test]
fn bad_matrices_are_refused_with_their_entry() {
    let good = mat![[2.0, 0.1], [0.1, 1.0]];
    let refused = |m: &Mat<f64>, c: &Mat<f64>, k: &Mat<f64>| {
        Structure::new(m.as_ref(), c.as_ref(), k.as_ref()).unwrap_err().to_string()
    };
    let nan = mat![[1.0, 0.0], [f64::NAN, 1.0]];
    assert!(refused(&good, &nan, &good).contains("damping[1, 0]"));
    let skew = mat![[1.0, 0.5], [0.0, 1.0]];
    assert!(refused(&good, &good, &skew).contains("stiffness[0, 1]"));
    let indefinite = mat![[1.0, 2.0], [2.0, 1.0]];
    assert_eq!(refused(&indefinite, &good, &good), Error::IndefiniteMass.to_string());
    assert!(refused(&good, &good, &mat![[1.0]]).contains("stiffness"));
}

#[test]
fn a_strongly_damped_high_mode_hides_no_coupling_of_low_ones() {
    let damping = mat![[0.02, 0.019, 0.0], [0.019, 0.02, 0.0], [0.0, 0.0, 1e9]];
    let stiffness = mat![[1000.0, 0.0, 0.0], [0.0, 1000.5, 0.0], [0.0, 0.0, 1e14]];
    let mass = Mat::<f64>::identity(3, 3);
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let ports =
        Ports { rows: Mat::zeros(0, 3).into(), stiffness: Mat::zeros(0, 0).into(), loads: vec![] };
    let (_, base) = compliance(&structure, &ports).unwrap();
    assert!(base == "complex modes" || base == "direct", "{base}");
}

/// Receptances of loads at some points are those of these points among all, however they are found.
#[test]
fn loads_at_some_points_are_answered_as_among_all() {
    let mut bases = Vec::new();
    // By hand and by a library, by sums and by products of matrices, and seen from the contacts.
    for contacts in [1, 3, 9, 17, 30, 140] {
        let size = contacts + 3;
        let full = |own: f64, next: f64, other: f64| {
            Mat::from_fn(size, size, |i, j| [own, next, other][i.abs_diff(j).min(2)])
        };
        let stiffness = full(5e4, -2e4, -1.0);
        let mass = Mat::from_fn(size, size, |i, j| if i == j { 1.0 + i as f64 } else { 0.0 });
        let local = Mat::from_fn(size, size, |i, j| if i == j && i < 2 { 9.0 } else { 0.0 });
        for damping in [faer::Scale(2.0) * &mass, faer::Scale(1e-3) * &stiffness, local] {
            let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref());
            let rows = Mat::from_fn(contacts, size, |i, j| if j == i + 1 { 1.0 } else { 0.0 });
            let held = faer::Scale(3e4) * Mat::<f64>::identity(contacts, contacts);
            let amplitude = (0..size).map(|i| c64::new(1.0, 0.1 * i as f64)).collect();
            let loads = vec![HarmonicLoad { harmonic: 1, amplitude }];
            let ports = Ports { rows: rows.into(), stiffness: held.into(), loads };
            let (compliance, base) = compliance(&structure.unwrap(), &ports).unwrap();
            bases.push(base);
            let points = &[contacts - 1, contacts / 2, 0][..contacts.min(3)];
            for (harmonic, omega) in [(0, 90.0), (1, 90.0), (3, 110.0)] {
                let [mut whole, mut some] = [Receptance::default(), Receptance::default()];
                compliance.receptance(harmonic, omega, &mut whole).unwrap();
                compliance.receptance_of(points, harmonic, omega, &mut some).unwrap();
                let columns = points.iter().map(|i| &whole.contact[i * contacts..][..contacts]);
                let columns: Vec<c64> = columns.flatten().copied().collect();
                assert_eq!(some.contact.len(), columns.len());
                compare(base, &some.contact, &columns);
                compare(base, &some.stuck, &whole.stuck);
            }
        }
    }
    for base in ["stuck modes", "free modes", "complex modes", "coupled stuck modes"] {
        assert!(bases.contains(&base), "{base}");
    }
}
