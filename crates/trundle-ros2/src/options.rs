//! ROS 2 options of a program's command line.

use crate::Ros2Error;
use crate::node::{Names, Networks, NodeSettings, RosArguments};
use crate::outputs::FrameNames;

/// ROS 2 options of a program.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Ros2Options {
    /// Namespace, names, domain, networks.
    pub node: NodeSettings,
    /// Names of frames.
    pub frames: FrameNames,
    /// Whether `/clock` gives the time.
    pub use_sim_time: bool,
    /// Whether commands are `TwistStamped`, else `Twist`.
    pub stamped_commands: bool,
}

/// Parameters allowed after `--ros-args`.
const KNOWN: &str = "use_sim_time, enable_stamped_cmd_vel, map_frame, odom_frame, base_frame, camera_frame";

impl Ros2Options {
    /// Reads the arguments after `--ros-args`. Without `domain`, the variable ROS_DOMAIN_ID applies, else 0.
    ///
    /// # Errors
    /// Names the argument, parameter or domain that is not of the known forms.
    pub fn read(
        name: &str,
        domain: Option<u16>,
        networks: Networks,
        arguments: &[String],
    ) -> Result<Self, Ros2Error> {
        let read = RosArguments::parse(name, arguments)?;
        let mut options = Self {
            node: NodeSettings::new(Names::of_node(name), domain_id(domain)?, networks),
            frames: FrameNames::default(),
            use_sim_time: false,
            stamped_commands: true,
        };
        let is_known = |name: &str| KNOWN.split(", ").any(|known| known == name);
        let shared = read.shared_parameters.iter().filter(|(name, _)| is_known(name));
        for (name, value) in shared.chain(&read.parameters) {
            options.set(name, value)?;
        }
        options.node.names = read.names;
        Ok(options)
    }

    fn set(&mut self, name: &str, value: &str) -> Result<(), Ros2Error> {
        let flag = || {
            value.parse().map_err(|_| Ros2Error::Parameter {
                name: name.to_owned(),
                value: value.to_owned(),
                expected: "true or false",
            })
        };
        match name {
            "use_sim_time" => self.use_sim_time = flag()?,
            "enable_stamped_cmd_vel" => self.stamped_commands = flag()?,
            "map_frame" => self.frames.map = value.to_owned(),
            "odom_frame" => self.frames.odom = value.to_owned(),
            "base_frame" => self.frames.base = value.to_owned(),
            "camera_frame" => self.frames.camera = value.to_owned(),
            _ => {
                let (name, value) = (name.to_owned(), value.to_owned());
                return Err(Ros2Error::Parameter { name, value, expected: KNOWN });
            }
        }
        Ok(())
    }
}

/// The domain: the given one, else that of the environment, else 0.
fn domain_id(given: Option<u16>) -> Result<u16, Ros2Error> {
    let from_environment = || std::env::var("ROS_DOMAIN_ID").ok().filter(|value| !value.is_empty());
    match (given, from_environment()) {
        (Some(domain), _) => Ok(domain),
        (None, None) => Ok(0),
        (None, Some(value)) => value.parse().map_err(|_| Ros2Error::Parameter {
            name: "ROS_DOMAIN_ID".to_owned(),
            value,
            expected: "0 to 232",
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_set_options_and_unknown_ones_are_named() {
        let read = |text: &str| {
            let arguments: Vec<String> = text.split(' ').map(str::to_owned).collect();
            Ros2Options::read("trundle", Some(7), Networks::Loopback, &arguments)
        };
        let options = read("-p use_sim_time:=true -p base_frame:=base_footprint -r __ns:=/robot1").unwrap();
        assert!(options.use_sim_time && options.stamped_commands);
        assert_eq!((options.frames.base.as_str(), options.node.domain), ("base_footprint", 7));
        assert_eq!(options.node.names.namespace, "/robot1");
        assert!(read("-p use_sim_time:=maybe").unwrap_err().to_string().contains("expected true or false"));
        assert!(read("-p speed:=1").unwrap_err().to_string().starts_with("parameter speed is '1'"));
    }

    #[test]
    fn parameters_that_a_file_gives_to_all_nodes_may_be_unknown() {
        let file = std::env::temp_dir().join(format!("trundle-options-{}.yaml", std::process::id()));
        std::fs::write(&file, "/**:\n  ros__parameters:\n    use_sim_time: true\n    speed: 1\n").unwrap();
        let arguments = ["--params-file".to_owned(), file.display().to_string()];
        let read = Ros2Options::read("trundle", Some(7), Networks::Loopback, &arguments);
        std::fs::remove_file(&file).unwrap();
        assert!(read.unwrap().use_sim_time);
    }
}
