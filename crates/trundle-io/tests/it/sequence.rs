//! TUM folders: reading, and wrong folders.

use crate::frame;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use trundle_core::{Pose2, Pose3, Stamp};
use trundle_io::*;

/// A folder of three frames, 100 ms apart, the depth images 3 ms later.
fn folder() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    let (mut rgb, mut depth) = (String::from("# colour\n"), String::from("# depth\n"));
    for i in 0..3 {
        let stamp = Stamp::from_nanos(1_305_031_229_528_748_000 + i * 100_000_000);
        let image = frame(stamp, 40, 30);
        fs::write(dir.path().join(format!("{i}.jpg")), encode_color(image.color(), JPEG_QUALITY).unwrap())
            .unwrap();
        fs::write(dir.path().join(format!("{i}.png")), encode_depth(image.depth()).unwrap()).unwrap();
        rgb += &format!("{stamp} {i}.jpg\n");
        depth += &format!("{} {i}.png\n", stamp.after(0.003));
    }
    fs::write(dir.path().join("rgb.txt"), rgb).unwrap();
    fs::write(dir.path().join("depth.txt"), depth).unwrap();
    dir
}

fn open(dir: &Path) -> Result<TumSequence, IoError> {
    TumSequence::open(dir, 1000.0, TumSequence::MAX_DIFFERENCE)
}

/// Error of opening, without the path of the temporary folder.
fn problem(dir: &TempDir) -> String {
    open(dir.path()).unwrap_err().to_string().replace(&dir.path().display().to_string(), "DIR")
}

fn load_problem(dir: &TempDir, sequence: &TumSequence, i: usize) -> String {
    sequence.load(i).unwrap_err().to_string().replace(&dir.path().display().to_string(), "DIR")
}

#[test]
fn reads_what_was_written() {
    let dir = folder();
    let poses = vec![(Stamp::from_nanos(5), Pose3::identity())];
    fs::write(dir.path().join("groundtruth.txt"), trajectory_text(&poses)).unwrap();
    let driven = vec![(Stamp::from_nanos(7), Pose2::new(1.0, 2.0, 0.3))];
    fs::write(dir.path().join("odometry.txt"), odometry_text(&driven)).unwrap();
    let sequence = open(dir.path()).unwrap().with_size(40, 30);
    assert_eq!((sequence.len(), sequence.unpaired(), sequence.is_empty()), (3, 0, false));
    assert_eq!(sequence.stamp(1).to_string(), "1305031229.628748000");
    for (i, image) in sequence.frames().enumerate() {
        let (image, stamp) = (image.unwrap(), sequence.stamp(i));
        let expected = EncodedRgbd::encode(&frame(stamp, 40, 30)).unwrap().decode().unwrap();
        assert!(image.stamp() == stamp && image.color() == expected.color());
        let depths = image.depth().data().iter().zip(expected.depth().data());
        assert!(depths.into_iter().all(|(a, b)| (a - b).abs() < 1e-6));
    }
    assert_eq!(sequence.ground_truth(), Some(&poses[..]));
    assert_eq!(sequence.odometry(), Some(&driven[..]));
}

#[test]
fn wrong_folders_are_one_clear_sentence() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(
        problem(&dir),
        "DIR: this is an empty folder, expected a TUM RGB-D folder (rgb.txt and depth.txt, or associations.txt), \
         a ROS bag or a trundle recording"
    );
    fs::write(dir.path().join("depths.txt"), "7.5 a.png").unwrap();
    assert_eq!(
        problem(&dir),
        "DIR: this is a folder, expected a TUM RGB-D folder (rgb.txt and depth.txt, or associations.txt), a ROS bag or a trundle recording; \
         name its lists of colour and depth images rgb.txt and depth.txt; each line is: timestamp filename"
    );
    fs::write(dir.path().join("rgb.txt"), "1.0 a.png").unwrap();
    assert_eq!(
        problem(&dir),
        "DIR: depth.txt is missing, expected rgb.txt and depth.txt, or associations.txt; rename depths.txt if its lines are: \
         timestamp filename"
    );
    fs::remove_file(dir.path().join("depths.txt")).unwrap();
    assert_eq!(
        problem(&dir),
        "DIR: depth.txt is missing, expected rgb.txt and depth.txt, or associations.txt"
    );
    fs::write(dir.path().join("depth.txt"), "7.5 a.png\n8 b.png").unwrap();
    assert_eq!(
        problem(&dir),
        "DIR: no colour image of rgb.txt (1.000000000 s) is within 0.02 s of a depth image of depth.txt \
         (7.500000000 s to 8.000000000 s)"
    );
    fs::write(dir.path().join("depth.txt"), "1 a.png\n0.5 b.png\nhalf c.png").unwrap();
    assert_eq!(
        problem(&dir),
        "DIR/depth.txt, line 3: timestamp is 'half', expected a decimal number of seconds"
    );
    fs::write(dir.path().join("depth.txt"), "1 a.png\n0.5 b.png").unwrap();
    let message: Vec<String> = open(dir.path()).unwrap().warnings().iter().map(ToString::to_string).collect();
    assert!(
        message.len() == 1
            && message[0].starts_with("rows with an earlier timestamp than the row before: 1 of 2"),
        "{message:?}"
    );
    let error = open(&dir.path().join("nowhere")).unwrap_err().to_string();
    assert!(error.starts_with("cannot read ") && error.ends_with("nowhere: it does not exist"), "{error}");
    let error = open(&dir.path().join("rgb.txt")).unwrap_err().to_string();
    assert!(error.contains("rgb.txt: this is a list of images, expected a TUM RGB-D folder"), "{error}");
    let scale = TumSequence::open(dir.path(), 0.0, 0.02).unwrap_err().to_string();
    assert!(scale.contains("depth_scale is 0 units per metre"), "{scale}");
    let scale = TumSequence::open(dir.path(), 0.001, 0.02).unwrap_err().to_string();
    assert!(
        scale.contains("depth_scale is 0.001, expected units per metre; 0.001 m per unit are 1000"),
        "{scale}"
    );
}

