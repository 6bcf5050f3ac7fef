//! Logs, bags, recordings and meshes.

use super::texts;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use trundle::app::RunSetup;
use trundle::core::{
    Beam, ColorImage, DepthImage, GyroRate, Pose2, RgbdImage, Scan, SensorEvent, Stamp, Touch, Vector2,
    WheelTicks,
};
use trundle::io::{EncodedEvent, Recorder};
use trundle::runtime::{Mission, RobotConfig, Task};

/// CARMEN logs, old and new.
pub fn laser_log() -> Vec<Vec<u8>> {
    texts(&[
        "# CARMEN\nPARAM robot_frontlaser_offset 0.1\nODOM 0 0 0 0 0 0 1.0 host 1.0\nFLASER 5 1.0 1.1 1.2 81.9 0.5 0 0 0 0 0 0 1.0 host 1.0\nFLASER 5 1.0 1.1 1.2 81.9 0.5 0.1 0 0 0.1 0 0 2.0 host 2.0\n",
        "ROBOTLASER1 0 -1.57 3.14 1.57 81.9 0.01 0 3 1 2 3 0 0.1 0 0.1 0.1 0 0.1 0 0 0.2 0.2 1.0 host 1.0\n",
    ])
}

/// Bags of both storage formats, compressed in both ways, and one with images.
pub fn bag() -> Vec<Vec<u8>> {
    let names = ["zstd.mcap", "lz4.mcap", "sqlite/bag_0.db3"];
    names.iter().filter_map(|name| committed(name)).chain(recording()).collect()
}

/// A bag as an SQLite file.
pub fn sqlite() -> Vec<Vec<u8>> {
    committed("sqlite/bag_0.db3").into_iter().collect()
}

/// A bag of the repository.
fn committed(name: &str) -> Option<Vec<u8>> {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "..", "data", "ros2"].iter().collect();
    std::fs::read(folder.join(name)).ok()
}

/// A scan, odometry and a transform, little endian.
pub fn cdr() -> Vec<Vec<u8>> {
    let head = [&[0, 1, 0, 0][..], &1_u32.to_le_bytes(), &7_u32.to_le_bytes()].concat();
    let name = |text: &str| [&(text.len() as u32 + 1).to_le_bytes()[..], text.as_bytes(), &[0]].concat();
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let doubles = |values: &[f64]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let scan = [
        head.clone(),
        name("las"),
        floats(&[-1.0, 1.0, 0.5, 0.0, 0.1, 0.1, 20.0]),
        vec![3, 0, 0, 0],
        floats(&[1.0, 2.0, 3.0]),
    ];
    let odometry =
        [head.clone(), name("odo"), name("bas"), vec![0; 4], doubles(&[1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0])];
    let count = [&[0, 1, 0, 0, 1, 0, 0, 0][..], &head[4..]].concat();
    let transform = [count, name("bas"), name("las"), doubles(&[0.1, 0.0, 0.2, 0.0, 0.0, 0.0, 1.0])];
    let image = [
        head.clone(),
        name("cam"),
        [1_u32, 2].map(u32::to_le_bytes).concat(),
        name("rgb8"),
        [vec![0; 4], 6_u32.to_le_bytes().to_vec(), 6_u32.to_le_bytes().to_vec(), vec![7; 6]].concat(),
    ];
    vec![scan.concat(), odometry.concat(), transform.concat(), image.concat()]
}

/// A recording with its setup and an event of each kind.
pub fn recording() -> Vec<Vec<u8>> {
    let mut recorder =
        Recorder::new(Cursor::new(Vec::new()), Path::new("memory")).expect("invariant: memory is writable");
    let mission =
        Mission::new(vec![Task::go(Pose2::new(1.0, 2.0, 0.5))]).expect("invariant: the goal is finite");
    let setup = RunSetup::new("seed", mission, RobotConfig::default());
    let at = |millis: i64| Stamp::from_nanos(1_000_000 * millis);
    recorder.record_json("/config", "trundle.Config", at(0), &setup).expect("invariant: a setup is JSON");
    for event in events(at) {
        let event = EncodedEvent::encode(&event).expect("invariant: the event can be encoded");
        recorder.record_event(&event).expect("invariant: memory is writable");
    }
    vec![recorder.finish().expect("invariant: memory is writable").into_inner()]
}

fn events(at: impl Fn(i64) -> Stamp) -> Vec<SensorEvent> {
    let (color, depth) = (ColorImage::filled(8, 6, [90, 80, 70]), DepthImage::filled(8, 6, 1.5));
    let beams = vec![Beam::Hit { range: 1.0 }, Beam::Free { range: 5.0 }, Beam::Unseen];
    vec![
        SensorEvent::Wheels(WheelTicks { stamp: at(1), left: 65_535, right: 3 }),
        SensorEvent::Gyro(GyroRate { stamp: at(2), omega: 0.3 }),
        SensorEvent::Rgbd(RgbdImage::new(at(3), color, depth).expect("invariant: the images are as large")),
        SensorEvent::Touch(Touch { stamp: at(4), pressed: true }),
        SensorEvent::Scan(
            Scan::new(at(5), Vector2::zeros(), -1.0, 0.1, beams).expect("invariant: the scan is valid"),
        ),
        SensorEvent::Truth { stamp: at(6), pose: Pose2::new(1.0, 2.0, 3.0) },
    ]
}

/// One triangle, as JSON with its buffer inside and as GLB.
pub fn gltf() -> Vec<Vec<u8>> {
    let positions: Vec<u8> =
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let json = |uri: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"scale":[2,1,1]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"material":0}}]}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorFactor":[1,0,0,1]}}}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}}],
"bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{{uri}"byteLength":36}}]}}"#
        )
    };
    let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let text = json(&format!(r#""uri":"data:application/octet-stream;base64,{data}","#));
    vec![text.into_bytes(), glb(json("").into_bytes(), &positions)]
}

fn glb(mut json: Vec<u8>, buffer: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8; 4], data: &[u8]| [&(data.len() as u32).to_le_bytes()[..], kind, data].concat();
    let body = [chunk(b"JSON", &json), chunk(b"BIN\0", buffer)].concat();
    [b"glTF".as_slice(), &2_u32.to_le_bytes(), &(body.len() as u32 + 12).to_le_bytes(), &body].concat()
}
