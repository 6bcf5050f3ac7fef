//! Camera files of trundle: TOML.

use super::fields::CameraFields;
use crate::IoError;
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
    #[serde(default)]
    readout: f64,
}

impl CameraFile {
    /// The keys of a camera.
    pub(super) fn of(camera: &PinholeCamera, depth_scale: f64) -> Self {
        let Distortion { k1, k2, p1, p2, k3 } = camera.distortion();
        let (width, height) = (camera.width(), camera.height());
        let (fx, fy, cx, cy) = (camera.fx(), camera.fy(), camera.cx(), camera.cy());
        Self { width, height, fx, fy, cx, cy, depth_scale, k1, k2, p1, p2, k3, readout: camera.readout() }
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

/// The numbers of a file, all of them accepted.
pub(super) fn parse(path: &Path, text: &str) -> Result<CameraFields, IoError> {
    let file: CameraFile = toml::from_str(text).map_err(|error| located(path, text, &error))?;
    let fields = file.fields();
    fields.camera().map_err(|invalid| match line_of_key(text, &invalid.field) {
        Some(line) => IoError::line(path, line, invalid.to_string()),
        None => IoError::field(path)(invalid),
    })?;
    Ok(fields)
}

/// The parser's complaint with its line and, where a value is at fault, its key.
fn located(path: &Path, text: &str, error: &toml::de::Error) -> IoError {
    let message = error.message().replace('\n', ", ");
    let Some(span) = error.span().filter(|_| !message.starts_with("missing field")) else {
        return IoError::malformed(path, message);
    };
    let before = text.get(..span.start).unwrap_or(text);
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let content = text.lines().nth(line - 1).unwrap_or_default();
    let key = content.split_once('=').map_or("", |(key, _)| key.trim());
    let names_it = key.is_empty() || message.contains(&format!("`{key}`"));
    let problem = if names_it { message } else { format!("{}: {message}", crate::excerpt::excerpt(key)) };
    IoError::line(path, line, problem)
}

fn line_of_key(text: &str, key: &str) -> Option<usize> {
    let is_key = |line: &str| line.split_once('=').is_some_and(|(name, _)| name.trim() == key);
    text.lines().position(is_key).map(|i| i + 1)
}
