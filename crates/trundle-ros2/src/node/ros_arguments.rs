//! The arguments after `--ros-args`: `-r FROM:=TO`, `-r __ns:=/NS`, `-r __node:=NAME`, `-p NAME:=VALUE`.

use super::Names;
use crate::Ros2Error;

/// Values that the arguments set.
#[derive(Debug, Clone, PartialEq)]
pub struct RosArguments {
    /// Namespace, node name and rules.
    pub names: Names,
    /// Parameters by name, as given.
    pub parameters: Vec<(String, String)>,
}

impl RosArguments {
    /// Reads the arguments into the names of the node `node`.
    ///
    /// # Errors
    /// Names an argument that is not of the known forms.
    pub fn parse(node: &str, arguments: &[String]) -> Result<Self, Ros2Error> {
        let mut parsed = Self { names: Names::of_node(node), parameters: Vec::new() };
        let mut arguments = arguments.iter().map(String::as_str).filter(|argument| *argument != "--ros-args");
        while let Some(flag) = arguments.next() {
            let value = arguments.next().unwrap_or_default();
            match (flag, value.split_once(":=")) {
                ("-r" | "--remap", Some((from, to))) if !to.is_empty() => parsed.add_rule(from, to),
                ("-p" | "--param", Some((name, value))) => {
                    parsed.parameters.push((name.to_owned(), value.to_owned()));
                }
                _ => {
                    return Err(Ros2Error::Argument {
                        argument: format!("{flag} {value}").trim().to_owned(),
                    });
                }
            }
        }
        Ok(parsed)
    }

    /// The value of a parameter; the last one counts.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&str> {
        self.parameters.iter().rev().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    fn add_rule(&mut self, from: &str, to: &str) {
        match from {
            "__ns" => self.names.namespace = format!("/{}", to.trim_matches('/')),
            "__node" | "__name" => self.names.node = to.to_owned(),
            _ => self.names.rules.push((from.to_owned(), to.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<RosArguments, Ros2Error> {
        let arguments: Vec<String> = text.split(' ').map(str::to_owned).collect();
        RosArguments::parse("trundle", &arguments)
    }

    #[test]
    fn rules_and_parameters_are_read() {
        let read = parse(
            "--ros-args -r odom:=wheel/odom -r __ns:=/robot1 --remap __node:=nav -p use_sim_time:=true",
        )
        .unwrap();
        assert_eq!(read.names.resolve("odom"), "/robot1/wheel/odom");
        assert_eq!((read.names.node.as_str(), read.parameter("use_sim_time")), ("nav", Some("true")));
        for bad in ["-r odom", "-q x:=y", "-r", "-r odom:="] {
            assert!(parse(bad).unwrap_err().to_string().contains(bad.split(' ').next().unwrap()), "{bad}");
        }
    }
}
