//! One sector in a travelling wave against the whole disk, and the converged table.

#![allow(clippy::unwrap_used)]

mod common;

use common::curves::{fixed, peak_of};
use common::{snecma_beam, System, SLIP_FORCE, STIFFNESS};
use faer::{c64, Mat};
use std::f64::consts::TAU;
use stickslip_core::balance::{sweep, ForcedBalance, Point, PointStatus};
use stickslip_core::contact::Jenkins;
use stickslip_core::fourier::Measure;
use stickslip_core::model::{Contact, Model, SectorContact};
use stickslip_core::structure::{
    CyclicMatrix, CyclicStructure, HarmonicLoad, Quantity, Receptance, Request, RingCoupling,
    Structure,
};

const COUPLING: f64 = 1e5;

/// A ring of beams coupled at their tips; `between` adds a damper between neighbouring tips.
fn ring(sectors: usize, engine_order: usize, between: Option<(f64, f64)>) -> Model {
    let beam = snecma_beam(20.313);
    let zero = Mat::zeros(3, 3);
    let mut stiffness = beam.stiffness.clone();
    stiffness[(1, 1)] += 2.0 * COUPLING;
    let mut next = zero.clone();
    next[(1, 1)] = -COUPLING;
    let row = |dof: usize, sign: f64| Mat::from_fn(1, 3, |_, j| if j == dof { sign } else { 0.0 });
    let mut contacts = vec![SectorContact {
        law: Box::new(Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap()),
        own: row(0, 1.0),
        next: Mat::zeros(1, 3),
    }];
    if let Some((k, limit)) = between {
        contacts.push(SectorContact {
            law: Box::new(Jenkins::new(k, limit).unwrap()),
            own: row(1, 1.0),
            next: row(1, -1.0),
        });
    }
    let mut amplitude = vec![c64::new(0.0, 0.0); 3];
    amplitude[1] = c64::new(20.313, 0.0);
    let cyclic = CyclicStructure {
        mass: CyclicMatrix::new(beam.mass, zero.clone()),
        damping: CyclicMatrix::new(beam.damping, zero),
        stiffness: CyclicMatrix::new(stiffness, next),
        sectors,
        engine_order,
        proportional: false,
        massless: Vec::new(),
    };
    Model::travelling_wave(cyclic, contacts, vec![HarmonicLoad { harmonic: 1, amplitude }]).unwrap()
}

/// The same ring, all sectors assembled.
fn assembly(sectors: usize, engine_order: usize, between: Option<(f64, f64)>) -> Model {
    let beam = snecma_beam(20.313);
    let n = 3 * sectors;
    let spread = |a: &Mat<f64>| {
        Mat::from_fn(n, n, |i, j| if i / 3 == j / 3 { a[(i % 3, j % 3)] } else { 0.0 })
    };
    let mut stiffness = spread(&beam.stiffness);
    for i in 0..sectors {
        let (a, b) = (3 * i + 1, 3 * ((i + 1) % sectors) + 1);
        stiffness[(a, a)] += COUPLING;
        stiffness[(b, b)] += COUPLING;
        stiffness[(a, b)] -= COUPLING;
        stiffness[(b, a)] -= COUPLING;
    }
    let phase = |i: usize| TAU * ((i * engine_order) % sectors) as f64 / sectors as f64;
    let dampers = (0..sectors).flat_map(|i| {
        let ground = (3 * i, None, STIFFNESS, SLIP_FORCE);
        let pair =
            between.map(|(k, limit)| (3 * i + 1, Some(3 * ((i + 1) % sectors) + 1), k, limit));
        std::iter::once(ground).chain(pair)
    });
    System {
        mass: spread(&beam.mass),
        damping: spread(&beam.damping),
        stiffness,
        dampers: dampers.collect(),
        forces: (0..sectors).map(|i| (3 * i + 1, 1, 20.313, phase(i))).collect(),
    }
    .model()
}

