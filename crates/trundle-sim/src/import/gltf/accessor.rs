//! glTF accessors: vectors and indices out of buffers.

use super::buffers::{Buffers, require_length};
use super::schema::at;
use crate::import::ImportFault;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Index, buffer};
use trundle_core::Invalid;

/// Largest number of elements of an accessor. A file with more elements counts as broken. Source: ours.
const MAX_ELEMENTS: u64 = 100_000_000;

/// Elements in a buffer: `parts` components each, `stride` bytes apart.
struct Elements<'a> {
    bytes: &'a [u8],
    component: ComponentType,
    parts: usize,
    stride: usize,
}

/// The `N`-vectors of an accessor, normalised if so marked; all finite.
pub(super) fn vectors<const N: usize>(
    buffers: &Buffers<'_>,
    index: Index<Accessor>,
) -> Result<Vec<[f32; N]>, ImportFault> {
    let accessor = at(&buffers.root().accessors, index, "accessors")?;
    let component = component_of(accessor, index)?;
    let parts = match accessor.type_ {
        Checked::Valid(kind) if parts_of(kind) == N => N,
        _ => return Err(wrong(index, "has another shape", format!("vectors of {N}"))),
    };
    let mut values = vec![[0.0; N]; count_of(accessor, index)?];
    if let Some(view) = accessor.buffer_view {
        let offset = accessor.byte_offset.unwrap_or_default().0;
        let elements = Elements::new(buffers, (view, offset), component, parts, values.len(), index)?;
        for (i, value) in values.iter_mut().enumerate() {
            *value = elements.vector(i, accessor.normalized);
        }
    }
    patch(buffers, accessor, index, &mut values)?;
    match values.iter().position(|value| value.iter().any(|x| !x.is_finite())) {
        Some(i) => Err(wrong(index, format!("{:?} at element {i}", values[i]), "finite numbers".into())),
        None => Ok(values),
    }
}

/// The whole numbers of an accessor.
pub(super) fn indices(buffers: &Buffers<'_>, index: Index<Accessor>) -> Result<Vec<u32>, ImportFault> {
    let accessor = at(&buffers.root().accessors, index, "accessors")?;
    let component = component_of(accessor, index)?;
    let unsigned = matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
    let is_scalar = matches!(accessor.type_, Checked::Valid(Type::Scalar));
    let (true, true, Some(view), None) = (unsigned, is_scalar, accessor.buffer_view, &accessor.sparse) else {
        return Err(wrong(index, "used as indices", "unsigned scalars in a buffer".into()));
    };
    let count = count_of(accessor, index)?;
    let offset = accessor.byte_offset.unwrap_or_default().0;
    let elements = Elements::new(buffers, (view, offset), component, 1, count, index)?;
    Ok((0..count).map(|i| elements.whole(i)).collect())
}

/// Replaces the elements listed by a sparse accessor.
fn patch<const N: usize>(
    buffers: &Buffers<'_>,
    accessor: &Accessor,
    index: Index<Accessor>,
    values: &mut [[f32; N]],
) -> Result<(), ImportFault> {
    let Some(sparse) = &accessor.sparse else { return Ok(()) };
    let count = sparse.count.0.min(values.len() as u64) as usize;
    let Checked::Valid(places) = &sparse.indices.component_type else { return Ok(()) };
    let from = (sparse.indices.buffer_view, sparse.indices.byte_offset.0);
    let places = Elements::new(buffers, from, places.0, 1, count, index)?;
    let from = (sparse.values.buffer_view, sparse.values.byte_offset.0);
    let patches = Elements::new(buffers, from, component_of(accessor, index)?, N, count, index)?;
    for i in 0..count {
        let place = places.whole(i) as usize;
        let expected = format!("below {}", values.len());
        let value =
            values.get_mut(place).ok_or_else(|| wrong(index, format!("patched at {place}"), expected))?;
        *value = patches.vector(i, accessor.normalized);
    }
    Ok(())
}

impl<'a> Elements<'a> {
    fn new(
        buffers: &'a Buffers<'_>,
        (view, offset): (Index<buffer::View>, u64),
        component: ComponentType,
        parts: usize,
        count: usize,
        accessor: Index<Accessor>,
    ) -> Result<Self, ImportFault> {
        let bytes = buffers.view(view)?;
        let size = component.size() * parts;
        let stride = at(&buffers.root().buffer_views, view, "bufferViews")?
            .byte_stride
            .map_or(size, |stride| stride.0.max(size));
        let needed = offset.saturating_add((count.max(1) - 1) as u64 * stride as u64 + size as u64);
        require_length(&format!("bufferView {view} under accessor {accessor}"), bytes.len(), needed)?;
        Ok(Self { bytes: &bytes[offset as usize..], component, parts, stride })
    }

    /// The bytes of component `part` of element `i`, padded with zeros.
    fn component(&self, i: usize, part: usize) -> [u8; 4] {
        let size = self.component.size();
        let at = i * self.stride + part * size;
        let mut word = [0; 4];
        word[..size].copy_from_slice(&self.bytes[at..at + size]);
        word
    }

    fn whole(&self, i: usize) -> u32 {
        u32::from_le_bytes(self.component(i, 0))
    }

    fn vector<const N: usize>(&self, i: usize, normalized: bool) -> [f32; N] {
        debug_assert_eq!(self.parts, N);
        std::array::from_fn(|part| {
            let word = self.component(i, part);
            let (value, max) = match self.component {
                ComponentType::I8 => (f32::from(word[0] as i8), 127.0),
                ComponentType::U8 => (f32::from(word[0]), 255.0),
                ComponentType::I16 => (f32::from(i16::from_le_bytes([word[0], word[1]])), 32767.0),
                ComponentType::U16 => (f32::from(u16::from_le_bytes([word[0], word[1]])), 65535.0),
                ComponentType::U32 => (u32::from_le_bytes(word) as f32, u32::MAX as f32),
                ComponentType::F32 => return f32::from_le_bytes(word),
            };
            if normalized { (value / max).max(-1.0) } else { value }
        })
    }
}

fn component_of(accessor: &Accessor, index: Index<Accessor>) -> Result<ComponentType, ImportFault> {
    match &accessor.component_type {
        Checked::Valid(component) => Ok(component.0),
        Checked::Invalid => Err(wrong(index, "of unknown numbers", "a component type of glTF 2.0".into())),
    }
}

fn count_of(accessor: &Accessor, index: Index<Accessor>) -> Result<usize, ImportFault> {
    let count = accessor.count.0;
    if count > MAX_ELEMENTS {
        return Err(wrong(index, format!("{count} elements long"), format!("at most {MAX_ELEMENTS}")));
    }
    Ok(count as usize)
}

fn parts_of(kind: Type) -> usize {
    match kind {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    }
}

fn wrong(index: Index<Accessor>, value: impl ToString, expected: String) -> ImportFault {
    Invalid::new(format!("accessor {index}"), value, "", expected).into()
}
