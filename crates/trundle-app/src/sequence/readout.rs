//! Readout time of a camera whose file does not hold it, by the first images.

use crate::sequence_input::SequenceInput;
use crate::{AppError, stop};
use trundle_slam::{ReadoutEstimate, ReadoutEstimator};

/// Number of images that are searched: 200, some 7 s. Source: ours.
const SEARCHED_IMAGES: usize = 200;

/// Estimates the readout time, if it is unknown, and sets it if the images show a rolling shutter.
///
/// # Errors
/// When the images cannot be read.
pub(super) fn find_readout(input: &mut SequenceInput, frames: Option<usize>) -> Result<(), AppError> {
    if input.camera.is_readout_known || input.robot.slam.motion.readout > 0.0 {
        return Ok(());
    }
    let count = frames.unwrap_or(usize::MAX).min(SEARCHED_IMAGES);
    let Some(found) = readout_by_images(input, count)?.filter(ReadoutEstimate::is_clear) else {
        return Ok(());
    };
    let camera = input.camera.model.camera.with_readout(found.readout_s)?;
    (input.camera.model.camera, input.robot.camera) = (camera, camera);
    input.readout_by_images = Some(found);
    let ReadoutEstimate { readout_s, sigma_s, pairs } = found;
    tracing::info!(
        "{}: readout time {:.1} ms from the first row to the last, standard deviation {:.1} ms, by {pairs} pairs of images",
        input.path.display(),
        readout_s * 1e3,
        sigma_s * 1e3,
    );
    Ok(())
}

fn readout_by_images(input: &SequenceInput, count: usize) -> Result<Option<ReadoutEstimate>, AppError> {
    let mut estimator = ReadoutEstimator::new(input.camera.model.camera, input.robot.slam.clone())?;
    for (i, frame) in input.frames()?.take(count).enumerate() {
        if stop::is_requested(|| format!("the readout time searched in {i} of {count} images")) {
            break;
        }
        if let Ok(image) = frame?.decode() {
            estimator.record(&image);
        }
    }
    Ok(estimator.estimate())
}
