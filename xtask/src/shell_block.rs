//! Marks of the blocks `sh` in docs: each block runs in `cargo xtask book`, or says why it does not.

/// The language of such a block.
const LANGUAGE: &str = "sh";
/// Reasons why a block does not run in `cargo xtask book`. A path in place of a reason is the script that runs the commands.
const REASONS: [(&str, &str); 5] = [
    ("needs-a-robot", "a base, a camera, or images of them"),
    ("needs-ros-2", "programs of ROS 2"),
    ("needs-root", "packages, devices or services of the system"),
    ("needs-a-network", "other computers"),
    ("takes-minutes", "more than 20 s"),
];

/// What happens to a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ShellBlock {
    /// `sh tested`: `cargo xtask book` runs it.
    Tested {
        /// `interrupt=N`: each command that still runs after N seconds gets the signal of Ctrl-C \[s\].
        interrupt_s: Option<u32>,
        /// `in=clone`: it runs in the folder of the sources, not in that of the page.
        is_in_clone: bool,
    },
    /// `sh elsewhere=SCRIPT`: this script of the sources runs the commands.
    By(String),
    /// `sh elsewhere=REASON`: nothing runs it.
    NotRun,
}

/// Reads the words after a block's fence; `None` for a block of another language. The error names what is expected.
pub fn read(info: &[String]) -> Option<Result<ShellBlock, String>> {
    let (language, marks) = info.split_first()?;
    (language == LANGUAGE).then(|| mark(&marks.iter().map(String::as_str).collect::<Vec<_>>()))
}

fn mark(marks: &[&str]) -> Result<ShellBlock, String> {
    match marks {
        ["tested", further @ ..] => tested(further),
        [mark] if mark.starts_with("elsewhere=") => elsewhere(mark.trim_start_matches("elsewhere=")),
        _ => {
            let marks = marks.join(" ");
            Err(format!("a block `sh` is marked {marks:?}, expected `sh tested` or `sh elsewhere=REASON`"))
        }
    }
}

fn tested(further: &[&str]) -> Result<ShellBlock, String> {
    let (mut interrupt_s, mut is_in_clone) = (None, false);
    for mark in further {
        match mark.split_once('=') {
            Some(("interrupt", seconds)) if seconds.parse::<u32>().is_ok_and(|s| s > 0) => {
                interrupt_s = seconds.parse().ok();
            }
            Some(("in", "clone")) => is_in_clone = true,
            _ => {
                return Err(format!(
                    "`sh tested` is marked {mark:?}, expected interrupt=SECONDS or in=clone"
                ));
            }
        }
    }
    Ok(ShellBlock::Tested { interrupt_s, is_in_clone })
}

fn elsewhere(reason: &str) -> Result<ShellBlock, String> {
    if reason.contains('/') {
        return Ok(ShellBlock::By(reason.to_owned()));
    }
    let names = REASONS.map(|(name, _)| name);
    let is_known = names.contains(&reason);
    is_known.then_some(ShellBlock::NotRun).ok_or_else(|| {
        format!(
            "elsewhere={reason:?} of a block `sh`, expected the path of a script, or {}",
            names.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(info: &str) -> Option<Result<ShellBlock, String>> {
        read(&info.split(' ').map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn a_block_is_tested_or_says_why_not() {
        let tested = |interrupt_s, is_in_clone| Some(Ok(ShellBlock::Tested { interrupt_s, is_in_clone }));
        assert_eq!(of("sh tested"), tested(None, false));
        assert_eq!(of("sh tested interrupt=3 in=clone"), tested(Some(3), true));
        assert_eq!(of("sh elsewhere=needs-root"), Some(Ok(ShellBlock::NotRun)));
        assert_eq!(of("sh elsewhere=a/b.sh"), Some(Ok(ShellBlock::By("a/b.sh".into()))));
        assert_eq!(of("text output"), None);
    }

    #[test]
    fn unmarked_blocks_and_unknown_marks_are_refused_with_what_is_expected() {
        let refused = |info| of(info).unwrap().unwrap_err();
        assert!(refused("sh").contains("expected `sh tested` or `sh elsewhere=REASON`"));
        assert!(refused("sh tested interrupt=0").contains("interrupt=SECONDS"));
        assert!(refused("sh elsewhere=laziness").contains("needs-a-robot"));
    }
}
