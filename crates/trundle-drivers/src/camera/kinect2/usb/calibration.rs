//! Calibration from the pages of the device.
//!
//! The device's images are mirrored left to right; [`turned_back`] is the camera of the image turned back.
//!
//! The map from depth to colour is a polynomial of third order, which includes rotation and both lenses:
//!
//! u = (P(x, y) / q_c) + f (m / z - m / s) + c_x, v = Q(x, y) / q_c + c_y, with (x, y) = q_d (pixel - principal point)
//!
//! The rotation between the cameras follows from the polynomial's constant and linear terms, and the baseline from m. The distortion of the
//! colour lens is part of the polynomial and is ignored: colour is misplaced by some pixels in the corners.

use crate::camera::kinect2::layout::{COLUMNS, FREQUENCY_COUNT, PIXEL_COUNT, ROWS};
use nalgebra::UnitQuaternion;
use trundle_core::{Distortion, Invalid, PinholeCamera, Pose3, Vector3, require_in};

/// Bytes before the tables. Source: \[Freenect2\].
const P0_HEADER_BYTES: usize = 32;
/// Bytes of a table: an unknown number of 16 bits before it and after it. Source: \[Freenect2\].
const P0_TABLE_BYTES: usize = 2 * (PIXEL_COUNT + 2);
/// Columns and rows of colour \[px\]. Source: \[Freenect2\].
pub const COLOR_SIZE: (usize, usize) = (1920, 1080);
/// Scale of a colour pixel in the polynomial \[1/px\]. Source: \[Freenect2\].
const COLOR_SCALE: f64 = 0.002199;
/// Middle of a pixel in the device's principal points \[px\]. Source: assumed, after the formula of its range tables.
const PIXEL_MIDDLE: f64 = 0.5;
/// Scale of the baseline \[m\]: the device counts millimetres. Source: SI.
const MILLIMETRE_M: f64 = 1e-3;
/// Longest baseline \[m\]. Source: ours; the cameras are 0.05 m apart.
const MAX_BASELINE_M: f64 = 0.2;
/// Largest angle between the cameras as a tangent \[1\]. Source: ours; both cameras face the same direction.
const MAX_TILT: f64 = 0.2;
/// Terms of a polynomial. Source: \[Freenect2\].
const TERM_COUNT: usize = 10;
/// Place of the coefficient of x. Source: \[Freenect2\].
const TERM_X: usize = 7;
/// Place of the constant. Source: \[Freenect2\].
const TERM_ONE: usize = 9;

/// The P0 tables for [`crate::camera::kinect2::Kinect2Calibration`]. The device stores the rows from the bottom, and its angles have the
/// opposite sign.
///
/// # Errors
/// When the page is too short.
pub fn p0_tables(page: &[u8]) -> Result<[Vec<u16>; FREQUENCY_COUNT], Invalid> {
    let tables = page.get(P0_HEADER_BYTES..).unwrap_or_default();
    let expected = FREQUENCY_COUNT * P0_TABLE_BYTES;
    if tables.len() < expected {
        let min = format!("at least {}", P0_HEADER_BYTES + expected);
        return Err(Invalid::new("P0 tables of the Kinect V2", page.len(), "bytes", min));
    }
    Ok(std::array::from_fn(|frequency| {
        let table = &tables[frequency * P0_TABLE_BYTES + 2..][..2 * PIXEL_COUNT];
        let rows = table.chunks_exact(2 * COLUMNS).rev();
        rows.flat_map(|row| row.as_chunks::<2>().0)
            .map(|pair| u16::from_le_bytes(*pair).wrapping_neg())
            .collect()
    }))
}

/// The depth camera of the device's mirrored image: f_x, f_y, unknown, c_x, c_y, k1, k2, p1, p2, k3.
///
/// # Errors
/// When the page is too short, or a number is not a property of a camera.
pub fn depth_camera(page: &[u8]) -> Result<PinholeCamera, Invalid> {
    let [fx, fy, _, cx, cy, k1, k2, p1, p2, k3] = numbers(page, "depth parameters of the Kinect V2")?;
    PinholeCamera::new((COLUMNS, ROWS), (fx, fy), centre(cx, cy), Distortion { k1, k2, p1, p2, k3 })
}

