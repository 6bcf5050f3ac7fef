//! Depth images of OpenEXR files: one channel of floats.

use super::CodecError;
use super::claim::check_size;
use exr::compression::Compression;
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, read};
use std::io::Cursor;
use trundle_core::Image;

/// Names of the depth channel, in order of preference; a single channel may have any name.
const DEPTH_CHANNELS: [&str; 7] = ["Z", "depth", "Depth", "depth.Z", "Y", "V", "R"];

/// The channel of depths of the first layer.
pub(super) fn decode(bytes: &[u8]) -> Result<Image<f32>, CodecError> {
    let failed = |problem: &str| CodecError::decode("depth", problem);
    let damaged = |_| failed("the OpenEXR file is damaged or cut off");
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(damaged)?;
    for header in &meta.headers {
        let size = (header.layer_size.width(), header.layer_size.height());
        require_readable(header.compression)?;
        check_size("depth", size, 16 * header.channels.list.len().max(1), bytes.len())?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(damaged)?;
    let channels = &image.layer_data.channel_data.list;
    let named = DEPTH_CHANNELS.iter().find_map(|name| channels.iter().find(|channel| channel.name.eq(name)));
    let channel = match (named, &channels[..]) {
        (Some(channel), _) => channel,
        (None, [only]) => only,
        _ => return Err(failed("the OpenEXR file has no channel named Z, depth or Y")),
    };
    let size = image.layer_data.size;
    let values = channel.sample_data.values_as_f32().collect();
    Ok(Image::new(size.width(), size.height(), values)?)
}

/// Refuses the lossy compressions that the decoder does not read.
fn require_readable(compression: Compression) -> Result<(), CodecError> {
    match compression {
        Compression::DWAA(_) | Compression::DWAB(_) => {
            let problem = format!("the OpenEXR file is compressed by {compression}, expected ZIP or none");
            Err(CodecError::decode("depth", problem))
        }
        _ => Ok(()),
    }
}
