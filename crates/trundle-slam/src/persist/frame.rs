//! The stored part of a frame as bytes.

use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::persist::bytes::{Reader, Writer};
use crate::persist::error::MapFileError;
use trundle_core::Stamp;
use trundle_optim::InverseDepth;
use trundle_vision::{Features, Keypoint};

/// Fewest bytes of a feature. Source: the layout that this file writes.
const MIN_FEATURE_BYTES: usize = 17 + 4 + 32 + 1;

/// Smallest standard deviation of a keypoint: 1e-6 px. A smaller one is refused as damage. Source: ours.
const MIN_KEYPOINT_SIGMA_PX: f32 = 1e-6;
/// Largest standard deviation of a keypoint: 1e6 px. A larger one is refused as damage. Source: ours.
const MAX_KEYPOINT_SIGMA_PX: f32 = 1e6;

pub(crate) fn write(out: &mut Writer, frame: &Frame) {
    out.u64(frame.stamp.nanos.cast_unsigned());
    out.count(frame.len());
    for (i, keypoint) in frame.features.keypoints.iter().enumerate() {
        [keypoint.x, keypoint.y, keypoint.angle, keypoint.response].into_iter().for_each(|v| out.f32(v));
        out.u8(keypoint.octave);
        out.f32(frame.pixel_sigmas[i]);
        out.descriptor(frame.descriptor(i));
        out.u8(u8::from(frame.depths[i].is_some()));
        out.f64s(frame.depths[i].into_iter().flat_map(|depth| [depth.value, depth.sigma]));
    }
}

pub(crate) fn read(bytes: &mut Reader, model: &ObservationModel) -> Result<Frame, MapFileError> {
    let stamp = Stamp::from_nanos(bytes.u64()?.cast_signed());
    let (mut features, mut depths, mut pixel_sigmas) = (Features::default(), Vec::new(), Vec::new());
    for _ in 0..bytes.count(MIN_FEATURE_BYTES)? {
        features.keypoints.push(read_keypoint(bytes, model)?);
        pixel_sigmas.push(bytes.f32_in(
            "sigma of a keypoint",
            MIN_KEYPOINT_SIGMA_PX,
            MAX_KEYPOINT_SIGMA_PX,
        )?);
        features.descriptors.push(bytes.descriptor()?);
        depths.push(read_depth(bytes)?);
    }
    let mut frame = Frame::of(stamp, features, depths, model);
    frame.pixel_sigmas = pixel_sigmas;
    let is_rectified = frame.pixels.iter().all(|pixel| pixel.iter().all(|v| v.is_finite()));
    bytes.require(is_rectified, "rectified place of a keypoint", "infinite", || "finite".to_owned())?;
    Ok(frame)
}

fn read_keypoint(bytes: &mut Reader, model: &ObservationModel) -> Result<Keypoint, MapFileError> {
    let [x, y, angle, response] = [bytes.f32()?, bytes.f32()?, bytes.f32()?, bytes.f32()?];
    let octave = bytes.u8()?;
    // With a rolling shutter a pixel may lie beyond the image border.
    let (width, height) = (model.camera.width() as f32, model.camera.height() as f32);
    let is_near = (-width..=2.0 * width).contains(&x) && (-height..=2.0 * height).contains(&y);
    bytes.require(is_near, "place of a keypoint", format!("({x}, {y})"), || {
        "in or near the image".to_owned()
    })?;
    let plain = angle.is_finite() && response.is_finite();
    bytes.require(plain, "angle or response of a keypoint", angle + response, || "finite".to_owned())?;
    let levels = model.scale_factors.len();
    bytes.require(usize::from(octave) < levels, "octave of a keypoint", octave, || {
        format!("less than {levels}")
    })?;
    Ok(Keypoint { x, y, octave, angle, response })
}

fn read_depth(bytes: &mut Reader) -> Result<Option<InverseDepth>, MapFileError> {
    if !bytes.mark("mark of a depth")? {
        return Ok(None);
    }
    let mut positive = |name: &str| bytes.f64_in(name, 1e-9, 1e9);
    Ok(Some(InverseDepth {
        value: positive("inverse depth")?,
        sigma: positive("sigma of an inverse depth")?,
    }))
}
