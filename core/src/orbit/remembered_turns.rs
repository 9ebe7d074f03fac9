//! Reversals of a period that a contact without sliders still remembers at its end.

use crate::contact::REVERSALS;

/// A reversal of the period.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reversal {
    pub(super) piece: usize,
    pub(super) contact: usize,
    /// Among those of its contact in the piece.
    pub(super) number: usize,
    /// −1 where its mirror image is meant.
    pub(super) sign: f64,
    /// Displacement \[m\].
    pub(super) at: f64,
}

/// Reversals that one contact remembers at an instant.
#[derive(Debug, Clone, Default)]
pub(super) struct RememberedTurns {
    /// Largest and least of the period; under half-wave symmetry none.
    pub(super) outermost: Option<[Reversal; 2]>,
    pub(super) kept: Vec<Reversal>,
}

impl RememberedTurns {
    /// Those of a period's reversals, in their order, that no loop has closed until the displacement is
    /// `now` \[m\]: the outermost and those behind them. Nothing of a contact that has not turned round.
    pub(super) fn new(turns: &[Reversal], now: f64, half_wave: bool) -> Option<Self> {
        let most = |of: &dyn Fn(f64) -> f64| {
            (0..turns.len()).max_by(|a, b| of(turns[*a].at).total_cmp(&of(turns[*b].at)))
        };
        let (mut kept, outermost, next) = if half_wave {
            let largest = most(&f64::abs)?;
            (vec![turns[largest]], None, largest + 1)
        } else {
            let (high, low) = (most(&|u| u)?, most(&|u| -u)?);
            if high == low {
                return None;
            }
            let (first, second) = (high.min(low), high.max(low));
            (vec![turns[first], turns[second]], Some([turns[high], turns[low]]), second + 1)
        };
        let outer = kept.len();
        for turn in &turns[next..] {
            close_loops(&mut kept, outer, turn.at);
            kept.push(*turn);
        }
        close_loops(&mut kept, outer, now);
        while kept.len() > REVERSALS {
            let way = |i: usize| (kept[i + 1].at - kept[i].at).abs();
            let inner = outer..kept.len() - 1;
            let least = inner.min_by(|a, b| way(*a).total_cmp(&way(*b)))?;
            kept.drain(least..least + 2);
        }
        Some(Self { outermost, kept })
    }
}

/// Forgets the loops that a motion to the displacement `u` closes; the `outer` reversals stay.
fn close_loops(kept: &mut Vec<Reversal>, outer: usize, u: f64) {
    while kept.len() >= outer + 2 {
        let [.., before, last] = kept[..] else { break };
        let sign = 1.0_f64.copysign(before.at - last.at);
        if sign * (u - before.at) < 0.0 {
            break;
        }
        kept.truncate(kept.len() - 2);
    }
}
