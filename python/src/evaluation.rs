//! Errors of a trajectory against the truth.

use crate::arrays::{from_list, from_rows, rows};
use crate::errors::value_error;
use crate::geometry::{pose3_array, trajectory};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use trundle::core::Invalid;
use trundle::eval::{
    AbsoluteConfig, Alignment, Delta, DeltaUnit, ErrorStatistics, RelativeConfig, absolute_trajectory_error,
    relative_pose_error,
};

/// The absolute trajectory error of `estimate` against `reference`, both float64 (N, 8): stamp s, x y z m, qx qy qz qw. The numbers equal
/// evo's.
///
/// `align` is "se3" (rotation and translation), "sim3" (and scale) or "none"; `max_difference` s between associated stamps.
///
/// Returns a dictionary: `count`, `rmse`, `mean`, `median`, `std`, `min`, `max` of the distances, m; `rotation`, the same of the angles, rad; `errors`
/// (K,) m; `pairs` (K, 2), indices in reference and estimate; `reference_from_estimate` (4, 4) and `scale`.
#[pyfunction]
#[pyo3(signature = (reference, estimate, *, align="se3", max_difference=0.01))]
pub fn ate<'py>(
    py: Python<'py>,
    reference: &Bound<'py, PyAny>,
    estimate: &Bound<'py, PyAny>,
    align: &str,
    max_difference: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let alignment = choice("align", align, &Alignment::CHOICES)?;
    let config = AbsoluteConfig::new(max_difference, alignment);
    let (reference, estimate) = (rows(reference, "reference")?, rows(estimate, "estimate")?);
    let found = py.detach(|| {
        let (truth, poses) = (trajectory(&reference, "reference")?, trajectory(&estimate, "estimate")?);
        absolute_trajectory_error(&truth, &poses, &config).map_err(value_error)
    })?;
    let dict = statistics(py, &found.statistics)?;
    dict.set_item("rotation", statistics(py, &found.rotation)?)?;
    dict.set_item("errors", from_list(py, found.errors))?;
    dict.set_item("pairs", from_rows(py, found.pairs.iter().map(|&(r, e)| [r as i64, e as i64]).collect())?)?;
    dict.set_item("reference_from_estimate", pose3_array(py, found.alignment.pose)?)?;
    dict.set_item("scale", found.alignment.scale)?;
    Ok(dict)
}

/// The relative pose error of `estimate` against `reference`, both float64 (N, 8): stamp s, x y z m, qx qy qz qw. The numbers equal evo's.
///
/// `delta` is the distance of two poses in `unit`: "frames", "s" or "m" along the estimate; `all_pairs` states whether a pair starts at
/// every pose.
///
/// Returns a dictionary: `count`, `rmse`, `mean`, `median`, `std`, `min`, `max` of the translation's errors, m; `rotation`, the same of the angles, rad;
/// `errors` (K, 2) m and rad; `pairs` (K, 2), indices in the estimate.
#[pyfunction]
#[pyo3(signature = (reference, estimate, *, delta=1.0, unit="frames", all_pairs=false, max_difference=0.01))]
pub fn rpe<'py>(
    py: Python<'py>,
    reference: &Bound<'py, PyAny>,
    estimate: &Bound<'py, PyAny>,
    delta: f64,
    unit: &str,
    all_pairs: bool,
    max_difference: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let delta = Delta::of(delta, choice("unit", unit, &DeltaUnit::CHOICES)?).map_err(value_error)?;
    let config = RelativeConfig::new(max_difference, delta, all_pairs);
    let (reference, estimate) = (rows(reference, "reference")?, rows(estimate, "estimate")?);
    let found = py.detach(|| {
        let (truth, poses) = (trajectory(&reference, "reference")?, trajectory(&estimate, "estimate")?);
        relative_pose_error(&truth, &poses, &config).map_err(value_error)
    })?;
    let dict = statistics(py, &found.translation)?;
    dict.set_item("rotation", statistics(py, &found.rotation)?)?;
    dict.set_item("errors", from_rows(py, found.errors.iter().map(|&(t, r)| [t, r]).collect())?)?;
    dict.set_item("pairs", from_rows(py, found.pairs.iter().map(|&(i, j)| [i as i64, j as i64]).collect())?)?;
    Ok(dict)
}

/// One of the choices of a front end.
fn choice<T: Copy>(field: &str, name: &str, choices: &[(&'static str, &'static str, T)]) -> PyResult<T> {
    let found = choices.iter().find(|(own, ..)| *own == name).map(|(.., value)| *value);
    found.ok_or_else(|| {
        let names: Vec<&str> = choices.iter().map(|(name, ..)| *name).collect();
        value_error(Invalid::new(field, name, "", format!("one of {}", names.join(", "))))
    })
}

fn statistics<'py>(py: Python<'py>, statistics: &ErrorStatistics) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("count", statistics.count)?;
    let numbers = [
        ("rmse", statistics.rmse),
        ("mean", statistics.mean),
        ("median", statistics.median),
        ("std", statistics.std),
        ("min", statistics.min),
        ("max", statistics.max),
    ];
    for (name, number) in numbers {
        dict.set_item(name, number)?;
    }
    Ok(dict)
}
