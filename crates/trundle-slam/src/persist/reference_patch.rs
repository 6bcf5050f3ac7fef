//! Image patches of a landmark as bytes.

use crate::map::reference_patch::{MAX_REFERENCE_PATCHES, ReferencePatch};
use crate::persist::bytes::{Reader, Writer};
use crate::persist::error::MapFileError;
use trundle_vision::ImagePatch;

pub(crate) fn write_all(out: &mut Writer, reference_patches: &[ReferencePatch]) {
    out.u8(reference_patches.len() as u8);
    for look in reference_patches {
        out.0.extend(look.image.pixels());
        look.image.feature().into_iter().for_each(|v| out.f32(v));
        [look.right, look.down, look.toward_camera].iter().for_each(|v| out.f64s(v.iter().copied()));
    }
}

pub(crate) fn read_all(bytes: &mut Reader) -> Result<Vec<ReferencePatch>, MapFileError> {
    let count = usize::from(bytes.u8()?);
    bytes.require(count <= MAX_REFERENCE_PATCHES, "reference patches of a landmark", count, || {
        format!("at most {MAX_REFERENCE_PATCHES}")
    })?;
    let mut reference_patches = Vec::with_capacity(count);
    for _ in 0..count {
        reference_patches.push(read(bytes)?);
    }
    Ok(reference_patches)
}

fn read(bytes: &mut Reader) -> Result<ReferencePatch, MapFileError> {
    let pixels = bytes.take()?;
    let mut feature = || bytes.f32_in("place of a patch's feature", -0.5, 0.5);
    let feature = [feature()?, feature()?];
    let patch = ImagePatch::new(pixels, feature).expect("invariant: it is at most half a pixel off");
    Ok(ReferencePatch {
        image: patch,
        right: bytes.vector("pixel of a patch")?,
        down: bytes.vector("pixel of a patch")?,
        toward_camera: bytes.direction("viewing direction of a reference patch")?,
    })
}
