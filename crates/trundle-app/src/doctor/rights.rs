//! Rights to devices: groups of the user, and the udev rules.

use super::check::Check;
use super::system::System;

/// Groups with rights to devices: the name, and what its members may open. Source: Debian's and Ubuntu's groups.
const GROUPS: [(&str, &str); 2] = [("dialout", "serial ports"), ("video", "cameras")];
/// Places of the rules of `trundle devices --udev`: by hand, and by the package.
const RULE_FILES: [&str; 3] = [
    "/etc/udev/rules.d/60-trundle.rules",
    "/usr/lib/udev/rules.d/60-trundle.rules",
    "/lib/udev/rules.d/60-trundle.rules",
];

/// Checks of groups and rules.
pub fn check(system: &System) -> Vec<Check> {
    let status = system.text("/proc/self/status").unwrap_or_default();
    let groups = system.text("/etc/group").unwrap_or_default();
    let mut checks: Vec<Check> =
        GROUPS.into_iter().map(|(name, what)| group(&status, &groups, name, what)).collect();
    checks.push(rules(system));
    checks
}

/// The check of one group; the administrator needs none.
fn group(status: &str, groups: &str, name: &str, what: &str) -> Check {
    let topic = "rights";
    let user = numbers(status, "Uid:").get(1).copied();
    if user == Some(0) {
        return Check::ok(topic, format!("the administrator may open {what}"));
    }
    let Some(id) = groups.lines().find_map(|line| group_id(line, name)) else {
        let remedy = format!("sudo groupadd --system {name}, if a device needs it");
        return Check::warning(topic, format!("no group {name}, whose members may open {what}"), remedy);
    };
    let own = [numbers(status, "Groups:"), numbers(status, "Gid:")].concat();
    if own.contains(&id) {
        return Check::ok(topic, format!("a member of {name} may open {what}"));
    }
    let remedy = format!("sudo usermod -aG {name} $USER, then log in again");
    Check::warning(topic, format!("the user is not in {name}, whose members may open {what}"), remedy)
}

/// Numbers of a line of `/proc/self/status`.
fn numbers(status: &str, name: &str) -> Vec<u32> {
    let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_default();
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Number of a group, if the line of `/etc/group` is its.
fn group_id(line: &str, name: &str) -> Option<u32> {
    let mut fields = line.split(':');
    (fields.next()? == name).then(|| fields.nth(1)?.parse().ok()).flatten()
}

fn rules(system: &System) -> Check {
    let topic = "udev rules";
    match RULE_FILES.into_iter().find(|path| system.exists(path)) {
        Some(path) => Check::ok(topic, path),
        None => Check::warning(
            topic,
            format!("{} is absent", RULE_FILES[0]),
            "trundle devices --udev | sudo tee /etc/udev/rules.d/60-trundle.rules",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;

    const STATUS: &str =
        "Name:\ttrundle\nUid:\t1000\t1000\t1000\t1000\nGid:\t1000\t1000\t1000\t1000\nGroups:\t20 1000 \n";

    #[test]
    fn groups_of_the_user_are_read() {
        let groups = "root:x:0:\ndialout:x:20:ann\nvideo:x:44:\n";
        assert_eq!(group(STATUS, groups, "dialout", "serial ports").level, CheckLevel::Ok);
        let video = group(STATUS, groups, "video", "cameras");
        assert!(video.level == CheckLevel::Warning && video.remedy.unwrap().contains("usermod -aG video"));
        assert!(group(STATUS, "", "video", "cameras").finding.starts_with("no group video"));
        let root = STATUS.replace("1000", "0");
        assert_eq!(group(&root, groups, "video", "cameras").level, CheckLevel::Ok);
        assert_eq!(group_id("video:x", "video"), None);
    }
}
