//! Rows of results, shared among threads.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard};
use std::thread;

use crate::error::{Error, Result};

/// Runs `work(scratch, rows, results)` over chunks of rows, `width` numbers a row.
///
/// What a chunk holds does not depend on the number of threads, and neither do the results; the
/// error is that of the first chunk that fails. Each thread works in a scratch of its own from
/// `prepare`, which must not carry anything from chunk to chunk.
pub(super) fn in_chunks<S>(
    results: &mut [f64],
    width: usize,
    chunk: usize,
    threads: usize,
    prepare: impl Fn() -> Result<S> + Sync,
    work: impl Fn(&mut S, Range<usize>, &mut [f64]) -> Result<()> + Sync,
) -> Result<()> {
    if threads == 0 {
        return Err(Error::invalid("threads must be 1 or more"));
    }
    if results.is_empty() {
        return Ok(());
    }
    let count = (results.len() / width).div_ceil(chunk);
    let waiting = Mutex::new(results.chunks_mut(chunk * width).enumerate());
    let failed = Mutex::new(None::<(usize, Error)>);
    let labour = || {
        let fail = |number: usize, error: Error| {
            let mut first = lock(&failed);
            if first.as_ref().is_none_or(|(before, _)| number < *before) {
                *first = Some((number, error));
            }
        };
        let mut scratch = match prepare() {
            Ok(scratch) => scratch,
            Err(error) => return fail(0, error),
        };
        // Chunks are taken in their order: when one fails, all before it are under way.
        while lock(&failed).is_none() {
            let Some((number, part)) = lock(&waiting).next() else {
                break;
            };
            let from = number * chunk;
            let rows = from..from + part.len() / width;
            if let Err(error) = work(&mut scratch, rows, part) {
                fail(number, error);
            }
        }
    };
    thread::scope(|scope| {
        // Where the system has no more threads to give, fewer do the work.
        for _ in 1..threads.min(count) {
            if thread::Builder::new().spawn_scoped(scope, labour).is_err() {
                break;
            }
        }
        labour();
    });
    match failed.into_inner() {
        Ok(None) => Ok(()),
        Ok(Some((_, error))) => Err(error),
        Err(poisoned) => poisoned
            .into_inner()
            .map_or(Ok(()), |(_, error)| Err(error)),
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex
        .lock()
        .unwrap_or_else(|poisoned| poisoned.into_inner())
}
