//! A node in Coulomb contact: its exact forces, and random motions of it.

use super::damper::Random;
use stickslip_core::contact::{
    Closure, ContactLaw as _, Coulomb, HarmonicForce, Motion, PointSummary, Residual, SlipLoad,
};
use stickslip_core::fourier::{Harmonics, SampleTable};

pub fn exact(law: &Coulomb) -> &dyn HarmonicForce {
    law.closed_form().unwrap()
}

pub fn motion<'a>(table: &'a SampleTable, displacement: &'a [f64]) -> Motion<'a> {
    Motion { table, displacement, residual: Residual::Centred }
}

pub fn load(law: &dyn HarmonicForce, motion: Motion<'_>, tangent: bool) -> SlipLoad {
    let mut out = SlipLoad::default();
    law.slip_load(motion, tangent, &mut out);
    out
}

/// Series of the force, `D u − q`.
pub fn force(law: &Coulomb, motion: Motion<'_>) -> Vec<f64> {
    let slots = motion.table.harmonics().slots();
    let stiffness = law.stiffness();
    let q = load(exact(law), motion, false).value;
    let stuck = |(index, u): (usize, &f64)| stiffness[(index / slots, index / slots)] * u;
    motion.displacement.iter().enumerate().map(stuck).zip(q).map(|(stuck, q)| stuck - q).collect()
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(1e-300_f64, |most, x| most.max(x.abs()))
}

pub fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let size = largest(expected);
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs() / size;
        assert!(error <= tolerance, "{what}: [{i}] {found} {expected} of {size}: {error:.2e}");
    }
}

/// A random contact and a motion of it, in units of the order of one.
pub struct Case {
    pub law: Coulomb,
    pub table: SampleTable,
    pub displacement: Vec<f64>,
}

/// Contacts that stick, slip, open and close again, by turns.
pub fn random_case(random: &mut Random, directions: usize, highest: usize) -> Case {
    let friction = random.between(0.0, 1.2);
    let tangential_stiffness = 10f64.powf(random.between(-0.5, 1.0));
    let normal_stiffness = 10f64.powf(random.between(-0.5, 1.0));
    let closure = if random.next() > 0.0 {
        Closure::Preload(normal_stiffness * random.between(0.0, 2.0))
    } else {
        Closure::Gap(random.between(-1.5, 0.7))
    };
    let law =
        Coulomb::new(directions, friction, tangential_stiffness, Some(normal_stiffness), closure);
    let table = SampleTable::new(Harmonics::new(highest, false));
    let slots = table.harmonics().slots();
    let decay = random.between(0.5, 2.0);
    let amplitude = 10f64.powf(random.between(-1.0, 0.5));
    let displacement = (0..(directions + 1) * slots)
        .map(|index| {
            let order = (index % slots).div_ceil(2).max(1) as f64;
            let size = if index / slots == directions { 1.0 } else { amplitude };
            size * random.next() / order.powf(decay)
        })
        .collect();
    Case { law: law.unwrap(), table, displacement }
}

pub fn summary(law: &dyn HarmonicForce, motion: Motion<'_>) -> Vec<PointSummary> {
    let slots = motion.table.harmonics().slots();
    let mut out = vec![PointSummary::default(); motion.displacement.len() / slots];
    law.summary(motion, &mut out);
    out
}

pub fn shakes_down(case: &Case) -> bool {
    let shares = summary(exact(&case.law), motion(&case.table, &case.displacement));
    // Slip that dies out slowly takes a march more laps than it has.
    shares.iter().all(|share| share.slip_fraction < 0.01)
}
