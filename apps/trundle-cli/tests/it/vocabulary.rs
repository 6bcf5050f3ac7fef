//! `trundle vocabulary`: training, exchange with DBoW2, and wrong files.

use crate::program::{refusal, text, trundle};
use std::fs;
use std::path::Path;

fn ran(args: &[&str]) -> String {
    let output = trundle(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn train(out: &Path, more: &[&str]) {
    let few = ["vocabulary", "train", "--scene", "room", "--views", "4", "--features-per-image", "300"];
    let shape = ["--branching", "6", "--depth", "3", "--quiet", "--out", text(out)];
    ran(&[&few[..], &shape, more].concat());
}

#[test]
fn a_trained_vocabulary_is_the_same_on_any_number_of_threads_and_survives_exchange() {
    let scratch = tempfile::tempdir().unwrap();
    let file = |name: &str| scratch.path().join(name);
    let (one, three, other) = (file("one.voc"), file("deeper/three.voc"), file("other.voc"));
    train(&one, &["--threads", "1"]);
    train(&three, &["--threads", "3"]);
    train(&other, &["--threads", "1", "--seed", "2"]);
    let bytes = fs::read(&one).unwrap();
    assert!(bytes == fs::read(&three).unwrap(), "threads changed the bytes");
    assert!(bytes != fs::read(&other).unwrap(), "the seed changes nothing");
    assert!(ran(&["vocabulary", "info", text(&one)]).contains("words"));
    let (exported, imported) = (file("one.txt"), file("again.voc"));
    ran(&["vocabulary", "export", text(&one), "--dbow2", text(&exported)]);
    assert!(fs::read_to_string(&exported).unwrap().starts_with("6 3 0 0\n0 0 "));
    ran(&["vocabulary", "import", text(&exported), "--out", text(&imported)]);
    assert!(bytes == fs::read(&imported).unwrap(), "exchange changed the bytes");
    let output =
        ran(&["vocabulary", "recall", "--vocabulary", text(&one), "--scene", "room", "--views", "4", "-q"]);
    assert!(output.contains("room 1") && output.contains(" %"), "{output}");
}

#[test]
fn descriptors_of_another_program_can_be_trained_on() {
    let scratch = tempfile::tempdir().unwrap();
    let (folder, out) = (scratch.path().join("made"), scratch.path().join("own.voc"));
    fs::create_dir(&folder).unwrap();
    for image in 0..3_u8 {
        let byte = |i: u8| (i / 32).wrapping_mul(37).wrapping_add(i % 32) ^ image;
        fs::write(folder.join(format!("{image}.orb")), (0..224).map(byte).collect::<Vec<u8>>()).unwrap();
    }
    let train =
        ["vocabulary", "train", "--descriptors", text(&folder), "--branching", "2", "--out", text(&out)];
    assert!(ran(&train).contains("from 21 descriptors of 3 images"));
    fs::write(folder.join("3.orb"), [0; 33]).unwrap();
    assert!(refusal(&train).contains("3.orb: 33 bytes, expected 32 a descriptor"));
}

#[test]
fn the_programs_own_vocabulary_is_the_default() {
    let output = ran(&["vocabulary", "info"]);
    let bytes: usize =
        output.split_once("size").unwrap().1.split_whitespace().next().unwrap().parse().unwrap();
    assert!((100_000..=12_000_000).contains(&bytes), "{output}");
}

#[test]
fn bad_input_is_named_and_leaves_no_file() {
    let scratch = tempfile::tempdir().unwrap();
    let (out, broken) = (scratch.path().join("new.voc"), scratch.path().join("broken.voc"));
    let refused = |args: &[&str]| refusal(&[&["vocabulary"], args].concat());
    let trained = |more: &[&str]| refused(&[&["train", "--quiet", "--out", text(&out)], more].concat());
    assert!(trained(&[]).contains("no images: name a TUM RGB-D folder or a --scene"));
    assert!(trained(&["/nowhere"]).contains("cannot read /nowhere"));
    assert!(trained(&[text(scratch.path())]).contains("this is an empty folder"));
    assert!(trained(&["--scene", "moon"]).contains("scene is moon, expected one of demo, room"));
    assert!(trained(&["--scene", "room.glb"]).contains("room.glb"));
    assert!(trained(&["--scene", "room", "--branching", "1"]).contains("vocabulary.branching is 1"));
    let few = ["--scene", "room", "--views", "1", "--branching", "64", "--features-per-image", "100"];
    assert!(trained(&few).contains("expected 128 or more"), "{}", trained(&few));
    assert!(!out.exists());
    fs::write(&broken, "trundle").unwrap();
    assert!(
        refused(&["info", text(&broken)])
            .contains("broken.voc: this is a text file of no known kind, expected a visual vocabulary")
    );
    assert!(refused(&["info", "/nowhere"]).contains("cannot read /nowhere"));
    let import = ["import", text(&broken), "--out", text(&out)];
    assert!(refused(&import).contains("broken.voc: line 1: 'trundle' is not a number of its kind"));
    let export = ["export", "--dbow2", text(scratch.path())];
    assert!(refused(&export).contains("is a folder, expected the name of a file"));
    assert!(refused(&["recall", "--quiet"]).contains("no images"));
    assert!(!out.exists());
}

#[test]
fn commands_that_recognise_places_take_a_vocabulary() {
    let scratch = tempfile::tempdir().unwrap();
    let file = scratch.path().join("broken.voc");
    fs::write(&file, "no vocabulary").unwrap();
    fs::write(scratch.path().join("rgb.txt"), "1.0 a.png\n").unwrap();
    fs::write(scratch.path().join("depth.txt"), "1.0 b.png\n").unwrap();
    for command in [&["demo", "--direct"][..], &["slam", text(scratch.path())]] {
        let sentence = refusal(&[command, &["--vocabulary", text(&file)]].concat());
        assert!(
            sentence
                .contains("broken.voc: this is a text file of no known kind, expected a visual vocabulary"),
            "{command:?}: {sentence}"
        );
    }
}

#[test]
fn vocabularies_of_another_kind_are_refused_with_what_to_do() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("ORBvoc.txt");
    let out = scratch.path().join("o.voc");
    let asked = ["vocabulary", "info", text(&path)];
    assert!(!refusal(&asked).contains("os error"), "{}", refusal(&asked));
    fs::write(&path, format!("10 6 0 0\n0 0{} 0.5\n", " 7".repeat(32))).unwrap();
    let dbow2 = refusal(&asked);
    assert!(dbow2.contains("DBoW2") && dbow2.contains("trundle vocabulary import"), "{dbow2}");
    let recall = refusal(&["vocabulary", "recall", "--scene", "room", "--vocabulary", text(&path)]);
    assert!(recall.contains("trundle vocabulary import"), "{recall}");
    fs::write(&path, b"\x89PNG\r\n\x1a\n\0\xff").unwrap();
    let import = ["vocabulary", "import", text(&path), "--out", text(&out)];
    assert!(refusal(&import).contains("a PNG picture"), "{}", refusal(&import));
    let train = ["vocabulary", "train", "--descriptors", text(&path), "--out", text(&out)];
    assert!(refusal(&train).contains("expected a folder of descriptors"), "{}", refusal(&train));
}
