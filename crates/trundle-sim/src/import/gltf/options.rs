//! Options of a glTF import: up axis, scale and pose.

use nalgebra::{Matrix4, Rotation3};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, Vector3, require_in};

/// Up axis of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UpAxis {
    /// +y, as glTF 2.0 prescribes and Blender writes. The file's x remains x; its -z becomes y.
    #[default]
    Y,
    /// +z, as in files of robotics tools without a rotation of the axes. All axes remain.
    Z,
}

impl UpAxis {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 2] =
        [("y", "As glTF has it", Self::Y), ("z", "As robots have it", Self::Z)];
}

/// Placement of a glTF file in the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct GltfOptions {
    /// The file's up axis. Default +y, by the standard.
    pub up: UpAxis,
    /// Metres per unit of the file, 1e-6 to 1e6. Default 1, by the standard.
    pub scale: f64,
    /// Height of the model's floor, m, which is moved to z = 0. Default: the detected height, if `pose` is the identity.
    pub floor: Option<f64>,
    /// `world_from_model`, applied after the three above. Default identity.
    pub pose: Pose3,
}

impl Default for GltfOptions {
    fn default() -> Self {
        Self { up: UpAxis::Y, scale: 1.0, floor: None, pose: Pose3::identity() }
    }
}

impl GltfOptions {
    /// A file with z up, in metres, at the world's origin.
    pub fn z_up() -> Self {
        Self { up: UpAxis::Z, ..Self::default() }
    }

    /// Passes valid options through.
    ///
    /// # Errors
    /// When the scale is outside its range or the pose is not finite.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("scale", self.scale, "m per unit", 1e-6, 1e6)?;
        self.floor.map_or(Ok(0.0), |floor| require_in("floor", floor, "m", -1e5, 1e5))?;
        if !self.pose.is_finite() {
            return Err(Invalid::new("pose", "not finite", "", "finite numbers"));
        }
        Ok(self)
    }

    /// Whether the floor is searched.
    pub(super) fn finds_floor(&self) -> bool {
        self.floor.is_none() && self.pose == Pose3::identity()
    }

    pub(super) fn world_from_file(&self) -> Matrix4<f64> {
        let turn = match self.up {
            UpAxis::Y => Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2),
            UpAxis::Z => Rotation3::identity(),
        };
        let pose: nalgebra::Isometry3<f64> = self.pose.into();
        let lift = Matrix4::new_translation(&Vector3::new(0.0, 0.0, -self.floor.unwrap_or(0.0)));
        pose.to_homogeneous() * lift * turn.to_homogeneous() * Matrix4::new_scaling(self.scale)
    }
}