/// The same ring as sectors that may differ, the stiffness of each beam scaled by `factors`.
fn sectors(factors: &[f64], engine_order: usize, between: Option<(f64, f64)>) -> Model {
    let beam = snecma_beam(20.313);
    let count = factors.len();
    let zero = Mat::zeros(3, 3);
    let mut next = zero.clone();
    next[(1, 1)] = -COUPLING;
    let row = |dof: usize, sign: f64| Mat::from_fn(1, 3, |_, j| if j == dof { sign } else { 0.0 });
    let contacts = || {
        let ground = SectorContact {
            law: Box::new(Jenkins::new(STIFFNESS, SLIP_FORCE).unwrap()),
            own: row(0, 1.0),
            next: Mat::zeros(1, 3),
        };
        let pair = between.map(|(k, limit)| SectorContact {
            law: Box::new(Jenkins::new(k, limit).unwrap()),
            own: row(1, 1.0),
            next: row(1, -1.0),
        });
        std::iter::once(ground).chain(pair).collect()
    };
    let structure = |factor: f64| {
        let mut stiffness = faer::Scale(factor) * &beam.stiffness;
        stiffness[(1, 1)] += 2.0 * COUPLING;
        Structure::new(beam.mass.as_ref(), beam.damping.as_ref(), stiffness.as_ref()).unwrap()
    };
    let load = |i: usize| {
        let mut amplitude = vec![c64::new(0.0, 0.0); 3];
        let phase = TAU * ((i * engine_order) % count) as f64 / count as f64;
        amplitude[1] = c64::from_polar(20.313, phase);
        vec![HarmonicLoad { harmonic: 1, amplitude }]
    };
    Model::ring(
        factors.iter().map(|factor| structure(*factor)).collect(),
        RingCoupling { mass: zero.clone(), damping: zero, stiffness: next },
        (0..count).map(|_| contacts()).collect(),
        (0..count).map(load).collect(),
    )
    .unwrap()
}

/// Friction between neighbours moves no blade at harmonics that come to all sectors at once: to 5 of them under engine
/// order 2 every fifth.
#[test]
fn contacts_between_sectors_do_not_feel_harmonics_that_come_to_all_at_once() {
    let factors = [1.0, 1.01, 0.98, 1.02, 1.0];
    let silent = |model: &Model| -> Vec<usize> {
        (1..11).filter(|&k| model.compliance().is_silent(k)).collect()
    };
    let between = Some((1e5, 5.0));
    assert_eq!(silent(&ring(5, 2, between)), [5, 10]);
    assert_eq!(silent(&sectors(&factors, 2, between)), [5, 10]);
    assert_eq!(silent(&ring(5, 2, None)), []);
    assert_eq!(silent(&sectors(&factors, 2, None)), []);
    assert_eq!(silent(&assembly(5, 2, between)), []);
}

#[test]
fn a_ring_of_sectors_is_the_whole_disk() {
    for (between, engine_order) in [(None, 2), (Some((2e5, 8.0)), 5)] {
        let factors = [1.0; 12];
        let (ring, whole) =
            (sectors(&factors, engine_order, between), assembly(12, engine_order, between));
        for (harmonic, omega) in [(1, 190.0), (3, 200.0), (7, 170.0)] {
            let blank = Receptance { slope: Some(Default::default()), ..Receptance::default() };
            let (mut ours, mut theirs) = (blank.clone(), blank);
            ring.compliance().receptance(harmonic, omega, &mut ours).unwrap();
            whole.compliance().receptance(harmonic, omega, &mut theirs).unwrap();
            let same = |a: &[c64], b: &[c64]| {
                let size = b.iter().map(|z| z.norm()).fold(1e-300, f64::max);
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).norm() < 1e-10 * size)
            };
            assert!(same(&ours.contact, &theirs.contact));
            assert!(same(&ours.stuck, &theirs.stuck));
            let (ours, theirs) = (ours.slope.unwrap(), theirs.slope.unwrap());
            assert!(same(&ours.0, &theirs.0));
            assert!(same(&ours.1, &theirs.1));
        }
        let everywhere: Vec<usize> = (0..36).collect();
        let omega: Vec<f64> = (0..8).map(|i| 160.0 + 40.0 * f64::from(i)).collect();
        let solve = |model: &Model| {
            sweep(ForcedBalance::new(model, fixed(5), &everywhere).unwrap(), &omega).unwrap()
        };
        for (a, b) in solve(&ring).points.iter().zip(&solve(&whole).points) {
            let size = b.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
            for (a, b) in a.displacement.iter().zip(&b.displacement) {
                assert!((a - b).norm() < 1e-9 * size);
            }
        }
    }
}

