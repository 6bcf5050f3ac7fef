//! Names of topics and services: namespace and remapping rules.

use crate::Ros2Error;
use ros2_client::Name;

/// Namespace, node name and remapping rules.
#[derive(Debug, Clone, PartialEq)]
pub struct Names {
    /// Namespace of the node: `/` or `/robot1`.
    pub namespace: String,
    /// Name of the node.
    pub node: String,
    /// Rules `from:=to`, in order. The first that fits counts.
    pub rules: Vec<(String, String)>,
}

impl Names {
    /// Names in the namespace `/` without rules.
    #[must_use]
    pub fn of_node(node: &str) -> Self {
        Self { namespace: "/".to_owned(), node: node.to_owned(), rules: Vec::new() }
    }

    /// The full name of a topic or service: `odom` is `/robot1/odom` in the namespace `/robot1`, `/tf` is unchanged, `~/x` is below the
    /// node's name.
    #[must_use]
    pub fn resolve(&self, name: &str) -> String {
        let full = self.full(name);
        let rule = self.rules.iter().find(|(from, _)| self.full(from) == full);
        rule.map_or(full, |(_, to)| self.full(to))
    }

    /// The resolved name in the client library's type.
    ///
    /// # Errors
    /// When the name has characters that ROS 2 does not allow.
    pub fn parsed(&self, name: &str) -> Result<Name, Ros2Error> {
        let full = self.resolve(name);
        Name::parse(&full).map_err(|error| Ros2Error::Name { name: full, problem: error.to_string() })
    }

    fn full(&self, name: &str) -> String {
        let space = self.namespace.trim_end_matches('/');
        if let Some(private) = name.strip_prefix("~/") {
            format!("{space}/{}/{private}", self.node)
        } else if name.starts_with('/') {
            name.to_owned()
        } else {
            format!("{space}/{name}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_namespace_and_rules() {
        let mut names = Names::of_node("trundle");
        assert_eq!(names.resolve("odom"), "/odom");
        names.namespace = "/robot1".to_owned();
        names.rules = vec![("scan".into(), "front/scan".into()), ("/tf".into(), "tf".into())];
        assert_eq!(names.resolve("odom"), "/robot1/odom");
        assert_eq!(names.resolve("scan"), "/robot1/front/scan");
        assert_eq!(names.resolve("/robot1/scan"), "/robot1/front/scan");
        assert_eq!(names.resolve("/tf"), "/robot1/tf");
        assert_eq!(names.resolve("~/state"), "/robot1/trundle/state");
        assert!(names.parsed("a b").unwrap_err().to_string().contains("/robot1/a b"));
    }
}
