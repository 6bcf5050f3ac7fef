//! The libraries for the tests.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

const CHILD: &str = "TRUNDLE_TEST_CHILD";

/// The folder that `bench/drivers/get-native-libraries.sh` fills.
pub fn folder() -> PathBuf {
    let target = || {
        let program = std::env::current_exe().unwrap();
        program.ancestors().nth(3).unwrap().join("native-libraries")
    };
    std::env::var_os("TRUNDLE_NATIVE_LIBRARIES").map_or_else(target, PathBuf::from)
}

/// Skips the test `name`, which needs `what`.
pub fn skip(name: &str, what: &str) {
    let message = format!("SKIPPED {name}: {what} is absent: run bench/drivers/get-native-libraries.sh");
    assert!(std::env::var_os("TRUNDLE_REQUIRE_NATIVE_LIBRARIES").is_none(), "{message}");
    println!("{message}");
}

/// The first file in `folder` whose name begins and ends so.
pub fn find(folder: &Path, prefix: &str, suffix: &str) -> Option<PathBuf> {
    let entries = std::fs::read_dir(folder).ok()?.flatten();
    entries.map(|entry| entry.path()).find(|path| {
        let name = path.file_name().unwrap().to_string_lossy();
        name.starts_with(prefix) && name.ends_with(suffix)
    })
}

/// A library from a Debian package.
pub fn debian(file: &str) -> Option<PathBuf> {
    let libraries = folder().join("debian/usr/lib");
    let machines = std::fs::read_dir(libraries).ok()?.flatten();
    machines.map(|machine| machine.path().join(file)).find(|path| path.exists())
}

/// libusb of the system, or else from the package.
pub fn libusb() -> Option<PathBuf> {
    let system = ["/lib", "/usr/lib"].iter().flat_map(|folder| {
        let machines = ["x86_64-linux-gnu", "aarch64-linux-gnu"];
        machines.map(|machine| Path::new(folder).join(machine).join("libusb-1.0.so.0"))
    });
    system.into_iter().find(|path| path.exists()).or_else(|| debian("libusb-1.0.so.0"))
}

/// A list of files for a setting.
pub fn list(files: &[PathBuf]) -> PathBuf {
    std::env::join_paths(files).unwrap().into()
}

/// Runs the test `name` again in a child process with additional environment variables; `true` in that process.
pub fn in_child(name: &str, environment: &[(&str, &OsStr)]) -> bool {
    if std::env::var_os(CHILD).is_some() {
        return true;
    }
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", name, "--nocapture"]).env(CHILD, "1").envs(environment.iter().copied());
    let output = command.output().unwrap();
    let text =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("1 passed"), "{} {text}", output.status);
    false
}
