//! What a landmark looks like, as bytes.

use super::bytes::{Reader, Writer};
use super::error::MapFileError;
use crate::look::{Look, MOST_LOOKS};
use trundle_vision::ImagePatch;

pub(super) fn write_all(out: &mut Writer, looks: &[Look]) {
    out.u8(looks.len() as u8);
    for look in looks {
        out.0.extend(look.patch.pixels());
        look.patch.feature().into_iter().for_each(|v| out.f32(v));
        [look.right, look.down, look.toward_camera].iter().for_each(|v| out.f64s(v.iter().copied()));
    }
}

pub(super) fn read_all(bytes: &mut Reader) -> Result<Vec<Look>, MapFileError> {
    let count = usize::from(bytes.u8()?);
    bytes.require(count <= MOST_LOOKS, "looks of a landmark", count, || format!("at most {MOST_LOOKS}"))?;
    let mut looks = Vec::with_capacity(count);
    for _ in 0..count {
        looks.push(read(bytes)?);
    }
    Ok(looks)
}

fn read(bytes: &mut Reader) -> Result<Look, MapFileError> {
    let pixels = bytes.take()?;
    let mut feature = || bytes.f32_in("place of a patch's feature", -0.5, 0.5);
    let feature = [feature()?, feature()?];
    let patch = ImagePatch::new(pixels, feature).expect("invariant: it is at most half a pixel off");
    Ok(Look {
        patch,
        right: bytes.vector("pixel of a patch")?,
        down: bytes.vector("pixel of a patch")?,
        toward_camera: bytes.direction("direction of a look")?,
    })
}
