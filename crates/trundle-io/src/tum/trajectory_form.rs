//! Forms of trajectory files: TUM, EuRoC and planar rows, recognised by their columns and header.

use crate::files::{fields, table_rows};
use crate::stamp_unit::StampUnit;
use nalgebra::Quaternion;
use trundle_core::{Pose2, Pose3};

/// Largest deviation of a quaternion's norm from 1: files with two decimals or more are accepted and normalised. Source: ours.
const NORM_TOLERANCE: f64 = 0.02;

/// Number of columns of EuRoC's states: with velocity, and with biases. Source: the EuRoC data set's format.
const EUROC_COLUMNS: [usize; 2] = [11, 17];
/// Number of columns of KITTI's poses: the upper three rows of a matrix. Source: KITTI's odometry benchmark, its read-me.
pub(super) const KITTI_COLUMNS: usize = 12;
/// Number of columns of a planar pose with its stamp. Source: ours.
const PLANAR_COLUMNS: usize = 4;

/// The form of a trajectory file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `timestamp tx ty tz qx qy qz qw`.
    Tum,
    /// `timestamp px py pz qw qx qy qz`, and perhaps velocity and biases.
    Euroc,
    /// `timestamp x y theta`.
    Planar,
    /// Twelve numbers of a matrix, no stamp.
    Kitti,
}

impl Form {
    /// The form of a text, by its first row and its header.
    pub(super) fn of(text: &str) -> Self {
        let columns = table_rows(text).first().map_or(0, |(_, line)| fields(line).count());
        match columns {
            PLANAR_COLUMNS => Self::Planar,
            KITTI_COLUMNS => Self::Kitti,
            _ if EUROC_COLUMNS.contains(&columns) || names_w_first(text) => Self::Euroc,
            _ => Self::Tum,
        }
    }

    /// Names of the numbers after the stamp.
    pub(super) fn names(self) -> &'static [&'static str] {
        match self {
            Self::Tum | Self::Kitti => &["tx", "ty", "tz", "qx", "qy", "qz", "qw"],
            Self::Euroc => &["px", "py", "pz", "qw", "qx", "qy", "qz"],
            Self::Planar => &["x", "y", "theta"],
        }
    }

    /// Unit of the stamps.
    pub(super) fn stamp_unit(self) -> StampUnit {
        if self == Self::Euroc { StampUnit::Nanoseconds } else { StampUnit::Seconds }
    }

    /// The pose of a row's numbers.
    pub(super) fn pose(self, numbers: &[f64]) -> Result<Pose3, String> {
        match (self, numbers) {
            (Self::Planar, &[x, y, theta]) => Ok(Pose3::from_pose2(Pose2::new(x, y, theta))),
            (Self::Euroc, &[x, y, z, qw, qx, qy, qz]) => of_quaternion([x, y, z, qx, qy, qz, qw]),
            (_, &[x, y, z, qx, qy, qz, qw]) => of_quaternion([x, y, z, qx, qy, qz, qw]),
            _ => Err(format!("{} numbers, expected {}", numbers.len(), self.names().len())),
        }
    }
}

/// Whether a header has the quaternion's real part first.
fn names_w_first(text: &str) -> bool {
    let header =
        text.lines().take_while(|line| line.starts_with('#') || line.starts_with(char::is_alphabetic)).last();
    let place = |axis: char| {
        let names = header?.split(|c: char| c == ',' || c.is_whitespace());
        let mut names = names.filter(|name| name.chars().any(char::is_alphabetic) && !name.starts_with('['));
        names.position(|name| name.starts_with('q') && name.trim_end_matches(['[', ']']).ends_with(axis))
    };
    matches!((place('w'), place('x')), (Some(w), Some(x)) if w < x)
}

/// The pose of `tx ty tz qx qy qz qw`.
fn of_quaternion(values: [f64; 7]) -> Result<Pose3, String> {
    let norm = Quaternion::new(values[6], values[3], values[4], values[5]).norm();
    if (norm - 1.0).abs() > NORM_TOLERANCE {
        return Err(format!("length of the quaternion is {norm}, expected 1 within {NORM_TOLERANCE}"));
    }
    Ok(Pose3::from(values))
}
