//! The texts of a recording: JSON in `std_msgs/msg/String` below `/trundle`, in chunks of zstd.

use mcap::records::{Record, op};
use mcap::{McapError, parse_record};
use std::io::Read;

/// Length of a record's head: opcode and length \[bytes\]. Source: MCAP specification, "Records".
const HEAD_BYTES: usize = 1 + 8;
/// Bytes of a text message before the text: encapsulation and length. A zero follows the text. Source: DDSI-RTPS, 10.2.
const TEXT_HEAD_BYTES: usize = 4 + 4;
/// In front of the topics of trundle's own messages.
const OWN_TOPICS: &str = "/trundle";

/// Hands on stamp (ns) and text of each message of `topic`, in the order of the file.
///
/// # Errors
/// When the file is not a recording with an index, or is broken.
pub(super) fn each_text(
    bytes: &[u8],
    topic: &str,
    mut hand_on: impl FnMut(u64, &[u8]),
) -> Result<(), McapError> {
    let summary = mcap::Summary::read(bytes)?.ok_or(McapError::UnexpectedEof)?;
    let name = format!("{OWN_TOPICS}{topic}");
    let channel = summary.channels.values().find(|channel| channel.topic == name).map(|channel| channel.id);
    let mut places: Vec<_> =
        summary.chunk_indexes.iter().map(|chunk| (chunk.chunk_start_offset, chunk.chunk_length)).collect();
    places.sort_unstable();
    for (start, length) in places {
        let (start, length) = (start as usize, length as usize);
        let content = bytes.get(start + HEAD_BYTES..start + length).ok_or(McapError::UnexpectedEof)?;
        for (opcode, record) in records(&unpacked(content)?) {
            if opcode != op::MESSAGE {
                continue;
            }
            let Record::Message { header, data } = parse_record(opcode, record)? else { continue };
            let text = data.get(TEXT_HEAD_BYTES..data.len().saturating_sub(1));
            if let Some(text) = text.filter(|_| Some(header.channel_id) == channel) {
                hand_on(header.log_time, text);
            }
        }
    }
    Ok(())
}

/// The records of a chunk.
fn unpacked(chunk: &[u8]) -> Result<Vec<u8>, McapError> {
    let Record::Chunk { header, data } = parse_record(op::CHUNK, chunk)? else {
        return Err(McapError::UnexpectedEof);
    };
    if header.compression.is_empty() {
        return Ok(data.into_owned());
    }
    let failed = |error: &dyn std::fmt::Display| McapError::DecompressionError(error.to_string());
    let mut decoder = ruzstd::decoding::StreamingDecoder::new(&data[..]).map_err(|error| failed(&error))?;
    let mut records = Vec::new();
    decoder.read_to_end(&mut records).map_err(|error| failed(&error))?;
    Ok(records)
}

/// Opcode and content of each whole record.
fn records(mut bytes: &[u8]) -> Vec<(u8, &[u8])> {
    let mut records = Vec::new();
    while let Some((head, rest)) = bytes.split_at_checked(HEAD_BYTES) {
        let length = u64::from_le_bytes(head[1..].try_into().expect("invariant: eight bytes")) as usize;
        let Some((content, rest)) = rest.split_at_checked(length) else { break };
        records.push((head[0], content));
        bytes = rest;
    }
    records
}
