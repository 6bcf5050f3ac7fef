//! Parser of the MCAP records that a reader of messages needs: every length is checked before memory is allocated.

use mcap::records::{Record, op};
use mcap::{McapError, McapResult, parse_record};

/// Longest record that is read, bytes: a bound for broken lengths. Source: ours.
pub(super) const MAX_RECORD: usize = 1 << 28;

/// A schema, channel or message; `None` for any other record.
///
/// # Errors
/// When the record is broken, or a text is longer than the record.
pub(super) fn parse_needed_record(opcode: u8, data: &[u8]) -> McapResult<Option<Record<'_>>> {
    match opcode {
        op::SCHEMA => require_texts(opcode, data, 2, 2)?,
        op::CHANNEL => {
            let metadata = require_texts(opcode, data, 4, 2)?;
            let pairs = skip_text(opcode, metadata)?;
            let mut pairs = &metadata[4..metadata.len() - pairs.len()];
            while !pairs.is_empty() {
                pairs = skip_text(opcode, pairs)?;
            }
            metadata
        }
        op::MESSAGE => data,
        _ => return Ok(None),
    };
    parse_record(opcode, data).map(Some)
}

/// Bytes behind `count` texts behind `head` bytes.
fn require_texts(opcode: u8, data: &[u8], head: usize, count: usize) -> McapResult<&[u8]> {
    let mut rest = data.get(head..).ok_or(McapError::UnexpectedEof)?;
    for _ in 0..count {
        rest = skip_text(opcode, rest)?;
    }
    Ok(rest)
}

/// Bytes behind a length of four bytes and as many bytes.
fn skip_text(opcode: u8, data: &[u8]) -> McapResult<&[u8]> {
    let (length, rest) = data.split_first_chunk().ok_or(McapError::UnexpectedEof)?;
    let length = u32::from_le_bytes(*length);
    rest.get(length as usize..).ok_or(McapError::RecordTooLarge { opcode, len: u64::from(length) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Vec<u8> {
        [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
    }

    #[test]
    fn whole_records_are_parsed_and_others_left_out() {
        let metadata = [text("a"), text("b")].concat();
        let pairs = [&(metadata.len() as u32).to_le_bytes()[..], &metadata].concat();
        let channel = [vec![1, 0, 2, 0], text("/scan"), text("cdr"), pairs].concat();
        let parsed = parse_needed_record(op::CHANNEL, &channel).unwrap();
        assert!(matches!(parsed, Some(Record::Channel(channel)) if channel.metadata["a"] == "b"));
        let schema = [vec![1, 0], text("x"), text("ros2msg"), text("float32 a")].concat();
        assert!(matches!(parse_needed_record(op::SCHEMA, &schema), Ok(Some(Record::Schema { .. }))));
        assert!(matches!(parse_needed_record(op::HEADER, &[0xff; 8]), Ok(None)));
    }

    #[test]
    fn a_length_beyond_the_record_is_refused() {
        let long = [vec![1, 0], 0x9a00_0000_u32.to_le_bytes().to_vec(), b"x".to_vec()].concat();
        let error = parse_needed_record(op::SCHEMA, &long).err();
        assert!(matches!(error, Some(McapError::RecordTooLarge { len: 0x9a00_0000, .. })), "{error:?}");
        let map = [vec![1, 0, 2, 0], text("/a"), text("cdr"), 6_u32.to_le_bytes().to_vec(), vec![0xff; 6]];
        assert!(parse_needed_record(op::CHANNEL, &map.concat()).is_err());
    }
}
