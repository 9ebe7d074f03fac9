//! Derivatives of the forces of a structure-like damper in its slip limits and its stiffness, against
//! central differences and the Jenkins element.

#![allow(clippy::unwrap_used)]

mod common;

use common::damper::{stiffness, Random, LIMITS};
use common::tangents::{difference, largest, motion};
use faer::{mat, Mat};
use std::collections::BTreeSet;
use stickslip_core::contact::{Aft, ContactLaw, Jenkins, PointState, SlipLoad, StructuralDamper};
use stickslip_core::fourier::{Harmonics, SampleTable};

/// Series of the contact forces `D u − q`.
fn force(law: &dyn ContactLaw, table: &SampleTable, u: &[f64]) -> Vec<f64> {
    let mut load = SlipLoad::default();
    law.slip_load(motion(table, u), false, &mut load);
    let (d, slots) = (law.stiffness(), table.harmonics().slots());
    (0..u.len())
        .map(|k| {
            let (i, slot) = (k / slots, k % slots);
            let stuck: f64 =
                (0..law.displacements()).map(|j| d[(i, j)] * u[j * slots + slot]).sum();
            stuck - load.value[k]
        })
        .collect()
}

fn slope(law: &dyn ContactLaw, table: &SampleTable, u: &[f64], index: usize) -> Vec<f64> {
    let mut slope = vec![f64::NAN; u.len()];
    law.parameter_slope(motion(table, u), index, &mut slope);
    slope
}

/// Deviation of a slope from central differences, the best of several steps: now and then one steps
/// over an event that appears or vanishes. Over the force per unit of the parameter.
fn error(law: &StructuralDamper, table: &SampleTable, u: &[f64], index: usize) -> f64 {
    let value = law.parameters()[index].value;
    let exact = slope(law, table, u, index);
    if value == f64::INFINITY {
        return largest(&exact);
    }
    let size = largest(&force(law, table, u)) / value;
    [1e-5, 1e-6, 1e-7]
        .iter()
        .map(|step| {
            let at = |sign: f64| {
                let changed = law.with_parameter(index, value * (1.0 + sign * step)).unwrap();
                force(changed.as_ref(), table, u)
            };
            let (ahead, behind) = (at(1.0), at(-1.0));
            let slope: Vec<f64> =
                ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step * value)).collect();
            difference(&slope, &exact) / largest(&exact).max(size).max(f64::MIN_POSITIVE)
        })
        .fold(f64::INFINITY, f64::min)
}

fn slip_sets(law: &dyn ContactLaw, table: &SampleTable, u: &[f64]) -> BTreeSet<Vec<bool>> {
    let phases = law.phases(motion(table, u));
    phases
        .iter()
        .map(|phase| phase.states.iter().map(|state| *state != PointState::Stuck).collect())
        .collect()
}

#[test]
fn slopes_of_the_dissertations_damper_match_differences_in_every_slip_set() {
    let law = StructuralDamper::new(stiffness().as_ref(), &LIMITS).unwrap();
    let mut random = Random(3);
    let mut sets = BTreeSet::new();
    for case in 0..60 {
        let table = SampleTable::new(Harmonics::new(1 + case % 6, case % 3 != 0));
        let size = 10f64.powf(random.between(-6.0, -2.5));
        let u = random.series(&table, 4, size);
        sets.extend(slip_sets(&law, &table, &u));
        for index in 0..5 {
            let error = error(&law, &table, &u, index);
            assert!(error < 1e-6, "case {case}, parameter {index}: {error:e} {u:?}");
        }
    }
    // Every subset of the three points that can slip.
    assert_eq!(sets.len(), 8, "{sets:?}");
}

#[test]
fn slopes_of_random_dampers_match_differences() {
    let mut random = Random(19);
    let mut slipped = 0;
    for case in 0..120 {
        let points = 1 + case % 6;
        let table = SampleTable::new(Harmonics::new(1 + case % 7, case % 2 == 0));
        let law = random.damper(points, 1.0, 1.0);
        let size = 10f64.powf(random.between(-1.0, 2.0));
        let u = random.series(&table, points, size);
        slipped += usize::from(slip_sets(&law, &table, &u).len() > 1);
        for (index, parameter) in law.parameters().iter().enumerate() {
            if parameter.value > 0.0 {
                let error = error(&law, &table, &u, index);
                assert!(error < 1e-5, "case {case}, {parameter:?}: {error:e}, {law:?}, {u:?}");
            }
        }
    }
    assert!(slipped > 60, "{slipped}");
}