/// The camera of the image mirrored back, left to right. The horizontal shear of the lens changes its sign.
///
/// # Errors
/// Never: the numbers are those of a camera.
pub fn turned_back(camera: &PinholeCamera) -> Result<PinholeCamera, Invalid> {
    let size = (camera.width(), camera.height());
    let centre = ((size.0 - 1) as f64 - camera.cx(), camera.cy());
    let distortion = Distortion { p2: -camera.distortion().p2, ..camera.distortion() };
    PinholeCamera::new(size, (camera.fx(), camera.fy()), centre, distortion)
}

/// The colour camera and the pose of the depth camera in its frame, both for the images mirrored back.
///
/// # Errors
/// When the page is too short, or a number is not a property of a camera.
pub fn color_camera(page: &[u8]) -> Result<(PinholeCamera, Pose3), Invalid> {
    // The first byte is the number of the table.
    let place = "colour parameters of the Kinect V2";
    let all: [f64; 5 + 2 * TERM_COUNT] = numbers(page.get(1..).unwrap_or_default(), place)?;
    let [f, cx, cy, shift_d, shift_m] = *all.first_chunk().unwrap_or(&[0.0; 5]);
    let mirrored = PinholeCamera::new(COLOR_SIZE, (f, f), centre(cx, cy), Distortion::default())?;
    let (across, down) = all[5..].split_at(TERM_COUNT);
    let right = across[TERM_ONE] / (COLOR_SCALE * f) - shift_m / shift_d;
    let below = down[TERM_ONE] / (COLOR_SCALE * f);
    let roll = down[TERM_X] / across[TERM_X];
    let baseline_m = shift_m * MILLIMETRE_M;
    for (name, value, limit) in [
        ("pan", right, MAX_TILT),
        ("tilt", below, MAX_TILT),
        ("roll", roll, MAX_TILT),
        ("baseline", baseline_m, MAX_BASELINE_M),
    ] {
        require_in(&format!("{name} of the {place}"), value, "", -limit, limit)?;
    }
    Ok((
        turned_back(&mirrored)?,
        Pose3::new(rotation(-right, below, -roll), Vector3::new(-baseline_m, 0.0, 0.0)),
    ))
}

/// The rotation that moves the optical axis to (right, below, 1) and the horizontal by `roll`, all as tangents.
fn rotation(right: f64, below: f64, roll: f64) -> UnitQuaternion<f64> {
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let tilt = below.atan2((1.0 + right * right).sqrt());
    about(Vector3::y_axis(), right.atan())
        * about(Vector3::x_axis(), -tilt)
        * about(Vector3::z_axis(), roll.atan())
}

fn centre(cx: f64, cy: f64) -> (f64, f64) {
    (cx - PIXEL_MIDDLE, cy - PIXEL_MIDDLE)
}

