//! Limit cycles under negative damping against the exact values of Guillen (1999), chapter V.
#![allow(clippy::unwrap_used)]

mod common;

use common::snecma_beam;
use faer::{mat, Mat};
use stickslip_core::balance::{CycleBalance, Onset};
use stickslip_core::contact::Jenkins;
use stickslip_core::fourier::{Harmonics, SampleTable};
use stickslip_core::model::{Contact, Model, NegativeDamping, Scalar, SelfExcited};
use stickslip_core::orbit::{limit_cycles, CycleOrbits, CycleSettings, OrbitCurve};
use stickslip_core::solve::{Bounds, Branch, Steps};
use stickslip_core::structure::Structure;

fn single_dof() -> (Model, Mat<f64>) {
    let one = |value: f64| Mat::from_fn(1, 1, |_, _| value);
    let structure =
        Structure::new(one(944.6).as_ref(), one(0.0).as_ref(), one(2.4e7).as_ref()).unwrap();
    let law = Box::new(Jenkins::new(2.4e7, 246.048).unwrap());
    let contacts = vec![Contact { law, rows: mat![[1.0]] }];
    (Model::new(structure, contacts, Vec::new()).unwrap(), one(-7699.054))
}

fn beam() -> (Model, Mat<f64>) {
    let mut system = snecma_beam(0.0);
    let negative = faer::Scale(-1.0) * &system.damping;
    system.damping = Mat::zeros(3, 3);
    system.forces.clear();
    (system.model(), negative)
}

fn trace(model: &Model, negative: Mat<f64>, mode: usize, highest: usize) {
    let family =
        SelfExcited::new(model, NegativeDamping::Whole(negative), Scalar::Ratio, 1.0).unwrap();
    let table = SampleTable::new(Harmonics::new(highest, true));
    let onset = Onset::new(&family, mode, 0.01).unwrap();
    let start = onset.first_point(&family, &table, 0.01, &|| false).unwrap();
    let time = std::time::Instant::now();
    let mut curve = CycleBalance::new(&family, &table, &start, &|| false);
    let bounds = Bounds { range: (0.0099, f64::INFINITY), most: 3000, ends: &|_| false };
    let branch = Branch::walk(&mut curve, start, 1.0, Steps::default(), &bounds);
    println!(
        "mode {mode} H {highest}: {:?} {} points {} iterations {} evaluations {} jumps {:?}",
        branch.end, branch.points.len(), branch.iterations, curve.evaluations, branch.jumps, time.elapsed()
    );
    for &fold in &branch.folds {
        let z = &branch.points[fold];
        println!("  fold {:?}", &z[z.len() - 2..]);
    }
    for r in [0.1, 1.0, 3.0, 5.0] {
        for (_, z) in branch.at(&mut curve, r) {
            let point = curve.point(&z, onset.dof);
            println!("  {r} {:?} {:?}", point.omega, point.contact_displacement[1].norm());
        }
    }
    let last = branch.points.last().unwrap();
    println!("  end {:?}", &last[last.len() - 2..]);
}

#[test]
fn look() {
    let (model, negative) = single_dof();
    for highest in [1, 31] {
        trace(&model, negative.clone(), 0, highest);
    }
    let (model, negative) = beam();
    for mode in 0..3 {
        for highest in [3, 15, 31, 63] {
            trace(&model, negative.clone(), mode, highest);
        }
    }
}

fn trace_exact(model: &Model, negative: Mat<f64>, mode: usize) {
    let family =
        SelfExcited::new(model, NegativeDamping::Whole(negative), Scalar::Ratio, 1.0).unwrap();
    let table = SampleTable::new(Harmonics::new(9, true));
    let onset = Onset::new(&family, mode, 0.01).unwrap();
    let start = onset.first_point(&family, &table, 0.01, &|| false).unwrap();
    let time = std::time::Instant::now();
    let point = CycleBalance::new(&family, &table, &start, &|| false).point(&start, onset.dof);
    let orbits = CycleOrbits::new(&family).unwrap().unwrap();
    let start = orbits.unknowns(&point, 0.01, onset.mode.omega).unwrap();
    let mut curve = OrbitCurve::new(&orbits, onset.mode.omega, &start, &|| false);
    let (start, its) = stickslip_core::solve::at_parameter(&mut curve, &start, 0.01, 25).unwrap();
    println!("start {its} {:?}", &start[start.len() - 2..]);
    let bounds = Bounds { range: (0.0099, f64::INFINITY), most: 3000, ends: &|_| false };
    let branch = Branch::walk(&mut curve, start, 1.0, Steps::default(), &bounds);
    println!(
        "exact mode {mode}: {:?} {} points {} iterations {} flows {} jumps {:?}",
        branch.end, branch.points.len(), branch.iterations, curve.flows, branch.jumps, time.elapsed()
    );
    for &fold in &branch.folds {
        let z = &branch.points[fold];
        println!("  fold {:?}", &z[z.len() - 2..]);
    }
    for r in [0.1, 1.0, 3.0, 4.6, 4.7, 5.0] {
        for (_, z) in branch.at(&mut curve, r) {
            let (m, _) = curve.multipliers(&z).unwrap();
            println!("  {r} {:?} {:?} {:?}", z[z.len() - 2], m[0] * m[0], m.len());
        }
    }
    let last = branch.points.last().unwrap();
    println!("  end {:?}", &last[last.len() - 2..]);
}

#[test]
fn look_exact() {
    let (model, negative) = single_dof();
    trace_exact(&model, negative.clone(), 0);
    let (model, negative) = beam();
    for mode in 0..3 {
        trace_exact(&model, negative.clone(), mode);
    }
}

#[test]
fn look_driver() {
    let (model, negative) = beam();
    for exact in [true, false] {
        let time = std::time::Instant::now();
        let settings = CycleSettings { exact, ..CycleSettings::default() };
        let out = limit_cycles(&model, &NegativeDamping::Whole(negative.clone()), &Scalar::Ratio, 1.0, &settings, &|_| true).unwrap();
        println!("{exact} {:?} {} limit {:?} ends {:?} {:?}", time.elapsed(), out.cycles.len(), out.limit, out.ends, out.end_values);
        for c in &out.changes { println!("{c:?}"); }
        println!("closed {}", out.cycles.iter().filter(|c| c.closed).count());
    }
    let (model, negative) = single_dof();
    for exact in [true, false] {
        let time = std::time::Instant::now();
        let settings = CycleSettings { exact, range: (1e3, 2.4e10), ..CycleSettings::default() };
        let scalar = Scalar::Law { parameter: "stiffness".into(), contacts: vec![0], factor: false };
        let out = limit_cycles(&model, &NegativeDamping::Whole(negative.clone()), &scalar, 1.0, &settings, &|_| true).unwrap();
        println!("{exact} {:?} {} limit {:?} {} ends {:?} {:?}", time.elapsed(), out.cycles.len(), out.limit, out.limit.unwrap().value / 2.4e7, out.ends, out.end_values);
        for c in &out.changes { println!("{c:?}"); }
        let amp = |c: &stickslip_core::orbit::Cycle| c.response.contact_displacement[1].norm();
        println!("{:?} {:?}", amp(&out.cycles[0]), amp(out.cycles.last().unwrap()));
    }
}