#[test]
fn slopes_of_two_points_are_those_of_a_jenkins_element() {
    let (k, limit) = (3.0, 0.7);
    let damper =
        StructuralDamper::new(mat![[k, -k], [-k, k]].as_ref(), &[limit, f64::INFINITY]).unwrap();
    let jenkins = Jenkins::new(k, limit).unwrap();
    let mut random = Random(5);
    for case in 0..40 {
        // Only odd harmonics: a mean motion sets them apart where nothing slips.
        let table = SampleTable::new(Harmonics::new(1 + case % 9, true));
        let slots = table.harmonics().slots();
        let u = random.series(&table, 2, 0.1 + case as f64 / 10.0);
        let apart: Vec<f64> = (0..slots).map(|s| u[s] - u[slots + s]).collect();
        let by_force = slope(&damper, &table, &u, 0);
        let by_factor = slope(&damper, &table, &u, 2);
        let expected = slope(&jenkins, &table, &apart, 1);
        let by_stiffness: Vec<f64> =
            slope(&jenkins, &table, &apart, 0).iter().map(|s| k * s).collect();
        let size = largest(&apart).max(1.0);
        assert!(difference(&by_force[..slots], &expected) < 1e-11, "{case}");
        assert!(difference(&by_factor[..slots], &by_stiffness) < 1e-11 * k * size, "{case}");
        for (one, other) in by_force[..slots].iter().zip(&by_force[slots..]) {
            assert!((one + other).abs() < 1e-11);
        }
        assert_eq!(largest(&slope(&damper, &table, &u, 1)), 0.0);
    }
}

#[test]
fn the_first_traces_of_friction_and_of_stiffness_count() {
    let (k, table) = (3.0, SampleTable::new(Harmonics::new(3, true)));
    let spring = mat![[k, -k], [-k, k]];
    let damper = StructuralDamper::new(spring.as_ref(), &[0.0, f64::INFINITY]).unwrap();
    let u = [1.0, 0.3, -0.2, 0.1, -0.4, 0.2, 0.1, 0.0];
    let apart: Vec<f64> = (0..4).map(|s| u[s] - u[4 + s]).collect();
    let expected = slope(&Jenkins::new(k, 0.0).unwrap(), &table, &apart, 1);
    assert!(largest(&expected) > 0.5);
    let error = difference(&slope(&damper, &table, &u, 0)[..4], &expected);
    assert!(error < 1e-4, "{error:e}");
    // A damper at rest has no direction of slip.
    assert_eq!(slope(&damper, &table, &[0.0; 8], 0), vec![0.0; 8]);

    // Without stiffness its first trace follows the motion.
    let slack = StructuralDamper::new(spring.as_ref(), &[0.7, f64::INFINITY]).unwrap();
    let slack = slack.with_parameter(2, 0.0).unwrap();
    assert_eq!(largest(&force(slack.as_ref(), &table, &u)), 0.0);
    let expected: Vec<f64> = apart.iter().map(|u| k * u).collect();
    let found = slope(slack.as_ref(), &table, &u, 2);
    assert!(difference(&found[..4], &expected) < 1e-14);
    assert!(difference(&slope(slack.as_ref(), &table, &u, 0), &[0.0; 8]) < 1e-14);
}

#[test]
fn a_factor_on_the_stiffness_is_the_stiffness_times_it_and_can_be_taken_back() {
    let law = StructuralDamper::new(stiffness().as_ref(), &LIMITS).unwrap();
    let table = SampleTable::new(Harmonics::new(5, true));
    let u = Random(2).series(&table, 4, 3e-4);
    let twice: Mat<f64> = faer::Scale(2.0) * stiffness();
    let expected = StructuralDamper::new(twice.as_ref(), &LIMITS).unwrap();
    let doubled = law.with_parameter(4, 2.0).unwrap();
    assert_eq!(doubled.stiffness(), twice);
    assert_eq!(doubled.parameters()[4].value, 2.0);
    let size = largest(&force(&expected, &table, &u));
    let off = difference(&force(doubled.as_ref(), &table, &u), &force(&expected, &table, &u));
    assert!(off < 1e-12 * size);
    let back = doubled.with_parameter(4, 0.0).unwrap().with_parameter(4, 1.0).unwrap();
    assert_eq!(back.stiffness(), law.stiffness());
    // The slope is in the factor, not in what it has made of D.
    let exact = slope(doubled.as_ref(), &table, &u, 4);
    let own: Vec<f64> = slope(&expected, &table, &u, 4).iter().map(|s| s / 2.0).collect();
    assert!(difference(&exact, &own) < 1e-12 * size);

    for (index, value) in [(0, -1.0), (1, f64::NAN), (4, -1.0), (4, f64::INFINITY)] {
        let message = law.with_parameter(index, value).unwrap_err().to_string();
        assert!(message.contains("structural: "), "{message}");
    }
}

/// Of one point that slips at a time: where one sticks as another begins to slip the march is of first
/// order, and its derivative does not converge.
#[test]
fn a_march_approaches_the_slopes() {
    let spring = mat![[3.0, -3.0], [-3.0, 3.0]];
    let law = StructuralDamper::new(spring.as_ref(), &[0.7, 2.0]).unwrap();
    let table = SampleTable::new(Harmonics::new(5, true));
    let u = Random(8).series(&table, 2, 1.0);
    for index in [0, 2] {
        let exact = slope(&law, &table, &u, index);
        assert!(largest(&exact) > 0.1);
        let errors = [512, 8192].map(|samples| {
            let marched = Aft::new(law.with_scaled_stiffness(1.0), samples).unwrap();
            difference(&slope(&marched, &table, &u, index), &exact) / largest(&exact)
        });
        assert!(errors[1] < 1e-3 && errors[1] < 0.2 * errors[0], "{index}: {errors:?}");
    }
}
