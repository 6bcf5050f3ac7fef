//! Scene files.

use std::path::Path;
use trundle_core::Pose2;
use trundle_sim::import::{GltfOptions, UpAxis};
use trundle_sim::scenes::file::{BaseLoader, LoadError, SceneFile};
use trundle_sim::{Material, Mesh, Scene, SimConfig, Simulator, Solid, Triangle};

/// Files of this loader: `floor.glb` and `floor.yaml` contain the test hall, all others are empty.
struct Shelf;

impl BaseLoader for Shelf {
    fn gltf(&self, path: &Path, options: &GltfOptions) -> Result<Mesh, LoadError> {
        assert_eq!((options.up, options.scale), (UpAxis::Z, 0.5));
        self.map(path, 2.0)?;
        let material = Material { name: "floor".into(), color: [120; 3], texture: None };
        let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let triangle = Triangle { corners: [0, 1, 2], material: 0 };
        Ok(Mesh::new(corners, vec![[0.0; 2]; 3], vec![triangle], vec![material])?)
    }

    fn map(&self, path: &Path, wall_height: f64) -> Result<Vec<Solid>, LoadError> {
        assert_eq!(wall_height, 2.0);
        if path.file_stem().is_some_and(|stem| stem == "floor") {
            Ok(crate::hall(Pose2::IDENTITY).world.solids().to_vec())
        } else {
            Err("no such file".into())
        }
    }
}

/// The same deserialisation as TOML's, which this crate does not depend on.
fn parse(json: &str) -> Result<SceneFile, String> {
    serde_json::from_str(json).map_err(|error| error.to_string())
}

fn build(json: &str) -> Result<Scene, String> {
    parse(json)?.build(&Shelf, 7).map_err(|error| error.to_string())
}

fn refusal(json: &str) -> String {
    build(json).map(|scene| scene.name).unwrap_err()
}

#[test]
fn a_file_adds_to_a_built_in_scene_and_changes_nothing_else() {
    let plain = build(r#"{"base": {"scene": "demo"}}"#).unwrap();
    let base = Scene::by_name("demo", 7).unwrap();
    assert_eq!((plain.start, plain.goal, &plain.name), (base.start, base.goal, &base.name));
    assert_eq!(plain.world.solids(), base.world.solids());
    let more = build(
        r#"{"name": "crowded", "base": {"scene": "demo", "seed": 7},
            "robot": {"start": {"x": 1.0, "y": 1.2, "heading_deg": 90}, "goal": {"x": 2.0, "y": 1.0}},
            "props": [{"kind": "table", "x": 1.0, "y": 3.0, "heading_deg": 30, "size": [0.9, 0.6, 0.7]},
                      {"kind": "cylinder", "x": 3.0, "y": 1.0, "paint": "bricks", "bottom": 0.2}],
            "people": [{"waypoints": [[1.0, 2.0], [3.0, 2.0]], "speed": 0.8}],
            "lights": {"ambient": 0.3, "lamps": []}}"#,
    )
    .unwrap();
    let solids = base.world.solids();
    assert_eq!(&more.world.solids()[..solids.len()], solids);
    assert_eq!(more.world.solids().len(), solids.len() + 5 + 1);
    assert_eq!(more.start, Pose2::new(1.0, 1.2, std::f64::consts::FRAC_PI_2));
    assert_eq!((more.people.len(), more.lights.ambient, more.name.as_str()), (1, 0.3, "crowded"));
}

