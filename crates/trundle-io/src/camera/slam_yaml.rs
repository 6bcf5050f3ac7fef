//! Camera settings of ORB-SLAM2, ORB-SLAM3 and stella_vslam: YAML with OpenCV's header.

use super::fields::CameraFields;
use super::image_side::image_side;
use crate::IoError;
use crate::yaml_document::{YamlDocument, YamlValue};
use std::path::Path;
use trundle_core::{Distortion, Invalid};

/// Names of pinhole models in the programs' files.
const PINHOLES: [&str; 3] = ["pinhole", "rectified", "perspective"];

/// The numbers of a settings file. `Camera1.fx` is ORB-SLAM3's key, `Camera.fx` that of the other programs, flat or in a table.
pub(super) fn parse(path: &Path, text: &str) -> Result<CameraFields, IoError> {
    let document = YamlDocument::parse(path, text)?;
    refuse_other_lens(&document)?;
    let prefix = if document.get("Camera1.fx").is_some() { "Camera1" } else { "Camera" };
    let own = |name: &str| document.number(&format!("{prefix}.{name}"), "px");
    let lens = |name: &str| document.number_or(&format!("{prefix}.{name}"), 0.0, "a number");
    let fields = CameraFields {
        size: (
            image_side(&document, &["Camera.width", "Camera.cols"])?,
            image_side(&document, &["Camera.height", "Camera.rows"])?,
        ),
        focal: (own("fx")?, own("fy")?),
        centre: (own("cx")?, own("cy")?),
        lens: Distortion {
            k1: lens("k1")?,
            k2: lens("k2")?,
            p1: lens("p1")?,
            p2: lens("p2")?,
            k3: lens("k3")?,
        },
        depth_scale: depth_scale(&document)?,
        readout: None,
    };
    fields.camera().map_err(|invalid| document.invalid(renamed(prefix, invalid)))?;
    Ok(fields)
}

fn depth_scale(document: &YamlDocument<'_>) -> Result<Option<f64>, IoError> {
    let names = [
        "RGBD.DepthMapFactor",
        "DepthMapFactor",
        "Preprocessing.depthmap_factor",
        "Camera.depthmap_factor",
        "depthmap_factor",
    ];
    let named = names.iter().find(|name| document.get(name).is_some());
    named.map(|name| document.number(name, "depth units per metre")).transpose()
}

fn refuse_other_lens(document: &YamlDocument<'_>) -> Result<(), IoError> {
    for key in ["Camera.type", "Camera.model"] {
        if let Some(value @ YamlValue::Text(model)) = document.get(key)
            && !PINHOLES.iter().any(|name| model.eq_ignore_ascii_case(name))
        {
            let expected = "a pinhole camera: rectify the images and give the rectified camera";
            return Err(document.wrong(key, value, expected));
        }
    }
    Ok(())
}

/// The error under the name that the file has for the field.
fn renamed(prefix: &str, invalid: Invalid) -> Invalid {
    let field = match invalid.field.as_str() {
        "depth_scale" => "DepthMapFactor".to_owned(),
        other => format!("{prefix}.{other}"),
    };
    Invalid { field, ..invalid }
}
