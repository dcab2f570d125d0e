//! NumPy arrays as arrays of the core, without a copy where they are in C order.

use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::Array;

use crate::exceptions::InvalidInput;

/// Keeps a NumPy array readable while the core works on it.
pub(crate) struct Held<'py, T: Element> {
    array: PyReadonlyArrayDyn<'py, T>,
    /// In C order, where the array itself is not.
    copy: Option<Vec<T>>,
}

/// The names NumPy gives to the element types of the core.
pub(crate) trait Named: Element + Copy {
    const NAME: &'static str;
}

impl Named for f64 {
    const NAME: &'static str = "float64";
}

impl Named for i64 {
    const NAME: &'static str = "int64";
}

impl Named for bool {
    const NAME: &'static str = "bool";
}

impl<'py, T: Named> Held<'py, T> {
    /// The entry `key` of the dict that the caller knows as `name`.
    pub(crate) fn entry(dict: &Bound<'py, PyDict>, name: &str, key: &str) -> PyResult<Self> {
        match dict.get_item(key)? {
            Some(value) => Self::new(&value, &format!("{name}[{key:?}]")),
            None => Err(InvalidInput::new_err(format!(
                "{name} lacks the key {key:?}"
            ))),
        }
    }

    pub(crate) fn new(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        let Ok(array) = value.cast::<PyArrayDyn<T>>() else {
            return Err(InvalidInput::new_err(format!(
                "{name} must be a numpy array of {}, not {}",
                T::NAME,
                describe(value)
            )));
        };
        let array = array
            .try_readonly()
            .map_err(|_| InvalidInput::new_err(format!("{name} is being written to")))?;
        // `as_slice` alone takes Fortran order too.
        let in_order = array.is_c_contiguous();
        let copy = (!in_order).then(|| array.as_array().iter().copied().collect());
        Ok(Self { array, copy })
    }

    pub(crate) fn view(&self) -> Array<'_, T> {
        let values = match &self.copy {
            Some(copy) => copy.as_slice(),
            None => self.array.as_slice().unwrap_or_default(),
        };
        Array::new(values, self.array.shape())
    }
}

fn describe(value: &Bound<'_, PyAny>) -> String {
    let kind = value.get_type().to_string();
    match value.getattr("dtype") {
        Ok(dtype) => format!("{kind} of {dtype}"),
        Err(_) => kind,
    }
}

/// Pairs of indices, i64[n, 2].
pub(crate) fn pairs(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<(usize, usize)>> {
    let held = Held::<i64>::new(value, name)?;
    let entries = held.view();
    let index = |value: i64| {
        usize::try_from(value)
            .map_err(|_| InvalidInput::new_err(format!("{name} holds the index {value}")))
    };
    if entries.shape.len() != 2 || entries.shape[1] != 2 {
        return Err(InvalidInput::new_err(format!("{name} must be [n, 2]")));
    }
    entries
        .values
        .chunks_exact(2)
        .map(|pair| Ok((index(pair[0])?, index(pair[1])?)))
        .collect()
}