#[test]
fn broken_rows_of_ground_truth_and_odometry_are_warned_of_and_odometry_without_any_row_is_refused() {
    let dir = folder();
    fs::write(dir.path().join("groundtruth.txt"), "# t\n1 2 3\n").unwrap();
    let sequence = open(dir.path()).unwrap();
    let message: Vec<String> = sequence.warnings().iter().map(ToString::to_string).collect();
    assert!(
        message.len() == 1 && message[0].starts_with("row left out, 3 fields, expected 8"),
        "{message:?}"
    );
    assert!(
        message[0].ends_with("groundtruth.txt, line 2") && sequence.ground_truth().is_none(),
        "{message:?}"
    );
    fs::remove_file(dir.path().join("groundtruth.txt")).unwrap();
    fs::write(dir.path().join("odometry.txt"), "1 2 3 x\n").unwrap();
    assert_eq!(problem(&dir), "DIR/odometry.txt, line 1: theta is 'x', expected a finite number");
    fs::write(dir.path().join("odometry.txt"), "1 2 3 x\n2 0 0 0\n").unwrap();
    let sequence = open(dir.path()).unwrap();
    let message: Vec<String> = sequence.warnings().iter().map(ToString::to_string).collect();
    assert!(message.len() == 1 && message[0].starts_with("row left out, theta is 'x'"), "{message:?}");
    assert_eq!(sequence.odometry().unwrap().len(), 1);
}

#[test]
fn a_broken_frame_is_named_and_the_next_one_is_read() {
    let dir = folder();
    let sequence = open(dir.path()).unwrap();
    fs::remove_file(dir.path().join("0.jpg")).unwrap();
    assert_eq!(
        load_problem(&dir, &sequence, 0),
        "frame 0 at 1305031229.528748000 s: cannot read DIR/0.jpg: it does not exist"
    );
    let whole = fs::read(dir.path().join("1.jpg")).unwrap();
    fs::write(dir.path().join("1.jpg"), &whole[..whole.len() / 2]).unwrap();
    assert!(
        load_problem(&dir, &sequence, 1)
            .ends_with("DIR/1.jpg: colour image cannot be decoded: the JPEG is truncated")
    );
    assert!(sequence.load(2).is_ok());
    assert_eq!(sequence.frames().filter(Result::is_ok).count(), 1);
}

#[test]
fn wrong_depth_images_are_named() {
    let dir = folder();
    let sequence = open(dir.path()).unwrap();
    let whole = fs::read(dir.path().join("0.png")).unwrap();
    fs::write(dir.path().join("0.png"), &whole[..whole.len() / 2]).unwrap();
    assert!(load_problem(&dir, &sequence, 0).contains("DIR/0.png: depth image cannot be decoded: "));
    let gray = vec![7u8; 40 * 30];
    image::save_buffer(dir.path().join("1.png"), &gray, 40, 30, image::ColorType::L8).unwrap();
    assert!(
        load_problem(&dir, &sequence, 1)
            .contains("DIR/1.png: depth image has 8-bit grey pixels, expected 16-bit grey ones")
    );
    let small = frame(Stamp::default(), 20, 10);
    fs::write(dir.path().join("2.png"), encode_depth(small.depth()).unwrap()).unwrap();
    assert!(
        load_problem(&dir, &sequence, 2)
            .ends_with("DIR/2.png: depth image size is 20 x 10 px, expected 40 x 30 as the colour image")
    );
    let sized = sequence.with_size(640, 480);
    assert!(
        load_problem(&dir, &sized, 2)
            .ends_with("DIR/2.jpg: colour image size is 40 x 30 px, expected 640 x 480 as the camera")
    );
}

