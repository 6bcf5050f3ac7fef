//! `trundle dock` on scans and maps.

use crate::plan::write_room;
use crate::program::{refusal, summary, text, trundle};
use std::fs;
use trundle::core::Hypotenuse;

/// A robot of 0.6 x 0.4 m in a corridor of 1 m, 10 cm to the side of its goal.
const PROBLEM: &str = "trundle-corridors 1
problem beside
footprint 0.3 0.2 -0.3 0.2 -0.3 -0.2 0.3 -0.2
start -0.1 0 90
goal 0.1 0 90
wall -0.5 -1.5 -0.5 1.5
wall 0.5 -1.5 0.5 1.5
";

#[test]
fn a_robot_beside_its_goal_gets_there_step_by_step() {
    let scratch = tempfile::tempdir().unwrap();
    let (file, out) = (scratch.path().join("beside.txt"), scratch.path().join("out"));
    fs::write(&file, PROBLEM).unwrap();
    let output = trundle(&["dock", text(&file), "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let message = String::from_utf8(output.stdout).unwrap();
    assert!(message.contains("step") && message.contains("planned in"), "{message}");
    let found = summary(&out);
    let (time, bound) = (found["duration_s"].as_f64().unwrap(), found["bound_s"].as_f64().unwrap());
    assert!(bound > 0.0 && bound <= time + 1e-9, "{bound} {time}");
    let steps = fs::read_to_string(out.join("steps.csv")).unwrap();
    let last: Vec<f64> = steps.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert!((last[4] - 0.1).hypotenuse(last[5]) < 1e-6, "{last:?}");
    assert!(fs::metadata(out.join("dock.png")).unwrap().len() > 1000);
}

#[test]
fn on_a_map_too_and_a_wall_between_is_a_reason() {
    let scratch = tempfile::tempdir().unwrap();
    let (map, out) = (write_room(scratch.path()), scratch.path().join("out"));
    let dock = |from: &str, to: &str| {
        trundle(&[
            "dock",
            text(&map),
            from,
            to,
            "--footprint=0.3,0.2 -0.3,0.2 -0.3,-0.2 0.3,-0.2",
            "--out",
            text(&out),
        ])
    };
    assert_eq!(dock("--from=1,1,0", "--to=1.2,1.15,0").status.code(), Some(0));
    let (here, there) = ("--from=2.6,0.6,90", "--to=3.5,0.6,90");
    assert_eq!(dock(here, there).status.code(), Some(0), "around the wall's end");
    assert!(out.join("steps.csv").exists());
    let picture = scratch.path().join("room.pgm");
    let mut cells = fs::read(&picture).unwrap();
    let header = cells.len() - 120 * 80;
    (0..80).for_each(|y| cells[header + 120 * y + 60] = 0);
    fs::write(&picture, cells).unwrap();
    let apart = dock(here, there);
    assert_eq!(apart.status.code(), Some(1), "{}", String::from_utf8_lossy(&apart.stderr));
    assert!(String::from_utf8_lossy(&apart.stdout).contains("No manoeuvre"));
    assert!(!out.join("steps.csv").exists() && !out.join("steps.png").exists(), "those of an earlier one");
}

#[test]
fn a_start_or_goal_that_does_not_fit_ends_as_in_plan_with_a_picture_and_the_reason() {
    let scratch = tempfile::tempdir().unwrap();
    let (map, out) = (write_room(scratch.path()), scratch.path().join("out"));
    let file = scratch.path().join("beside.txt");
    fs::write(&file, PROBLEM).unwrap();
    for (place, from, to, reason) in [
        (&map, "--from=0.1,1,0", "--to=1,1,0", "the start overlaps the occupied cell at (0.025, "),
        (&map, "--from=1,1,0", "--to=3.02,0.5,0", "the goal overlaps the occupied cell at (3.0"),
        (&map, "--from=1,1,0", "--to=-30,1,0", "the goal (-30.00, 1.00) m is off the map"),
        (&map, "--from=1,1,0", "--to=-1e5,1,0", "the goal (-100000.00, 1.00) m is off the map"),
        (&file, "--from=0,0,90", "--to=40,30,0", "plan a path there first"),
    ] {
        let output = trundle(&["dock", text(place), from, to, "--out", text(&out)]);
        let sentence = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{from} {to}: {sentence}");
        assert!(sentence.contains(reason), "{sentence}");
        let written = summary(&out);
        assert!(written["reason"].as_str().unwrap().contains(reason), "{written}");
        assert!(written["success"] == false && out.join("dock.png").exists());
    }
    let plan = ["plan", text(&map), "--from=0.1,1,0", "--goal=1,1,0", "--out", text(&out)];
    assert_eq!(trundle(&plan).status.code(), Some(1), "the same decision");
}

#[test]
fn bad_tasks_are_refused_with_their_reason() {
    let scratch = tempfile::tempdir().unwrap();
    let map = write_room(scratch.path());
    let file = scratch.path().join("beside.txt");
    fs::write(&file, PROBLEM).unwrap();
    let message = |extra: &[&str]| refusal(&[&["dock"], extra].concat());
    assert!(message(&[text(&map)]).contains("a map needs --from and --to"));
    assert!(message(&[text(&file), "--problem=x"]).contains("it has no problem 'x'"));
    let shaped = |corners: &str| message(&[text(&file), "--footprint", corners]);
    assert!(shaped("0.3,0.2 -0.3,0.2 0,0.1 -0.3,-0.2 0.3,-0.2").contains("expected convex"));
    assert!(shaped("0,0 1,0 2,0").contains("area is 0 m^2"));
    assert!(message(&["nowhere.txt"]).contains("cannot read nowhere.txt: it does not exist"));
    fs::write(&file, PROBLEM.replace("start -0.1 0 90", "start NaN 0 90")).unwrap();
    assert!(message(&[text(&file)]).contains("line 4"));
    fs::write(&file, format!("{PROBLEM}\nwall 0 0 1 NaN\n")).unwrap();
    assert!(message(&[text(&file)]).contains("finite numbers"));
}

#[test]
fn the_papers_corridor_experiment_holds() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let output = trundle(&["experiment", "corridor", "--quiet", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for name in ["a-paper.png", "d-optimal.png", "b-paper.csv", "corridor.csv", "report.html", "summary.json"]
    {
        assert!(out.join(name).exists(), "{name}");
    }
    let (paper, optimal) = (&summary(&out)["a-paper"]["time_s"], &summary(&out)["a-optimal"]["time_s"]);
    assert!(optimal.as_f64().unwrap() <= paper.as_f64().unwrap() + 1e-9);
}

/// A laser 0.5 m from a wall on its left and another on its right.
#[test]
fn among_the_points_of_a_scan_too() {
    let scratch = tempfile::tempdir().unwrap();
    let (log, out) = (scratch.path().join("robot.log"), scratch.path().join("out"));
    let range = |i: usize| 0.5 / (i as f64 - 89.5).to_radians().sin().abs();
    let ranges: Vec<String> = (0..180).map(|i| format!("{:.3}", range(i).min(8.0))).collect();
    let line = format!("FLASER 180 {} 0 0 0 0 0 0 1.0 host 1.0\n", ranges.join(" "));
    fs::write(&log, line).unwrap();
    let dock = ["dock", text(&log), "--to=0.3,0.05,0", "--footprint=0.2", "--out", text(&out)];
    let output = trundle(&dock);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(summary(&out)["duration_s"].as_f64().unwrap() > 1.0);
    assert!(refusal(&[&dock[..], &["--scan", "9"]].concat()).contains("it has no scan 9, only 1 to 1"));
    assert!(refusal(&["dock", text(&log), "--footprint=0.2"]).contains("a scan needs --to"));
}

#[test]
fn built_in_problems_are_written_and_read() {
    let scratch = tempfile::tempdir().unwrap();
    let (file, out) = (scratch.path().join("corridor.txt"), scratch.path().join("out"));
    assert!(trundle(&["dock", "hong24-a", "--write-problem", text(&file)]).status.success());
    let output =
        trundle(&["dock", text(&file), "--problem", "hong24-a", "--method=paper", "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(summary(&out)["motions"].as_array().unwrap().len(), 4);
    let there = trundle(&["dock", "hong24-a", "--to=-0.1,0,90", "--out", text(&out)]);
    assert!(String::from_utf8_lossy(&there.stdout).contains("Already there"));
    fs::write(&file, PROBLEM.replace("goal 0.1 0 90\n", "")).unwrap();
    let message = refusal(&["dock", text(&file)]);
    assert!(message.contains("`goal`"), "{message}");
}

/// A written problem is the problem that would have been solved.
#[test]
fn a_problem_is_written_as_it_was_asked_for() {
    let scratch = tempfile::tempdir().unwrap();
    let (map, file) = (write_room(scratch.path()), scratch.path().join("task.txt"));
    let write = |place: &str, extra: &[&str]| {
        let output = trundle(&[&["dock", place, "--write-problem", text(&file)], extra].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(&file).unwrap()
    };
    let asked = ["--from=-0.1,0.05,90", "--to=0.12,0,90", "--footprint=0.2"];
    let written = write("hong24-a", &asked);
    for line in ["disc 0.2\n", "start -0.1 0.05 90\n", "goal 0.12 0 90\n", "problem hong24-a\n"] {
        assert!(written.contains(line), "{line} in {written}");
    }
    let of_map = write(text(&map), &["--from=1,1,0", "--to=1.2,1.15,0", "--footprint=0.2"]);
    assert!(of_map.contains("start 1 1 0\n") && of_map.contains("\nwall "), "{of_map}");
    let out = scratch.path().join("out");
    assert!(trundle(&["dock", text(&file), "--out", text(&out)]).status.success());
}

#[test]
fn options_that_mean_nothing_here_are_refused() {
    let message = |extra: &[&str]| refusal(&[&["dock", "hong24-a"], extra].concat());
    assert!(
        message(&["--problem=x"])
            .contains("--problem goes with a file of problems, this is a built-in problem")
    );
    assert!(message(&["--scan=1"]).contains("--scan goes with a laser log"));
    assert!(message(&["--through-unknown"]).contains("--through-unknown goes with a map"));
    assert!(message(&["--margin=0.9"]).contains("docking.margin is 0.9 m"));
}

#[test]
fn the_robot_files_planner_counts() {
    let scratch = tempfile::tempdir().unwrap();
    let (robot, out) = (scratch.path().join("robot.toml"), scratch.path().join("out"));
    fs::write(&robot, "[docking.planner]\nmargin = 0.03\n").unwrap();
    let output = trundle(&["dock", "hong24-a", "--config", text(&robot), "--out", text(&out)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!((summary(&out)["margin_m"].as_f64().unwrap() - 0.03).abs() < 1e-9);
}
