//! Work in parts on all processors, with one caller who may end it.

use crate::progress::Progress;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{channel, Sender};
use std::time::Duration;

/// Time between two questions whether to go on.
const PATIENCE: Duration = Duration::from_millis(20);

/// Parts that wait for each processor: few, so that works at the same time advance at the same pace.
const AHEAD: usize = 4;

/// Does `count` parts of a work, as many at a time as there are processors, and returns what they give in
/// their order: no result depends on the number of threads. A part tells its share of the work done, and
/// ends when it hears `false`; `progress` hears the mean, in the thread of the caller. Parts that were not
/// begun by then hear `false` from the start.
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
        let begin = |index: usize| {
            let (answer, stop, shares, part) = (Answer::new(index, &sender), &stop, &shares, &part);
            scope.spawn_fifo(move |_| {
                let look = |share: f64| {
                    shares[index].store(share.to_bits(), Ordering::Relaxed);
                    !stop.load(Ordering::Relaxed)
                };
                let own = part(index, &look);
                answer.give(own);
            });
            index
        };
        let mut rest = 0..count;
        let first = rest.by_ref().take(AHEAD * rayon::current_num_threads());
        let (mut under_way, mut ended): (Vec<usize>, usize) = (first.map(begin).collect(), 0);
        while !under_way.is_empty() {
            if let Ok((index, own)) = receiver.recv_timeout(PATIENCE) {
                found[index] = own;
                ended += 1;
                under_way.retain(|other| *other != index);
                under_way.extend(rest.next().map(begin));
            }
            let share = |index: &usize| f64::from_bits(shares[*index].load(Ordering::Relaxed));
            let done = ended as f64 + under_way.iter().map(share).sum::<f64>();
            if !progress(done / count as f64) {
                stop.store(true, Ordering::Relaxed);
                for index in rest.by_ref() {
                    found[index] = Some(part(index, &|_| false));
                    ended += 1;
                }
            }
        }
    });
    // Every part has sent what it found: a panic of one has left the scope with it.
    found.into_iter().flatten().collect()
}

/// What a part sends: nothing, if it panics.
struct Answer<T> {
    index: usize,
    sender: Sender<(usize, Option<T>)>,
    own: Option<T>,
}

impl<T> Answer<T> {
    fn new(index: usize, sender: &Sender<(usize, Option<T>)>) -> Self {
        Self { index, sender: sender.clone(), own: None }
    }

    fn give(mut self, own: T) {
        self.own = Some(own);
    }
}

impl<T> Drop for Answer<T> {
    fn drop(&mut self) {
        // The caller listens until the last part has ended.
        let _ = self.sender.send((self.index, self.own.take()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

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

    /// Neither waits until all parts of the other are done.
    #[test]
    fn works_at_the_same_time_advance_together() {
        const COUNT: usize = 1000;
        let [begun, waiting] = [AtomicBool::new(false), AtomicBool::new(false)];
        let [done, seen] = [AtomicUsize::new(0), AtomicUsize::new(COUNT)];
        let wait_for = |told: &AtomicBool| {
            while !told.load(Ordering::Relaxed) {
                std::thread::yield_now();
            }
        };
        std::thread::scope(|scope| {
            scope.spawn(|| {
                in_parts(COUNT, &|_| true, |index, _| {
                    begun.store(true, Ordering::Relaxed);
                    if index > COUNT / 10 {
                        wait_for(&waiting);
                    }
                    done.fetch_add(1, Ordering::Relaxed);
                });
            });
            wait_for(&begun);
            // It is heard once its parts wait for a processor, or have been done.
            let heard = |_: f64| {
                waiting.store(true, Ordering::Relaxed);
                true
            };
            in_parts(COUNT, &heard, |index, _| {
                if index == 0 {
                    seen.store(done.load(Ordering::Relaxed), Ordering::Relaxed);
                }
            });
        });
        assert!(seen.into_inner() < COUNT / 2);
    }
}
