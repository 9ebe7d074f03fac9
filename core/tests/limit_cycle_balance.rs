//! The balance of limit cycles: its Jacobian against differences of its residual.
#![allow(clippy::unwrap_used, clippy::panic)]

use faer::{mat, Mat};
use stickslip_core::balance::CycleBalance;
use stickslip_core::contact::Jenkins;
use stickslip_core::fourier::{Harmonics, SampleTable};
use stickslip_core::model::{
    Contact, FlutterModel, Model, NegativeDamping, ParameterMode, Variation,
};
use stickslip_core::solve::Curve as _;
use stickslip_core::structure::Structure;

fn model(coupled: bool) -> (Model, Mat<f64>) {
    let mass = mat![[2.0, 0.1], [0.1, 1.0]];
    let stiffness = mat![[300.0, -100.0], [-100.0, 150.0]];
    let damping = Mat::<f64>::zeros(2, 2);
    let structure = Structure::new(mass.as_ref(), damping.as_ref(), stiffness.as_ref()).unwrap();
    let contact = |row: [f64; 2], stiffness, slip_force| Contact {
        law: Box::new(Jenkins::new(stiffness, slip_force).unwrap()),
        rows: Mat::from_fn(1, 2, |_, j| row[j]),
    };
    let contacts = vec![contact([1.0, 0.0], 80.0, 0.3), contact([1.0, -1.0], 200.0, 0.2)];
    let negative =
        if coupled { mat![[-0.5, 0.2], [-0.1, -0.3]] } else { faer::Scale(-0.2) * &mass };
    (Model::new(structure, contacts, Vec::new()).unwrap(), negative)
}

#[test]
fn jacobians_match_differences_of_the_residual() {
    let law = |name: &str| Variation::Law {
        parameter: name.to_owned(),
        contacts: vec![(0, None), (1, None)],
        common: ParameterMode::Factor,
    };
    for (coupled, variation) in [
        (false, Variation::Ratio),
        (true, Variation::Ratio),
        (false, law("stiffness")),
        (true, law("slip_force")),
    ] {
        let (model, negative) = model(coupled);
        let by_law = variation != Variation::Ratio;
        let family =
            FlutterModel::new(&model, NegativeDamping::Whole(negative), variation, 0.7).unwrap();
        let table = SampleTable::new(Harmonics::new(5, true));
        let size = 2 * table.harmonics().slots();
        let mut z: Vec<f64> =
            (0..size).map(|i| 0.02 * (1.0 + i as f64).sin() / (1.0 + i as f64 / 3.0)).collect();
        z.extend([9.0, 1.1]);
        let mut curve = CycleBalance::new(&family, &table, &z, &|| false);
        let unknowns = curve.unknowns();
        let jacobian = curve.jacobian(&z).unwrap();
        let (mut ahead, mut behind) = (vec![0.0; unknowns - 1], vec![0.0; unknowns - 1]);
        // The derivative in a parameter of the laws is that of a solution.
        let last = if by_law { unknowns - 1 } else { unknowns };
        for j in 0..last {
            let h = 1e-6 * z[j].abs().max(1e-3);
            let mut shifted = z.clone();
            shifted[j] += h;
            curve.residual(&shifted, &mut ahead);
            shifted[j] -= 2.0 * h;
            curve.residual(&shifted, &mut behind);
            for i in 0..unknowns - 1 {
                let difference = (ahead[i] - behind[i]) / (2.0 * h);
                let scale = 1.0 + difference.abs() + jacobian.col(j).norm_max();
                assert!((difference - jacobian[(i, j)]).abs() < 1e-6 * scale, "{i} {j}");
            }
        }
    }
}
