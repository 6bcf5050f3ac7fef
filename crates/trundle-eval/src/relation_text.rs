//! Reader and writer of relation files in the text format of the SLAM benchmark of \[Kuemmerle09\].

use crate::Relation;
use std::fmt::Write;
use thiserror::Error;
use trundle_core::{Pose3, Stamp, Vector3};

/// A line of a relation file that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: {problem}")]
pub struct RelationTextError {
    /// The line, from 1.
    pub line: usize,
    /// The problem.
    pub problem: String,
}

/// The relations of a text in the format of the SLAM benchmark of \[Kuemmerle09\]. Each line is `from_time to_time x y z roll pitch yaw`
/// (s, s, m, rad); `#` starts a comment.
///
/// # Errors
/// With the line, when a field is missing, too many or no finite number.
pub fn relations_from_text(text: &str) -> Result<Vec<Relation>, RelationTextError> {
    let content = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    content
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .map(|(line, content)| relation(content).map_err(|problem| RelationTextError { line, problem }))
        .collect()
}

fn relation(line: &str) -> Result<Relation, String> {
    const NAMES: [&str; 8] = ["from_time", "to_time", "x", "y", "z", "roll", "pitch", "yaw"];
    let fields: Vec<&str> = line.split_whitespace().collect();
    if fields.len() != NAMES.len() {
        return Err(format!("{} fields, expected 8: {}", fields.len(), NAMES.join(" ")));
    }
    let mut values = [0.0; 8];
    for ((value, text), name) in values.iter_mut().zip(&fields).zip(NAMES) {
        let number = text.parse::<f64>().ok().filter(|v| v.is_finite());
        let short: String = text.chars().take(40).collect();
        *value = number.ok_or_else(|| format!("{name} is '{short}', expected a finite number"))?;
    }
    let [_, _, x, y, z, roll, pitch, yaw] = values;
    let rotation = nalgebra::UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    Ok(Relation {
        from: stamp(fields[0], "from_time")?,
        to: stamp(fields[1], "to_time")?,
        relative: Pose3::new(rotation, Vector3::new(x, y, z)),
    })
}

/// Decimal seconds, exact to the nanosecond for plain digits.
fn stamp(text: &str, name: &str) -> Result<Stamp, String> {
    let exact = || {
        let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
        let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
        if whole.is_empty() || whole.len() > 10 || !digits(whole) || !digits(fraction) {
            return None;
        }
        let nanos = format!("{fraction:0<9}").get(..9)?.parse::<i64>().ok()?;
        whole.parse::<i64>().ok()?.checked_mul(1_000_000_000)?.checked_add(nanos).map(Stamp::from_nanos)
    };
    let rounded = || Stamp::from_secs(text.parse().ok()?);
    exact().or_else(rounded).ok_or_else(|| format!("{name} is {text} s, out of range"))
}

/// The text of [`relations_from_text`].
pub fn relations_text(relations: &[Relation]) -> String {
    let mut text = String::from("# from_time to_time x y z roll pitch yaw\n");
    for Relation { from, to, relative } in relations {
        let (roll, pitch, yaw) = relative.rotation.euler_angles();
        let t = relative.translation;
        writeln!(text, "{from} {to} {} {} {} {roll} {pitch} {yaw}", t.x, t.y, t.z)
            .expect("invariant: a String takes any text");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_line_of_the_benchmark() {
        let relations =
            relations_from_text("# x\n\n1031745824.658 1031745827.297 0.57 -0.001 0 0 0 0.0058\n").unwrap();
        let Relation { from, to, relative } = relations[0];
        assert_eq!((from.nanos, to.nanos), (1_031_745_824_658_000_000, 1_031_745_827_297_000_000));
        assert_eq!(relative.translation, Vector3::new(0.57, -0.001, 0.0));
        assert!((relative.angle() - 0.0058).abs() < 1e-9);
        let again = relations_from_text(&relations_text(&relations)).unwrap();
        assert_eq!((again[0].from, again[0].to), (from, to));
        assert!((again[0].relative.inverse() * relative).log().norm() < 1e-12);
    }

    #[test]
    fn errors_name_line_and_field() {
        let problem = |text: &str| relations_from_text(text).unwrap_err().to_string();
        assert_eq!(
            problem("#\n1 2 3"),
            "line 2: 3 fields, expected 8: from_time to_time x y z roll pitch yaw"
        );
        assert_eq!(problem("1 2 0 0 0 0 0 nan"), "line 1: yaw is 'nan', expected a finite number");
        assert_eq!(problem("1e300 2 0 0 0 0 0 0"), "line 1: from_time is 1e300 s, out of range");
    }

    proptest! {
        #[test]
        fn any_text_does_not_panic(text in "[0-9 .e#a\n-]{0,80}") {
            let _ = relations_from_text(&text);
        }
    }
}
