//! Saved maps: a saved map is restored exactly, and other files are refused.

use crate::room::{camera, shoot};
use crate::walks::{dark, turned};
use proptest::prelude::*;
use std::sync::LazyLock;
use trundle_core::{PinholeCamera, RgbdImage};
use trundle_slam::{MapFileError, Mode, RgbdSlam, SlamConfig, Tracking};

/// A map of a part of the room.
fn mapped(config: SlamConfig) -> RgbdSlam {
    let mut slam = RgbdSlam::new(camera(), config).unwrap();
    for i in 0..11 {
        assert!(slam.step(&shoot(i, turned(3 * i)), None).tracking.is_located());
    }
    slam
}

fn small() -> SlamConfig {
    let mut config = SlamConfig::default();
    config.orb.features = 150;
    config.mapping.min_points = 20;
    config
}

/// A small map, made once.
static SAVED: LazyLock<Vec<u8>> = LazyLock::new(|| mapped(small()).save());

static VIEWS: LazyLock<[RgbdImage; 2]> = LazyLock::new(|| [shoot(1, turned(5)), shoot(2, turned(14))]);

fn load(bytes: &[u8]) -> Result<RgbdSlam, MapFileError> {
    RgbdSlam::load(bytes, camera(), small())
}

#[test]
fn a_loaded_map_is_identical_and_the_camera_is_relocalized_in_it() {
    let bytes = mapped(SlamConfig::default()).save();
    let mut slam = RgbdSlam::load(&bytes, camera(), SlamConfig::default()).unwrap();
    assert_eq!(slam.save(), bytes);
    let report = slam.step(&dark(100), None);
    assert_eq!(report.tracking, Tracking::Lost);
    assert!(report.covariance.trace() > 1e6, "it may be anywhere");
    assert_eq!(
        slam.step(&shoot(101, turned(18)), None).tracking,
        Tracking::Lost,
        "one image may show a look-alike place"
    );
    let report = slam.step(&shoot(102, turned(21)), None);
    assert!(report.tracking == Tracking::Ok && report.relocalised);
    assert!((turned(21).inverse() * report.visual_from_camera).log().norm() < 0.03);
    let reported = report.covariance.fixed_view::<3, 3>(0, 0).trace().sqrt();
    let mut unsure = SlamConfig::default();
    unsure.tracking.recognised_sigma = reported / 10.0;
    let mut other = RgbdSlam::load(&bytes, camera(), unsure).unwrap();
    for i in 0..4 {
        let report = other.step(&shoot(101 + i, turned(21)), None);
        assert_eq!(report.tracking, Tracking::Lost, "image {i}, {reported} m is too little");
    }
    let keyframes = report.keyframes;
    for i in 1..10 {
        assert!(slam.step(&shoot(102 + i, turned(21 + 3 * i)), None).tracking.is_located(), "{i}");
    }
    assert!(slam.keyframes().count() > keyframes);
    assert_ne!(slam.save(), bytes);
}

#[test]
fn in_a_loaded_map_the_camera_is_lost_until_a_place_is_recognized() {
    let mut slam = load(&SAVED).unwrap();
    for i in 0..5 {
        let report = slam.step(&dark(i), Some(turned(1).into()));
        assert_eq!((report.tracking, report.new_keyframe), (Tracking::Lost, false));
    }
    let mut slam = load(&SAVED).unwrap().starting_at(turned(3));
    assert_eq!(slam.step(&dark(0), None).tracking, Tracking::Lost);
    assert_eq!(slam.step(&dark(1), Some(turned(1).into())).tracking, Tracking::DeadReckoning);
}

