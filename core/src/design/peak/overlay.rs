//! Loads at several harmonics: what the phases between their motions do to an amplitude.
//!
//! How high such a motion is depends on how its harmonics fall on each other, which changes as fast as
//! their phases: by a multiple of π within the bandwidth of every resonance. The curve of the amplitude
//! has as many summits then, of which none needs to be at a resonance, and no slope at its ends tells of
//! those between. What bounds it is the sum of the moduli, which is as smooth as each of them.

use super::interpolant::Knot;
use crate::fourier::{Harmonics, Measure};
use std::f64::consts::{PI, TAU};

/// Change of the amplitude, relative, that the phases may make in an interval in which the slopes of the
/// amplitude tell of all its summits.
const TURN: f64 = 0.25;

/// The motion of a loaded harmonic.
#[derive(Debug, Clone, Copy)]
struct Tone {
    order: f64,
    modulus: f64,
    phase: f64,
    /// Its derivative in frequency.
    rate: f64,
}

/// The harmonics of a motion at a frequency.
#[derive(Debug, Clone)]
pub(super) struct Overlay {
    /// What the amplitude were if the harmonics fell on each other, and its slope.
    pub(super) ceiling: Knot,
    /// Those that are loaded.
    tones: Vec<Tone>,
}

impl Overlay {
    /// Of a series with its derivative in frequency, under loads of the `orders`.
    pub(super) fn new(
        at: f64,
        (harmonics, series, slopes): (&Harmonics, &[f64], &[f64]),
        orders: &[usize],
        measure: Measure,
    ) -> Self {
        let mean = harmonics.mean(series);
        let (mut height, mut slope) = match measure {
            Measure::Max => (mean.abs(), 1.0_f64.copysign(mean) * harmonics.mean(slopes)),
            Measure::HalfRange | Measure::Fundamental => (0.0, 0.0),
        };
        let mut tones = Vec::with_capacity(orders.len());
        for &order in harmonics.oscillating() {
            let Some(slot) = harmonics.slot(order) else { continue };
            let [a, b, da, db] = [series[slot], series[slot + 1], slopes[slot], slopes[slot + 1]];
            let modulus = a.hypot(b);
            if modulus == 0.0 {
                continue;
            }
            height += modulus;
            slope += (a * da + b * db) / modulus;
            if orders.contains(&order) {
                let rate = (a * db - b * da) / (modulus * modulus);
                tones.push(Tone { order: order as f64, modulus, phase: b.atan2(a), rate });
            }
        }
        Self { ceiling: Knot { at, height, slope }, tones }
    }

    /// Whether the phases turn so far between two points that the amplitude may have summits there of
    /// which neither tells.
    pub(super) fn turns_to(&self, other: &Self, height: f64) -> bool {
        let width = other.ceiling.at - self.ceiling.at;
        let pairs = self.tones.iter().filter_map(|one| {
            let same = |other: &&Tone| other.order == one.order;
            other.tones.iter().find(same).map(|other| (one, other))
        });
        let larger = |(one, other): (&Tone, &Tone)| one.modulus.max(other.modulus);
        // Time is counted from the largest.
        let by_size = |a: &(&Tone, &Tone), b: &(&Tone, &Tone)| larger(*a).total_cmp(&larger(*b));
        let Some(largest) = pairs.clone().max_by(by_size) else { return false };
        let missed = |(one, other): (&Tone, &Tone)| {
            let expected = 0.5 * width * (one.rate + other.rate);
            let error = other.phase - one.phase - expected;
            (error - TAU * (error / TAU).round()).abs().min(PI)
        };
        let turned = |pair: (&Tone, &Tone)| {
            let share = pair.0.order / largest.0.order;
            let left = pair.0.rate - share * largest.0.rate;
            let right = pair.1.rate - share * largest.1.rate;
            width * left.abs().max(right.abs()) + missed(pair) + share * missed(largest)
        };
        let others = pairs.filter(|pair| pair.0.order != largest.0.order);
        others.map(|pair| larger(pair) * turned(pair)).sum::<f64>() > TURN * height
    }
}
