//! Many starts at once, on all processors.

use super::classification::{Classification, ClassificationSettings, Classifier};
use crate::model::Model;
use crate::progress::Progress;
use crate::Error;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::Mutex;
use std::time::Duration;

/// Time between two looks at the caller.
const LOOK: Duration = Duration::from_millis(20);

/// What becomes of many starts, each a state `(x, v, f)`; `None` of those that an interruption has
/// left out. `threads` is 0 for one per processor. What comes of a start does not depend on it.
///
/// # Errors
/// As [`Classifier::new`] and [`Classifier::of`].
pub fn fates(
    model: &Model,
    settings: ClassificationSettings,
    starts: &[Vec<f64>],
    threads: usize,
    progress: &Progress<'_>,
) -> Result<Vec<Option<Classification>>, Error> {
    let prepared = Classifier::new(model, settings)?;
    let there = std::thread::available_parallelism().map_or(1, usize::from);
    let wanted = if threads == 0 { there } else { threads.min(there) };
    let workers = wanted.min(starts.len().max(1));
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let done = Mutex::new(Vec::with_capacity(starts.len()));
    let count = AtomicUsize::new(0);
    let work = || loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        let Some(start) = starts.get(index) else { return };
        if stop.load(Ordering::Relaxed) {
            return;
        }
        let fate = prepared.of(start, &|| !stop.load(Ordering::Relaxed));
        if fate.is_err() {
            stop.store(true, Ordering::Relaxed);
        }
        if let Ok(mut done) = done.lock() {
            done.push((index, fate));
        }
        count.fetch_add(1, Ordering::Relaxed);
    };
    std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        while !handles.iter().all(std::thread::ScopedJoinHandle::is_finished) {
            let share = count.load(Ordering::Relaxed) as f64 / starts.len().max(1) as f64;
            if !progress(share) {
                stop.store(true, Ordering::Relaxed);
            }
            std::thread::sleep(LOOK.min(Duration::from_micros(200 * (1 + starts.len() as u64))));
        }
    });
    let mut fates: Vec<Option<Classification>> = vec![None; starts.len()];
    for (index, fate) in done.into_inner().unwrap_or_default() {
        fates[index] = Some(fate?);
    }
    Ok(fates)
}
