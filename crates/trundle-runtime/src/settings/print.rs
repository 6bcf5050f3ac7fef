//! Prints a robot file with the meaning of each key above it.

use super::reference::{Setting, reference};
use crate::RobotConfig;
use std::fmt::Write;
use toml::Value;

/// Width of the comments, characters. Source: ours.
const COMMENT_WIDTH: usize = 110;

/// The whole robot file as TOML. Each key has its meaning, unit, range and default as a comment; unset keys are comments too.
pub fn to_commented_toml(config: &RobotConfig) -> String {
    let root = Value::try_from(config).expect("invariant: the configuration is plain data");
    let mut text = String::new();
    let mut tables: Vec<&str> = Vec::new();
    for setting in reference() {
        if !tables.contains(&setting.table()) {
            tables.push(setting.table());
        }
    }
    for table in tables {
        if !table.is_empty() {
            let _ = writeln!(text, "\n[{table}]");
        }
        for setting in reference().iter().filter(|setting| setting.table() == table) {
            write_setting(&mut text, setting, value_at(&root, setting.path));
        }
    }
    text
}

fn write_setting(text: &mut String, setting: &Setting, value: Option<&Value>) {
    for line in wrapped(setting.doc) {
        let _ = writeln!(text, "# {line}");
    }
    if setting.kind.contains('|') {
        let choices: Vec<String> = setting.kind.split('|').map(|word| format!("\"{word}\"")).collect();
        let _ = writeln!(text, "# One of {}.", choices.join(", "));
    }
    let _ = match value {
        Some(value) => writeln!(text, "{} = {value}", setting.name()),
        None => writeln!(text, "# {} is not set", setting.name()),
    };
}

fn value_at<'a>(root: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').try_fold(root, |value, field| value.get(field))
}

fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.last_mut().expect("invariant: never empty");
        if !last.is_empty() && last.chars().count() + 1 + word.chars().count() > COMMENT_WIDTH {
            lines.push(word.to_owned());
        } else {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::RobotFile;

    #[test]
    fn printed_settings_read_back_the_same() {
        let text = to_commented_toml(&RobotConfig::default());
        let file = RobotFile::parse(&text, &[]).unwrap();
        assert_eq!(file.config, RobotConfig::default());
        assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    }

    #[test]
    fn every_value_stands_under_its_meaning() {
        let text = to_commented_toml(&RobotConfig::default());
        let at = text.find("wheel_radius_m = 0.035").unwrap();
        let comment = text[..at].rsplit("[drive]\n").next().unwrap();
        assert!(comment.starts_with("# Radius of the driven wheels, m, above 0"), "{comment}");
        assert!(comment.lines().all(|line| line.starts_with('#')), "{comment}");
        let values = text.lines().filter(|line| !line.starts_with('#') && line.contains(" = ")).count();
        let unset = text.lines().filter(|line| line.ends_with(" is not set")).count();
        assert_eq!(values + unset, reference().len());
    }
}
