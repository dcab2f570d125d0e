//! The order of elimination by approximate minimum degree.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

/// The order, with the multiplications of the factorisation. Of each unknown,
/// `rows` has what it is coupled with, once or twice, from `first` on.
pub(crate) fn minimum_degree(first: &[usize], rows: &[usize]) -> Option<(Vec<usize>, f64)> {
    // Half of the memory is half of the time.
    let [first, rows] = [first, rows].map(narrow);
    let size = first.len() - 1;
    let pattern = SymbolicSparseColMatRef::new_unsorted_checked(size, size, &first, None, &rows);
    let scratch = amd::order_maybe_unsorted_scratch::<u32>(size, rows.len());
    let mut memory = MemBuffer::try_new(scratch).ok()?;
    let (mut order, mut inverse) = (vec![0; size], vec![0; size]);
    let counts = amd::order_maybe_unsorted(
        &mut order,
        &mut inverse,
        pattern,
        amd::Control::default(),
        MemStack::new(&mut memory),
    );
    let counts = counts.ok()?;
    let order = order.into_iter().map(|at| at as usize);
    Some((order.collect(), counts.n_div + counts.n_mult_subs_ldl))
}

fn narrow(numbers: &[usize]) -> Vec<u32> {
    numbers.iter().map(|&number| number as u32).collect()
}
