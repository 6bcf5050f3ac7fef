//! Occupancy grids to and from arrays and map files.

use crate::arrays::{array, slice};
use crate::errors::{app_error, io_error, value_error};
use crate::numbers::{numbers, point};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::path::PathBuf;
use trundle::core::{Cell, GridGeometry, Invalid, OccupancyGrid as Grid, Vector2};
use trundle::io::{MapImage, map_files, replace_file};

/// A map of cells that are free, occupied or unknown.
///
/// `cells` int8 (rows, columns) as in ROS: -1 unknown, 0 free, 100 occupied, row 0 at the lowest y; `resolution` m, the side of a cell;
/// `origin` (x m, y m), the lower left corner of cell (0, 0) in the map frame.
///
/// >>> import numpy as np
/// >>> grid = trundle.OccupancyGrid(np.array([[0, 100], [-1, 0]], np.int8), resolution=0.5, origin=(-1, 0))
/// >>> grid.at((-0.25, 0.25)), grid.at((-0.75, 0.75)), grid.shape
/// (100, -1, (2, 2))
/// >>> grid.save("map.yaml")
/// >>> trundle.OccupancyGrid.load("map.yaml") == grid
/// True
#[pyclass(frozen, module = "trundle")]
pub struct OccupancyGrid {
    /// The grid.
    pub grid: Grid,
}

#[pymethods]
impl OccupancyGrid {
    #[new]
    #[pyo3(signature = (cells, resolution, origin=None))]
    fn new(cells: &Bound<'_, PyAny>, resolution: f64, origin: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let array = array::<i8, numpy::Ix2>(cells, "cells", "(rows, columns), row 0 at the lowest y")?;
        let origin = origin.map_or(Ok(Vector2::zeros()), |origin| point(origin, "origin"))?;
        let (rows, columns) = (array.shape()[0], array.shape()[1]);
        let geometry = GridGeometry::new(resolution, origin, columns, rows).map_err(value_error)?;
        let cells: PyResult<Vec<Cell>> = slice(&array, "cells")?.iter().map(|value| cell(*value)).collect();
        Ok(Self { grid: Grid::new(geometry, cells?).map_err(value_error)? })
    }

    /// The map of a map_server YAML file with its picture.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let grid = py.detach(|| trundle::app::read_map(&path)).map_err(app_error)?;
        Ok(Self { grid })
    }

    /// Writes a YAML file and its picture beside it, `image` "pgm" or "png", as Nav2's map_saver does. The name of the file ends in .yaml.
    #[pyo3(signature = (path, image="pgm"))]
    fn save(&self, py: Python<'_>, path: PathBuf, image: &str) -> PyResult<()> {
        let choice = MapImage::CHOICES.iter().find(|(name, ..)| *name == image);
        let (.., image) =
            choice.ok_or_else(|| value_error(Invalid::new("image", image, "", "pgm or png")))?;
        py.detach(|| {
            let files = map_files(&path, &self.grid, *image)?;
            files.iter().try_for_each(|(path, bytes)| replace_file(path, bytes))
        })
        .map_err(io_error)
    }

    /// A map from lines of text, the highest y first: `#` occupied, `.` free, other characters unknown; `resolution` m.
    #[staticmethod]
    fn from_ascii(resolution: f64, art: &str) -> PyResult<Self> {
        Ok(Self { grid: Grid::from_ascii(resolution, art).map_err(value_error)? })
    }

    /// Cells, int8 (rows, columns): -1 unknown, 0 free, 100 occupied. Row 0 is at the lowest y.
    #[getter]
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i8>>> {
        let values = self.grid.cells().iter().map(|cell| match cell {
            Cell::Unknown => UNKNOWN_VALUE,
            Cell::Free => FREE_VALUE,
            Cell::Occupied => OCCUPIED_VALUE,
        });
        let geometry = self.grid.geometry();
        PyArray1::from_vec(py, values.collect()).reshape([geometry.height, geometry.width])
    }

    /// Side of a cell, m.
    #[getter]
    fn resolution(&self) -> f64 {
        self.grid.geometry().resolution
    }

    /// Lower left corner of cell (0, 0), map frame: x m, y m.
    #[getter]
    fn origin(&self) -> (f64, f64) {
        let origin = self.grid.geometry().origin;
        (origin.x, origin.y)
    }

    /// Rows and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.grid.geometry().height, self.grid.geometry().width)
    }

    /// The cell at a point (x m, y m) of the map frame: -1 (also off the map), 0 or 100.
    fn at(&self, point: &Bound<'_, PyAny>) -> PyResult<i8> {
        let [x, y] = numbers(point, "point", "2 numbers: x m, y m")?;
        Ok(match self.grid.at(Vector2::new(x, y)) {
            Cell::Unknown => UNKNOWN_VALUE,
            Cell::Free => FREE_VALUE,
            Cell::Occupied => OCCUPIED_VALUE,
        })
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| other.get().grid == self.grid)
    }

    fn __repr__(&self) -> String {
        let (rows, columns) = self.shape();
        let (x, y) = self.origin();
        format!("OccupancyGrid({rows} x {columns} cells of {} m, origin ({x}, {y}) m)", self.resolution())
    }
}

/// Value of an unknown cell. Source: `nav_msgs/OccupancyGrid`.
const UNKNOWN_VALUE: i8 = -1;
/// Value of a free cell. Source: `nav_msgs/OccupancyGrid`.
const FREE_VALUE: i8 = 0;
/// Value of an occupied cell. Source: `nav_msgs/OccupancyGrid`.
const OCCUPIED_VALUE: i8 = 100;

fn cell(value: i8) -> PyResult<Cell> {
    match value {
        UNKNOWN_VALUE => Ok(Cell::Unknown),
        FREE_VALUE => Ok(Cell::Free),
        OCCUPIED_VALUE => Ok(Cell::Occupied),
        other => {
            let expected = "-1 unknown, 0 free or 100 occupied: apply your thresholds first";
            Err(value_error(Invalid::new("value of a cell", other, "", expected)))
        }
    }
}