#[test]
fn localisation_leaves_every_bit_of_the_map_as_it_is() {
    let mut slam = mapped(SlamConfig::default());
    let bytes = slam.save();
    slam.set_mode(Mode::Localisation);
    let (mut located, mut lost) = (0, 0);
    for i in 10..40 {
        let image = if i % 7 == 0 { dark(i) } else { shoot(i, turned(2 * i)) };
        let report = slam.step(&image, (i % 3 > 0).then(|| turned(2).into()));
        assert!(!report.new_keyframe && report.merged.is_none());
        located += usize::from(report.tracking.is_located());
        lost += usize::from(!report.tracking.is_located());
    }
    assert!(located >= 10 && lost >= 3, "{located} located, {lost} lost");
    assert_eq!(slam.save(), bytes);
}

#[test]
fn a_map_of_other_settings_is_refused_by_name() {
    let refused = |camera: PinholeCamera, change: &dyn Fn(&mut SlamConfig)| {
        let mut config = small();
        change(&mut config);
        RgbdSlam::load(&SAVED, camera, config).unwrap_err().to_string()
    };
    let wide = PinholeCamera::from_field_of_view((320, 240), (1.4, 1.0)).unwrap();
    assert!(refused(wide, &|_| ()).starts_with("the map was made with camera fx (px) 237"));
    let levels = refused(camera(), &|config| config.orb.levels = 5);
    assert_eq!(levels, "the map was made with orb.levels 8, not 5");
    assert_eq!(refused(camera(), &|c| c.depth.sigma = -1.0), "depth.sigma is -1 m, expected 0.000001 to 1");
}

#[test]
fn bytes_that_are_not_a_map_are_refused_with_the_reason() {
    let refused = |bytes: &[u8]| load(bytes).unwrap_err().to_string();
    assert_eq!(refused(b""), "this is not a visual map of trundle (visual.map)");
    assert_eq!(refused(b"ply\nformat ascii 1.0"), "this is not a visual map of trundle (visual.map)");
    assert_eq!(refused(&SAVED[..12]), "the map is cut off in its head");
    assert_eq!(refused(&SAVED[..SAVED.len() - 1]), "the map is damaged: its checksum is wrong");
    let mut newer = SAVED.clone();
    newer[7] = 9;
    assert_eq!(refused(&newer), "map of version 9, expected 3");
    assert_eq!(refused(&sealed(&SAVED[..SAVED.len() - 1])), "the map is cut off in its loops");
    let mut longer = SAVED.clone();
    longer.push(0);
    assert_eq!(
        refused(&sealed(&longer)),
        "the map contradicts itself: bytes behind the map is 1, expected 0"
    );
}

/// The same bytes with a matching checksum, as an attacker would send them.
fn sealed(bytes: &[u8]) -> Vec<u8> {
    let sum = bytes[16..].chunks(8).fold(0xCBF2_9CE4_8422_2325 ^ (bytes.len() - 16) as u64, |sum, chunk| {
        let word = chunk.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        (sum ^ word).wrapping_mul(0x0100_0000_01B3)
    });
    let mut bytes = bytes.to_vec();
    bytes[8..16].copy_from_slice(&sum.to_le_bytes());
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn a_flipped_bit_or_a_cut_is_refused(at in any::<prop::sample::Index>(), bit in 0..8_u8, cut: bool) {
        let at = at.index(SAVED.len());
        let mut bytes = SAVED.clone();
        if cut { bytes.truncate(at) } else { bytes[at] ^= 1_u8 << bit }
        prop_assert!(load(&bytes).is_err());
    }

    /// Changed bytes with a matching checksum: refused, or a usable map; never a panic.
    #[test]
    fn a_hostile_map_is_refused_or_harmless(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6), cut in 0..40_usize,
    ) {
        let mut bytes = SAVED.clone();
        for (at, value) in changes {
            let at = 16 + at.index(bytes.len() - 16);
            bytes[at] = value;
        }
        if cut < 8 {
            bytes.truncate(bytes.len() - cut);
        }
        if let Ok(mut slam) = load(&sealed(&bytes)) {
            let again = slam.save();
            prop_assert_eq!(load(&again).unwrap().save(), again);
            VIEWS.iter().for_each(|view| _ = slam.step(view, None));
        }
    }
}