#[test]
fn associations_alone_pair_the_images_whichever_column_is_depth() {
    let dir = folder();
    let listed = open(dir.path()).unwrap();
    let lines = |swap: bool| -> String {
        let line = |i: usize| {
            let stamp = listed.stamp(i);
            let (color, depth) = (format!("{stamp} {i}.jpg"), format!("{} {i}.png", stamp.after(0.003)));
            if swap { format!("{depth} {color}\n") } else { format!("{color} {depth}\n") }
        };
        (0..3).rev().map(line).collect()
    };
    ["rgb.txt", "depth.txt"].iter().for_each(|name| fs::remove_file(dir.path().join(name)).unwrap());
    for swap in [false, true] {
        fs::write(dir.path().join("associations.txt"), lines(swap)).unwrap();
        let sequence = open(dir.path()).unwrap();
        assert_eq!(sequence.len(), 3);
        for i in 0..3 {
            assert_eq!(sequence.stamp(i), listed.stamp(i));
            assert_eq!(sequence.load(i).unwrap(), listed.load(i).unwrap(), "{swap}");
        }
    }
    fs::write(dir.path().join("associations.txt"), "1 0.jpg 1\n").unwrap();
    assert!(problem(&dir).contains("associations.txt, line 1: 3 fields, expected 4"), "{}", problem(&dir));
}

#[test]
fn kitti_poses_without_times_are_those_of_the_images() {
    let dir = folder();
    let rows: String = (0..3).map(|i| format!("1 0 0 {i} 0 1 0 0 0 0 1 0\n")).collect();
    fs::write(dir.path().join("groundtruth.txt"), rows).unwrap();
    let sequence = open(dir.path()).unwrap();
    let truth = sequence.ground_truth().unwrap();
    assert!((0..3).all(|i| truth[i].0 == sequence.stamp(i) && truth[i].1.translation.x == i as f64));
    assert!(sequence.warnings().is_empty());
}

fn shared(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data")).join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is not here", path.display());
    None
}

#[test]
fn pairs_and_reads_a_real_sequence() {
    let Some(dir) = shared("tum_fr1_rpy_400") else { return };
    let sequence = TumSequence::open(&dir, 5000.0, 0.02).unwrap().with_size(640, 480);
    // As in the folder's associations.txt, 16 depth images are paired with two colour images each.
    let listed = fs::read_to_string(dir.join("associations.txt")).unwrap();
    let colors: Vec<Stamp> =
        listed.lines().map(|line| parse_stamp(line.split(' ').next().unwrap()).unwrap()).collect();
    assert!((0..sequence.len()).all(|i| colors.binary_search(&sequence.stamp(i)).is_ok()));
    assert_eq!((sequence.len(), sequence.unpaired(), colors.len()), (400, 0, 400));
    assert!(sequence.ground_truth().is_some_and(|poses| poses.len() > 1000));
    let image = sequence.load(0).unwrap();
    let depths: Vec<f32> = image.depth().data().iter().copied().filter(|&d| d > 0.0).collect();
    assert!(depths.len() > 100_000 && depths.iter().all(|&d| (0.3..12.0).contains(&d)));
}

#[test]
fn reads_every_shared_map_and_trajectory() {
    let maps = [
        "nav/nav2",
        "nav/mrpb/maps/room02",
        "nav/mrpb/maps/office01add",
        "nav/mrpb/maps/empty_world",
        "nav/mrpb/maps/track",
        "nav/mrpb/maps/office02_partially_unknown",
        "scenes",
        "trajectories",
    ];
    for dir in maps.iter().filter_map(|name| shared(name)) {
        for entry in fs::read_dir(&dir).unwrap() {
            let path = entry.unwrap().path();
            match path.extension().and_then(|e| e.to_str()) {
                Some("yaml") => {
                    let grid = read_map(&path).unwrap_or_else(|error| panic!("{error}"));
                    assert!(grid.geometry().len() > 1000);
                }
                Some("txt") if !path.ends_with("README.txt") && !path.ends_with("config.txt") => {
                    let poses = read_trajectory(&path).unwrap_or_else(|error| panic!("{error}"));
                    assert!(poses.len() > 30);
                }
                _ => {}
            }
        }
    }
}
