//! The forms of a conversion, and its counts.

/// The form that a sequence is converted into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SequenceForm {
    /// A TUM RGB-D folder.
    TumFolder,
    /// `bag.mcap`: a ROS 2 bag with colour as JPEG, depth in whole millimetres, camera_info, transforms, odometry, gyro, scans and ground
    /// truth.
    RosBag,
    /// `recording.mcap`: a recording of trundle with all sensors and ground truth, which `trundle replay` runs.
    Recording,
}

impl std::str::FromStr for SequenceForm {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "tum" => Ok(Self::TumFolder),
            "bag" => Ok(Self::RosBag),
            "recording" => Ok(Self::Recording),
            _ => Err("expected tum, bag or recording".to_owned()),
        }
    }
}

/// Counts of a conversion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Converted {
    /// Number of images.
    pub images: usize,
    /// Number of images that are damaged and left out.
    pub skipped: usize,
    /// Number of scans of a laser.
    pub scans: usize,
}

impl std::fmt::Display for Converted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} images, {} damaged and left out", self.images, self.skipped)?;
        if self.scans > 0 {
            write!(f, ", {} scans", self.scans)?;
        }
        Ok(())
    }
}
