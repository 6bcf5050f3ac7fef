//! Bytes of the stored scans.

use super::{
    bytes::{Reader, Writer},
    error::FilterFileError,
};
use crate::loop_closing::stored_scan::{PackedRay, PackedSpan, StoredScan};

/// Writes a stored scan: origin of the beams, beams, their sigmas and free spans.
pub(crate) fn write(out: &mut Writer, scan: &StoredScan) {
    out.u32(scan.origin.0.to_bits());
    out.u32(scan.origin.1.to_bits());
    out.count(scan.rays.len());
    for &PackedRay { x, y, what } in &scan.rays {
        out.u16(x as u16);
        out.u16(y as u16);
        out.u8(what);
    }
    out.count(scan.sigmas.len());
    out.0.extend(&scan.sigmas);
    out.count(scan.spans.len());
    for span in &scan.spans {
        out.u32(span.ray);
        out.u16(span.from);
        out.u16(span.to);
    }
}

pub(crate) fn read(bytes: &mut Reader<'_>) -> Result<StoredScan, FilterFileError> {
    let origin = (f32::from_bits(bytes.u32()?), f32::from_bits(bytes.u32()?));
    bytes.require(origin.0.is_finite() && origin.1.is_finite(), "the origin of a scan")?;
    let mut rays = Vec::new();
    for _ in 0..bytes.count(5)? {
        rays.push(PackedRay { x: bytes.u16()? as i16, y: bytes.u16()? as i16, what: bytes.u8()? });
    }
    let mut sigmas = Vec::new();
    for _ in 0..bytes.count(1)? {
        sigmas.push(bytes.u8()?);
    }
    bytes.require(sigmas.is_empty() || sigmas.len() == rays.len(), "the sigmas of a scan")?;
    let mut spans: Vec<PackedSpan> = Vec::new();
    for _ in 0..bytes.count(8)? {
        let ray = bytes.index(rays.len(), "the ray of a free stretch")? as u32;
        let rises = spans.last().is_none_or(|last| last.ray <= ray);
        bytes.require(rises, "the ray of a free stretch")?;
        spans.push(PackedSpan { ray, from: bytes.u16()?, to: bytes.u16()? });
    }
    Ok(StoredScan { origin, rays: rays.into(), sigmas: sigmas.into(), spans: spans.into() })
}

#[cfg(test)]
mod tests;
