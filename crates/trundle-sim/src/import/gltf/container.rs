//! The binary glTF container (GLB).

use crate::import::ImportFault;

/// First bytes of a file, and kinds of its chunks. Source: glTF 2.0, section 4.4.
const MAGIC: &[u8] = b"glTF";
const JSON_CHUNK: u32 = u32::from_le_bytes(*b"JSON");
const BINARY_CHUNK: u32 = u32::from_le_bytes(*b"BIN\0");

/// The two parts of a GLB file; a `.gltf` file is the first alone.
#[derive(Debug)]
pub(super) struct Container<'a> {
    /// The description.
    pub(super) json: &'a [u8],
    /// The buffer without a name.
    pub(super) binary: Option<&'a [u8]>,
}

impl<'a> Container<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, ImportFault> {
        if !bytes.starts_with(MAGIC) {
            return Ok(Self { json: bytes, binary: None });
        }
        let word_at = |at: usize| {
            let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
            word.map(u32::from_le_bytes).ok_or(truncated("the GLB file", bytes.len(), at as u64 + 4))
        };
        let not_gltf = |reason: String| ImportFault::NotGltf { reason };
        if word_at(4)? != 2 {
            return Err(not_gltf(format!("GLB version {}, expected 2", word_at(4)?)));
        }
        let length = word_at(8)?;
        if bytes.len() < length as usize {
            return Err(truncated("the GLB file", bytes.len(), length.into()));
        }
        let mut chunks = Vec::new();
        let mut at = 12;
        while at < length as usize {
            let (size, kind) = (word_at(at)? as usize, word_at(at + 4)?);
            let chunk = bytes.get(at + 8..at + 8 + size);
            let chunk = chunk.ok_or(truncated("the GLB file", bytes.len(), at as u64 + 8 + size as u64))?;
            chunks.push((kind, chunk));
            at += 8 + size;
        }
        let find = |kind: u32| chunks.iter().find(|(k, _)| *k == kind).map(|(_, chunk)| *chunk);
        let json = find(JSON_CHUNK).ok_or_else(|| not_gltf("no JSON chunk".into()))?;
        Ok(Self { json, binary: find(BINARY_CHUNK) })
    }
}

fn truncated(item: &str, found: usize, expected: u64) -> ImportFault {
    ImportFault::Truncated { item: item.into(), found: found as u64, expected }
}
