//! Compressed images as ROS 2 has them: `sensor_msgs/msg/CompressedImage` in CDR, whose bytes stand as they are.

use trundle_core::{Invalid, Stamp};

/// The name of the message.
pub(super) const SCHEMA: &str = "sensor_msgs/msg/CompressedImage";
/// How the definition is written.
pub(super) const SCHEMA_ENCODING: &str = "ros2msg";
/// The definition of the message and of those in it.
pub(super) const DEFINITION: &str = "std_msgs/Header header\nstring format\nuint8[] data\n\
    ================================================================================\n\
    MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
    ================================================================================\n\
    MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

/// First bytes of a message: plain CDR, little endian.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];
/// The frame of the camera.
const FRAME: &str = "camera";
/// Nanoseconds of a second.
const NANOS_PER_S: i64 = 1_000_000_000;

/// An image's bytes and the stamp of its message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ImageBytes {
    pub stamp: Stamp,
    pub bytes: Vec<u8>,
}

/// The message of a JPEG or PNG.
///
/// # Errors
/// When the stamp is no time that ROS 2 can hold.
pub(super) fn encode(stamp: Stamp, image: &[u8]) -> Result<Vec<u8>, Invalid> {
    let invalid = || Invalid::new("stamp of an image", stamp, "s", "0 to 2^31 s");
    let sec = i32::try_from(stamp.nanos.div_euclid(NANOS_PER_S)).map_err(|_| invalid())?;
    let nanosec = u32::try_from(stamp.nanos.rem_euclid(NANOS_PER_S)).map_err(|_| invalid())?;
    let mut message = Vec::with_capacity(image.len() + 64);
    message.extend(ENCAPSULATION);
    message.extend(sec.to_le_bytes());
    message.extend(nanosec.to_le_bytes());
    push_text(&mut message, FRAME);
    push_text(&mut message, if image.starts_with(b"\x89PNG") { "png" } else { "jpeg" });
    push_length(&mut message, image.len());
    message.extend(image);
    Ok(message)
}

fn push_text(message: &mut Vec<u8>, text: &str) {
    push_length(message, text.len() + 1);
    message.extend(text.as_bytes());
    message.push(0);
}

/// A length, at a multiple of four bytes.
fn push_length(message: &mut Vec<u8>, length: usize) {
    message.resize(message.len().next_multiple_of(4), 0);
    message.extend(u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes());
}

/// The image of a message.
///
/// # Errors
/// What is wrong, in words.
pub(super) fn decode(message: &[u8]) -> Result<ImageBytes, String> {
    let cut = || format!("the message of {} bytes is cut", message.len());
    let rest = message.strip_prefix(&ENCAPSULATION).ok_or("expected plain CDR, little endian")?;
    let mut at = 0;
    let mut word = || {
        let bytes = rest.get(at..at + 4)?;
        at += 4;
        bytes.try_into().ok().map(u32::from_le_bytes)
    };
    let (sec, nanosec) = word().zip(word()).ok_or_else(cut)?;
    let (_frame, at) = block(rest, at).ok_or_else(cut)?;
    let (_format, at) = block(rest, at).ok_or_else(cut)?;
    let (image, _) = block(rest, at).ok_or_else(cut)?;
    let nanos = i64::from(sec.cast_signed()) * NANOS_PER_S + i64::from(nanosec);
    Ok(ImageBytes { stamp: Stamp::from_nanos(nanos), bytes: image.to_vec() })
}

/// The bytes behind a length at or after `at`, and where they end.
fn block(bytes: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let start = at.next_multiple_of(4) + 4;
    let length = u32::from_le_bytes(bytes.get(start - 4..start)?.try_into().ok()?);
    let end = start.checked_add(usize::try_from(length).ok()?)?;
    Some((bytes.get(start..end)?, end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_gives_its_image_back_and_a_cut_one_is_an_error() {
        let stamp = Stamp::from_nanos(1_305_031_229_528_748_001);
        for image in [&b"\x89PNG and so on"[..], b"a JPEG", b""] {
            let message = encode(stamp, image).unwrap();
            assert_eq!(decode(&message).unwrap(), ImageBytes { stamp, bytes: image.to_vec() });
            assert!((0..message.len()).all(|end| decode(&message[..end]).is_err()));
            assert!(message.len() < image.len() + 64);
        }
        assert!(encode(Stamp::from_nanos(i64::MAX), b"").is_err());
        assert!(decode(&[0, 0, 0, 0]).is_err());
    }
}
