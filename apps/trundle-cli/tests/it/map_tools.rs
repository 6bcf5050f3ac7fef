//! `trundle map crop`, `rotate`, `diff`, `merge` and `rooms`: tools for finished maps.

use crate::program::{refusal, shared, summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};
use trundle::core::{Cell, OccupancyGrid, Pose2, Vector2};
use trundle::io::{read_annotations, read_map};

/// Runs a tool that succeeds; its `summary.json`.
fn tool(args: &[&str], out: &Path) -> serde_json::Value {
    let output = trundle(&[&["map"], args, &["--quiet", "--out", text(out)]].concat());
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty(), "{args:?}");
    summary(out)
}

/// The true map of a built-in scene.
fn scene(name: &str, folder: &Path) -> PathBuf {
    let map = folder.join(format!("{name}.yaml"));
    let output = trundle(&["sim", name, "--map", text(&map), "--quiet"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    map
}

fn count(grid: &OccupancyGrid, value: Cell) -> f64 {
    grid.cells().iter().filter(|cell| **cell == value).count() as f64
}

#[test]
fn a_crop_keeps_frame_and_cells() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scene("house", scratch.path());
    let out = scratch.path().join("part");
    let found = tool(&["crop", text(&map), "--to=1.01,0.5,4,3"], &out);
    let (whole, part) = (read_map(&map).unwrap(), read_map(&out.join("map.yaml")).unwrap());
    for i in 0..part.geometry().len() {
        let at = part.geometry().center(part.geometry().cell(i));
        assert_eq!(part.at(at), whole.at(at), "{at}");
    }
    assert_eq!(part.geometry().width, 60, "{found}");
    assert!(fs::read(out.join("overview.png")).unwrap().starts_with(b"\x89PNG"));
    let known = tool(&["crop", text(&map), "--known"], &scratch.path().join("known"));
    assert_eq!(known["success"], true);
    assert!(refusal(&["map", "crop", text(&map), "--out", text(&out)]).contains("--to"));
    let far = refusal(&["map", "crop", text(&map), "--to=900,900,901,901", "--out", text(&out)]);
    assert!(
        far.contains("house.yaml: box is (900, 900) to (901, 901) m, expected a part of the map"),
        "{far}"
    );
    let wrong = refusal(&["map", "crop", text(&map), "--to=2,0,1,1", "--out", text(&out)]);
    assert!(wrong.contains("X0 is 2 m and X1 is 1 m, expected X0 < X1"), "{wrong}");
}

#[test]
fn walls_are_turned_onto_the_axes_again() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scene("house", scratch.path());
    let whole = read_map(&map).unwrap();
    for by in [-20.0, 7.3, 33.0] {
        let (turned, upright) = (scratch.path().join("turned"), scratch.path().join("upright"));
        tool(&["rotate", text(&map), &format!("--by={by}")], &turned);
        let grid = read_map(&turned.join("map.yaml")).unwrap();
        let ratio = count(&grid, Cell::Occupied) / count(&whole, Cell::Occupied);
        assert!((ratio - 1.0).abs() < 0.05, "{ratio} of the walls after {by} deg");
        let found = tool(&["rotate", text(&turned.join("map.yaml")), "--to", "walls"], &upright);
        let turn = found["turn_deg"].as_f64().unwrap();
        assert!((turn + by).abs() < 0.1, "{turn} deg for {by} deg");
    }
    let round = scratch.path().join("round.yaml");
    fs::write(&round, "image: round.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n").unwrap();
    let pixel = |i: i32| match ((i % 200 - 100).pow(2) + (i / 200 - 100).pow(2)) as f64 {
        square if square < 77.0 * 77.0 => 254_u8,
        square if square < 80.0 * 80.0 => 0,
        _ => 205,
    };
    let pgm: Vec<u8> = b"P5\n200 200\n255\n".iter().copied().chain((0..40_000).map(pixel)).collect();
    fs::write(scratch.path().join("round.pgm"), pgm).unwrap();
    let out = scratch.path().join("out");
    let refused = refusal(&["map", "rotate", text(&round), "--to", "walls", "--out", text(&out)]);
    assert!(refused.contains("no common direction") && refused.contains("--by DEG"), "{refused}");
    assert!(!out.exists());
}

