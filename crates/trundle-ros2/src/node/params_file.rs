//! A parameter file of ROS 2: scalars below `ros__parameters` of nodes, in the block style of YAML. Lists and other styles are skipped.

use super::Names;

/// Key between the names of a node and those of its parameters.
const SECTION: &str = "ros__parameters";

/// Parameters of a file, by name.
#[derive(Debug, Default, PartialEq)]
pub(super) struct FileParameters {
    /// Those of all nodes, `/**`.
    pub(super) shared: Vec<(String, String)>,
    /// Those of the own node.
    pub(super) own: Vec<(String, String)>,
}

impl FileParameters {
    /// The parameters for the node of `names` in a file's text.
    ///
    /// # Errors
    /// When a section of the node is in another style of YAML.
    pub(super) fn of(text: &str, names: &Names) -> Result<Self, String> {
        let mut parameters = Self::default();
        for (path, value) in scalars(text) {
            let Some((node, name)) = path.split_once(&format!("/{SECTION}/")) else {
                let node = path.strip_suffix(SECTION).unwrap_or(&path).trim_end_matches('/');
                if value.starts_with('{') && value != "{}" && (node == "/**" || is_own(node, names)) {
                    return Err(format!("{path} is {value}, expected a line NAME: VALUE for each parameter"));
                }
                continue;
            };
            let parameter = (name.replace('/', "."), value);
            if node == "/**" {
                parameters.shared.push(parameter);
            } else if is_own(node, names) {
                parameters.own.push(parameter);
            }
        }
        Ok(parameters)
    }
}

/// Whether a section is that of the node: `trundle`, `/robot1/trundle`, `/**/trundle`.
fn is_own(node: &str, names: &Names) -> bool {
    let full = format!("{}/{}", names.namespace.trim_matches('/'), names.node);
    let node = node.strip_prefix("/**/").unwrap_or(node).trim_start_matches('/');
    node == full.trim_start_matches('/') || node == names.node
}

/// The scalars of a text with their keys, parted by `/`.
fn scalars(text: &str) -> Vec<(String, String)> {
    let mut above: Vec<(usize, &str)> = Vec::new();
    let mut found = Vec::new();
    for line in text.lines() {
        let line = line.split(" #").next().unwrap_or_default().trim_end();
        let text = line.trim_start();
        let Some((key, value)) = text.split_once(':').filter(|_| !text.starts_with('#')) else { continue };
        let indent = line.len() - text.len();
        let (key, value) = (unquoted(key), unquoted(value));
        while above.last().is_some_and(|(own, _)| *own >= indent) {
            above.pop();
        }
        if value.is_empty() {
            above.push((indent, key));
        } else {
            let keys: Vec<&str> = above.iter().map(|(_, key)| *key).chain([key]).collect();
            found.push((keys.join("/"), value.to_owned()));
        }
    }
    found
}

fn unquoted(text: &str) -> &str {
    text.trim().trim_matches(['"', '\''])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sections_of_all_nodes_and_of_the_own_one_are_read() {
        let text = "# of a launch file\n/**:\n  ros__parameters:\n    use_sim_time: true  # of a simulator\n    frames:\n      - map\n\
                    other:\n  ros__parameters:\n    base_frame: wrong\n\
                    robot2:\n  trundle:\n    ros__parameters:\n      base_frame: wrong\n\
                    /robot1/trundle:\n  ros__parameters:\n    base_frame: \"base_footprint\"\n    limits:\n      v_m_s: 0.2\n    map_frame: m\n";
        let mut names = Names::of_node("trundle");
        names.namespace = "/robot1".to_owned();
        let read = FileParameters::of(text, &names).unwrap();
        let list = |own: &[(&str, &str)]| -> Vec<(String, String)> {
            own.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
        };
        assert_eq!(read.shared, list(&[("use_sim_time", "true")]));
        let own = [("base_frame", "base_footprint"), ("limits.v_m_s", "0.2"), ("map_frame", "m")];
        assert_eq!(read.own, list(&own));
        let nested = "robot1:\n  trundle:\n    ros__parameters:\n      map_frame: m\n";
        assert_eq!(FileParameters::of(nested, &names).unwrap().own, list(&[("map_frame", "m")]));
        let none = FileParameters::of("trundle: {}\n: :\n - x\n\t\nother: {a: 1}", &names);
        assert_eq!(none, Ok(FileParameters::default()));
        let flow = FileParameters::of("/**: {ros__parameters: {use_sim_time: true}}", &names).unwrap_err();
        assert!(
            flow.starts_with("/** is {ros__parameters") && flow.contains("expected a line NAME: VALUE"),
            "{flow}"
        );
    }
}
