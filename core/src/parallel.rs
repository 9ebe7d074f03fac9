//! Work in parts on all processors, with one caller who may end it.

use crate::progress::Progress;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{channel, RecvTimeoutError};
use std::time::Duration;

/// Time between two questions whether to go on.
const PATIENCE: Duration = Duration::from_millis(20);

/// Does `count` parts of a work, as many at a time as there are processors, and returns what they give in
/// their order: no result depends on the number of threads. A part tells its share of the work done, and
/// ends when it hears `false`; `progress` hears the mean, in the thread of the caller.
pub(crate) fn in_parts<T: Send>(
    count: usize,
    progress: &Progress<'_>,
    part: impl Fn(usize, &Progress<'_>) -> T + Sync,
) -> Vec<T> {
    // A thread of a pool that waits for its pool may wait for itself.
    let alone = rayon::current_num_threads() <= 1 || rayon::current_thread_index().is_some();
    if count <= 1 || alone {
        let share = |index: usize, share: f64| (index as f64 + share) / count as f64;
        return (0..count).map(|i| part(i, &|own| progress(share(i, own)))).collect();
    }
    let stop = AtomicBool::new(false);
    let shares: Vec<AtomicU64> = (0..count).map(|_| AtomicU64::new(0)).collect();
    let (sender, receiver) = channel();
    let mut found: Vec<Option<T>> = (0..count).map(|_| None).collect();
    rayon::in_place_scope_fifo(|scope| {
        for index in 0..count {
            let (sender, stop, shares, part) = (sender.clone(), &stop, &shares, &part);
            scope.spawn_fifo(move |_| {
                let look = |share: f64| {
                    shares[index].store(share.to_bits(), Ordering::Relaxed);
                    !stop.load(Ordering::Relaxed)
                };
                let own = part(index, &look);
                look(1.0);
                // The caller listens until the last part has ended.
                let _ = sender.send((index, own));
            });
        }
        drop(sender);
        loop {
            match receiver.recv_timeout(PATIENCE) {
                Ok((index, own)) => found[index] = Some(own),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            let done = shares.iter().map(|share| f64::from_bits(share.load(Ordering::Relaxed)));
            if !progress(done.sum::<f64>() / count as f64) {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
    // Every part has sent what it found: a panic of one has left the scope with it.
    found.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_come_back_in_their_order_and_end_when_told_to() {
        let squares = in_parts(100, &|share| (0.0..=1.0).contains(&share), |i, _| i * i);
        assert!(squares.iter().enumerate().all(|(i, square)| *square == i * i));
        let told = in_parts(4, &|_| false, |_, look| {
            while look(0.5) {
                std::thread::yield_now();
            }
            true
        });
        assert_eq!(told, [true; 4]);
    }
}
