//! `trundle plan` on map files: goals, zones, and stages.

use crate::program::{summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};
use trundle::core::Hypotenuse;

/// A room of 6 x 4 m with a wall across, open at the top.
pub fn write_room(folder: &std::path::Path) -> std::path::PathBuf {
    let (width, height) = (120, 80);
    let cell = |x: usize, y: usize| {
        let border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        if border || (x == 60 && y > 25) { 0u8 } else { 254 }
    };
    let mut pgm = format!("P5\n{width} {height}\n255\n").into_bytes();
    pgm.extend((0..height).flat_map(|y| (0..width).map(move |x| cell(x, y))));
    fs::write(folder.join("room.pgm"), pgm).unwrap();
    let yaml = "image: room.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    fs::write(folder.join("room.yaml"), yaml).unwrap();
    folder.join("room.yaml")
}

#[test]
fn a_plan_leads_around_the_wall() {
    let scratch = tempfile::tempdir().unwrap();
    let (map, out) = (write_room(scratch.path()), scratch.path().join("out"));
    let output =
        trundle(&["plan", text(&map), "--from=1,1,0", "--to=5,1,-90", "--quiet", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["waypoints.csv", "curve.csv", "coefficients.csv", "trajectory.csv", "plan.png"] {
        assert!(fs::metadata(out.join(name)).unwrap().len() > 20, "{name}");
    }
    let length = summary(&out)["length_m"].as_f64().unwrap();
    assert!(length > 5.0 && length < 9.0, "{length}");
    let trajectory = fs::read_to_string(out.join("trajectory.csv")).unwrap();
    let last: Vec<f64> = trajectory.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert!((last[1] - 5.0).hypotenuse(last[2] - 1.0) < 2e-3, "{last:?}");
    assert!((last[3] + std::f64::consts::FRAC_PI_2).abs() < 1e-3, "{last:?}");
}

/// A picture of one grey with a box of another, as a mask of the room.
fn write_mask(folder: &Path, name: &str, (clear, dark): (u8, u8), more: &str) -> PathBuf {
    let (width, height) = (120, 80);
    let cell = |x: usize, y: usize| if (62..90).contains(&x) && y < 25 { dark } else { clear };
    let mut pgm = format!("P5\n{width} {height}\n255\n").into_bytes();
    pgm.extend((0..height).flat_map(|y| (0..width).map(move |x| cell(x, y))));
    fs::write(folder.join(format!("{name}.pgm")), pgm).unwrap();
    let yaml = format!("image: {name}.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n{more}");
    fs::write(folder.join(format!("{name}.yaml")), yaml).unwrap();
    folder.join(format!("{name}.yaml"))
}

const TRINARY: &str = "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
const SCALE: &str = "mode: scale\noccupied_thresh: 1.0\nfree_thresh: 0.0\n";
const PLACES: &str =
    "[desk]\nx = 1.0\ny = 1.0\nheading_deg = 0\n[\"far door\"]\nx = 5.0\ny = 1.0\nheading_deg = -90\n";

struct Room {
    scratch: tempfile::TempDir,
    map: PathBuf,
    places: PathBuf,
}

impl Room {
    fn new() -> Self {
        let scratch = tempfile::tempdir().unwrap();
        let (map, places) = (write_room(scratch.path()), scratch.path().join("places.toml"));
        fs::write(&places, PLACES).unwrap();
        Self { scratch, map, places }
    }

    fn out(&self) -> PathBuf {
        self.scratch.path().join("out")
    }

    /// Runs `trundle plan` with the places; returns its standard output, or its error.
    fn plan(&self, more: &[&str]) -> Result<String, String> {
        let out = self.out();
        let base = ["plan", text(&self.map), "--places", text(&self.places), "--out", text(&out)];
        let output = trundle(&[&base, more].concat());
        let (stderr_text, complaint) =
            (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
        if output.status.success() { Ok(stderr_text) } else { Err(complaint) }
    }

    fn summary(&self) -> serde_json::Value {
        summary(&self.out())
    }
}

/// Rows of `trajectory.csv`: time, x, y, heading, v, omega.
fn trajectory(out: &Path) -> Vec<Vec<f64>> {
    let csv = fs::read_to_string(out.join("trajectory.csv")).unwrap();
    csv.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

#[test]
fn named_goals_are_driven_to_in_a_row_and_stages_are_timed() {
    let room = Room::new();
    let stderr_text =
        room.plan(&["--from", "desk", "--goal", "far door", "--goal=2,3,180", "--coefficients"]).unwrap();
    for word in ["distance field", "way-points", "curve", "timing", "x(u) = ", "u^5", "active constraints"] {
        assert!(stderr_text.contains(word), "{word}: {stderr_text}");
    }
    let summary = room.summary();
    assert_eq!(summary["goals"].as_array().unwrap().len(), 2);
    assert!(summary["wall_clock"]["curve_s"].as_f64().unwrap() > 0.0);
    for name in ["plan.png", "field.png", "corridors.png", "plan.html", "constraints.csv", "coefficients.csv"]
    {
        assert!(fs::metadata(room.out().join(name)).unwrap().len() > 20, "{name}");
    }
    let rows = trajectory(&room.out());
    let rests = rows.iter().any(|row| (row[1] - 5.0).hypotenuse(row[2] - 1.0) < 2e-3 && row[4] == 0.0);
    assert!(rests, "no rest at the far door");
    let last = &rows[rows.len() - 1];
    assert!((last[1] - 2.0).hypotenuse(last[2] - 3.0) < 2e-3, "{last:?}");
}

#[test]
fn masks_forbid_and_slow_down() {
    let room = Room::new();
    let forbidden = write_mask(room.scratch.path(), "keepout", (254, 0), TRINARY);
    // The only path leads through the mask's box above the wall.
    let complaint =
        room.plan(&["--from=desk", "--goal=far door", "--keepout", text(&forbidden)]).unwrap_err();
    assert!(
        complaint.contains("from 'desk' at (1, 1) m to 'far door' at (5, 1) m: no path to the goal"),
        "{complaint}"
    );
    let within = room.plan(&["--from=desk", "--goal=4,3.5,0", "--keepout", text(&forbidden)]).unwrap_err();
    assert!(within.contains("does not fit at the goal"), "{within}");
    let near = room.plan(&["--from=desk", "--goal=4,3.5,0", "--near=2", "--keepout", text(&forbidden)]);
    let stderr_text = near.unwrap();
    assert!(
        stderr_text.contains("goal 1 moved to") && stderr_text.contains("from the one asked for"),
        "{stderr_text}"
    );
    assert!(stderr_text.contains("the robot does not fit at the goal"), "{stderr_text}");
    assert!(room.summary()["goals_moved"][0]["off_m"].as_f64().unwrap() > 0.5);
    let reached = &room.summary()["reached"][0];
    assert!(reached["x"].as_f64().unwrap() < 3.4, "{reached}");
    let slow = write_mask(room.scratch.path(), "slow", (255, 26), SCALE);
    room.plan(&["--from=desk", "--goal=far door", "--speed-mask", text(&slow)]).unwrap();
    let rows = trajectory(&room.out());
    // Grey 26 of 255 is a value of 90: a tenth of the Kobuki's 0.7 m/s.
    let inside = |row: &&Vec<f64>| (3.11..4.49).contains(&row[1]) && row[2] > 2.76;
    let fastest = rows.iter().filter(inside).map(|row| row[4]).fold(0.0, f64::max);
    assert!(fastest > 0.05 && fastest <= 0.0701, "{fastest}");
    let black = write_mask(room.scratch.path(), "black", (255, 0), SCALE);
    let output = trundle(&[
        "plan",
        text(&room.map),
        "--from=1,1,0",
        "--goal=5,1,0",
        "--speed-mask",
        text(&black),
        "--out",
        text(&room.out()),
    ]);
    assert!(output.status.success());
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        complaint.contains("700 of 9600 cells") && complaint.contains("they set no limit"),
        "{complaint}"
    );
}

#[test]
fn no_plan_leaves_its_reason_and_nothing_of_an_earlier_plan() {
    let room = Room::new();
    let out = room.out();
    let ask = |more: &[&str]| {
        let base = ["plan", text(&room.map), "--from=1,1,0", "--out", text(&out)];
        let output = trundle(&[&base, more].concat());
        (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    fs::create_dir(&out).unwrap();
    fs::write(out.join("mine.txt"), "kept").unwrap();
    let (code, why) = ask(&["--goal=5,1,0"]);
    assert!(code == 2 && why.contains("mine.txt"), "a file that trundle did not write: {why}");
    fs::remove_file(out.join("mine.txt")).unwrap();
    let names = || {
        let mut names: Vec<_> =
            fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.retain(|name| !name.starts_with('.'));
        names.sort();
        names
    };
    assert_eq!(ask(&["--goal=5,1,0"]).0, 0);
    assert_eq!(names().len(), 11);
    // Bad input: no file is written or removed.
    assert_eq!(ask(&["--goal=5,1,0", "--keepout=nowhere.yaml"]).0, 2);
    assert_eq!(names().len(), 11);
    let mask = write_mask(room.scratch.path(), "keepout", (254, 0), TRINARY);
    let (code, why) = ask(&["--goal=5,1,0", "--keepout", text(&mask)]);
    assert!(code == 1 && why.contains("; without the keep-out mask there is one"), "{code} {why}");
    assert_eq!(names(), ["log.txt", "plan.png", "summary.json"]);
    let summary = room.summary();
    assert_eq!(summary["success"], false);
    assert!(
        summary["why"].as_str().unwrap().contains("no path to the goal")
            && summary["nearest_reachable_m"][0].is_f64()
    );
    let (code, why) = ask(&["--goal=4,3.5,0", "--keepout", text(&mask)]);
    assert!(
        code == 1 && why.contains("m of clearance are missing; it would without the keep-out mask"),
        "{code} {why}"
    );
    let (code, why) = ask(&["--goal=3,1,0", "--keepout", text(&mask)]);
    assert!(
        code == 1 && why.ends_with("m of clearance are missing\n"),
        "in a wall, mask or not: {code} {why}"
    );
}

/// Rows of numbers of a CSV file.
fn numbers(path: &Path) -> Vec<Vec<f64>> {
    let csv = fs::read_to_string(path).unwrap();
    csv.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

fn over(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// The printed polynomials are the drawn curve, and the printed constraints are active at the right places.
#[test]
fn coefficients_are_the_curve_and_active_constraints_are_active() {
    let room = Room::new();
    // Around the wall's end and back: corners that touch the wall.
    let stderr_text =
        room.plan(&["--from=desk", "--goal=3.5,0.8,-90", "--goal=2.5,0.6,180", "--coefficients"]).unwrap();
    // For each piece, as printed: x then y, increasing powers.
    let polynomials: Vec<Vec<f64>> = stderr_text
        .lines()
        .filter_map(|line| {
            line.trim().strip_prefix("x(u) = ").or_else(|| line.trim().strip_prefix("y(u) = "))
        })
        .map(|sum| {
            sum.split(' ').filter(|term| !term.starts_with('u')).map(|term| term.parse().unwrap()).collect()
        })
        .collect();
    let pieces: Vec<(&Vec<f64>, &Vec<f64>)> =
        polynomials.chunks(2).map(|axes| (&axes[0], &axes[1])).collect();
    let at = |c: &[f64], u: f64| c.iter().rev().fold(0.0, |sum, c| sum * u + c);
    let dense: Vec<(f64, f64)> = pieces
        .iter()
        .flat_map(|(x, y)| (0..=2000).map(move |k| f64::from(k) / 2000.0).map(move |u| (at(x, u), at(y, u))))
        .collect();
    let curve = numbers(&room.out().join("curve.csv"));
    assert!(curve.len() > 100 && pieces.len() > 5);
    for row in &curve {
        let off = dense.iter().map(|(x, y)| (x - row[2]).hypotenuse(y - row[3])).fold(9.0, f64::min);
        assert!(off < 1e-3, "{row:?}: {off}");
    }
    let table = numbers(&room.out().join("coefficients.csv"));
    let printed: usize = polynomials.iter().map(Vec::len).sum();
    assert_eq!(table.len() * 2, printed);
    // A control point of a curve and piece in the Bernstein basis.
    let control = |curve: f64, piece: f64, k: usize| {
        let rows: Vec<_> = table.iter().filter(|row| row[0] == curve && row[1] == piece).collect();
        let n = rows.len() - 1;
        let sum = |axis: usize| (0..=k).map(|i| over(k, i) / over(n, i) * rows[i][axis]).sum::<f64>();
        (sum(3), sum(4))
    };
    let active = numbers(&room.out().join("constraints.csv"));
    assert!(
        stderr_text.contains(&format!("multiplier in m^2: {}", active.len()))
            && !stderr_text.contains("0.00e0"),
        "{stderr_text}"
    );
    assert!(!active.is_empty());
    for row in &active {
        let (x, y) = control(row[0], row[1], row[2] as usize);
        let beyond = row[3] * x + row[4] * y - row[5];
        assert!(beyond.abs() < 1e-3 && row[6] > 0.0, "{beyond} m beyond: {row:?}");
        assert!((row[3].hypotenuse(row[4]) - 1.0).abs() < 1e-5, "{row:?}");
    }
}

/// Grey is costly: the path leads around it if the detour is short.
#[test]
fn grey_of_a_keep_out_mask_has_a_high_cost() {
    let room = Room::new();
    let grey = write_mask(room.scratch.path(), "grey", (255, 30), SCALE);
    let length = |more: &[&str]| {
        room.plan(&[&["--from=2.9,3.5,0", "--goal=4.6,3.5,0"], more].concat()).unwrap();
        room.summary()["length_m"].as_f64().unwrap()
    };
    let straight = length(&[]);
    let around = length(&["--keepout", text(&grey)]);
    assert!(straight < 1.75 && around > straight + 0.2, "{straight} {around}");
}

#[test]
fn a_turned_map_is_planned_on() {
    let room = Room::new();
    let turned = fs::read_to_string(&room.map).unwrap().replace("[0.0, 0.0, 0.0]", "[0.0, 0.0, 0.6]");
    let map = room.scratch.path().join("turned.yaml");
    fs::write(&map, turned).unwrap();
    let at = |x: f64, y: f64, deg: f64| {
        let (s, c) = 0.6_f64.sin_cos();
        format!("{},{},{}", c * x - s * y, s * x + c * y, deg + 0.6_f64.to_degrees())
    };
    let (from, goal) = (format!("--from={}", at(1.0, 1.0, 0.0)), format!("--goal={}", at(5.0, 1.0, -90.0)));
    let out = room.out();
    let output = trundle(&["plan", text(&map), &from, &goal, "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let length = room.summary()["length_m"].as_f64().unwrap();
    assert!(length > 5.0 && length < 9.0, "{length}");
}

#[test]
fn lanes_of_a_graph_file_are_kept_to() {
    let room = Room::new();
    let node = |id: u32, x: f64, y: f64| {
        format!(
            r#"{{"properties": {{"id": {id}, "frame": "map"}}, "geometry": {{"type": "Point", "coordinates": [{x}, {y}]}}}}"#
        )
    };
    let lane = |id: u32, a: u32, b: u32| {
        format!(
            r#"{{"properties": {{"id": {id}, "startid": {a}, "endid": {b}}}, "geometry": {{"type": "MultiLineString", "coordinates": []}}}}"#
        )
    };
    let features = [node(1, 1.0, 3.5), node(2, 3.0, 3.5), node(3, 5.0, 3.5), lane(4, 1, 2), lane(5, 2, 3)];
    let graph = room.scratch.path().join("lanes.geojson");
    fs::write(&graph, format!("{{\"type\": \"FeatureCollection\", \"features\": [{}]}}", features.join(",")))
        .unwrap();
    room.plan(&["--from=desk", "--goal=far door", "--graph", text(&graph)]).unwrap();
    let points = fs::read_to_string(room.out().join("waypoints.csv")).unwrap();
    assert!(points.contains("3.5"), "{points}");
    let back = room.plan(&["--from=far door", "--goal=desk", "--graph", text(&graph)]);
    assert!(back.is_err() || room.summary()["length_m"].as_f64().unwrap() > 5.0);
}

#[test]
fn errors_are_named_clearly() {
    let room = Room::new();
    let elsewhere = write_mask(room.scratch.path(), "beside", (254, 0), TRINARY);
    let yaml = fs::read_to_string(&elsewhere).unwrap().replace("[0.0, 0.0", "[50.0, 0.0");
    fs::write(&elsewhere, yaml).unwrap();
    let file = |name: &str, content: &str| {
        let path = room.scratch.path().join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let (none, zero) = (file("none.toml", ""), file("zero.geojson", ""));
    let empty = file("empty.geojson", r#"{"type": "FeatureCollection", "features": []}"#);
    let node = |id: u32, x: f64, y: f64| {
        format!(
            r#"{{"properties": {{"id": {id}}}, "geometry": {{"type": "Point", "coordinates": [{x}, {y}]}}}}"#
        )
    };
    let graph =
        |name: &str, nodes: [String; 2]| file(name, &format!(r#"{{"features": [{}]}}"#, nodes.join(",")));
    let degrees = graph("degrees.geojson", [node(1, 8.5401, 47.3701), node(2, 8.5403, 47.3702)]);
    let far = graph("far.geojson", [node(1, 80.0, 1.0), node(2, 90.0, 1.0)]);
    let out = room.out();
    let nowhere =
        ["plan", text(&room.map), "--from=1,1,0", "--goal=a", "--places", text(&none), "--out", text(&out)];
    let complaint = String::from_utf8(trundle(&nowhere).stderr).unwrap();
    assert!(complaint.contains("no place 'a'; the file has no place, expected tables [NAME]"), "{complaint}");
    for (arguments, message) in [
        (
            vec!["--from=desk", "--goal=desk", "--graph", text(&zero)],
            "zero.geojson: this is an empty file, expected a GeoJSON file of way-points",
        ),
        (
            vec!["--from=desk", "--goal=desk", "--graph", text(&empty)],
            "there is no node: the list `features` is empty",
        ),
        (
            vec!["--from=desk", "--goal=desk", "--graph", text(&degrees)],
            "no node lies on the map, the first is at (8.5401, 47.3701) m, the map has x 0.00 to 6.00 m, y 0.00 to 4.00 m: \
             all points lie within 0.2 mm: are they longitude and latitude in degrees?",
        ),
        (vec!["--from=desk", "--goal=desk", "--graph", text(&far)], "is it the graph of this map?"),
        (
            vec!["--from=desk", "--goal=8.54,47.37,0"],
            "the goal is off the map, which has x 0.00 to 6.00 m, y 0.00 to 4.00 m",
        ),
        (vec!["--from=desk", "--goal=kitchen"], "places.toml: no place 'kitchen'; there are: desk, far door"),
        (vec!["--from=desk", "--goal=1,2"], "2 numbers, expected 3: X,Y,DEG"),
        (vec!["--from=0.05,0.05,0", "--goal=desk"], "the robot does not fit at the start"),
        (vec!["--from=desk", "--goal=9,9,0"], "the goal is off the map"),
        (vec!["--from=-3,1,0", "--goal=desk"], "the start is off the map"),
        (
            vec!["--from=desk", "--goal=far door", "--goal=3.02,1,0"],
            "goal 2, from 'far door' at (5, 1) m to (3.02, 1) m: the robot does not fit at the goal",
        ),
        (
            vec!["--from=desk", "--goal=far door", "--keepout", text(&elsewhere)],
            "beside.yaml: the mask lies beside the map",
        ),
        (
            vec!["--from=desk", "--goal=desk", "--graph", "nowhere.geojson"],
            "cannot read nowhere.geojson: it does not exist",
        ),
        (vec!["--from=desk"], "--goal"),
    ] {
        let complaint = room.plan(&arguments).unwrap_err();
        assert!(complaint.contains(message), "{arguments:?}: {complaint}");
    }
    let bare = trundle(&["plan", text(&room.map), "--from=desk", "--goal=1,1,0", "--out", text(&room.out())]);
    assert!(
        String::from_utf8_lossy(&bare.stderr)
            .contains("'desk' is not a pose X,Y,DEG; to name a place, give its file with --places")
    );
}
