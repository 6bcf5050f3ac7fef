//! Planar range scans.

use crate::arrays::{array, from_list, from_rows, slice};
use crate::errors::value_error;
use crate::numbers::{point, seconds};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use trundle::core::{Beam, Invalid, Scan as CoreScan, Vector2, require_positive};

/// A sweep of a 2-D laser in the base's plane, like ROS's LaserScan.
///
/// `stamp` s; `ranges` float64 (beams,) m: infinity for a beam without a hit within `range_max`, NaN for an unknown range; `angle_min` rad
/// of the first beam from the base's x, `angle_increment` rad; `origin` (x m, y m) of the laser on the base.
///
/// >>> import numpy as np
/// >>> scan = trundle.Scan(0.0, np.array([1.0, np.inf, np.nan]), -0.1, 0.1, range_max=10.0)
/// >>> scan.ranges, len(scan), scan.points().shape
/// (array([ 1., inf, nan]), 3, (1, 2))
#[pyclass(frozen, module = "trundle")]
pub struct Scan {
    /// The scan.
    pub scan: CoreScan,
}

#[pymethods]
impl Scan {
    #[new]
    #[pyo3(signature = (stamp, ranges, angle_min, angle_increment, *, range_max, origin=None))]
    fn new(
        stamp: f64,
        ranges: &Bound<'_, PyAny>,
        angle_min: f64,
        angle_increment: f64,
        range_max: f64,
        origin: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        require_positive("range_max", range_max, "m").map_err(value_error)?;
        let ranges = array::<f64, numpy::Ix1>(ranges, "ranges", "(beams,)")?;
        let ranges = slice(&ranges, "ranges")?;
        let beams: PyResult<Vec<Beam>> =
            ranges.iter().enumerate().map(|(i, range)| beam(i, *range, range_max)).collect();
        let origin = origin.map_or(Ok(Vector2::zeros()), |origin| point(origin, "origin"))?;
        let stamp = crate::numbers::stamp(stamp)?;
        let scan = CoreScan::new(stamp, origin, angle_min, angle_increment, beams?).map_err(value_error)?;
        Ok(Self { scan })
    }

    /// When it was taken, s.
    #[getter]
    fn stamp(&self) -> f64 {
        seconds(self.scan.stamp())
    }

    /// Ranges, m, (beams,): infinity for a beam without a hit, NaN for an unknown range.
    #[getter]
    fn ranges<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        from_list(py, self.scan.beams().iter().map(range_of).collect())
    }

    /// Bearings of the beams from the base's x, rad, (beams,).
    #[getter]
    fn angles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        from_list(py, (0..self.scan.beams().len()).map(|i| self.scan.angle(i)).collect())
    }

    /// Bearing of the first beam, rad.
    #[getter]
    fn angle_min(&self) -> f64 {
        self.scan.angle_min()
    }

    /// Angle between neighbouring beams, rad.
    #[getter]
    fn angle_increment(&self) -> f64 {
        self.scan.angle_increment()
    }

    /// Origin of the beams on the base: x m, y m.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        (self.scan.origin().x, self.scan.origin().y)
    }

    /// Hit points of the beams, base frame, m: (N, 2).
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        from_rows(py, self.scan.hits().map(Into::into).collect::<Vec<[f64; 2]>>())
    }

    fn __len__(&self) -> usize {
        self.scan.beams().len()
    }

    fn __repr__(&self) -> String {
        format!("Scan(stamp={}, {} beams)", self.stamp(), self.scan.beams().len())
    }
}

/// The range of a beam: infinity without a hit, NaN if unknown.
pub fn range_of(beam: &Beam) -> f64 {
    match beam {
        Beam::Hit { range } => *range,
        Beam::Free { .. } => f64::INFINITY,
        Beam::Unseen => f64::NAN,
    }
}

/// The beam of a range of ROS's LaserScan (REP 117): infinity means no hit within `range_max`; NaN and -infinity mean unknown.
fn beam(index: usize, range: f64, range_max: f64) -> PyResult<Beam> {
    if range.is_nan() || range == f64::NEG_INFINITY {
        return Ok(Beam::Unseen);
    }
    if range < 0.0 {
        let field = format!("range of beam {index}");
        let expected = "0 or more, infinity where nothing was met, NaN where nothing is known";
        return Err(value_error(Invalid::new(field, range, "m", expected)));
    }
    Ok(if range >= range_max { Beam::Free { range: range_max } } else { Beam::Hit { range } })
}
