//! Many mistuning patterns at once, in parallel threads.
//!
//! What is computed of a pattern depends on nothing but the pattern and the tuned disk: neither on
//! the patterns before it nor on the number of threads, so that numbers are the same bit by bit.

use super::mistuned::TunedDisk;
use super::peak::{climbed, PeakQuery, Summits, OF_STUDY};
use crate::balance::Settings;
use crate::Error;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{sync_channel, RecvTimeoutError};
use std::time::Duration;

/// Time between two questions whether to go on.
const PATIENCE: Duration = Duration::from_millis(50);

/// A mistuned disk to compute.
#[derive(Debug, Clone, Copy)]
pub struct Pattern<'a> {
    /// Position of the tuned disk.
    pub disk: usize,
    /// Deviations of the sectors' stiffness.
    pub deviations: &'a [f64],
}

/// Finds the summits of every pattern, of DOFs of a sector at all sectors, and hands them over one
/// by one with the position of their pattern as they come; `order` is the order at which automatic
/// harmonics start, by disk. Where `deliver` returns `false`, or `wait`, which is called about
/// twenty times per second, patterns under way are given up.
///
/// # Errors
/// The first that a pattern meets; those that were handed over before are good.
#[allow(clippy::too_many_arguments)]
pub fn study(
    disks: &[&TunedDisk],
    patterns: &[Pattern<'_>],
    settings: Settings,
    quest: &PeakQuery,
    order: &[Option<usize>],
    threads: usize,
    deliver: &mut dyn FnMut(usize, Summits) -> bool,
    wait: &mut dyn FnMut() -> bool,
) -> Result<(), Error> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Error::shape("threads", "as many as the system grants", error))?;
    let stop = AtomicBool::new(false);
    // Nothing is kept between a thread and `deliver`: what a thread has found is in flight.
    let (sender, receiver) = sync_channel(0);
    pool.in_place_scope_fifo(|scope| {
        // Dropped with this closure, so that no thread waits for a listener that has gone.
        let receiver = receiver;
        for (index, pattern) in patterns.iter().enumerate() {
            let (sender, stop) = (sender.clone(), &stop);
            scope.spawn_fifo(move |_| {
                let proceed = |_| !stop.load(Ordering::Relaxed);
                if proceed(0.0) {
                    let found = climb(disks, *pattern, settings, quest, order, &proceed);
                    // Nobody listens any more once the study has ended.
                    let _ = sender.send((index, found));
                }
            });
        }
        drop(sender);
        let mut ended = Ok(());
        loop {
            let go_on = match receiver.recv_timeout(PATIENCE) {
                Ok((index, Ok(found))) => found.interrupted() || deliver(index, found),
                Ok((_, Err(error))) => {
                    ended = ended.and(Err(error));
                    false
                }
                Err(RecvTimeoutError::Timeout) => true,
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if !(go_on && wait()) {
                stop.store(true, Ordering::Relaxed);
                break;
            }
        }
        ended
    })
}

fn climb(
    disks: &[&TunedDisk],
    pattern: Pattern<'_>,
    settings: Settings,
    quest: &PeakQuery,
    order: &[Option<usize>],
    proceed: &dyn Fn(f64) -> bool,
) -> Result<Summits, Error> {
    let Some(disk) = disks.get(pattern.disk) else {
        let total = format!("there are {} disks", disks.len());
        return Err(Error::value("pattern: disk", pattern.disk as f64, &total));
    };
    let everywhere = |group: &Vec<usize>| -> Vec<usize> {
        let dofs = disk.dofs();
        (0..disk.sectors()).flat_map(|i| group.iter().map(move |dof| i * dofs + dof)).collect()
    };
    let quest =
        PeakQuery { groups: quest.groups.iter().map(everywhere).collect(), ..quest.clone() };
    let model = disk.mistuned(pattern.deviations)?;
    let order = order.get(pattern.disk).copied().flatten();
    climbed(&model, settings, &quest, OF_STUDY, order, proceed)
}