#[test]
fn differences_are_counted_and_other_frames_are_found() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scene("house", scratch.path());
    let out = scratch.path().join("diff");
    let same = tool(&["diff", text(&map), text(&map)], &out);
    assert_eq!((&same["only_in_a_cells"], &same["only_in_b_cells"]), (&0.into(), &0.into()));
    assert!(same["occupied_in_both_cells"].as_u64().unwrap() > 100, "{same}");
    assert!(fs::read(out.join("diff.png")).unwrap().starts_with(b"\x89PNG"));
    let turned = scratch.path().join("turned");
    tool(&["rotate", text(&map), "--by=25"], &turned);
    let found = tool(&["diff", text(&map), text(&turned.join("map.yaml")), "--align", "--within=0.1"], &out);
    assert!((found["b_heading_deg"].as_f64().unwrap() + 25.0).abs() < 0.3, "{found}");
    let part = |key: &str| found[key].as_f64().unwrap();
    assert!(part("only_in_a_m2") < 0.02 * part("occupied_in_both_m2"), "{found}");
    let both = refusal(&["map", "diff", "a", "b", "--align", "--at=1,2,3", "--out", text(&out)]);
    assert!(both.contains("--align") && both.contains("--at"), "{both}");
}

#[test]
fn parts_of_a_house_in_other_frames_become_the_house() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scene("house", scratch.path());
    let whole = read_map(&map).unwrap();
    let geometry = whole.geometry();
    let far =
        geometry.origin + Vector2::new(geometry.width as f64, geometry.height as f64) * geometry.resolution;
    let middle = (geometry.origin.x + far.x) / 2.0;
    let crop = |low: f64, high: f64, name: &str| {
        let out = scratch.path().join(name);
        tool(&["crop", text(&map), &format!("--to={low},{},{high},{}", geometry.origin.y, far.y)], &out);
        out.join("map.yaml")
    };
    let left = crop(geometry.origin.x, middle + 2.0, "left");
    let right = crop(middle - 2.0, far.x, "right");
    let turned = scratch.path().join("turned");
    tool(&["rotate", text(&right), "--by=-70"], &turned);
    let out = scratch.path().join("merged");
    let found = tool(&["merge", text(&left), text(&turned.join("map.yaml"))], &out);
    let second = &found["maps"][0];
    assert!((second["heading_deg"].as_f64().unwrap() - 70.0).abs() < 0.3, "{found}");
    assert!(second["agreeing_share"].as_f64().unwrap() > 0.9, "{found}");
    let merged = read_map(&out.join("map.yaml")).unwrap();
    let agree = (0..geometry.len()).filter(|i| {
        let cell = geometry.cell(*i);
        merged.at(geometry.center(cell)) == whole.get(cell)
    });
    let share = agree.count() as f64 / geometry.len() as f64;
    assert!(share > 0.97, "{share} of the cells are those of the house");
    let pose = "--poses=0,0,70";
    let given = tool(&["merge", text(&left), text(&turned.join("map.yaml")), pose], &out);
    assert!(
        given["maps"][0]["second_best_share"].is_null()
            && given["maps"][0]["agreeing_share"].as_f64().unwrap() > 0.9
    );
    let refused = refusal(&["map", "merge", text(&left), text(&right), pose, pose, "--out", text(&out)]);
    assert!(refused.contains("2 poses for 1 maps"), "{refused}");
    assert!(refusal(&["map", "merge", text(&left), "--out", text(&out)]).contains("<MAP>"));
}

