//! The arguments after `--ros-args`: `-r FROM:=TO`, `-r __ns:=/NS`, `-r __node:=NAME`, `-p NAME:=VALUE`, `--params-file FILE`.

use super::Names;
use super::params_file::FileParameters;
use crate::Ros2Error;
use std::path::Path;
use trundle_io::read_text;

/// Values that the arguments set.
#[derive(Debug, Clone, PartialEq)]
pub struct RosArguments {
    /// Namespace, node name and rules.
    pub names: Names,
    /// Parameters by name, as given: those of files first.
    pub parameters: Vec<(String, String)>,
    /// Parameters that files give to all nodes, of which a node uses those that it has.
    pub shared_parameters: Vec<(String, String)>,
}

impl RosArguments {
    /// Reads the arguments into the names of the node `node`. A level of a log has no effect.
    ///
    /// # Errors
    /// Names an argument that is not of the known forms, or a file that cannot be read.
    pub fn parse(node: &str, arguments: &[String]) -> Result<Self, Ros2Error> {
        let (names, mut given, mut files) = (Names::of_node(node), Vec::new(), Vec::new());
        let mut parsed = Self { names, parameters: Vec::new(), shared_parameters: Vec::new() };
        let mut arguments = arguments.iter().map(String::as_str).filter(|argument| *argument != "--ros-args");
        while let Some(flag) = arguments.next() {
            let value = arguments.next().unwrap_or_default();
            match (flag, value.split_once(":=")) {
                ("-r" | "--remap", Some((from, to))) if !to.is_empty() => parsed.add_rule(from, to),
                ("-p" | "--param", Some((name, value))) => given.push((name.to_owned(), value.to_owned())),
                ("--params-file", _) if !value.is_empty() => files.push(Path::new(value)),
                ("--log-level", _) if !value.is_empty() => {}
                _ => {
                    return Err(Ros2Error::Argument {
                        argument: format!("{flag} {value}").trim().to_owned(),
                    });
                }
            }
        }
        // The names of the node are complete only now.
        for file in files {
            let text = read_text(file).map_err(|error| Ros2Error::ParameterFile(error.to_string()))?;
            let read = FileParameters::of(&text, &parsed.names);
            let named = |problem| Ros2Error::ParameterFile(format!("{}: {problem}", file.display()));
            let FileParameters { shared, own } = read.map_err(named)?;
            parsed.shared_parameters.extend(shared);
            parsed.parameters.extend(own);
        }
        parsed.parameters.extend(given);
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
        assert!(parse("--log-level info --log-level rcl:=debug").unwrap().parameters.is_empty());
        for bad in ["--params-file", "--log-level", "-r odom", "-q x:=y", "-r", "-r odom:="] {
            assert!(parse(bad).unwrap_err().to_string().contains(bad.split(' ').next().unwrap()), "{bad}");
        }
    }

    #[test]
    fn parameters_of_files_come_before_those_of_the_command_line() {
        let file = std::env::temp_dir().join(format!("trundle-params-{}.yaml", std::process::id()));
        let text = "/**:\n  ros__parameters:\n    use_sim_time: true\nnav:\n  ros__parameters:\n    base_frame: base\n";
        std::fs::write(&file, text).unwrap();
        let read = parse(&format!("--params-file {} -r __node:=nav -p map_frame:=m", file.display()));
        std::fs::remove_file(&file).unwrap();
        let read = read.unwrap();
        let names: Vec<&str> = read.parameters.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!((names, read.parameter("base_frame")), (vec!["base_frame", "map_frame"], Some("base")));
        assert_eq!(read.shared_parameters, [("use_sim_time".to_owned(), "true".to_owned())]);
        let missing = parse("--params-file /nowhere/params.yaml").unwrap_err().to_string();
        assert!(missing.contains("/nowhere/params.yaml"), "{missing}");
    }
}
