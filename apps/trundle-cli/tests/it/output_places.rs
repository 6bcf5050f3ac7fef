//! Outputs are checked before the work, and options without effect are refused.

use crate::program::{refusal, summary, text, trundle};
use std::fs;
use std::path::{Path, PathBuf};

/// A recorded drive of four images.
fn recorded(folder: &Path) -> PathBuf {
    let place = folder.join("recorded");
    let args = ["sim", "demo", "--quiet", "--duration", "1", "--rate", "4", "--record", text(&place)];
    assert!(trundle(&args).status.success());
    place
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_work_of_every_command() {
    let scratch = tempfile::tempdir().unwrap();
    let data = recorded(scratch.path());
    let (file, out) = (scratch.path().join("file"), scratch.path().join("out"));
    fs::write(&file, "mine").unwrap();
    let below = |name: &str| file.join(name).display().to_string();
    let (glb, ply, tree, png) = (below("x.glb"), below("x.ply"), below("x.bt"), below("x.png"));
    let (yaml, toml, any) = (below("x.yaml"), below("x.toml"), below("x"));
    let mcap = data.join("no-recording.mcap");
    let slam = ["slam", text(&data), "--out", text(&out)];
    let (slam_any, convert) = (["slam", text(&data), "--out", &any], ["convert", text(&data), &any]);
    let commands: [&[&str]; 13] = [
        &[&slam[..], &["--mesh", &glb]].concat(),
        &[&slam[..], &["--cloud", &ply]].concat(),
        &[&slam[..], &["--octomap", &tree]].concat(),
        &[&slam[..], &["--heights", &png]].concat(),
        &slam_any,
        &convert,
        &["map", text(&data), "--out", &any],
        &["sim", "demo", "--map", &yaml],
        &["demo", "--checkpoint", &any, "--out", text(&out)],
        &["dock", "hong24-a", "--write-problem", &any],
        &["calibrate", "mount", text(&mcap), "--write", &toml],
        &["calibrate", "board", "checkerboard:9x6:25mm", "--out", &any],
        &["vocabulary", "train", "--scene", "room", "--out", &any],
    ];
    for args in commands {
        let message = refusal(args);
        assert!(
            message.contains("cannot be written: a file is in the way") && message.contains(text(&file)),
            "{message}"
        );
    }
    let folder = refusal(&[&slam[..], &["--mesh", text(&data)]].concat());
    assert!(folder.contains("this is a folder"), "{folder}");
    let mut names: Vec<_> = fs::read_dir(scratch.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["file", "recorded"], "nothing is written");
}

#[test]
fn a_surface_in_the_output_folder_belongs_to_it() {
    let scratch = tempfile::tempdir().unwrap();
    let data = recorded(scratch.path());
    let (out, kept) = (scratch.path().join("out"), scratch.path().join("out.1"));
    let (mesh, heights) = (out.join("x.glb"), out.join("deep/h.png"));
    let slam = ["slam", text(&data), "--quiet", "--out", text(&out)];
    let args = [&slam[..], &["--mesh", text(&mesh), "--heights", text(&heights)]].concat();
    for _ in 0..2 {
        let output = trundle(&args);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(fs::metadata(&mesh).unwrap().len() > 1000 && heights.exists());
        assert!(out.join("deep/h.png.yaml").exists());
    }
    assert!(kept.join("x.glb").exists(), "the surface of the last run is kept with it");
    let map = refusal(&[&slam[..], &["--heights", text(&out.join("map.png"))]].concat());
    assert!(map.contains("map.png: this is the picture of the map, expected another name"), "{map}");
    let last = refusal(&[&slam[..], &["--mesh", text(&kept.join("x.glb"))]].concat());
    assert!(last.contains("in which the last run is kept") && !last.contains("input"), "{last}");
    let demo = refusal(&["demo", "--out", text(&out), "--checkpoint", text(&out.join("robot.state"))]);
    assert!(demo.contains("the folder of the results, which is replaced as a whole"), "{demo}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_for_the_surface_keeps_all_other_results() {
    let scratch = tempfile::tempdir().unwrap();
    let data = recorded(scratch.path());
    let (out, full, mesh) =
        (scratch.path().join("out"), scratch.path().join("x.ply"), scratch.path().join("x.glb"));
    std::os::unix::fs::symlink("/dev/full", &full).unwrap();
    let args = ["slam", text(&data), "--out", text(&out), "--cloud", text(&full), "--mesh", text(&mesh)];
    let output = trundle(&args);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(
        message.contains("x.ply: the disk is full") && message.contains("the other results are in"),
        "{message}"
    );
    assert!(out.join("map.yaml").exists() && mesh.exists());
    assert_eq!(summary(&out)["success"], true);
}

#[test]
fn options_without_effect_are_refused() {
    let scratch = tempfile::tempdir().unwrap();
    let data = recorded(scratch.path());
    let out = scratch.path().join("out");
    let slam = |option: &[&str]| refusal(&[&["slam", text(&data), "--out", text(&out)], option].concat());
    assert!(slam(&["--voxel", "0.05"]).contains("--voxel 0.05 m has no effect without a surface"));
    assert!(slam(&["--recover"]).contains("--recover has no effect on"));
    assert!(slam(&["--depth-topic", "/d"]).contains("--depth-topic /d has no effect on"));
    for option in [&["--resolution", "0.1"][..], &["--band", "0.1", "0.5"], &["--map-image", "png"]] {
        let message = refusal(&[&["sim", "demo"], option].concat());
        assert!(message.contains("--map <FILE.yaml>"), "{option:?}: {message}");
    }
    let scale = refusal(&["sim", "demo", "--scale", "0.01", "--duration", "1"]);
    assert!(scale.contains("--scale 0.01 has no effect on this scene"), "{scale}");
    for option in ["--out=x", "--method=paper", "--margin=0.1"] {
        let message = refusal(&["dock", "hong24-a", "--write-problem", "x.txt", option]);
        assert!(message.contains("cannot be used with"), "{message}");
    }
    assert!(!out.exists());
}
