//! A view of rows of numbers.

use std::ops::Index;

/// A borrowed array in C order.
#[derive(Debug, Clone, Copy)]
pub struct Array<'a, T> {
    pub values: &'a [T],
    pub shape: &'a [usize],
}

impl<'a, T> Array<'a, T> {
    pub fn new(values: &'a [T], shape: &'a [usize]) -> Self {
        Self { values, shape }
    }

    /// Length of the first axis.
    pub fn len(&self) -> usize {
        self.shape.first().copied().unwrap_or(0)
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Everything behind the first index, flat.
    pub fn row(&self, index: usize) -> &'a [T] {
        let width: usize = self.shape[1..].iter().product();
        &self.values[index * width..(index + 1) * width]
    }
}

impl<T> Index<usize> for Array<'_, T> {
    type Output = T;

    fn index(&self, index: usize) -> &T {
        &self.values[index]
    }
}

impl Array<'_, i64> {
    /// An index, of which it is known that it is not negative.
    #[inline]
    pub fn at(&self, index: usize) -> usize {
        self.values[index] as usize
    }
}
