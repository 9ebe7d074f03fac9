//! Damping that couples no modes is known as such at any size, and no other is taken for it.

#![allow(clippy::unwrap_used)]

use faer::{c64, Mat};
use stickslip_core::structure::{
    compliance, modes, Compliance, DirectCompliance, FlutterCompliance, HarmonicLoad, Ports,
    Receptance, Structure,
};

/// Numbers in [-1, 1] from a seed.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 33) as f64) / f64::from(1_u32 << 30) - 1.0
    }
}

fn identity(size: usize, factor: f64) -> Mat<f64> {
    Mat::from_fn(size, size, |i, j| if i == j { factor } else { 0.0 })
}

/// Masses in a row between two walls; springs of other stiffness one after the other.
fn chain(springs: &[f64]) -> Mat<f64> {
    let size = springs.len() - 1;
    Mat::from_fn(size, size, |i, j| match i.abs_diff(j) {
        0 => springs[i] + springs[i + 1],
        1 => -springs[i.max(j)],
        _ => 0.0,
    })
}

/// `M Φ diag(2 ζ_j ω_j) Φᵀ M`.
fn modal(mass: &Mat<f64>, stiffness: &Mat<f64>, ratio: impl Fn(usize) -> f64) -> Mat<f64> {
    let modes = modes(mass.as_ref(), stiffness.as_ref()).unwrap();
    let shapes = mass * &modes.shapes;
    let omega = modes.frequencies();
    let scaled = Mat::from_fn(shapes.nrows(), shapes.ncols(), |i, j| {
        2.0 * ratio(j) * omega[j] * shapes[(i, j)]
    });
    scaled * shapes.transpose()
}

fn ports(size: usize, stiffness: f64) -> Ports {
    let place = size / 2;
    let amplitude = (0..size).map(|i| c64::new(f64::from(u8::from(i == 0)), 0.0)).collect();
    Ports {
        rows: Mat::from_fn(1, size, |_, j| f64::from(u8::from(j == place))).into(),
        stiffness: Mat::from_fn(1, 1, |_, _| stiffness).into(),
        loads: vec![HarmonicLoad { harmonic: 1, amplitude }],
    }
}

/// The base that is chosen, and its largest distance from direct solution at some frequencies,
/// relative to the larger of the two.
fn judged(structure: &Structure, ports: &Ports) -> (&'static str, f64) {
    let (form, base) = compliance(structure, ports).unwrap();
    let direct = DirectCompliance::new(structure, ports).unwrap();
    let frequencies = form.stuck_frequencies();
    let (mut ours, mut theirs) = (Receptance::default(), Receptance::default());
    let mut worst = 0.0_f64;
    for omega in [0.7, 1.0, 1.001, 1.7, 3.1].map(|share| share * frequencies[0]) {
        form.receptance(1, omega, &mut ours).unwrap();
        direct.receptance(1, omega, &mut theirs).unwrap();
        for (a, b) in [(ours.contact[0], theirs.contact[0]), (ours.stuck[0], theirs.stuck[0])] {
            worst = worst.max((a - b).norm() / b.norm());
        }
    }
    (base, worst)
}

#[test]
fn long_chains_keep_their_modes_by_law_and_by_matrix() {
    for size in [37, 129, 200] {
        let (mass, stiffness) = (identity(size, 0.1), chain(&vec![1e6; size + 1]));
        let ports = ports(size, 1e5);
        let laws = [
            ("stuck modes", faer::Scale(2.0) * &mass),
            ("free modes", faer::Scale(2.0) * &mass + faer::Scale(1e-6) * &stiffness),
            ("free modes", modal(&mass, &stiffness, |_| 1e-3)),
        ];
        for (expected, damping) in laws {
            for law in [false, true] {
                let matrices = [&mass, &damping, &stiffness].map(Mat::as_ref);
                let structure = Structure::new(matrices[0], matrices[1], matrices[2]).unwrap();
                let (base, error) = judged(&structure.with_law(law), &ports);
                assert_eq!(base, expected, "{size}, law {law}");
                assert!(error < 1e-7, "{size}, {expected}, law {law}: {error:.1e}");
            }
        }
    }
}

#[test]
fn a_law_counts_however_many_decades_the_springs_span() {
    let mut number = numbers(3);
    for size in [37, 85] {
        for decades in [3.0, 6.0, 9.0] {
            let spring = |_| 1e4 * 10_f64.powf(0.5 * decades * (1.0 + number()));
            let springs: Vec<f64> = (0..=size).map(spring).collect();
            let (mass, stiffness) = (identity(size, 0.1), chain(&springs));
            let damping = modal(&mass, &stiffness, |_| 1e-3);
            let structure =
                Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
            let (base, error) = judged(&structure.with_law(true), &ports(size, 1e5));
            assert_eq!(base, "free modes");
            // Direct solution and modes lose the decades between the lowest and the highest mode.
            assert!(error < 1e-13 * 10_f64.powf(decades + 3.0), "{size}, {decades}: {error:.1e}");
        }
    }
}

