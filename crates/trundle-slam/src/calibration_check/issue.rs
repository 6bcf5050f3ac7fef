//! Issues of the settings that the images show.

use std::fmt;

/// A setting that is probably wrong, and the evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum CalibrationIssue {
    /// Many depths are outside the range of any depth camera.
    DepthRange {
        /// Part of the depths, 0 to 1.
        part: f64,
        /// Whether the depths are beyond the far end of the range; else they are before the near end.
        beyond: bool,
        /// Median of all depths, m.
        median: f64,
    },
    /// No image had any depth.
    NoDepth,
    /// The camera's distance travelled differs from the wheels'.
    TravelledDistance {
        /// Ratio of the camera's distance to the wheels'.
        ratio: f64,
    },
    /// Matched points fit other focal lengths, in x and y, px.
    FocalLengths {
        /// The configured focal lengths.
        given: (f64, f64),
        /// The best fit.
        found: (f64, f64),
        /// Whether fx and fy are swapped.
        swapped: bool,
    },
    /// Matched points fit another principal point.
    PrincipalPoint {
        /// Offset from the configured principal point, px.
        offset: (f64, f64),
    },
    /// Matched points are displaced towards the image border.
    Distortion {
        /// Error at three quarters of the half diagonal, px.
        at_the_rim: f64,
    },
    /// The edges of the depth image lie beside those of the picture.
    Registration {
        /// Shift of the depth image that would align the edges, px.
        offset: (f64, f64),
    },
}

impl CalibrationIssue {
    /// The issue with pixels of an image `factor` times as large.
    pub(crate) fn enlarged(self, factor: f64) -> Self {
        let both = |(x, y): (f64, f64)| (factor * x, factor * y);
        match self {
            Self::FocalLengths { given, found, swapped } => {
                Self::FocalLengths { given: both(given), found: both(found), swapped }
            }
            Self::PrincipalPoint { offset } => Self::PrincipalPoint { offset: both(offset) },
            Self::Distortion { at_the_rim } => Self::Distortion { at_the_rim: factor * at_the_rim },
            Self::Registration { offset } => Self::Registration { offset: both(offset) },
            Self::DepthRange { .. } | Self::NoDepth | Self::TravelledDistance { .. } => self,
        }
    }
}

impl fmt::Display for CalibrationIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::DepthRange { part, beyond, median } => write!(
                f,
                "{:.0} % of the depths are {} than a depth camera measures (median {median:.2} m): is the depth scale {}?",
                100.0 * part,
                if beyond { "farther" } else { "nearer" },
                if beyond {
                    "too small (1000 where 5000 is right makes depths 5 times as large)"
                } else {
                    "too large (5000 where 1000 is right makes depths a fifth)"
                },
            ),
            Self::NoDepth => write!(
                f,
                "no image had any depth: is the depth scale far too large, or does the depth camera send nothing?"
            ),
            Self::TravelledDistance { ratio } => write!(
                f,
                "the camera goes {ratio:.2} times as far as the wheels say: is the depth scale wrong, or the wheels' radius?"
            ),
            Self::FocalLengths { given, found, swapped } => {
                let cause = if swapped {
                    "are fx and fy swapped"
                } else {
                    "are they another camera's, or of another image size"
                };
                write!(
                    f,
                    "the points ask for focal lengths of about {:.0}, {:.0} px, but {:.0}, {:.0} px are set: {cause}?",
                    found.0, found.1, given.0, given.1
                )
            }
            Self::PrincipalPoint { offset } => write!(
                f,
                "the points ask for a principal point about {:.0}, {:.0} px from the one set: is it another camera's, or was the image cut?",
                offset.0, offset.1
            ),
            Self::Distortion { at_the_rim } => write!(
                f,
                "points are off by about {at_the_rim:.0} px towards the rim of the image: are the distortion coefficients another camera's, or is the image rectified already?"
            ),
            Self::Registration { offset } => write!(
                f,
                "the depth image's edges lie about {:.0}, {:.0} px beside the picture's: are colour and depth not registered?",
                offset.0, offset.1
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_names_its_likely_cause() {
        let swapped =
            CalibrationIssue::FocalLengths { given: (300.0, 360.0), found: (355.0, 304.0), swapped: true }
                .to_string();
        assert!(swapped.contains("fx and fy swapped"), "{swapped}");
        let other =
            CalibrationIssue::FocalLengths { given: (300.0, 300.0), found: (525.0, 524.0), swapped: false }
                .to_string();
        assert!(other.contains("another camera's") && other.contains("525, 524"), "{other}");
        let scale = CalibrationIssue::DepthRange { part: 0.8, beyond: true, median: 11.0 }.to_string();
        assert!(scale.contains("depth scale too small") && scale.contains("80 %"), "{scale}");
    }
}