fn numbers<const COUNT: usize>(page: &[u8], place: &str) -> Result<[f64; COUNT], Invalid> {
    let (words, _) = page.as_chunks::<4>();
    let too_short = || Invalid::new(place, page.len(), "bytes", format!("at least {}", 4 * COUNT));
    let words = words.first_chunk::<COUNT>().ok_or_else(too_short)?;
    Ok(words.map(|word| f64::from(f32::from_le_bytes(word))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    fn page(numbers: &[f64]) -> Vec<u8> {
        numbers.iter().flat_map(|number| (*number as f32).to_le_bytes()).collect()
    }

    #[test]
    fn rows_of_p0_come_from_the_bottom_with_the_opposite_sign() {
        let mut bytes = vec![0xff; P0_HEADER_BYTES];
        for table in 0..3_u16 {
            bytes.extend([0xee; 2]);
            bytes.extend(
                (0..PIXEL_COUNT).flat_map(|pixel| (table * 1000 + (pixel / COLUMNS) as u16).to_le_bytes()),
            );
            bytes.extend([0xee; 2]);
        }
        let tables = p0_tables(&bytes).unwrap();
        assert!(tables.iter().all(|table| table.len() == PIXEL_COUNT));
        assert_eq!(tables[0][0], 423_u16.wrapping_neg());
        assert_eq!(
            (tables[2][PIXEL_COUNT - 1], tables[1][COLUMNS]),
            (2000_u16.wrapping_neg(), 1422_u16.wrapping_neg())
        );
        let error = p0_tables(&bytes[..bytes.len() - 1]).unwrap_err().to_string();
        assert!(error.contains("at least 1302572"), "{error}");
    }

    #[test]
    fn the_depth_camera_is_turned_back() {
        let camera = |page: &[u8]| depth_camera(page).and_then(|camera| turned_back(&camera));
        let camera = camera(&page(&[365.0, 366.0, 0.0, 250.0, 205.0, 0.09, -0.27, 0.0, 0.01, 0.1])).unwrap();
        assert_eq!((camera.cx(), camera.cy(), camera.fx(), camera.fy()), (261.5, 204.5, 365.0, 366.0));
        assert!((camera.distortion().p2 + 0.01).abs() < 1e-6 && (camera.distortion().k1 - 0.09).abs() < 1e-6);
        assert!(depth_camera(&[0; 40]).is_err() && depth_camera(&[0; 39]).is_err(), "focal length 0, cut");
        assert!(depth_camera(&[0xff; 40]).is_err(), "not a number");
    }

    /// The page of a device whose colour camera is rotated by small angles and 52 mm away, without distortion. The polynomial is fitted to
    /// the true projection of its mirrored images at an infinite distance.
    #[test]
    fn the_pose_projects_as_the_polynomial_does() {
        let (f, cx, cy, fd, shift_m, shift_d) = (1081.37, 959.5, 539.5, 366.0, 52.0, 863.0);
        let (right, below, roll) = (0.013, -0.02, 0.004);
        // First order of the mirrored projection: u = f (fd-normalised x + right), v likewise, rolled.
        let slope = f / fd / 0.01 * COLOR_SCALE;
        let mut across = [0.0; TERM_COUNT];
        let mut down = [0.0; TERM_COUNT];
        (across[TERM_X], across[TERM_X + 1]) = (slope, -roll * slope);
        (down[TERM_X], down[TERM_X + 1]) = (roll * slope, slope);
        across[TERM_ONE] = (right + shift_m / shift_d) * COLOR_SCALE * f;
        down[TERM_ONE] = below * COLOR_SCALE * f;
        let mut bytes = vec![1];
        bytes.extend(page(&[&[f, cx, cy, shift_d, shift_m], &across[..], &down[..]].concat()));
        let (camera, color_from_depth) = color_camera(&bytes).unwrap();
        for (x, y, z) in [(0.0, 0.0, 1.0), (0.05, 0.02, 0.8), (-0.1, 0.1, 2.0), (0.2, -0.1, 4.0)] {
            let found = camera.project(color_from_depth.transform(Vector3::new(x, y, z))).unwrap();
            // The device's formula for the mirrored point, with pixel = fd x / z, turned back.
            let (px, py) = (-fd * x / z * 0.01, fd * y / z * 0.01);
            let poly = |terms: &[f64]| terms[TERM_X] * px + terms[TERM_X + 1] * py + terms[TERM_ONE];
            let u = poly(&across) / COLOR_SCALE + f * (shift_m / (1e3 * z) - shift_m / shift_d) + cx - 0.5;
            let v = poly(&down) / COLOR_SCALE + cy - 0.5;
            let error = found - Vector2::new(1919.0 - u, v);
            assert!(error.norm() < 1.5, "at {x} {y} {z}: {error}");
        }
        assert!(color_camera(&bytes[..100]).is_err() && color_camera(&[0; 101]).is_err());
    }
}
