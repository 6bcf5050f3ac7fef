//! The unit of depth images.

use trundle_core::{Invalid, require_in, require_positive};

/// Depth units per metre in TUM's depth images. Source: TUM RGB-D benchmark, "File Formats".
pub const TUM_DEPTH_SCALE: f64 = 5000.0;

/// Depth units per metre in the depth images of a Kinect V2, of ROS and of trundle's recordings: millimetres. Source: REP 118.
pub const KINECT_V2_DEPTH_SCALE: f64 = 1000.0;

/// Depth scale below which a file gives the inverse \[units per metre\]: RealSense's 0.001 is in metres per unit. Source: ours.
const MIN_DEPTH_SCALE: f64 = 1.0;

/// Depth scale above which no camera's is \[units per metre\]. Source: ours.
const MAX_DEPTH_SCALE: f64 = 1e6;

/// A depth scale in units per metre; one below 1 is metres per unit and refused with its inverse.
pub(crate) fn checked_depth_scale(depth_scale: f64) -> Result<f64, Invalid> {
    require_positive("depth_scale", depth_scale, "units per metre")?;
    if depth_scale < MIN_DEPTH_SCALE {
        let expected = format!("units per metre; {depth_scale} m per unit are {:.0}", 1.0 / depth_scale);
        return Err(Invalid::new("depth_scale", depth_scale, "", expected));
    }
    require_in("depth_scale", depth_scale, "units per metre", MIN_DEPTH_SCALE, MAX_DEPTH_SCALE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metres_a_unit_are_refused_with_units_a_metre() {
        assert_eq!(checked_depth_scale(5000.0), Ok(5000.0));
        let problem = checked_depth_scale(0.001).unwrap_err().to_string();
        assert_eq!(problem, "depth_scale is 0.001, expected units per metre; 0.001 m per unit are 1000");
        assert!(checked_depth_scale(f64::NAN).is_err() && checked_depth_scale(1e9).is_err());
    }
}
