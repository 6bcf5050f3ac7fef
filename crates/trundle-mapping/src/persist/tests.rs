//! Saved filters: the loaded state, and refused files.

use super::bytes::{Reader, Writer};
use super::*;
use nalgebra::Matrix3;
use proptest::prelude::*;
use trundle_core::{Beam, FreeSpan, Pose2, Scan, ScanParts, Vector2};

/// Scan of a corner of walls, some beams with gaps.
fn scan(k: usize) -> Scan {
    let beam = |i: usize| match i % 5 {
        0 => Beam::Unseen,
        1 => Beam::Free { range: 2.5 },
        _ => Beam::Hit { range: 2.0 + 0.1 * (i as f64 * 0.7).sin() + 0.02 * k as f64 },
    };
    let spans = (0..24).filter(|i| i % 5 == 2).map(|beam| FreeSpan { beam, from: 0.5, to: 1.5 });
    let parts = ScanParts {
        beams: (0..24).map(beam).collect(),
        free: k.is_multiple_of(2).then(|| spans.collect()),
        sigmas: vec![0.02; 24],
        ..ScanParts::default()
    };
    let stamp = Stamp::from_nanos(k as i64 * 1_000_000_000);
    Scan::from_parts(stamp, Vector2::new(0.1, 0.0), (-0.6, 0.05), parts).unwrap()
}

fn config() -> ParticleConfig {
    ParticleConfig { particles: 2, ..ParticleConfig::default() }
}

/// A filter of two particles after three scans.
fn filter() -> ParticleMapper {
    let mut mapper = ParticleMapper::new(config(), 4).unwrap();
    for k in 0..3 {
        mapper.update(Pose2::new(0.4 * k as f64, 0.02, 0.1), &scan(k));
    }
    mapper
}

/// The bytes with the checksum of their body.
fn signed(mut bytes: Vec<u8>) -> Vec<u8> {
    if bytes.len() >= HEADER_BYTES {
        let sum = checksum(&bytes[HEADER_BYTES..]);
        bytes[HEADER_BYTES - 8..HEADER_BYTES].copy_from_slice(&sum.to_le_bytes());
    }
    bytes
}

#[test]
fn a_saved_filter_comes_back_byte_for_byte() {
    let mapper = filter();
    let bytes = mapper.save();
    let loaded = ParticleMapper::load(&bytes, config()).unwrap();
    assert_eq!(loaded.save(), bytes);
    assert_eq!(loaded.trajectory(), mapper.trajectory());
    assert_eq!(loaded.pose(), mapper.pose());
    assert_eq!(signed(bytes.clone()), bytes);
}

/// A truncated file is refused at every length, also with a checksum that fits the rest.
#[test]
fn every_truncation_is_an_error() {
    let bytes = filter().save();
    for end in 0..bytes.len() {
        let cut = &bytes[..end];
        assert!(ParticleMapper::load(cut, config()).is_err(), "{end} bytes");
        if end < 700 || end.is_multiple_of(13) || end + 700 > bytes.len() {
            assert!(ParticleMapper::load(&signed(cut.to_vec()), config()).is_err(), "{end} bytes, signed");
        }
    }
    let mut longer = bytes;
    longer.push(0);
    let error = ParticleMapper::load(&signed(longer), config()).unwrap_err();
    assert!(matches!(error, FilterFileError::Content { .. }), "{error}");
}

