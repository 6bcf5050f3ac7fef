//! Camera files of trundle: TOML.

use super::fields::CameraFields;
use crate::{IoError, toml_text::parse_toml};
use serde::{Deserialize, Serialize};
use std::path::Path;
use trundle_core::{Distortion, PinholeCamera};

/// The keys of the file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraFile {
    width: usize,
    height: usize,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    depth_scale: f64,
    #[serde(default)]
    k1: f64,
    #[serde(default)]
    k2: f64,
    #[serde(default)]
    p1: f64,
    #[serde(default)]
    p2: f64,
    #[serde(default)]
    k3: f64,
    readout: Option<f64>,
}

impl CameraFile {
    /// The keys of a camera.
    pub(super) fn of(camera: &PinholeCamera, depth_scale: f64) -> Self {
        let Distortion { k1, k2, p1, p2, k3 } = camera.distortion();
        let (width, height) = (camera.width(), camera.height());
        let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
        Self {
            width,
            height,
            fx,
            fy,
            cx,
            cy,
            depth_scale,
            k1,
            k2,
            p1,
            p2,
            k3,
            readout: Some(camera.readout()),
        }
    }

    fn fields(self) -> CameraFields {
        let Self { width, height, fx, fy, cx, cy, depth_scale, k1, k2, p1, p2, k3, readout } = self;
        CameraFields {
            size: (width, height),
            focal: (fx, fy),
            centre: (cx, cy),
            lens: Distortion { k1, k2, p1, p2, k3 },
            depth_scale: Some(depth_scale),
            readout,
        }
    }
}

/// The numbers of a file, all of them validated.
pub(super) fn parse(path: &Path, text: &str) -> Result<CameraFields, IoError> {
    let file: CameraFile = parse_toml(path, text)?;
    let fields = file.fields();
    fields.camera().map_err(|invalid| match line_of_key(text, &invalid.field) {
        Some(line) => IoError::line(path, line, invalid.to_string()),
        None => IoError::field(path)(invalid),
    })?;
    Ok(fields)
}

fn line_of_key(text: &str, key: &str) -> Option<usize> {
    let is_key = |line: &str| line.split_once('=').is_some_and(|(name, _)| name.trim() == key);
    text.lines().position(is_key).map(|i| i + 1)
}
