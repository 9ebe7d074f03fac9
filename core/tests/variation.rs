//! What is varied, and what the analyses refuse.
#![allow(clippy::unwrap_used)]

use faer::{mat, Mat};
use stickslip_core::balance::Settings;
use stickslip_core::contact::{Jenkins, StructuralDamper};
use stickslip_core::design::{peak_curve, Target};
use stickslip_core::fourier::Measure;
use stickslip_core::model::{
    Change, Contact, FlutterModel, NegativeDamping, ParameterMode, Variation,
};
use stickslip_core::structure::Structure;
use stickslip_core::Model;

/// A Jenkins element, then a damper of two points with the limits 2 and infinity.
fn model() -> Model {
    let unit = mat![[1.0, 0.0], [0.0, 1.0]];
    let structure = Structure::new(unit.as_ref(), unit.as_ref(), unit.as_ref()).unwrap();
    let spring = mat![[3.0, -3.0], [-3.0, 3.0]];
    let contacts = vec![
        Contact {
            law: Box::new(Jenkins::new(5.0, 0.5).unwrap()),
            rows: Mat::from_fn(1, 2, |_, j| if j == 0 { 1.0 } else { 0.0 }),
        },
        Contact {
            law: Box::new(StructuralDamper::new(spring.as_ref(), &[2.0, f64::INFINITY]).unwrap()),
            rows: unit,
        },
    ];
    Model::new(structure, contacts, Vec::new()).unwrap()
}

fn law(parameter: &str, contacts: &[(usize, Option<usize>)], common: ParameterMode) -> Variation {
    Variation::Law { parameter: parameter.to_owned(), contacts: contacts.to_vec(), common }
}

fn values(variation: &Variation, value: f64) -> Vec<f64> {
    let laws = variation.laws(&model(), value).unwrap();
    laws.iter().flat_map(|law| law.parameters()).map(|one| one.value).collect()
}

#[test]
fn contacts_and_points_take_values_and_factors() {
    let all = [(0, None), (1, None)];
    // k and F of the first, then both limits and the factor on D of the second.
    let given = vec![5.0, 0.5, 2.0, f64::INFINITY, 1.0];
    assert_eq!(values(&Variation::Level, 3.0), given);
    assert_eq!(values(&Variation::Ratio, 3.0), given);
    let factor = values(&law("slip_force", &all, ParameterMode::Factor), 3.0);
    assert_eq!(factor, vec![5.0, 1.5, 6.0, f64::INFINITY, 1.0]);
    // What never slips does so without friction, too: 0 times infinity is no number.
    let none = values(&law("slip_force", &all, ParameterMode::Factor), 0.0);
    assert_eq!(none, vec![5.0, 0.0, 0.0, f64::INFINITY, 1.0]);
    let value = values(&law("slip_force", &[(0, None), (1, Some(0))], ParameterMode::Value), 3.0);
    assert_eq!(value, vec![5.0, 3.0, 3.0, f64::INFINITY, 1.0]);
    let stiffness = values(&law("stiffness", &all, ParameterMode::Factor), 3.0);
    assert_eq!(stiffness, vec![15.0, 0.5, 2.0, f64::INFINITY, 3.0]);

    let changes = law("slip_force", &all, ParameterMode::Factor).changes(&model()).unwrap();
    let rates: Vec<f64> = changes.iter().map(Change::rate).collect();
    assert_eq!(rates, vec![0.5, 2.0, 0.0]);
}

#[test]
fn what_a_model_does_not_have_is_refused() {
    for (variation, part) in [
        (law("stiffness", &[(1, None)], ParameterMode::Value), "contact 2: parameter"),
        (law("stiffness", &[(1, Some(0))], ParameterMode::Factor), "slip_force"),
        (law("slip_force", &[(1, Some(2))], ParameterMode::Value), "contact 2"),
        (law("mass", &[(0, None)], ParameterMode::Value), "stiffness or slip_force"),
        (law("slip_force", &[(2, None)], ParameterMode::Value), "2 contacts"),
    ] {
        let message = variation.changes(&model()).unwrap_err().to_string();
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn every_analysis_refuses_what_it_does_not_vary() {
    let target = Target { dof: 0, measure: Measure::HalfRange, span: (0.5, 2.0) };
    let settings = Settings::default();
    let curve = peak_curve(&model(), settings, &Variation::Ratio, &[1.0], &target, &|_| true, None);
    assert!(curve.unwrap_err().to_string().contains("limit cycles"));
    let negative = NegativeDamping::Whole(mat![[-1.0, 0.0], [0.0, -1.0]]);
    let model = model();
    let cycles = FlutterModel::new(&model, negative, Variation::Level, 1.0);
    assert!(cycles.err().is_some_and(|error| error.to_string().contains("no loads")));
}
