//! Every target reads its seeds and the committed inputs without a panic.

use trundle_fuzz::TARGETS;
use trundle_fuzz::corpus::committed_inputs;

#[test]
fn no_seed_and_no_committed_input_is_a_panic() {
    for target in TARGETS {
        for input in committed_inputs(&target) {
            (target.run)(&input);
            for end in [input.len() / 3, input.len().saturating_sub(1)] {
                (target.run)(&input[..end]);
            }
        }
    }
}

#[test]
fn every_name_is_there_once() {
    let mut names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), TARGETS.len());
}

#[test]
fn every_target_has_its_file_for_libfuzzer() {
    let fuzz = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz");
    let manifest = std::fs::read_to_string(fuzz.join("Cargo.toml")).unwrap();
    for target in TARGETS {
        assert!(fuzz.join("fuzz_targets").join(format!("{}.rs", target.name)).is_file(), "{}", target.name);
        assert!(manifest.contains(&format!("name = \"{}\"", target.name)), "{}", target.name);
    }
}
