//! Arrays of numpy: inputs are checked, results are moved or borrowed.

use crate::errors::value_error;
use crate::numbers::wrong_type;
use numpy::ndarray::Dimension;
use numpy::{
    Element, PyArray, PyArray1, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyReadonlyArray,
    PyUntypedArray, PyUntypedArrayMethods, dtype,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use trundle::core::{ColorImage, DepthImage};

/// An array of this dtype and number of axes, as one block of memory in C order. An array in another order is copied.
///
/// # Errors
/// `TypeError` for another dtype or an object that is no array; `ValueError` for another number of axes. Both name the expected `shape`.
pub fn array<'py, T: Element, D: Dimension>(
    object: &Bound<'py, PyAny>,
    name: &str,
    shape: &str,
) -> PyResult<PyReadonlyArray<'py, T, D>> {
    let kind = dtype::<T>(object.py());
    let expected = format!("a numpy array of dtype {kind} and shape {shape}");
    let untyped = object.cast::<PyUntypedArray>().map_err(|_| wrong_type(object, name, &expected))?;
    if !untyped.dtype().is_equiv_to(&kind) {
        let found = untyped.dtype();
        return Err(PyTypeError::new_err(format!("{name} has dtype {found}, expected {expected}")));
    }
    let misfit = || value_error(format!("{name} has shape {:?}, expected {expected}", untyped.shape()));
    let typed = object.cast::<PyArray<T, D>>().map_err(|_| misfit())?;
    let readable = |array: &Bound<'py, PyArray<T, D>>| {
        array.try_readonly().map_err(|_| value_error(format!("{name} is being written by another call")))
    };
    let whole = readable(typed)?;
    // A slice of an array in Fortran's order would be transposed.
    if whole.is_c_contiguous() && whole.as_slice().is_ok() {
        return Ok(whole);
    }
    let copy = typed.call_method0("copy")?.cast_into::<PyArray<T, D>>().map_err(|_| misfit())?;
    readable(&copy)
}

/// Rows of `N` f64.
///
/// # Errors
/// As [`array`], and for another number of columns.
pub fn rows<const N: usize>(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<[f64; N]>> {
    let shape = format!("(any, {N})");
    let array = array::<f64, numpy::Ix2>(object, name, &shape)?;
    if array.shape()[1] != N {
        let found = array.shape();
        return Err(value_error(format!(
            "{name} has shape {found:?}, expected a numpy array of dtype float64 and shape {shape}"
        )));
    }
    Ok(slice(&array, name)?.as_chunks::<N>().0.to_vec())
}

/// The numbers of an array from [`array`].
pub fn slice<'a, T: Element, D: Dimension>(
    array: &'a PyReadonlyArray<'_, T, D>,
    name: &str,
) -> PyResult<&'a [T]> {
    array.as_slice().map_err(|_| value_error(format!("{name} is not one block of memory")))
}

/// A colour image from uint8 of shape (height, width, 3), in `memory`.
///
/// # Errors
/// As [`array`]; also for a number of channels other than 3, or a side of 0.
pub fn color_image(object: &Bound<'_, PyAny>, mut memory: Vec<[u8; 3]>) -> PyResult<ColorImage> {
    const SHAPE: &str = "(height, width, 3)";
    let array = array::<u8, numpy::Ix3>(object, "rgb", SHAPE)?;
    let &[height, width, 3] = array.shape() else {
        let found = array.shape();
        return Err(value_error(format!(
            "rgb has shape {found:?}, expected a numpy array of dtype uint8 and shape {SHAPE}"
        )));
    };
    memory.clear();
    memory.extend_from_slice(slice(&array, "rgb")?.as_chunks::<3>().0);
    ColorImage::new(width, height, memory).map_err(value_error)
}

/// A depth image from uint16 in units of 1 / `depth_scale` m, or from float32 in m, in `memory`. Values that are not positive count as
/// missing depth.
///
/// # Errors
/// As [`array`], and for a side of 0.
pub fn depth_image(
    object: &Bound<'_, PyAny>,
    depth_scale: f64,
    mut memory: Vec<f32>,
) -> PyResult<DepthImage> {
    const SHAPE: &str = "(height, width)";
    let is_metres = object
        .cast::<PyUntypedArray>()
        .is_ok_and(|array| array.dtype().is_equiv_to(&dtype::<f32>(object.py())));
    memory.clear();
    let size = if is_metres {
        let array = array::<f32, numpy::Ix2>(object, "depth", SHAPE)?;
        let valid = |depth: &f32| if depth.is_finite() && *depth > 0.0 { *depth } else { 0.0 };
        memory.extend(slice(&array, "depth")?.iter().map(valid));
        size_of(&array)
    } else {
        let array = array::<u16, numpy::Ix2>(object, "depth", "(height, width), or float32 in metres")?;
        let valid = |units: &u16| (f64::from(*units) / depth_scale) as f32;
        memory.extend(slice(&array, "depth")?.iter().map(valid));
        size_of(&array)
    };
    DepthImage::new(size.0, size.1, memory).map_err(value_error)
}

/// Width and height.
fn size_of<T: Element>(array: &PyReadonlyArray<'_, T, numpy::Ix2>) -> (usize, usize) {
    (array.shape()[1], array.shape()[0])
}

/// An array of shape (rows, N) in the memory of the list.
pub fn from_rows<const N: usize, T: Element>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.into_flattened()).reshape([count, N])
}

/// An array of one axis in the memory of the list.
pub fn from_list<T: Element>(py: Python<'_>, list: Vec<T>) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, list)
}
