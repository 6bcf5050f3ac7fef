//! Saved filters: written as bytes, loaded with a check of every number.
//!
//! | bytes | |
//! |---|---|
//! | 7 | `trundlF` |
//! | 1 | version |
//! | 8 | checksum of the rest (FNV-1a by words of 8 bytes) |
//! | 5 x 8 | cell size and sensor model, f64 |
//! | | filter, particles, tiles (each once, runs packed), ancestry, history |
//!
//! All numbers are little endian.

mod bytes;
mod error;
mod scans;
mod tiles;

use crate::loop_closing::scan_history::ScanHistory;
use crate::particle_config::ParticleConfig;
use crate::pose_graph::Constraint;
use crate::rbpf::ancestry::Ancestry;
use crate::rbpf::map_redraw::MapRedraw;
use crate::rbpf::mapper::ParticleMapper;
use crate::rbpf::odometry_bias::OdometryBias;
use crate::rbpf::odometry_noise::OdometryNoise;
use crate::rbpf::particle_set::Particle;
use crate::rbpf::update_gate::LastScan;
use bytes::{Reader, Writer, checksum};
pub use error::FilterFileError;
use trundle_core::Stamp;
use trundle_grid::tiles::{TileMap, TilePools, assemble};

/// First bytes of the file. Source: ours.
const MAGIC: &[u8; 7] = b"trundlF";
/// Version of the file's layout. Other versions are refused. Source: ours.
const FORMAT_VERSION: u8 = 4;
/// Number of bytes before those covered by the checksum.
const HEADER_BYTES: usize = 16;

