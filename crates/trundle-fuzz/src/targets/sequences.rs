//! RGB-D folders, trajectories, images and cameras.

use crate::scratch::{with_file, with_files};
use crate::seeds::small_png;
use trundle::eval::relations_from_text;
use trundle::io::{
    CameraModel, TumSequence, decode_color, decode_depth, decode_raw_depth, read_odometry, read_trajectory,
};

/// The list of a folder's colour images; the depth images' list is a fixed one.
pub fn image_list(bytes: &[u8]) {
    let files = [("rgb.txt", bytes), ("depth.txt", b"1.0 depth/1.png\n2.0 depth/2.png\n".as_slice())];
    let _ = with_files(&files, |folder| TumSequence::open(folder, 5000.0, TumSequence::MAX_DIFFERENCE));
}

/// The depth image of a frame, in any of the formats that are read; list and colour image are fixed.
pub fn depth_file(bytes: &[u8]) {
    let (list, color) = (b"1.0 color.png\n".as_slice(), small_png());
    let files =
        [("rgb.txt", list), ("color.png", &color), ("depth.txt", b"1.0 depth.png\n"), ("depth.png", bytes)];
    with_files(&files, |folder| {
        let sequence = TumSequence::open(folder, 5000.0, TumSequence::MAX_DIFFERENCE);
        let _ = sequence.map(|sequence| sequence.load(0));
    });
}

/// A trajectory of the camera.
pub fn trajectory(bytes: &[u8]) {
    let _ = with_file("trajectory.txt", bytes, read_trajectory);
}

/// Odometry in the plane.
pub fn odometry(bytes: &[u8]) {
    let _ = with_file("odometry.txt", bytes, read_odometry);
}

/// Relations between poses.
pub fn relations(bytes: &[u8]) {
    let _ = std::str::from_utf8(bytes).map(relations_from_text);
}

/// A colour image.
pub fn color_image(bytes: &[u8]) {
    let _ = decode_color(bytes);
}

/// A depth image.
pub fn depth_image(bytes: &[u8]) {
    let _ = decode_depth(bytes);
    let _ = decode_raw_depth(bytes);
}

/// A camera file.
pub fn camera(bytes: &[u8]) {
    let _ = with_file("camera.toml", bytes, CameraModel::read);
}