/// Mistuned, with and without friction between neighbours: the ring solver against dense matrices.
#[test]
fn mistuned_rings_move_as_the_assembled_disk() {
    for (count, between, highest) in [
        (1, None, 3),
        (2, Some((2e5, 8.0)), 3),
        (3, None, 5),
        (9, None, 7),
        (9, Some((2e5, 8.0)), 5),
    ] {
        let factors: Vec<f64> =
            (0..count).map(|i| 1.0 + 0.07 * (2.3 * f64::from(i) + 0.4).sin()).collect();
        let ring = sectors(&factors, 2, between);
        let contacts = (0..ring.laws().len()).map(|i| Contact {
            law: ring.laws()[i].with_scaled_stiffness(1.0),
            rows: ring.ports().rows.get(i..i + 1, ..).to_owned(),
        });
        let loads = ring.ports().loads.clone();
        let dense = Model::new(ring.structure().clone(), contacts.collect(), loads).unwrap();
        let everywhere: Vec<usize> = (0..3 * factors.len()).collect();
        let omega: Vec<f64> = (0..18).map(|i| 150.0 + 25.0 * f64::from(i)).collect();
        let solve = |model: &Model, highest: usize| {
            sweep(ForcedBalance::new(model, fixed(highest), &everywhere).unwrap(), &omega).unwrap()
        };
        let (ours, theirs) = (solve(&ring, highest), solve(&dense, highest));
        let mut slips = false;
        for (a, b) in ours.points.iter().zip(&theirs.points) {
            assert_eq!((a.status, b.status), (PointStatus::Converged, PointStatus::Converged));
            assert!(a.iterations <= b.iterations + 3, "{} {}", a.iterations, b.iterations);
            slips |= b.contacts.iter().any(|c| c.slip_fraction > 0.0);
            let size = b.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
            for (a, b) in a.displacement.iter().zip(&b.displacement) {
                assert!((a - b).norm() < 1e-9 * size);
            }
        }
        // How far an estimate looks depends on what the equations cost in either form; neither is
        // far below the true error.
        let truth = solve(&dense, 41);
        for (point, truth) in
            ours.points.iter().chain(&theirs.points).zip(truth.points.iter().cycle())
        {
            let orders = |point: &Point| point.displacement.len() / everywhere.len();
            let size = truth.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
            for (dof, estimate) in point.error_estimate.iter().enumerate() {
                let of = |point: &Point, order: usize| {
                    let kept = order < orders(point);
                    if kept {
                        point.displacement[dof * orders(point) + order]
                    } else {
                        c64::new(0.0, 0.0)
                    }
                };
                let error: f64 =
                    (0..orders(truth)).map(|k| (of(point, k) - of(truth, k)).norm()).sum();
                assert!(error <= 5.0 * estimate + 1e-6 * size, "{error} {estimate}");
            }
        }
        assert!(slips);
    }
}