/// Settings that must be equal in file and configuration.
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
        out.u8(FORMAT_VERSION);
        out.u64(0);
        settings(&self.models.config).iter().for_each(|(_, value)| out.f64(*value));
        out.u64(self.seed);
        out.u64(self.updates);
        out.f64(self.expected_log_likelihood);
        self.odometry
            .noise
            .numbers()
            .into_iter()
            .chain(self.odometry.bias.numbers())
            .for_each(|v| out.f64(v));
        out.f64(self.loops.loop_closer.driven);
        out.count(self.set.first_pose_of_run);
        let last = self.gate.last.unwrap_or_default();
        out.u8(u8::from(self.gate.last.is_some()));
        out.u64(last.stamp.nanos as u64);
        out.pose(last.odom_from_base);
        out.u8(u8::from(self.odometry.map_from_odom.is_some()));
        out.pose(self.odometry.map_from_odom.unwrap_or_default());
        out.count(self.set.particles.len());
        for (particle, parent) in self.set.particles.iter().zip(&self.set.parents) {
            out.pose(particle.pose);
            out.f64(particle.log_weight);
            out.u16(*parent);
        }
        let redraw = self.loops.redraw.iter().map(|redraw| &redraw.map);
        tiles::write(&mut out, &TilePools::new(self.set.particles.iter().map(|p| &p.map).chain(redraw)));
        write_ancestry(&mut out, &self.set.ancestry);
        write_history(&mut out, &self.loops.history, &self.loops.loop_closer.pending);
        write_redraw(&mut out, self.loops.redraw.as_ref());
        let mut bytes = out.0;
        let sum = checksum(&bytes[HEADER_BYTES..]);
        bytes[HEADER_BYTES - 8..HEADER_BYTES].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// Restores a saved filter, which continues with the next scan. For a new run, with another origin of the odometry, call
    /// [`ParticleMapper::kidnapped`] after loading.
    ///
    /// # Errors
    /// When the configuration is out of range, or the bytes are not a filter, of another version, damaged, cut off, made with other cells
    /// or another sensor model, or inconsistent. No input causes a panic.
    pub fn load(bytes: &[u8], config: ParticleConfig) -> Result<Self, FilterFileError> {
        let mut body = checked_body(bytes)?;
        let mut mapper = Self::new(config, 0)?;
        for (name, given) in settings(&mapper.models.config) {
            let saved = body.f64(name)?;
            if saved != given {
                return Err(FilterFileError::Mismatch { name, saved, given });
            }
        }
        body.within = "particles";
        mapper.seed = body.u64()?;
        mapper.updates = body.u64()?;
        mapper.expected_log_likelihood = body.f64("the expected log-likelihood")?;
        let trust = [(); 6].map(|()| body.f64("state of the odometry"));
        let [a, b, c, d, e, f] = trust;
        mapper.odometry.noise = OdometryNoise::from_numbers([a?, b?, c?, d?, e?, f?]);
        let bias = [(); 7].map(|()| body.f64("bias of the odometry"));
        let [a, b, c, d, e, f, g] = bias;
        mapper.odometry.bias = OdometryBias::from_numbers([a?, b?, c?, d?, e?, f?, g?]);
        mapper.loops.loop_closer.driven = body.f64("the distance since the last search for loops")?;
        mapper.set.first_pose_of_run = body.u32()? as usize;
        let known = body.u8()? == 1;
        let last = LastScan {
            stamp: Stamp::from_nanos(body.u64()? as i64),
            odom_from_base: body.pose("the last odometry")?,
        };
        mapper.gate.last = known.then_some(last);
        let known = body.u8()? == 1;
        let map_from_odom = body.pose("where the odometry begins")?;
        mapper.odometry.map_from_odom = known.then_some(map_from_odom);
        let count = body.count(34)?;
        body.require((1..=1000).contains(&count), "the number of particles")?;
        let mut states = Vec::new();
        for _ in 0..count {
            let state =
                (body.pose("the pose of a particle")?, body.f64("the weight of a particle")?, body.u16()?);
            states.push(state);
        }
        let mut pools = tiles::read(&mut body)?;
        body.require((count..=count + 1).contains(&pools.maps.len()), "the number of maps")?;
        pools.tiles.iter_mut().for_each(|tile| mapper.models.ray_update.nearest.fill_coarse(tile));
        let mut maps = assemble(pools.tiles, &pools.chunks, &pools.maps);
        let bent_map = if maps.len() > count { maps.pop() } else { None };
        mapper.set.ancestry = read_ancestry(&mut body)?;
        let column = mapper.set.ancestry.columns.last().map_or(usize::MAX, |column| column.poses.len());
        body.require(states.iter().all(|s| usize::from(s.2) < column), "the parent of a particle")?;
        let length = mapper.set.ancestry.len();
        (mapper.loops.history, mapper.loops.loop_closer.pending) = read_history(&mut body, length)?;
        body.require(mapper.set.first_pose_of_run <= length, "the beginning of the run")?;
        if let Some(map) = bent_map {
            mapper.loops.redraw = Some(read_redraw(&mut body, length, map)?);
        }
        body.end()?;
        let log_weights: Vec<f64> = states.iter().map(|state| state.1).collect();
        let chosen = chosen(&log_weights, mapper.set.particles.len());
        let particle = |&i: &usize| Particle {
            pose: states[i].0,
            log_weight: states[i].1,
            map: maps[i].clone(),
            proposal: None,
        };
        mapper.set.particles = chosen.iter().map(particle).collect();
        mapper.set.parents = chosen.iter().map(|&i| states[i].2).collect();
        Ok(mapper)
    }
}

/// Indices of the saved particles to load. For a smaller number, the ones with the largest weights in their order; for a larger one, all of
/// them cyclically.
fn chosen(log_weights: &[f64], wanted: usize) -> Vec<usize> {
    let count = log_weights.len();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| log_weights[b].total_cmp(&log_weights[a]));
    order.truncate(wanted);
    order.sort_unstable();
    (0..wanted).map(|i| order[i % order.len()]).collect()
}

