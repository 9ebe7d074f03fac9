//! The exact flow: no point slips against its force, and a run ends when it is told to.
#![allow(clippy::unwrap_used)]

use faer::{mat, Mat};
use stickslip_core::contact::{PointState, StructuralDamper};
use stickslip_core::model::{Contact, Model};
use stickslip_core::motion::{Flow, FlowEvent, Halt, ModalSystem, State};
use stickslip_core::structure::Structure;

/// Three masses on springs, joined by a damper that touches all of them.
fn masses() -> Model {
    let mass = Mat::<f64>::identity(3, 3);
    let stiffness = mat![[1.0, 0.0, 0.0], [0.0, 1.7, 0.0], [0.0, 0.0, 2.9]];
    let structure =
        Structure::new(mass.as_ref(), Mat::zeros(3, 3).as_ref(), stiffness.as_ref()).unwrap();
    let damper = mat![[3.0, -2.4, -0.5], [-2.4, 3.4, -0.8], [-0.5, -0.8, 1.5]];
    let law = StructuralDamper::new(damper.as_ref(), &[0.2, 0.5, 0.3]).unwrap();
    let contacts = vec![Contact { law: Box::new(law), rows: Mat::identity(3, 3) }];
    Model::new(structure, contacts, Vec::new()).unwrap()
}

#[test]
fn no_point_slips_against_its_force() {
    let model = masses();
    let system = ModalSystem::new(&model).unwrap();
    let mut turned_back = 0;
    for start in 0..40 {
        let mut state = State::rest(&system);
        for (j, v) in state.velocity.iter_mut().enumerate() {
            *v = 2.0 * (f64::from(start) * (1.3 + j as f64)).sin();
        }
        let mut begun = f64::NAN;
        Flow::new(&system, 1.0)
            .run(&mut state, 20.0, &mut |passage| match passage {
                FlowEvent::Segment(arc) => {
                    let (mut x, mut v) = (vec![0.0; 3], vec![0.0; 3]);
                    arc.series.motion_at(0.5 * arc.length, &mut x, &mut v);
                    let speed = system.contact_displacement(&v);
                    for (i, point) in arc.regime.points.iter().enumerate() {
                        let slip: f64 =
                            (0..3).map(|j| arc.regime.slip_rate[(i, j)] * speed[j]).sum();
                        assert!(slip * point.sign() >= -1e-9, "{start}: {i} at {slip}");
                    }
                }
                FlowEvent::Event { event, .. } if event.state != PointState::Stuck => {
                    begun = event.time;
                }
                FlowEvent::Event { event, .. } => {
                    turned_back += usize::from(event.time == begun);
                }
            })
            .unwrap();
    }
    assert!(turned_back > 0);
}

#[test]
fn a_flow_takes_the_steps_that_it_is_granted_and_asks_whether_to_end() {
    let model = masses();
    let system = ModalSystem::new(&model).unwrap();
    let mut state = State::rest(&system);
    state.velocity[0] = 1.0;
    let mut flow = Flow::new(&system, 1.0).granted(7);
    let run = flow.run(&mut state.clone(), 1e6, &mut |_| {});
    assert_eq!((run, flow.steps, flow.is_spent()), (Err(Halt::Steps), 7, true));
    let asked = std::cell::Cell::new(0);
    let interrupted = || {
        asked.set(asked.get() + 1);
        asked.get() > 3
    };
    let mut flow = Flow::new(&system, 1.0).watched(&interrupted);
    let run = flow.run(&mut state, 1e6, &mut |_| {});
    assert_eq!((run, flow.steps), (Err(Halt::Interrupted), 3 * 32));
}
