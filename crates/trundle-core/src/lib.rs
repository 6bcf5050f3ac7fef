//! The data types that the crates of trundle exchange.
//!
//! Plain data only: no algorithm, no IO, no clock, no global random generator. Units are SI and radians; a suffix
//! (`_px`, `_cells`, `_deg`, `_ms`) marks other units. Axes follow REP 103 (x forward, y left, z up) for the
//! base and the map, and the optical convention (x right, y down, z forward) for cameras. See `docs/conventions.md`.
//!
//! ```
//! use trundle_core::{Pose2, Vector2};
//! # use std::f64::consts::FRAC_PI_2;
//! // Frames cancel: a point 0.5 m ahead of a robot that stands at (1, 2) m and faces +y.
//! let map_from_base = Pose2::new(1.0, 2.0, FRAC_PI_2);
//! let p_map = map_from_base.transform(Vector2::new(0.5, 0.0));
//! assert!((p_map - Vector2::new(1.0, 2.5)).norm() < 1e-12);
//! ```

mod angle;
mod body;
mod body_event;
mod camera;
mod camera_motion;
mod deskew;
mod drive;
mod estimate;
mod footprint;
mod footprint_text;
mod frame;
mod grid;
mod grid_text;
mod image;
mod invalid;
mod map_annotations;
mod odometry;
mod path;
mod portable_math;
mod pose2;
mod pose3;
mod rgbd;
mod scan;
mod stamp;
mod toml_words;
mod trajectory;
mod twist;
mod zone;

pub use angle::{difference_of_angles, wrap_angle};
pub use body::{Cliff, RobotBody, SensorEvent, Touch};
pub use body_event::{
    Battery, BodyEvent, BodyEventKind, Button, Device, DockBeams, DockInfrared, Link, PerWheel, PowerSource,
};
pub use camera::{Distortion, FOCAL_LENGTH_PER_SIDE, PinholeCamera};
pub use camera_motion::CameraMotion;
pub use deskew::deskewed;
pub use drive::{DifferentialDrive, DriveLimits};
pub use estimate::{PoseBound, PoseEstimate};
pub use footprint::{Footprint, MAX_FOOTPRINT_RADIUS_M};
pub use footprint_text::footprint_corners;
pub use frame::FrameId;
pub use grid::{Cell, CellIndex, GridGeometry, OccupancyGrid};
pub use grid_text::MAX_TEXT_CELLS;
pub use image::{ColorImage, DepthImage, GrayImage, Image, gray_from_color};
pub use invalid::{Invalid, require_finite, require_in, require_positive};
pub use map_annotations::{MapAnnotations, NamedPlace};
pub use odometry::{GyroRate, Odometry, WheelTicks};
pub use path::{Path, shape_points};
pub use portable_math::{Hypotenuse, angle_of_f32, tanh_f32};
pub use pose2::{MAX_COORDINATE_M, Pose2};
pub use pose3::Pose3;
pub use rgbd::RgbdImage;
pub use scan::{Beam, BeamTimes, FreeSpan, ObstacleKind, Scan, ScanParts};
pub use stamp::Stamp;
pub use toml_words::{TomlProblem, number_list, toml_problem};
pub use trajectory::{Trajectory, TrajectoryPoint};
pub use twist::Twist2;
pub use zone::{MAX_ZONE_CORNERS, SPEED_LIMIT_RANGE_M_S, Zone, ZoneKind};

/// A point or vector in a plane, metres.
pub type Vector2 = nalgebra::Vector2<f64>;
/// A point or vector in space, metres.
pub type Vector3 = nalgebra::Vector3<f64>;
