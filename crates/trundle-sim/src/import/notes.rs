//! Notes about an imported file that are no errors.

use std::fmt;

/// Number of examples in a note. Source: ours.
const MAX_EXAMPLES: usize = 3;

/// A note for the user about an imported file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ImportNote {
    /// Textures that cannot be read; their surfaces are grey.
    LostTextures {
        /// Reason for each.
        reasons: Vec<String>,
    },
    /// Number of surfaces with both a texture and vertex colours; these colours are ignored.
    HiddenColors {
        /// Number of surfaces.
        surfaces: usize,
    },
    /// The floor was not at z = 0, and the scene was moved.
    FloorMoved {
        /// Height in the file, m.
        height_m: f64,
    },
    /// The size is implausible for an indoor space.
    OddSize {
        /// Size along x, y and z, m.
        size_m: [f64; 3],
        /// Probable unit of the file, and its metres.
        unit: Option<(&'static str, f64)>,
    },
}

impl fmt::Display for ImportNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LostTextures { reasons } => {
                let (count, shown) = (reasons.len(), reasons.len().min(MAX_EXAMPLES));
                let more = if shown < count { "; ..." } else { "" };
                let examples = reasons[..shown].join("; ");
                write!(f, "textures that cannot be read are grey: {count}: {examples}{more}")
            }
            Self::HiddenColors { surfaces } => {
                write!(f, "colours of vertices are not drawn over a texture: {surfaces} surfaces")
            }
            Self::FloorMoved { height_m } => write!(
                f,
                "the floor lies at z = {height_m} m: the scene is moved so that it lies at 0; --floor Z names another height"
            ),
            Self::OddSize { size_m: [x, y, z], unit } => {
                write!(f, "the scene is {x} x {y} m and {z} m high: is the scale right?")?;
                match unit {
                    Some((name, metres)) => write!(f, " If the file is in {name}, say --scale {metres}"),
                    None => Ok(()),
                }
            }
        }
    }
}
