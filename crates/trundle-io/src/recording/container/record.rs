//! The numbers and texts of an MCAP record.

/// The content of a record, written field by field: numbers little endian, texts and lists behind their length.
#[derive(Default)]
pub(super) struct RecordWriter(Vec<u8>);

impl RecordWriter {
    pub(super) fn u8(self, value: u8) -> Self {
        self.append(&[value])
    }

    pub(super) fn u16(self, value: u16) -> Self {
        self.append(&value.to_le_bytes())
    }

    pub(super) fn u32(self, value: u32) -> Self {
        self.append(&value.to_le_bytes())
    }

    pub(super) fn u64(self, value: u64) -> Self {
        self.append(&value.to_le_bytes())
    }

    pub(super) fn text(self, text: &str) -> Self {
        self.bytes(text.as_bytes())
    }

    /// A list, preceded by its length in bytes.
    pub(super) fn bytes(self, bytes: &[u8]) -> Self {
        self.u32(bytes.len() as u32).append(bytes)
    }

    pub(super) fn append(mut self, bytes: &[u8]) -> Self {
        self.0.extend(bytes);
        self
    }

    /// A whole record of this content.
    pub(super) fn append_record(self, opcode: u8, content: &[u8]) -> Self {
        self.u8(opcode).u64(content.len() as u64).append(content)
    }

    pub(super) fn content(self) -> Vec<u8> {
        self.0
    }

    /// The record of the content.
    pub(super) fn record(self, opcode: u8) -> Vec<u8> {
        Self::default().append_record(opcode, &self.0).0
    }
}
