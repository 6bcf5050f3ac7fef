//! Filters that last: saved as bytes, loaded with every number checked.
//!
//! | bytes | |
//! |---|---|
//! | 7 | `trundlF` |
//! | 1 | version |
//! | 8 | checksum of the rest (FNV-1a by words of 8 bytes) |
//! | 5 x 8 | cell size and sensor model, f64 |
//! | | filter, particles, tiles (each once, runs packed), ancestry, history |
//!
//! All little endian.

mod bytes;
mod error;
mod tiles;

use super::{
    ParticleConfig, ParticleMapper, ancestry::Ancestry, gate::Last, graph::Tie, history::History,
    mapper::Particle, store::StoredScan,
};
use crate::tiles::{Pools, assemble};
use bytes::{Reader, Writer, checksum};
pub use error::FilterFileError;
use trundle_core::Stamp;

const MAGIC: &[u8; 7] = b"trundlF";
const VERSION: u8 = 1;
/// Bytes before those that the checksum is of.
const HEAD: usize = 16;

/// What a map must have been made with to be gone on with.
fn settings(config: &ParticleConfig) -> [(&'static str, f64); 5] {
    let map = &config.map;
    [
        ("map.resolution", map.resolution),
        ("map.hit", map.hit),
        ("map.free", map.free),
        ("map.clamp_high", map.clamp_high),
        ("map.clamp_low", map.clamp_low),
    ]
}

impl ParticleMapper {
    /// The whole filter as bytes: versioned, with a checksum. The same filter gives the same bytes, before and after
    /// [`ParticleMapper::load`].
    pub fn save(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.0.extend(MAGIC);
        out.u8(VERSION);
        out.u64(0);
        settings(&self.config).iter().for_each(|(_, value)| out.f64(*value));
        out.u64(self.seed);
        out.u64(self.updates);
        out.f64(self.usual);
        out.f64(self.closer.looked_at);
        out.count(self.session);
        let last = self.gate.last.unwrap_or_default();
        out.u8(u8::from(self.gate.last.is_some()));
        out.u64(last.stamp.nanos as u64);
        out.pose(last.odom_from_base);
        out.count(self.particles.len());
        for (particle, parent) in self.particles.iter().zip(&self.parents) {
            out.pose(particle.pose);
            out.f64(particle.log_weight);
            out.u16(*parent);
        }
        tiles::write(&mut out, &Pools::new(self.particles.iter().map(|p| &p.map)));
        write_ancestry(&mut out, &self.ancestry);
        write_history(&mut out, &self.history, &self.closer.pending);
        let mut bytes = out.0;
        let sum = checksum(&bytes[HEAD..]);
        bytes[HEAD - 8..HEAD].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// Goes on with a saved filter: the next scans are taken in as if it had never stopped. For another run, with odometry of
    /// its own, tell it so by [`ParticleMapper::kidnapped`].
    ///
    /// # Errors
    /// When the configuration is out of range, or the bytes are no filter, of another version, damaged, cut off, made with
    /// other cells or another sensor model, or contradict themselves. No bytes make it panic.
    pub fn load(bytes: &[u8], config: ParticleConfig) -> Result<Self, FilterFileError> {
        let mut body = checked_body(bytes)?;
        let mut mapper = Self::new(config, 0)?;
        for (name, given) in settings(&mapper.config) {
            let saved = body.f64(name)?;
            if saved != given {
                return Err(FilterFileError::Mismatch { name, saved, given });
            }
        }
        body.within = "particles";
        mapper.seed = body.u64()?;
        mapper.updates = body.u64()?;
        mapper.usual = body.f64("the usual likelihood")?;
        mapper.closer.looked_at = body.f64("the way")?;
        mapper.session = body.u32()? as usize;
        let known = body.u8()? == 1;
        let last = Last {
            stamp: Stamp::from_nanos(body.u64()? as i64),
            odom_from_base: body.pose("the last odometry")?,
        };
        mapper.gate.last = known.then_some(last);
        let count = body.count(34)?;
        body.require((1..=1000).contains(&count), "the number of particles")?;
        let mut states = Vec::new();
        for _ in 0..count {
            let state =
                (body.pose("the pose of a particle")?, body.f64("the weight of a particle")?, body.u16()?);
            body.require(usize::from(state.2) < count, "the parent of a particle")?;
            states.push(state);
        }
        let mut pools = tiles::read(&mut body)?;
        body.require(pools.maps.len() == count, "the number of maps")?;
        pools.tiles.iter_mut().for_each(|tile| mapper.brush.field.fill_coarse(tile));
        let maps = assemble(pools.tiles, &pools.chunks, &pools.maps);
        mapper.ancestry = read_ancestry(&mut body, count)?;
        let length = mapper.ancestry.len();
        (mapper.history, mapper.closer.pending) = read_history(&mut body, length)?;
        body.require(mapper.session <= length, "the beginning of the run")?;
        body.end()?;
        let wanted = mapper.particles.len();
        let particle = |i: usize| Particle {
            pose: states[i % count].0,
            log_weight: states[i % count].1,
            map: maps[i % count].clone(),
            proposal: None,
        };
        mapper.particles = (0..wanted).map(particle).collect();
        mapper.parents = (0..wanted).map(|i| states[i % count].2).collect();
        Ok(mapper)
    }
}

fn checked_body(bytes: &[u8]) -> Result<Reader<'_>, FilterFileError> {
    let Some((_, rest)) = bytes.split_first_chunk::<7>().filter(|(magic, _)| *magic == MAGIC) else {
        return Err(FilterFileError::Foreign);
    };
    let Some((&found, rest)) = rest.split_first() else { return Err(FilterFileError::Foreign) };
    if found != VERSION {
        return Err(FilterFileError::Version { found, expected: VERSION });
    }
    let Some((sum, body)) = rest.split_first_chunk::<8>() else {
        return Err(FilterFileError::Cut { within: "head" });
    };
    if u64::from_le_bytes(*sum) != checksum(body) {
        return Err(FilterFileError::Checksum);
    }
    Ok(Reader::new(body, "settings"))
}

fn write_ancestry(out: &mut Writer, ancestry: &Ancestry) {
    out.count(ancestry.shared.len());
    for (stamp, pose) in &ancestry.shared {
        out.u64(stamp.nanos as u64);
        out.pose(*pose);
    }
    out.count(ancestry.columns.len());
    for column in &ancestry.columns {
        out.u64(column.stamp.nanos as u64);
        out.count(column.poses.len());
        for (pose, parent) in column.poses.iter().zip(&column.parents) {
            out.pose(*pose);
            out.u16(*parent);
        }
    }
}

fn read_ancestry(bytes: &mut Reader<'_>, particles: usize) -> Result<Ancestry, FilterFileError> {
    bytes.within = "trajectories";
    let mut ancestry = Ancestry::default();
    for _ in 0..bytes.count(32)? {
        let stamp = Stamp::from_nanos(bytes.u64()? as i64);
        ancestry.shared.push((stamp, bytes.pose("a pose of the trajectory")?));
    }
    for _ in 0..bytes.count(12)? {
        let stamp = Stamp::from_nanos(bytes.u64()? as i64);
        let count = bytes.count(26)?;
        bytes.require(count == particles, "the number of poses at a time")?;
        let (mut poses, mut parents) = (Vec::new(), Vec::new());
        for _ in 0..count {
            poses.push(bytes.pose("a pose of the trajectory")?);
            parents.push(bytes.u16()?);
        }
        bytes.require(parents.iter().all(|p| usize::from(*p) < count), "the parent of a pose")?;
        ancestry.push_column(stamp, poses, parents);
    }
    Ok(ancestry)
}

fn write_history(out: &mut Writer, history: &History, pending: &[Tie]) {
    out.count(history.scans.len());
    for (scan, step) in history.scans.iter().zip(&history.steps) {
        out.u32(scan.origin.0.to_bits());
        out.u32(scan.origin.1.to_bits());
        out.matrix(step);
        out.count(scan.raw().count());
        for (x, y, what) in scan.raw() {
            out.u16(x as u16);
            out.u16(y as u16);
            out.u8(what);
        }
    }
    out.count(history.measured.len());
    history.measured.iter().for_each(|pose| out.pose(*pose));
    for ties in [&history.loops[..], pending] {
        out.count(ties.len());
        for tie in ties {
            out.u32(tie.from);
            out.u32(tie.to);
            out.pose(tie.from_to);
            out.matrix(&tie.covariance);
        }
    }
}

fn read_history(bytes: &mut Reader<'_>, poses: usize) -> Result<(History, Vec<Tie>), FilterFileError> {
    bytes.within = "scans";
    let mut history = History::default();
    let count = bytes.count(84)?;
    bytes.require(count == poses, "the number of scans")?;
    for _ in 0..count {
        let origin = (f32::from_bits(bytes.u32()?), f32::from_bits(bytes.u32()?));
        bytes.require(origin.0.is_finite() && origin.1.is_finite(), "the origin of a scan")?;
        let step = bytes.covariance("the covariance of a step")?;
        let mut rays = Vec::new();
        for _ in 0..bytes.count(5)? {
            rays.push((bytes.u16()? as i16, bytes.u16()? as i16, bytes.u8()?));
        }
        history.push(StoredScan::from_raw(origin, rays.into_iter()), step);
    }
    bytes.within = "loops";
    let measured = bytes.count(24)?;
    bytes.require(measured <= poses, "the number of steps")?;
    for _ in 0..measured {
        history.measured.push(bytes.pose("a step")?);
    }
    let loops = read_ties(bytes, poses)?;
    history.loops = loops;
    Ok((history, read_ties(bytes, poses)?))
}

fn read_ties(bytes: &mut Reader<'_>, poses: usize) -> Result<Vec<Tie>, FilterFileError> {
    let mut ties = Vec::new();
    for _ in 0..bytes.count(104)? {
        let from = bytes.index(poses, "the first pose of a loop")? as u32;
        let to = bytes.index(poses, "the second pose of a loop")? as u32;
        bytes.require(from != to, "the poses of a loop")?;
        let from_to = bytes.pose("a loop")?;
        ties.push(Tie { from, to, from_to, covariance: bytes.covariance("the covariance of a loop")? });
    }
    Ok(ties)
}
