//! Calibrations of Kalibr (`camchain.yaml`) and of the EuRoC data set (`sensor.yaml`).

use super::fields::CameraFields;
use super::image_side::whole_side;
use crate::IoError;
use crate::yaml_document::{YamlDocument, YamlValue};
use std::path::Path;
use trundle_core::{Distortion, Invalid};

/// Names of the lens model k1, k2, p1, p2, in any case of letters. Source: Kalibr's and EuRoC's files.
const RADIAL_TANGENTIAL: [&str; 2] = ["radtan", "radial-tangential"];

/// Number of camera names that are looked for in a file. Source: ours, more than any robot has.
const MAX_CAMERAS: usize = 16;

/// The numbers of a calibration with one camera: keys at the top, or in the table `cam0`.
pub(super) fn parse(path: &Path, text: &str) -> Result<CameraFields, IoError> {
    let document = YamlDocument::parse(path, text)?;
    refuse_other_sensors(path, &document)?;
    let key = |name: &str| match document.get("cam0") {
        Some(_) => format!("cam0.{name}"),
        None => name.to_owned(),
    };
    refuse_other_model(&document, &key("camera_model"))?;
    let [fx, fy, cx, cy] = some_numbers(&document, &key("intrinsics"), "fx, fy, cx, cy, px")?;
    let [width, height] = some_numbers(&document, &key("resolution"), "width and height, px")?;
    let fields = CameraFields {
        size: (whole_side(&document, "width", width)?, whole_side(&document, "height", height)?),
        focal: (fx, fy),
        centre: (cx, cy),
        lens: lens(&document, &key)?,
        depth_scale: depth_scale(&document, &key)?,
        readout: None,
    };
    let named =
        |invalid: Invalid| Invalid { field: format!("{} {}", key("intrinsics"), invalid.field), ..invalid };
    fields.camera().map_err(|invalid| document.invalid(named(invalid)))?;
    Ok(fields)
}

/// Refuses a file of several cameras, or of another sensor.
fn refuse_other_sensors(path: &Path, document: &YamlDocument<'_>) -> Result<(), IoError> {
    if let Some(other) = (1..MAX_CAMERAS).map(|i| format!("cam{i}")).find(|name| document.get(name).is_some())
    {
        let problem = format!("it has {other}, expected the colour camera alone, as cam0");
        return Err(IoError::malformed(path, problem));
    }
    match document.get("sensor_type") {
        Some(YamlValue::Text(kind)) if kind == "camera" => Ok(()),
        Some(other) => Err(document.wrong("sensor_type", other, "camera")),
        None => Ok(()),
    }
}

/// The depth scale; Kalibr itself writes none.
fn depth_scale(document: &YamlDocument<'_>, key: &dyn Fn(&str) -> String) -> Result<Option<f64>, IoError> {
    let names = [key("depth_scale"), "depth_scale".to_owned()];
    let name = names.iter().find(|name| document.get(name).is_some());
    name.map(|name| document.number(name, "depth units per metre")).transpose()
}

fn refuse_other_model(document: &YamlDocument<'_>, key: &str) -> Result<(), IoError> {
    match document.require(key, "pinhole")? {
        YamlValue::Text(model) if model.eq_ignore_ascii_case("pinhole") => Ok(()),
        other => {
            let expected = "pinhole: rectify the images and give the rectified camera";
            Err(document.wrong(key, other, expected))
        }
    }
}

/// The lens: of model radtan, or none.
fn lens(document: &YamlDocument<'_>, key: &dyn Fn(&str) -> String) -> Result<Distortion, IoError> {
    let model_key = key("distortion_model");
    let expected = "radtan or none: rectify the images and give the rectified camera";
    let model = document.require(&model_key, expected)?;
    let is = |name: &str| matches!(model, YamlValue::Text(text) if text.eq_ignore_ascii_case(name));
    if is("none") {
        return Ok(Distortion::default());
    }
    if !RADIAL_TANGENTIAL.into_iter().any(is) {
        return Err(document.wrong(&model_key, model, expected));
    }
    let names = [key("distortion_coeffs"), key("distortion_coefficients")];
    let name = document.first_of(&names.each_ref().map(String::as_str));
    let [k1, k2, p1, p2] = some_numbers(document, name, "k1, k2, p1, p2")?;
    Ok(Distortion { k1, k2, p1, p2, k3: 0.0 })
}

