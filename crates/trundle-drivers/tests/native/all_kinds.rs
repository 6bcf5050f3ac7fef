//! Reports and cameras of all kinds, as the program's own environment leads to the libraries.

use crate::support::{debian, folder, in_child, skip};
use trundle_drivers::camera::CameraError;
use trundle_drivers::camera::native::{LibraryState, NativeKind, Selection, list_devices, open, reports};

#[test]
fn each_library_is_reported_with_its_file_or_the_way_to_get_it() {
    let reports = reports();
    assert_eq!(reports.len(), NativeKind::ALL.len());
    for report in reports {
        let text = report.to_string();
        assert!(text.starts_with(report.name), "{text}");
        match report.state {
            LibraryState::Usable { file, .. } => assert!(text.contains(&file.display().to_string())),
            LibraryState::Unusable { problem } => {
                assert!(problem.contains("install") && problem.contains(report.name), "{problem}");
            }
        }
    }
}

#[test]
fn wheels_and_variables_lead_to_the_libraries() {
    const NAME: &str = "all_kinds::wheels_and_variables_lead_to_the_libraries";
    let (python, fakenect) = (folder().join("python"), debian("fakenect/libfreenect.so.0.5"));
    let Some(fakenect) = fakenect.filter(|_| python.join("pyorbbecsdk").exists()) else {
        return skip(NAME, "the package libfreenect0.5 or the wheel pyorbbecsdk2");
    };
    let environment =
        [("TRUNDLE_PYTHON_WHEELS", python.as_os_str()), ("TRUNDLE_FREENECT_LIB", fakenect.as_os_str())];
    if !in_child(NAME, &environment) {
        return;
    }
    let found: Vec<_> = reports();
    let [_, freenect, orbbec, ..] = found.as_slice() else { panic!("{found:?}") };
    assert!(freenect.is_usable() && freenect.to_string().contains("fakenect"), "{freenect}");
    assert!(orbbec.is_usable() && orbbec.to_string().contains("pyorbbecsdk"), "{orbbec}");
    assert_eq!(list_devices(NativeKind::Orbbec).unwrap(), []);
    let nothing = open(NativeKind::Orbbec, &Selection::First).err().unwrap();
    assert!(matches!(nothing, CameraError::NoDevice { .. }), "{nothing}");
}