/// A wrong number with a correct checksum is refused or read, without a panic. A filter that was read can be saved and used.
#[test]
fn no_changed_byte_makes_loading_panic() {
    let bytes = filter().save();
    let mut refused = 0;
    for at in
        (HEADER_BYTES..bytes.len()).filter(|at| *at < 900 || at.is_multiple_of(17) || at + 900 > bytes.len())
    {
        for flip in [1_u8, 0x80] {
            let mut changed = bytes.clone();
            changed[at] ^= flip;
            match ParticleMapper::load(&signed(changed), config()) {
                Ok(mut mapper) if at.is_multiple_of(10) => {
                    mapper.grid();
                    mapper.save();
                }
                Ok(_) => {}
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 50, "{refused} refused");
}

proptest! {
    #[test]
    fn numbers_come_back_in_the_order_they_were_written(
        a: u8, b: u16, c: u32, d: u64, e in -1e9..1e9_f64, pose in prop::array::uniform3(-100.0..100.0_f64),
    ) {
        let pose = Pose2 { x: pose[0], y: pose[1], theta: pose[2] };
        let mut out = Writer::default();
        out.u8(a);
        out.u16(b);
        out.u32(c);
        out.u64(d);
        out.f64(e);
        out.pose(pose);
        out.matrix(&Matrix3::identity());
        let mut bytes = Reader::new(&out.0, "test");
        prop_assert_eq!((bytes.u8().unwrap(), bytes.u16().unwrap()), (a, b));
        prop_assert_eq!((bytes.u32().unwrap(), bytes.u64().unwrap()), (c, d));
        prop_assert_eq!(bytes.f64("e").unwrap(), e);
        prop_assert_eq!(bytes.pose("pose").unwrap(), pose);
        prop_assert!(bytes.end().is_err(), "the matrix is left");
        prop_assert_eq!(bytes.covariance("matrix").unwrap(), Matrix3::identity());
        prop_assert!(bytes.end().is_ok());
        prop_assert_eq!(bytes.u8().unwrap_err(), FilterFileError::Cut { within: "test" });
    }

    #[test]
    fn one_flipped_bit_changes_the_checksum(bytes in prop::collection::vec(any::<u8>(), 1..200), at: prop::sample::Index, bit in 0..8_u32) {
        let mut other = bytes.clone();
        other[at.index(bytes.len())] ^= 1 << bit;
        prop_assert_ne!(checksum(&bytes), checksum(&other));
        let mut longer = bytes.clone();
        longer.push(0);
        prop_assert_ne!(checksum(&bytes), checksum(&longer));
    }
}

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    let mut out = Writer::default();
    out.f64(f64::NAN);
    out.f64(1e10);
    out.count(5);
    out.u32(7);
    let mut bytes = Reader::new(&out.0, "test");
    assert_eq!(bytes.f64("a pose").unwrap_err(), FilterFileError::Content { what: "a pose" });
    assert_eq!(bytes.f64("a weight").unwrap_err(), FilterFileError::Content { what: "a weight" });
    assert_eq!(bytes.count(2).unwrap_err(), FilterFileError::Cut { within: "test" });
    assert_eq!(bytes.index(7, "a tile").unwrap_err(), FilterFileError::Content { what: "a tile" });
    let mut out = Writer::default();
    out.matrix(&(-Matrix3::identity()));
    let error = Reader::new(&out.0, "test").covariance("a step").unwrap_err();
    assert_eq!(error, FilterFileError::Content { what: "a step" });
}

#[test]
fn fewer_particles_are_the_heaviest_and_more_are_all_in_turn() {
    let log_weights = [-3.0, 0.0, -1.0, -9.0, -2.0];
    assert_eq!(chosen(&log_weights, 3), [1, 2, 4]);
    assert_eq!(chosen(&log_weights, 1), [1]);
    assert_eq!(chosen(&log_weights, 5), [0, 1, 2, 3, 4]);
    assert_eq!(chosen(&log_weights, 7), [0, 1, 2, 3, 4, 0, 1]);
}

/// The error of a truncated file names the part in which the file ends: parts follow each other in the order of the file.
#[test]
fn a_truncation_is_reported_in_the_part_where_it_is() {
    let bytes = filter().save();
    let mut parts: Vec<&str> = Vec::new();
    for end in HEADER_BYTES..bytes.len() {
        if let Err(FilterFileError::Cut { within }) =
            ParticleMapper::load(&signed(bytes[..end].to_vec()), config())
            && parts.last() != Some(&within)
        {
            parts.push(within);
        }
    }
    assert_eq!(parts, ["settings", "particles", "tiles", "trajectories", "scans", "loops"]);
}
