//! Rows of results, shared among threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use crate::error::{Error, Result};

/// Rows that a thread takes at a time.
const CHUNK: usize = 16;

/// `work(scratch, row, results)` of every row, one behind the other, or the
/// error of the first row that fails. Neither depends on the number of
/// threads. Each thread works in a scratch of its own from `prepare`, which
/// must not carry anything from row to row.
pub fn for_each_row<S>(
    rows: usize,
    threads: usize,
    prepare: impl Fn() -> Result<S> + Sync,
    work: impl Fn(&mut S, usize, &mut Vec<f64>) -> Result<()> + Sync,
) -> Result<Vec<f64>> {
    if threads == 0 {
        return Err(Error::invalid("threads must be 1 or more"));
    }
    let chunks = rows.div_ceil(CHUNK);
    let next = AtomicUsize::new(0);
    let failed = AtomicBool::new(false);
    // Chunks are taken in their order: when one fails, all before it are
    // taken and come to their end.
    let share = || -> Result<Vec<(usize, Result<Vec<f64>>)>> {
        let mut scratch = prepare()?;
        let mut done = Vec::new();
        while !failed.load(Ordering::Relaxed) {
            let chunk = next.fetch_add(1, Ordering::Relaxed);
            if chunk >= chunks {
                break;
            }
            let mut results = Vec::new();
            let own = chunk * CHUNK..rows.min((chunk + 1) * CHUNK);
            let outcome = own
                .into_iter()
                .try_for_each(|row| work(&mut scratch, row, &mut results));
            failed.fetch_or(outcome.is_err(), Ordering::Relaxed);
            done.push((chunk, outcome.map(|()| results)));
        }
        Ok(done)
    };
    let mut done = thread::scope(|scope| {
        // Where the system has no more threads to give, fewer do the work.
        let others: Vec<_> = (1..threads.min(chunks))
            .map_while(|_| thread::Builder::new().spawn_scoped(scope, share).ok())
            .collect();
        let mut done = share()?;
        for other in others {
            match other.join() {
                Ok(more) => done.extend(more?),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        Ok(done)
    })?;
    done.sort_by_key(|&(chunk, _)| chunk);
    let mut results = Vec::new();
    for (_, chunk) in done {
        results.extend(chunk?);
    }
    Ok(results)
}
