//! Records of ROS 1 bags: named fields, and data.

/// A record of a ROS 1 bag.
#[derive(Debug)]
pub(super) struct Ros1Record<'a> {
    fields: Vec<(&'a [u8], &'a [u8])>,
    pub(super) data: &'a [u8],
}

impl<'a> Ros1Record<'a> {
    /// The record at `at`, and the start of the next one.
    pub(super) fn parse(bytes: &'a [u8], at: usize) -> Result<(Self, usize), String> {
        let (header, at) = part(bytes, at)?;
        let (data, at) = part(bytes, at)?;
        Ok((Self::of_parts(header, data)?, at))
    }

    /// The record of a header, a list of `name=value` each with its length, and its data.
    pub(super) fn of_parts(header: &'a [u8], data: &'a [u8]) -> Result<Self, String> {
        let (mut fields, mut at) = (Vec::new(), 0);
        while at < header.len() {
            let (field, next) = part(header, at)?;
            let split = field.iter().position(|byte| *byte == b'=');
            let split = split.ok_or("a record is broken: one of its fields has no name")?;
            fields.push((&field[..split], &field[split + 1..]));
            at = next;
        }
        Ok(Self { fields, data })
    }

    /// The kind of the record.
    pub(super) fn kind(&self) -> Option<u8> {
        self.field("op")?.first().copied()
    }

    pub(super) fn number(&self, name: &str) -> Result<u32, String> {
        let bytes = self.field(name).and_then(|bytes| bytes.try_into().ok());
        bytes.map(u32::from_le_bytes).ok_or_else(|| missing(name, "a number of four bytes"))
    }

    pub(super) fn text(&self, name: &str) -> Result<String, String> {
        let bytes = self.field(name).ok_or_else(|| missing(name, "a text"))?;
        Ok(String::from_utf8_lossy(bytes).into_owned())
    }

    fn field(&self, name: &str) -> Option<&'a [u8]> {
        self.fields.iter().find(|(own, _)| *own == name.as_bytes()).map(|(_, value)| *value)
    }
}

fn missing(name: &str, expected: &str) -> String {
    format!("a record is broken: field '{name}' is missing, expected {expected}")
}

/// The bytes after a length, and their end.
fn part(bytes: &[u8], at: usize) -> Result<(&[u8], usize), String> {
    let rest = bytes.get(at..).unwrap_or_default();
    let (length, rest) = rest.split_first_chunk::<4>().ok_or("a record is broken: it ends in a length")?;
    let length = u32::from_le_bytes(*length) as usize;
    let part = rest.get(..length).ok_or_else(|| {
        format!("a record is broken: {length} bytes announced at byte {at}, {} left", rest.len())
    })?;
    Ok((part, at + 4 + length))
}
