//! Checks of single arrays. Messages name the array, the index and what would
//! be right.

use rga_simd::Array;

use crate::error::{Error, Result};

pub(crate) trait CheckShape {
    /// The shape must be `expected` and the values must fill it.
    fn check_shape(&self, name: &str, expected: &[usize]) -> Result<()>;
}

impl<T> CheckShape for Array<'_, T> {
    fn check_shape(&self, name: &str, expected: &[usize]) -> Result<()> {
        if self.shape == expected && self.values.len() == expected.iter().product::<usize>() {
            return Ok(());
        }
        Err(Error::invalid(format!(
            "{name} has shape {:?}; it must be {expected:?}",
            self.shape
        )))
    }
}

pub(crate) trait CheckNumbers {
    /// Every value must be good, which is what `right` says.
    fn check_each(&self, name: &str, right: &str, good: impl Fn(f64) -> bool) -> Result<()>;

    /// The same of one row of a matrix.
    fn check_row(
        &self,
        name: &str,
        row: usize,
        right: &str,
        good: impl Fn(f64) -> bool,
    ) -> Result<()>;

    fn check_finite(&self, name: &str) -> Result<()>;

    /// The same of the value of one member.
    fn check_member(
        &self,
        name: &str,
        index: usize,
        right: &str,
        good: impl Fn(f64) -> bool,
    ) -> Result<()>;
}

impl CheckNumbers for Array<'_, f64> {
    fn check_each(&self, name: &str, right: &str, good: impl Fn(f64) -> bool) -> Result<()> {
        match self.values.iter().position(|&value| !good(value)) {
            None => Ok(()),
            Some(at) => Err(Error::invalid(format!(
                "{name}{} is {}; it must be {right}",
                place(at, self.shape),
                self.values[at]
            ))),
        }
    }

    fn check_row(
        &self,
        name: &str,
        row: usize,
        right: &str,
        good: impl Fn(f64) -> bool,
    ) -> Result<()> {
        match self.row(row).iter().position(|&value| !good(value)) {
            None => Ok(()),
            Some(at) => Err(Error::invalid(format!(
                "{name}[{row}, {at}] is {:?}; it must be {right}",
                self.row(row)[at]
            ))),
        }
    }

    fn check_finite(&self, name: &str) -> Result<()> {
        self.check_each(name, "a finite number", f64::is_finite)
    }

    fn check_member(
        &self,
        name: &str,
        index: usize,
        right: &str,
        good: impl Fn(f64) -> bool,
    ) -> Result<()> {
        if good(self[index]) {
            return Ok(());
        }
        Err(Error::invalid(format!(
            "{name}[{index}] is {}; it must be {right}",
            self[index]
        )))
    }
}

pub(crate) trait CheckIndices {
    /// Every index must be at least `low` and below `end`.
    fn check_range(&self, name: &str, low: i64, end: usize) -> Result<()>;
}

impl CheckIndices for Array<'_, i64> {
    fn check_range(&self, name: &str, low: i64, end: usize) -> Result<()> {
        let good = |value: i64| value >= low && value < end as i64;
        match self.values.iter().position(|&value| !good(value)) {
            None => Ok(()),
            Some(at) => Err(Error::invalid(format!(
                "{name}{} is {}; it must be at least {low} and below {end}",
                place(at, self.shape),
                self.values[at]
            ))),
        }
    }
}

/// The indices of flat position `at`, as one writes them: `[2, 0]`.
fn place(mut at: usize, shape: &[usize]) -> String {
    let mut indices: Vec<String> = Vec::with_capacity(shape.len());
    for &size in shape.iter().rev() {
        indices.push((at % size).to_string());
        at /= size;
    }
    indices.reverse();
    format!("[{}]", indices.join(", "))
}

pub(crate) fn positive(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

pub(crate) fn not_negative(value: f64) -> bool {
    value.is_finite() && value >= 0.0
}