#[test]
fn a_room_that_looks_the_same_from_both_ends_is_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let yaml = scratch.path().join("box.yaml");
    fs::write(&yaml, "image: box.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n").unwrap();
    let pixel =
        |i: usize| if i % 100 < 2 || i % 100 > 97 || i / 100 < 2 || i / 100 > 57 { 0 } else { 254_u8 };
    let pgm: Vec<u8> = b"P5\n100 60\n255\n".iter().copied().chain((0..6000).map(pixel)).collect();
    fs::write(scratch.path().join("box.pgm"), pgm).unwrap();
    let out = scratch.path().join("out");
    let refused = refusal(&["map", "merge", text(&yaml), text(&yaml), "--out", text(&out)]);
    assert!(refused.contains("several poses of this map fit") && refused.contains("X,Y,DEG"), "{refused}");
    assert!(!out.exists());
}

#[test]
fn a_house_has_rooms_with_names() {
    let scratch = tempfile::tempdir().unwrap();
    let map = scene("house", scratch.path());
    let out = scratch.path().join("rooms");
    let found = tool(&["rooms", text(&map)], &out);
    let rooms = found["rooms"].as_array().unwrap();
    assert!(rooms.len() >= 5, "{found}");
    let areas: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("rooms.geojson")).unwrap()).unwrap();
    let features = areas["features"].as_array().unwrap();
    assert_eq!(features.len(), rooms.len());
    assert_eq!(features[0]["properties"]["name"], "room 1");
    let corner = &features[1]["geometry"]["coordinates"][0];
    assert_eq!(corner[0], corner[corner.as_array().unwrap().len() - 1], "rings are closed");
    assert!(fs::read(out.join("rooms.png")).unwrap().starts_with(b"\x89PNG"));
    let places = scratch.path().join("places.toml");
    fs::write(&places, "[kitchen]\nx = 4\ny = 2\nheading_deg = 90\n").unwrap();
    let named = tool(&["rooms", text(&map), "--places", text(&places)], &out);
    assert!(named["rooms"].to_string().contains("kitchen"), "{named}");
    let zones = read_annotations(&out.join("zones.geojson")).unwrap();
    assert_eq!((zones.zones.len(), zones.places.len()), (rooms.len(), rooms.len()));
    let kitchen = zones.pose_of("kitchen").unwrap();
    assert!(
        kitchen.distance(&Pose2::new(4.0, 2.0, 0.0)) < 1e-6
            && (kitchen.theta.to_degrees() - 90.0).abs() < 1e-3
    );
    let (again, turned) = (scratch.path().join("again"), scratch.path().join("turned"));
    let written = out.join("zones.geojson");
    let same = tool(&["rooms", text(&map), "--places", text(&written)], &again);
    assert_eq!(same["rooms"], named["rooms"], "zones name the rooms they were made of");
    tool(&["rotate", text(&map), "--by=90", "--zones", text(&written)], &turned);
    let place = read_annotations(&turned.join("zones.geojson")).unwrap().pose_of("kitchen").unwrap();
    assert!(place.distance(&Pose2::new(-2.0, 4.0, 0.0)) < 1e-6, "{place:?}");
    let none = refusal(&["map", "rooms", text(&map), "--min-area=900", "--out", text(&out)]);
    assert!(none.contains("no room") && none.contains("--min-area"), "{none}");
}

#[test]
fn maps_of_other_programs_have_rooms() {
    let scratch = tempfile::tempdir().unwrap();
    for (name, least) in
        [("nav/mrpb/maps/office02_partially_unknown/map.yaml", 3), ("nav/nav2/depot.yaml", 1)]
    {
        let Some(map) = shared(name) else { continue };
        let found = tool(&["rooms", text(&map)], &scratch.path().join("rooms"));
        assert!(found["room_count"].as_u64().unwrap() >= least, "{name}: {found}");
    }
}

#[test]
fn tools_and_logs_do_not_mix() {
    assert!(refusal(&["map"]).contains("<LOG>"), "the log is named where neither is given");
    let both = refusal(&["map", "robot.log", "crop", "a.yaml", "--known", "--out", "x"]);
    assert!(both.contains("crop"), "{both}");
}
