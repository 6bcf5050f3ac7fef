//! Commands that pages of docs show: blocks of `sh tested` run, and blocks of `text output` are compared with their output.

use super::page_run::PageRun;
use crate::markdown::{Block, blocks, pages};
use crate::workspace::Verdict;
use std::path::Path;

/// A step of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// A script that runs.
    Script,
    /// Lines that the last script must have printed.
    Output,
}

/// Runs the tested commands of each page, with `trundle` first in the path. Returns whether all pages pass.
pub fn run(root: &Path, trundle: &Path) -> Verdict {
    let mut is_well = true;
    for page in pages(&root.join("docs"))? {
        let text =
            std::fs::read_to_string(&page).map_err(|e| format!("cannot read {}: {e}", page.display()))?;
        let name = page.strip_prefix(root).unwrap_or(&page).display().to_string();
        if let Err(why) = run_page(root, trundle, &name, &text)? {
            println!("{name}:{why}");
            is_well = false;
        }
    }
    Ok(is_well)
}

/// Runs the steps of one page, up to the first that fails: its line and the reason.
fn run_page(root: &Path, trundle: &Path, name: &str, text: &str) -> Result<Result<(), String>, String> {
    let steps: Vec<(Step, Block)> =
        blocks(text).into_iter().filter_map(|block| Some((step(&block)?, block))).collect();
    if steps.is_empty() {
        return Ok(Ok(()));
    }
    let mut run = PageRun::new(root, trundle, name)?;
    for (step, block) in steps {
        let result = match step {
            Step::Script => run.script(&block.text)?,
            Step::Output => run.compare(&block.text),
        };
        if let Err(why) = result {
            return Ok(Err(format!("{}: {why}", block.line)));
        }
    }
    Ok(Ok(()))
}

fn step(block: &Block) -> Option<Step> {
    match block.info.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["sh", "tested"] => Some(Step::Script),
        ["text", "output"] => Some(Step::Output),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(text: &str) -> Result<(), String> {
        let name = format!("test-{}", std::thread::current().name().unwrap_or("page"));
        run_page(&crate::workspace::root(), Path::new("/bin/true"), &name, text).unwrap()
    }

    #[test]
    fn a_page_passes_if_its_scripts_and_their_output_do() {
        let text = "```sh tested\nprintf 'a  1\\nb 2\\nc 3\\n' > x; cat x\n```\n```text output\n  a 1\n...\nc 3\n```\n```sh\nfalse\n```";
        assert_eq!(page(text), Ok(()));
    }

    #[test]
    fn a_failed_script_and_a_missing_line_are_named_by_the_line_of_their_block() {
        let failed = page("text\n```sh tested\necho here; false; echo there\n```\n").unwrap_err();
        assert!(failed.starts_with("2: exit code 1") && failed.contains("here"), "{failed}");
        let missing = page("```sh tested\necho a; echo b\n```\n```text output\nb\na\n```\n").unwrap_err();
        assert!(missing.starts_with("4: the output has no line \"a\""), "{missing}");
    }
}
