//! `trundle sim` with files: scenes, maps, glTF, faults.

use crate::plan::write_room;
use crate::program::{refusal, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

/// A triangle of 1 m with texture coordinates and one texture `gone.png`.
const TRIANGLE: &str = r#"{
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
  "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
  "textures": [{"source": 0}], "images": [{"uri": "gone.png"}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, -1], "max": [1, 0, 0]},
    {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
  "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"}]
}"#;

fn file(folder: &Path, name: &str, content: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

/// Runs `trundle sim` on `scene` in `folder`, with the scene's `content`.
fn refused(folder: &Path, name: &str, content: &str, extra: &[&str]) -> String {
    let path = file(folder, name, content);
    let sentence = refusal(&[&["sim", text(&path)], extra].concat());
    sentence.replace(&format!("{}/", folder.display()), "").trim_end().to_owned()
}

fn message(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn scene_files_are_driven_and_wrong_ones_name_file_and_item() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let scene = "[base]\nscene = \"obstacles\"\n[robot]\nstart = { x = 0.7, y = 0.7, heading_deg = 90 }\n";
    let good = file(folder, "good.toml", scene);
    let output = trundle(&["sim", text(&good), "--duration", "0.2"]);
    assert!(output.status.success() && message(&output).contains("images"), "{}", message(&output));

    let sentence = refused(folder, "key.toml", &format!("{scene}goals = 3\n"), &[]);
    assert!(
        sentence.starts_with("trundle: key.toml, line 5: unknown key goals, expected start or goal"),
        "{sentence}"
    );
    let sentence = refused(folder, "base.toml", "[base]\nscene = \"moon\"\n", &[]);
    assert!(
        sentence.starts_with("trundle: base.toml: base.scene is moon, expected one of demo"),
        "{sentence}"
    );
    let sentence = refused(folder, "wall.toml", &scene.replace("x = 0.7", "x = -0.05"), &[]);
    assert!(
        sentence.contains("wall.toml: start of scene 'obstacles' at (-0.050, 0.700) m is 0."),
        "{sentence}"
    );
    let sentence = refused(folder, "nan.toml", &scene.replace("x = 0.7", "x = nan"), &[]);
    assert!(sentence.starts_with("trundle: nan.toml: robot.start.x is NaN m"), "{sentence}");
    let sentence = refused(folder, "far.toml", "[base]\nmap = \"gone.yaml\"\n", &[]);
    assert!(
        sentence.contains("far.toml: base.map 'gone.yaml': ") && sentence.ends_with("does not exist"),
        "{sentence}"
    );
}

#[test]
fn scenes_that_are_missing_or_have_no_surface() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    for name in ["nowhere.toml", "nowhere.yaml", "nowhere.glb"] {
        let sentence = refusal(&["sim", name]);
        assert!(sentence.contains("nowhere"), "{sentence}");
    }
    let empty = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}"#;
    assert_eq!(
        refused(folder, "empty.gltf", empty, &[]),
        "trundle: empty.gltf: has no triangles in its scene"
    );
    let sentence = refused(folder, "wrong.glb", "no glTF at all", &[]);
    assert!(sentence.contains("wrong.glb: "), "{sentence}");
}

#[test]
fn a_scene_without_its_texture_is_grey_and_warned_of_once() {
    let scratch = tempfile::tempdir().unwrap();
    let path = file(scratch.path(), "bare.gltf", TRIANGLE);
    let run = |more: &[&str]| {
        let fixed = ["sim", text(&path), "--start=0.3,0.3,0", "--duration=0.1"];
        let output = trundle(&[&fixed[..], more].concat());
        assert!(output.status.success(), "{}", message(&output));
        message(&output)
    };
    let plain = run(&[]);
    assert_eq!(plain.matches("gone.png").count(), 1, "{plain}");
    assert!(plain.contains("textures that cannot be read are grey: 1: image 0 ('gone.png')"), "{plain}");
    assert!(run(&["--scale=2000"]).contains("is the scale right?"));
    assert!(!run(&["--floor=0"]).contains("the floor lies"));
}

