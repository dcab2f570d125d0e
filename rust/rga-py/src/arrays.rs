//! NumPy arrays as arrays of the core, without a copy where they are in C order.

use numpy::ndarray::{Array2, Zip};
use numpy::{
    Element, PyArrayDyn, PyArrayMethods, PyReadonlyArray3, PyReadonlyArrayDyn,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rga_core::{Array, Directions};

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

/// Indices, i64[n].
pub(crate) fn numbers(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<usize>> {
    let held = Held::<i64>::new(value, name)?;
    let index = |value: &i64| {
        usize::try_from(*value)
            .map_err(|_| InvalidInput::new_err(format!("{name} holds the index {value}")))
    };
    held.view().values.iter().map(index).collect()
}

/// Rates f64[n, e, c] with their name, n and e.
type Rates<'a, 'py> = (&'a Bound<'py, PyAny>, &'a str, [usize; 2]);

/// Directions along which loads and stiffnesses change, and the rates f64[n, ...] of those entries
/// alone that change in some row.
pub(crate) fn directions(
    loads: Rates<'_, '_>,
    stiffnesses: Rates<'_, '_>,
) -> PyResult<(Directions, Vec<f64>, Vec<f64>)> {
    let (count, loads, of_loads) = changes(loads)?;
    let (also, changes, of_changes) = changes(stiffnesses)?;
    if count != also {
        return Err(InvalidInput::new_err(format!(
            "the rates are along {count} directions and along {also}; they must be as many"
        )));
    }
    let along = Directions {
        count,
        loads,
        changes,
    };
    Ok((along, of_loads, of_changes))
}

/// How many directions there are, pairs of a direction and an entry, and their rates row by row.
type Changes = (usize, Vec<(usize, usize)>, Vec<f64>);

fn changes((value, name, expected): Rates<'_, '_>) -> PyResult<Changes> {
    let rates: PyReadonlyArray3<'_, f64> = value
        .extract()
        .map_err(|_| InvalidInput::new_err(format!("{name} must be float64 with three axes")))?;
    let rates = rates.as_array();
    let (rows, entries, count) = rates.dim();
    if [rows, entries] != expected {
        return Err(InvalidInput::new_err(format!(
            "{name} is [{rows}, {entries}, {count}]; it must be [{}, {}, directions]",
            expected[0], expected[1]
        )));
    }
    let mut change = Array2::from_elem((entries, count), false);
    for row in rates.outer_iter() {
        Zip::from(&mut change)
            .and(&row)
            .for_each(|change, rate| *change |= *rate != 0.0);
    }
    let pairs = (0..count).flat_map(|direction| (0..entries).map(move |entry| (direction, entry)));
    let pairs: Vec<_> = pairs
        .filter(|&(direction, entry)| change[[entry, direction]])
        .collect();
    let own = |row: usize| {
        pairs
            .iter()
            .map(move |&(direction, entry)| [row, entry, direction])
    };
    let found = (0..rows).flat_map(own).map(|at| rates[at]).collect();
    Ok((count, pairs, found))
}