/// The `N` numbers of a list.
fn some_numbers<const N: usize>(
    document: &YamlDocument<'_>,
    key: &str,
    expected: &str,
) -> Result<[f64; N], IoError> {
    let numbers = document.numbers(key, expected)?;
    let problem = |found: Vec<f64>| {
        document.invalid(Invalid::new(key, format!("{} numbers", found.len()), "", expected))
    };
    numbers.try_into().map_err(problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EUROC: &str = "# VI-Sensor cam0\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1.0, 0.0]\n\
                         rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\n\
                         intrinsics: [458.654, 457.296, 367.215, 248.375]\ndistortion_model: radial-tangential\n\
                         distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n";
    const KALIBR: &str = "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n  \
                          distortion_model: radtan\n  intrinsics: [458.654, 457.296, 367.215, 248.375]\n  resolution: [752, 480]\n  \
                          rostopic: /cam0/image_raw\n";

    fn read(text: &str) -> Result<CameraFields, String> {
        parse(Path::new("cam.yaml"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn both_forms_give_the_same_camera() {
        for text in [EUROC, KALIBR] {
            let fields = read(text).unwrap();
            assert_eq!((fields.size, fields.focal), ((752, 480), (458.654, 457.296)));
            assert_eq!((fields.centre, fields.lens.k1), ((367.215, 248.375), -0.283_408_11));
            assert_eq!((fields.lens.p2, fields.depth_scale), (1.761_871_14e-5, None));
        }
    }

    #[test]
    fn other_spellings_and_a_depth_scale_are_read() {
        let text = KALIBR.replace("radtan", "RadTan").replace("pinhole", "Pinhole");
        let fields = read(&text.replace("  rostopic", "  depth_scale: 5000\n  rostopic")).unwrap();
        assert_eq!((fields.depth_scale, fields.lens.k1), (Some(5000.0), -0.283_408_11));
        let bare = KALIBR
            .replace("radtan", "none")
            .replace("[-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]", "[]");
        assert_eq!(read(&bare).unwrap().lens, Distortion::default());
        assert!(
            read(&EUROC.replace("sensor_type: camera", "sensor_type: imu"))
                .err()
                .unwrap()
                .contains("sensor_type is 'imu', expected camera")
        );
    }

    #[test]
    fn other_cameras_and_wrong_numbers_are_named() {
        for (from, to, expected) in [
            ("pinhole", "omni", "camera_model is 'omni', expected pinhole: rectify"),
            ("radtan", "equidistant", "distortion_model is 'equidistant', expected radtan or none: rectify"),
            (
                "distortion_model: radtan",
                "distortion_model: 4",
                "distortion_model is 4, expected radtan or none",
            ),
            ("  distortion_model: radtan\n", "", "distortion_model is missing, expected radtan or none"),
            ("0.00019359, ", "", "distortion_coeffs is 3 numbers, expected k1, k2, p1, p2"),
            ("458.654, ", "", "intrinsics is 3 numbers, expected fx, fy, cx, cy, px"),
            ("458.654", "36100000", "line 5: cam0.intrinsics fx is 36100000 px"),
            ("[752, ", "[752.5, ", "width is 752.5 px, expected a whole number from 1 to 65536"),
            ("  resolution: [752, 480]\n", "", "resolution is missing, expected width and height, px"),
            ("cam0:", "cam1:", "it has cam1, expected the colour camera alone, as cam0"),
            ("  rostopic", "  depth_scale: 0.001\n  rostopic", "depth_scale is 0.001"),
        ] {
            let problem = read(&KALIBR.replace(from, to)).err().unwrap();
            assert!(problem.contains(expected), "{from} -> {to}: {problem}");
        }
    }
}