#[test]
fn files_are_loaded_by_the_caller_and_need_a_start() {
    let base = r#""base": {"gltf": "rooms/floor.glb", "up": "z", "scale": 0.5}"#;
    let scene = build(&format!(r#"{{{base}, "robot": {{"start": {{"x": 0, "y": 1}}}}}}"#)).unwrap();
    assert_eq!((scene.name.as_str(), scene.start, scene.goal.position().y), ("floor", scene.goal, 1.0));
    assert!(refusal(&format!("{{{base}}}")).contains("robot.start is missing"));
    let raised =
        r#"{"base": {"map": "maps/floor.yaml", "wall_height": 2}, "robot": {"start": {"x": 0, "y": 0}}}"#;
    assert_eq!(build(raised).unwrap().world.solids(), crate::hall(Pose2::IDENTITY).world.solids());
    let lost =
        refusal(r#"{"base": {"map": "lost.yaml", "wall_height": 2}, "robot": {"start": {"x": 0, "y": 0}}}"#);
    assert_eq!(lost, "base.map 'lost.yaml': no such file");
}

#[test]
fn every_kind_of_prop_stands_where_it_is_put() {
    for kind in [
        "box", "cylinder", "table", "chair", "stool", "sofa", "bed", "shelf", "cabinet", "carton", "bin",
        "plant", "pallet",
    ] {
        let count = |props: &str| {
            build(&format!(r#"{{"base": {{"scene": "room"}}, "props": [{props}]}}"#))
                .unwrap()
                .world
                .solids()
                .to_vec()
        };
        let prop = |rest: &str| format!(r#"{{"kind": "{kind}", "x": 1.0, "y": -1.0{rest}}}"#);
        let empty = count("").len();
        let plain = count(&prop(""));
        assert!(plain.len() > empty, "{kind}");
        // Props with equal seeds are equal; with other seeds they differ.
        let pair = count(&format!("{}, {}", prop(r#", "seed": 3"#), prop(r#", "seed": 3"#)));
        let half = (pair.len() - empty) / 2;
        assert_eq!(pair[empty..empty + half], pair[empty + half..], "{kind}");
        let others = count(&format!("{}, {}", prop(""), prop("")));
        assert_ne!(others[empty..empty + half], others[empty + half..], "{kind}");
    }
}

#[test]
fn a_robot_inside_a_prop_is_refused_by_the_simulator() {
    let scene = build(
        r#"{"base": {"scene": "room"}, "robot": {"start": {"x": 1.0, "y": 1.0}},
            "props": [{"kind": "carton", "x": 1.1, "y": 1.0}]}"#,
    )
    .unwrap();
    let error = Simulator::new(scene, SimConfig::default(), 1).unwrap_err().to_string();
    assert!(error.contains("inside an obstacle"), "{error}");
}

#[test]
fn errors_of_scene_files_are_named() {
    let with = |item: &str| refusal(&format!(r#"{{"base": {{"scene": "room"}}, {item}}}"#));
    let prop = |rest: &str| with(&format!(r#""props": [{{"kind": "box", "x": 0, "y": 0}}, {{{rest}}}]"#));
    for (reported, expected) in [
        (refusal(r#"{"base": {}}"#), "base is 0 of scene, gltf, map, expected exactly one"),
        (refusal(r#"{"base": {"scene": "room", "map": "floor.yaml"}}"#), "base is 2"),
        (refusal(r#"{"base": {"scene": "moon"}}"#), "base.scene is moon"),
        (refusal(r#"{"base": {"scene": "room", "scale": 2}}"#), "base.scale is given"),
        (refusal(r#"{"base": {"map": "floor.yaml", "wall_height": 99}}"#), "base.wall_height is 99"),
        (refusal(r#"{"base": {"scene": "room"}, "prop": []}"#), "unknown field `prop`"),
        (prop(r#""kind": "sofa", "x": 1e9, "y": 0"#), "props[1].x is 1000000000 m"),
        (prop(r#""kind": "box", "x": 0, "y": 0, "size": [1, 0, 1]"#), "props[1].size is 0 m"),
        (prop(r#""kind": "bin", "x": 0, "y": 0, "size": [1, 2, 1]"#), "props[1].size is [1.0, 2.0, 1.0] m"),
        (prop(r#""kind": "sofa", "x": 0, "y": 0, "paint": "bricks""#), "props[1].paint"),
        (prop(r#""kind": "throne", "x": 0, "y": 0"#), "unknown variant `throne`"),
        (with(r#""people": [{"waypoints": []}]"#), "people[0]"),
        (with(r#""lights": {"ambient": -1}"#), "lights.ambient is -1"),
        (with(r#""robot": {"goal": {"x": 0, "y": 1e300}}"#), "robot.goal.y"),
    ] {
        assert!(reported.contains(expected), "'{reported}' does not say '{expected}'");
    }
}

#[test]
fn numbers_that_are_none_are_refused_by_item() {
    let mut file =
        parse(r#"{"base": {"scene": "room"}, "props": [{"kind": "box", "x": 0, "y": 0}]}"#).unwrap();
    let refused = |spoil: fn(&mut SceneFile), expected: &str| {
        let mut spoilt = file.clone();
        spoil(&mut spoilt);
        let reported = spoilt.build(&Shelf, 1).unwrap_err().to_string();
        assert!(reported.contains(expected), "'{reported}' does not say '{expected}'");
    };
    refused(|file| file.props[0].heading_deg = f64::NAN, "props[0].heading_deg is NaN");
    refused(|file| file.props[0].size = Some([f64::NAN; 3]), "props[0].size is NaN");
    refused(|file| file.props[0].bottom = f64::INFINITY, "props[0].bottom is inf");
    file.name = None;
    assert!(file.build(&Shelf, 1).is_ok());
}
