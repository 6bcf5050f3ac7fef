//! Files of settings and robots: what cannot be read is refused with file, line and value.

use std::path::{Path, PathBuf};
use trundle_app::{AppError, load_robot, read_text, read_toml};
use trundle_runtime::Schedule;

fn file(folder: &tempfile::TempDir, text: &str) -> PathBuf {
    let path = folder.path().join("robot.toml");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_toml_file_is_read_and_a_wrong_one_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let good: Schedule = read_toml(&file(&folder, "# rates\nmap_hz = 3.0\n")).unwrap();
    assert_eq!(good.map_hz, 3.0);
    for (text, line) in [("map_hz = 3.0\nmap_rate = 1.0\n", 2), ("\n\nmap_hz = \"fast\"\n", 3)] {
        let path = file(&folder, text);
        let error = read_toml::<Schedule>(&path).unwrap_err().to_string();
        assert!(error.starts_with(&format!("{}, line {line}: ", path.display())), "{error}");
        assert!(!error.contains('\n'), "one sentence: {error}");
        assert!(!error.contains("f64") && !error.contains("field"), "words of Rust: {error}");
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = read_text(Path::new("no/such/robot.toml")).unwrap_err().to_string();
    assert!(error.contains("no/such/robot.toml"), "{error}");
}

#[test]
fn without_a_file_the_robot_is_the_default_one_with_the_overrides() {
    let robot = load_robot(None, &["schedule.map_hz=3".to_owned()]).unwrap();
    assert_eq!(robot.schedule.map_hz, 3.0);
    let error = load_robot(None, &["schedule.map_hz=300".to_owned()]).unwrap_err().to_string();
    assert!(error.contains("map_hz") && error.contains("300"), "{error}");
}

#[test]
fn overrides_win_over_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "[schedule]\nmap_hz = 3.0\ncheck_hz = 4.0\n");
    let robot = load_robot(Some(&path), &["schedule.map_hz=2".to_owned()]).unwrap();
    assert_eq!((robot.schedule.map_hz, robot.schedule.check_hz), (2.0, 4.0));
}

#[test]
fn a_wrong_robot_file_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "[schedule]\nmap_hz = 3.0\nmap_rate = 1.0\n");
    let error = load_robot(Some(&path), &[]).unwrap_err().to_string();
    assert!(error.starts_with(&path.display().to_string()) && error.contains("line 3"), "{error}");
}

#[test]
fn a_context_goes_in_front_of_what_was_put_in_and_not_of_a_files_name() {
    let input = AppError::input("no number").in_context(&"goal 2");
    assert_eq!(input.to_string(), "goal 2: no number");
    let system = read_text(Path::new("no/such/file")).unwrap_err();
    let text = system.to_string();
    assert_eq!(system.in_context(&"goal 2").to_string(), text, "the file is named already");
}