/// Laws of another stiffness reach the couplings between neighbours, and sensitivities the ring.
#[test]
fn other_laws_and_slopes_of_rings_are_those_of_the_whole_disk() {
    let between = Some((2e5, 8.0));
    let factors: Vec<f64> = (0..7).map(|i| 1.0 + 0.05 * (3.0 * f64::from(i)).sin()).collect();
    let stiffer = |model: &Model| {
        let laws = model.laws().iter().map(|law| law.with_parameter(0, 3e5).unwrap()).collect();
        model.with_laws(laws).unwrap()
    };
    let ring = stiffer(&sectors(&factors, 2, between));
    let whole = {
        let assembled = |model: &Model| {
            let contacts = (0..model.laws().len()).map(|i| Contact {
                law: model.laws()[i].with_scaled_stiffness(1.0),
                rows: model.ports().rows.get(i..i + 1, ..).to_owned(),
            });
            let loads = model.ports().loads.clone();
            Model::new(model.structure().clone(), contacts.collect(), loads).unwrap()
        };
        stiffer(&assembled(&sectors(&factors, 2, between)))
    };
    let observe = [0, 4, 10];
    let contacts = ring.compliance().contacts();
    let slip: Vec<c64> = (0..contacts).map(|i| c64::new(i as f64, 1.0)).collect();
    let zero = c64::new(0.0, 0.0);
    let mut receptance = Receptance::default();
    ring.compliance().receptance(3, 190.0, &mut receptance).unwrap();
    let contact: Vec<c64> = (0..contacts)
        .map(|i| (0..contacts).map(|j| receptance.contact[j * contacts + i] * slip[j]).sum())
        .collect();
    let displacement = |model: &Model, quantity, omega: f64| {
        let (contact, slip_load, observe) = (&contact[..], &slip[..], &observe[..]);
        let request = Request { harmonic: 3, omega, quantity, contact, slip_load, observe };
        let mut out = [zero; 3];
        model.compliance().displacement(&request, &mut out).unwrap();
        out
    };
    let values = |model: &Model| {
        [Quantity::Whole, Quantity::OfSlip, Quantity::Slope]
            .map(|quantity| displacement(model, quantity, 190.0))
    };
    for (ours, theirs) in values(&ring).iter().zip(&values(&whole)).take(2) {
        for (a, b) in ours.iter().zip(theirs) {
            assert!((a - b).norm() < 1e-9 * b.norm(), "{a} {b}");
        }
    }
    // At fixed slip load the whole motion changes; differences say by how much.
    let h = 1e-3;
    let at = |omega: f64| displacement(&ring, Quantity::Whole, omega);
    let (ahead, behind) = (at(190.0 + h), at(190.0 - h));
    for (i, slope) in values(&ring)[2].iter().enumerate() {
        let difference = (ahead[i] - behind[i]) / (2.0 * h);
        assert!((difference - slope).norm() < 1e-6 * slope.norm());
    }
}

#[test]
fn a_sector_moves_as_the_whole_disk() {
    for (between, highest, engine_order) in [
        (None, 7, 2),
        (Some((2e5, 8.0)), 7, 5),
        (Some((2e5, 8.0)), 5, 3),
        (None, 5, 0),
        (None, 5, 6),
    ] {
        let sectors = 12;
        let (wave, whole) =
            (ring(sectors, engine_order, between), assembly(sectors, engine_order, between));
        let omega: Vec<f64> = (0..16).map(|i| 160.0 + 40.0 * f64::from(i)).collect();
        let everywhere: Vec<usize> = (0..3 * sectors).collect();
        let one =
            sweep(ForcedBalance::new(&wave, fixed(highest), &[0, 1, 2]).unwrap(), &omega).unwrap();
        let all = sweep(ForcedBalance::new(&whole, fixed(highest), &everywhere).unwrap(), &omega)
            .unwrap();
        let mut slips = false;
        for (sector, disk) in one.points.iter().zip(&all.points) {
            assert_eq!(
                (sector.status, disk.status),
                (PointStatus::Converged, PointStatus::Converged)
            );
            let size = sector.displacement.iter().map(|x| x.norm()).fold(0.0, f64::max);
            let orders = highest + 1;
            slips |= sector.contacts.iter().any(|c| c.slip_fraction > 0.0);
            for blade in 0..sectors {
                for dof in 0..3 {
                    for k in 0..orders {
                        let turn =
                            TAU * ((blade * k * engine_order) % sectors) as f64 / sectors as f64;
                        let expected =
                            sector.displacement[dof * orders + k] * c64::from_polar(1.0, turn);
                        let found = disk.displacement[(3 * blade + dof) * orders + k];
                        assert!((expected - found).norm() < 1e-9 * size, "{blade} {dof} {k}");
                    }
                }
            }
        }
        assert!(slips);
    }
}

/// Guillen (1999), section 4.5: ring of 36 beams, engine order 2, converged peaks.
#[test]
fn the_tuned_ring_of_36_beams() {
    let ring = ring(36, 2, None);
    for (highest, expected) in
        [(1, 8.0014e-5), (3, 8.3035e-5), (7, 8.6130e-5), (15, 8.3912e-5), (35, 8.4116e-5)]
    {
        let (_, peak) = peak_of(&ring, fixed(highest), 0, Measure::HalfRange, (150.0, 269.0));
        assert!((peak / expected - 1.0).abs() < 1e-4, "{highest}: {peak} {expected}");
    }
}
