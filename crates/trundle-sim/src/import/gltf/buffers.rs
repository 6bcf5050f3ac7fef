//! glTF buffers, embedded or in separate files.

use super::container::Container;
use super::schema::at;
use crate::import::ImportFault;
use base64::Engine as _;
use gltf::json::{Index, Root, buffer};
use std::borrow::Cow;

/// Fetches a file named in a glTF file.
pub(super) type Resolve<'a> = &'a (dyn Fn(&str) -> std::io::Result<Vec<u8>> + Sync);

/// All bytes of a glTF file and its separate files.
pub(super) struct Buffers<'a> {
    root: &'a Root,
    data: Vec<Cow<'a, [u8]>>,
    resolve: Resolve<'a>,
}

impl<'a> Buffers<'a> {
    pub(super) fn load(
        root: &'a Root,
        container: &Container<'a>,
        resolve: Resolve<'a>,
    ) -> Result<Self, ImportFault> {
        let load = |(i, buffer): (usize, &buffer::Buffer)| {
            let item = format!("buffer {i}");
            let data = match (&buffer.uri, container.binary) {
                (Some(uri), _) => Cow::Owned(fetch(&item, uri, resolve)?),
                (None, Some(binary)) if i == 0 => Cow::Borrowed(binary),
                _ => return Err(ImportFault::part(item, "has neither a file nor a binary chunk")),
            };
            require_length(&item, data.len(), buffer.byte_length.0)?;
            Ok(data)
        };
        let data = root.buffers.iter().enumerate().map(load).collect::<Result<_, _>>()?;
        Ok(Self { root, data, resolve })
    }

    pub(super) fn root(&self) -> &'a Root {
        self.root
    }

    /// The bytes of a view; a view beyond the end of its buffer gives the bytes that exist.
    pub(super) fn view(&self, index: Index<buffer::View>) -> Result<&[u8], ImportFault> {
        let view = at(&self.root.buffer_views, index, "bufferViews")?;
        at(&self.root.buffers, view.buffer, "buffers")?;
        let data = &self.data[view.buffer.value()];
        let start = view.byte_offset.unwrap_or_default().0;
        let end = start.saturating_add(view.byte_length.0).min(data.len() as u64);
        let item = || format!("buffer {} under bufferView {index}", view.buffer);
        require_length(&item(), data.len(), start)?;
        Ok(&data[start as usize..end as usize])
    }

    /// The bytes behind a URI.
    pub(super) fn fetch(&self, item: &str, uri: &str) -> Result<Vec<u8>, ImportFault> {
        fetch(item, uri, self.resolve)
    }
}

pub(super) fn require_length(item: &str, found: usize, expected: u64) -> Result<(), ImportFault> {
    if (found as u64) < expected {
        return Err(ImportFault::Truncated { item: item.into(), found: found as u64, expected });
    }
    Ok(())
}

fn fetch(item: &str, uri: &str, resolve: Resolve<'_>) -> Result<Vec<u8>, ImportFault> {
    if let Some(data) = uri.strip_prefix("data:") {
        let coded = data.split_once(";base64,").map(|(_, coded)| coded);
        let coded = coded.ok_or_else(|| ImportFault::part(item, "its data URI is not base64"))?;
        let engine = base64::engine::general_purpose::STANDARD;
        return engine.decode(coded).map_err(|e| ImportFault::part(item, format!("its data URI: {e}")));
    }
    let name = percent_decoded(uri);
    resolve(&name).map_err(|error| ImportFault::part(format!("{item} ('{name}')"), reason(&error)))
}

fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "it does not exist".to_owned(),
        std::io::ErrorKind::PermissionDenied => "no permission".to_owned(),
        _ => error.to_string(),
    }
}

/// Decodes `%20` and similar codes to bytes.
fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let hex = |at: usize| bytes.get(at).and_then(|&b| char::from(b).to_digit(16));
    let (mut out, mut at) = (Vec::with_capacity(bytes.len()), 0);
    while let Some(&byte) = bytes.get(at) {
        match (byte, hex(at + 1), hex(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((high * 16 + low) as u8);
                at += 3;
            }
            _ => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uris_are_decoded() {
        assert_eq!(percent_decoded("a%20b%2Fc%"), "a b/c%");
        let nowhere = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        assert_eq!(fetch("x", "data:application/octet-stream;base64,AAEC", &nowhere).unwrap(), [0, 1, 2]);
        let error = fetch("image 3", "wood%20floor.png", &nowhere).unwrap_err();
        assert!(error.to_string().starts_with("image 3 ('wood floor.png'): "), "{error}");
    }
}
