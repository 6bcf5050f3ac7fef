//! Variables of ROS 2: the domain, the middleware and the range of the search for other nodes.

use super::check::Check;
use super::system::System;

/// Largest domain. Source: RTPS 2.3, 9.6.1.1: ports end at 65535.
const MAX_DOMAIN: u16 = 232;
/// Middlewares that speak DDS, as trundle does. Source: REP 2000.
const DDS_MIDDLEWARES: [&str; 6] = [
    "rmw_fastrtps_cpp",
    "rmw_fastrtps_dynamic_cpp",
    "rmw_cyclonedds_cpp",
    "rmw_connextdds",
    "rmw_gurumdds_cpp",
    "rmw_dds_common",
];
/// Ranges of the search. Source: ROS 2, `ROS_AUTOMATIC_DISCOVERY_RANGE`.
const RANGES: [&str; 4] = ["SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT"];

/// Checks of the variables.
pub fn check(system: &System) -> Vec<Check> {
    vec![domain(system), middleware(system), range(system)]
}

fn domain(system: &System) -> Check {
    let topic = "ROS domain";
    match system.variable("ROS_DOMAIN_ID") {
        None => Check::ok(topic, "ROS_DOMAIN_ID is not set: domain 0"),
        Some(text) => match text.parse::<u16>() {
            Ok(domain) if domain <= MAX_DOMAIN => Check::ok(topic, format!("domain {domain}")),
            _ => Check::problem(
                topic,
                format!("ROS_DOMAIN_ID is {text:?}, expected 0 to {MAX_DOMAIN}"),
                "export ROS_DOMAIN_ID=0",
            ),
        },
    }
}

fn middleware(system: &System) -> Check {
    let topic = "ROS middleware";
    match system.variable("RMW_IMPLEMENTATION") {
        None => Check::ok(topic, "RMW_IMPLEMENTATION is not set: ROS 2 uses DDS, as trundle does"),
        Some(name) if DDS_MIDDLEWARES.contains(&name) => {
            Check::ok(topic, format!("{name} speaks DDS, as trundle does"))
        }
        Some(name) => Check::warning(
            topic,
            format!("RMW_IMPLEMENTATION is {name:?}, trundle speaks DDS"),
            "export RMW_IMPLEMENTATION=rmw_fastrtps_cpp in the other programs",
        ),
    }
}

fn range(system: &System) -> Check {
    let topic = "ROS range";
    match system.variable("ROS_AUTOMATIC_DISCOVERY_RANGE") {
        None => Check::ok(topic, "ROS_AUTOMATIC_DISCOVERY_RANGE is not set; trundle uses --ros-interface"),
        Some(range) if RANGES.contains(&range) => {
            Check::ok(topic, format!("{range}; trundle uses --ros-interface"))
        }
        Some(range) => Check::warning(
            topic,
            format!("ROS_AUTOMATIC_DISCOVERY_RANGE is {range:?}, expected one of {}", RANGES.join(", ")),
            "export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::doctor::check::CheckLevel;
    use std::path::Path;

    #[test]
    fn wrong_domains_are_problems_and_other_middlewares_warnings() {
        let levels = |variables: &[(&str, &str)]| {
            let checks = check(&System::of(Path::new("/"), variables));
            checks.iter().map(|check| check.level).collect::<Vec<_>>()
        };
        use CheckLevel::{Ok, Problem, Warning};
        assert_eq!(levels(&[]), [Ok, Ok, Ok]);
        assert_eq!(
            levels(&[("ROS_DOMAIN_ID", "232"), ("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")]),
            [Ok, Warning, Ok]
        );
        let wrong = [("ROS_DOMAIN_ID", "233"), ("ROS_AUTOMATIC_DISCOVERY_RANGE", "everywhere")];
        assert_eq!(levels(&wrong), [Problem, Ok, Warning]);
    }
}