fn checked_body(bytes: &[u8]) -> Result<Reader<'_>, FilterFileError> {
    let Some((_, rest)) = bytes.split_first_chunk::<7>().filter(|(magic, _)| *magic == MAGIC) else {
        return Err(FilterFileError::Foreign);
    };
    let Some((&found, rest)) = rest.split_first() else { return Err(FilterFileError::Foreign) };
    if found != FORMAT_VERSION {
        return Err(FilterFileError::Version { found, expected: FORMAT_VERSION });
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

fn read_ancestry(bytes: &mut Reader<'_>) -> Result<Ancestry, FilterFileError> {
    bytes.within = "trajectories";
    let mut ancestry = Ancestry::default();
    for _ in 0..bytes.count(32)? {
        let stamp = Stamp::from_nanos(bytes.u64()? as i64);
        ancestry.shared.push((stamp, bytes.pose("a pose of the trajectory")?));
    }
    for _ in 0..bytes.count(12)? {
        let stamp = Stamp::from_nanos(bytes.u64()? as i64);
        let count = bytes.count(26)?;
        bytes.require((1..=1000).contains(&count), "the number of poses at a time")?;
        let (mut poses, mut parents) = (Vec::new(), Vec::new());
        for _ in 0..count {
            poses.push(bytes.pose("a pose of the trajectory")?);
            parents.push(bytes.u16()?);
        }
        // The number of particles may change between runs.
        let before = ancestry.columns.last().map_or(usize::MAX, |column| column.poses.len());
        bytes.require(parents.iter().all(|p| usize::from(*p) < before), "the parent of a pose")?;
        ancestry.push_column(stamp, poses, parents);
    }
    Ok(ancestry)
}

fn write_history(out: &mut Writer, history: &ScanHistory, pending: &[Constraint]) {
    out.count(history.scans.len());
    for (scan, step) in history.scans.iter().zip(&history.steps) {
        out.matrix(step);
        scans::write(out, scan);
    }
    out.count(history.measured.len());
    history.measured.iter().for_each(|pose| out.pose(*pose));
    for constraints in [&history.loops[..], pending] {
        out.count(constraints.len());
        for constraint in constraints {
            out.u32(constraint.from);
            out.u32(constraint.to);
            out.pose(constraint.from_to);
            out.matrix(&constraint.covariance);
        }
    }
}

fn read_history(
    bytes: &mut Reader<'_>,
    poses: usize,
) -> Result<(ScanHistory, Vec<Constraint>), FilterFileError> {
    bytes.within = "scans";
    let mut history = ScanHistory::default();
    let count = bytes.count(92)?;
    bytes.require(count == poses, "the number of scans")?;
    for _ in 0..count {
        let step = bytes.covariance("the covariance of a step")?;
        history.push(scans::read(bytes)?, step);
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

fn write_redraw(out: &mut Writer, redraw: Option<&MapRedraw>) {
    let Some(redraw) = redraw else { return };
    out.f64(redraw.farthest);
    out.count(redraw.drawn);
    out.count(redraw.poses.len());
    redraw.poses.iter().for_each(|pose| out.pose(*pose));
}

fn read_redraw(bytes: &mut Reader<'_>, poses: usize, map: TileMap) -> Result<MapRedraw, FilterFileError> {
    bytes.within = "corrected trajectory";
    let farthest = bytes.f64("the correction of a loop")?;
    let drawn = bytes.u32()? as usize;
    let count = bytes.count(24)?;
    bytes.require((1..=poses).contains(&count) && drawn <= count, "the number of corrected poses")?;
    let mut redraw = MapRedraw::default();
    (redraw.farthest, redraw.drawn, redraw.map) = (farthest, drawn, map);
    for _ in 0..count {
        redraw.poses.push(bytes.pose("a corrected pose")?);
    }
    Ok(redraw)
}

fn read_ties(bytes: &mut Reader<'_>, poses: usize) -> Result<Vec<Constraint>, FilterFileError> {
    let mut constraints = Vec::new();
    for _ in 0..bytes.count(104)? {
        let from = bytes.index(poses, "the first pose of a loop")? as u32;
        let to = bytes.index(poses, "the second pose of a loop")? as u32;
        bytes.require(from != to, "the poses of a loop")?;
        let from_to = bytes.pose("a loop")?;
        constraints.push(Constraint {
            from,
            to,
            from_to,
            covariance: bytes.covariance("the covariance of a loop")?,
        });
    }
    Ok(constraints)
}

#[cfg(test)]
mod tests;