#[test]
fn modes_of_one_frequency_are_turned_to_their_damping() {
    // Two equal chains with different damping, seen in coordinates that mix them.
    let half = 9;
    let single = chain(&[1e4; 10]);
    let size = 2 * half;
    let block = |a: &Mat<f64>, b: &Mat<f64>| {
        Mat::from_fn(size, size, |i, j| match (i < half, j < half) {
            (true, true) => a[(i, j)],
            (false, false) => b[(i - half, j - half)],
            _ => 0.0,
        })
    };
    let (sin, cos) = 0.6_f64.sin_cos();
    let mix = Mat::from_fn(size, size, |i, j| match (i / half, j / half, i % half == j % half) {
        (_, _, false) => 0.0,
        (0, 1, true) => -sin,
        (1, 0, true) => sin,
        _ => cos,
    });
    let one = identity(half, 1.0);
    let damping = block(&modal(&one, &single, |_| 1e-3), &modal(&one, &single, |_| 4e-2));
    let mixed = |a: &Mat<f64>| mix.transpose() * a * &mix;
    let matrices = [&identity(size, 1.0), &mixed(&damping), &mixed(&block(&single, &single))]
        .map(|a| Mat::from_fn(size, size, |i, j| 0.5 * (a[(i, j)] + a[(j, i)])));
    for law in [false, true] {
        let [mass, damping, stiffness] = matrices.each_ref().map(Mat::as_ref);
        let structure = Structure::new(mass, damping, stiffness).unwrap().with_law(law);
        let (base, error) = judged(&structure, &ports(size, 1e3));
        assert_eq!(base, "free modes");
        assert!(error < 1e-9, "law {law}: {error:.1e}");
    }
}

#[test]
fn a_matrix_slightly_off_is_never_wrong_beyond_its_effect() {
    let mut number = numbers(11);
    let mut taken = [0, 0];
    for case in 0..120 {
        let size = 4 + case % 9;
        let springs: Vec<f64> = (0..=size).map(|_| 10_f64.powf(4.0 + 2.0 * number())).collect();
        let masses: Vec<f64> = (0..size).map(|_| 10_f64.powf(0.5 * number())).collect();
        let mass = Mat::from_fn(size, size, |i, j| if i == j { masses[i] } else { 0.0 });
        let stiffness = chain(&springs);
        let ratio = 10_f64.powf(-3.0 + number());
        let mut damping = modal(&mass, &stiffness, |_| ratio);
        let off = 10_f64.powf(-8.0 + 7.0 * number());
        for i in 0..size {
            for j in 0..=i {
                let change = 1.0 + off * number();
                damping[(i, j)] *= change;
                damping[(j, i)] = damping[(i, j)];
            }
        }
        let structure =
            Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
        let (base, error) = judged(&structure, &ports(size, 1e3));
        taken[usize::from(base == "free modes")] += 1;
        assert!(error < 1e-7, "case {case}, {base}, off by {off:.1e}: {error:.1e}");
    }
    assert!(taken[0] > 40 && taken[1] > 5, "{taken:?}");
}

#[test]
fn negative_damping_of_a_law_keeps_the_modes() {
    let size = 150;
    let (mass, stiffness) = (identity(size, 0.1), chain(&vec![1e6; size + 1]));
    let own = modal(&mass, &stiffness, |_| 1e-3);
    let negative = modal(&mass, &stiffness, |j| if j == 0 { -1e-2 } else { 0.0 });
    let structure = Structure::new(mass.as_ref(), own.as_ref(), stiffness.as_ref()).unwrap();
    let ports = ports(size, 1e5);
    for law in [false, true] {
        let structure = structure.clone().with_law(law);
        let family =
            FlutterCompliance::new(&structure, ports.rows.as_ref(), negative.as_ref(), law)
                .unwrap();
        assert_eq!(family.name(), "free modes");
        let total = &own + faer::Scale(0.05) * &negative;
        let summed = Structure::new(mass.as_ref(), total.as_ref(), stiffness.as_ref()).unwrap();
        let direct = DirectCompliance::new(&summed, &ports).unwrap();
        let omega = 1.01 * direct.stuck_frequencies()[0];
        let (mut found, mut wanted) = (Receptance::default(), Receptance::default());
        family.at(0.05, Mat::clone(&ports.stiffness)).receptance(1, omega, &mut found).unwrap();
        direct.receptance(1, omega, &mut wanted).unwrap();
        let error = (found.contact[0] - wanted.contact[0]).norm() / wanted.contact[0].norm();
        assert!(error < 1e-8, "{error:.1e}");
    }
    let local = Mat::from_fn(size, size, |i, j| if i == 3 && j == 3 { -1.0 } else { 0.0 });
    let family =
        FlutterCompliance::new(&structure, ports.rows.as_ref(), local.as_ref(), false).unwrap();
    assert_eq!(family.name(), "direct");
}