#[test]
fn a_map_raised_to_walls_is_driven_in_and_maps_back_to_itself() {
    let scratch = tempfile::tempdir().unwrap();
    let room = write_room(scratch.path());
    let back = scratch.path().join("back.yaml");
    let output = trundle(&["sim", text(&room), "--duration", "0.2", "--rate", "10", "--map", text(&back)]);
    assert!(output.status.success(), "{}", message(&output));
    let cells = |name: &str| {
        let bytes = fs::read(scratch.path().join(name)).unwrap();
        bytes[bytes.len() - 120 * 80..].to_vec()
    };
    assert!(cells("room.pgm") == cells("back.pgm"));

    fs::write(scratch.path().join("room.pgm"), "P5\n100000 100000\n255\n").unwrap();
    let sentence = refusal(&["sim", text(&room)]);
    assert!(sentence.contains("room.pgm: size is 100000 x 100000 px, expected 1 to 268435456"), "{sentence}");
    let yaml = fs::read_to_string(&room).unwrap().replace("resolution: 0.05", "resolution: 2.0");
    let mut pgm = b"P5\n2000 2000\n255\n".to_vec();
    pgm.resize(pgm.len() + 2000 * 2000, 254);
    fs::write(scratch.path().join("room.pgm"), pgm).unwrap();
    let sentence = refused(scratch.path(), "room.yaml", &yaml, &[]);
    assert!(sentence.contains("room.yaml: memory for the textures of the map is "), "{sentence}");
}

#[test]
fn faults_and_a_laser_are_recorded_and_wrong_faults_are_named() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let faults = |content: &str| {
        let path = file(folder, "faults.toml", content);
        refusal(&["sim", "room", "--faults", text(&path)])
    };
    let sentence = faults("[[faults]]\nfrom_s = 1\nkind = \"camera-blue\"\n");
    assert!(
        sentence.contains("faults.toml, line 3: kind is camera-blue, expected one of camera-black"),
        "{sentence}"
    );
    let sentence = faults("[[faults]]\nfrom_s = 2\nto_s = 1\nkind = \"gyro-stuck\"\n");
    assert!(sentence.contains("faults.toml: faults[0].to_s is 1 s, expected more than 2"), "{sentence}");

    let black = "[[faults]]\nfrom_s = 0.25\nkind = \"camera-black\"\n[[faults]]\nfrom_s = 0.05\nto_s = 0.15\nkind = { camera-dropped = { probability = 1.0 } }\n";
    let (path, out) = (file(folder, "black.toml", black), folder.join("out"));
    let output = trundle(&[
        "sim",
        "room",
        "--faults",
        text(&path),
        "--laser",
        "urg-04lx",
        "--rate",
        "10",
        "--duration",
        "0.4",
        "--record",
        text(&out),
    ]);
    assert!(output.status.success(), "{}", message(&output));
    let list = fs::read_to_string(out.join("rgb.txt")).unwrap();
    let images: Vec<&str> = list.lines().skip(1).map(|line| line.split(' ').nth(1).unwrap()).collect();
    assert_eq!(images.len(), 3, "the image at 0.1 s is dropped: {list}");
    let brightest = |name: &str| {
        image::open(out.join(name)).unwrap().into_rgb8().pixels().flat_map(|p| p.0).max().unwrap()
    };
    assert!(brightest(images[0]) > 100 && brightest(images[2]) < 20, "{list}");
    let log = fs::read_to_string(out.join("laser.log")).unwrap();
    let sweep = log.lines().find(|line| line.starts_with("ROBOTLASER1")).unwrap();
    assert_eq!(sweep.split(' ').nth(8), Some("682"), "{sweep}");
    let ranges: Vec<f64> = sweep.split(' ').skip(9).take(682).map(|word| word.parse().unwrap()).collect();
    assert!(ranges.iter().all(|range| (0.0..7.0).contains(range)) && ranges.iter().any(|range| *range < 5.0));
}
