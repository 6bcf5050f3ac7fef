//! The images of a sequence that are converted, and their number.

use super::Converted;
use crate::sequence_input::{PendingFrame, SequenceInput};
use crate::{AppError, StepProgress, stop};
use trundle_core::RgbdImage;

/// Hands on each image that is whole.
pub(super) fn each_image(
    input: &SequenceInput,
    progress: &dyn StepProgress,
    mut write: impl FnMut(PendingFrame<'_>, RgbdImage) -> Result<(), AppError>,
) -> Result<Converted, AppError> {
    let mut converted = Converted { images: 0, skipped: 0, scans: 0 };
    progress.begin(Some(input.len()));
    for frame in input.frames()? {
        if stop::is_requested(|| format!("{} of {} images", converted.images, input.len())) {
            return Err(AppError::Stopped);
        }
        let frame = frame?;
        match frame.decode() {
            Ok(image) => {
                write(frame, image)?;
                converted.images += 1;
            }
            Err(problem) => {
                tracing::warn!("{problem}; the image is left out");
                converted.skipped += 1;
            }
        }
        progress.advance();
    }
    progress.end();
    Ok(converted)
}

/// Refuses a conversion that found nothing.
pub(super) fn finished(input: &SequenceInput, converted: Converted) -> Result<Converted, AppError> {
    if converted.images == 0 && converted.scans == 0 {
        return Err(AppError::Input(format!("{}: no image can be used", input.path.display())));
    }
    Ok(converted)
}
