//! Commands that pages of docs show: blocks of `sh tested` run, and blocks of `text output` are compared with their output. With the mark
//! `interrupt=N` each command of the block gets Ctrl-C after N seconds; with `in=clone` the block runs in the folder of the sources.

use super::interrupted;
use super::page_run::PageRun;
use crate::markdown::{Block, blocks, pages};
use crate::shell_block::{self, ShellBlock};
use crate::workspace::Verdict;
use std::path::Path;

/// A step of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Step {
    /// A script that runs, in the page's folder or in that of the sources.
    Script { text: String, is_in_clone: bool },
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
            Step::Script { text, is_in_clone: true } => run.script_in_clone(&text)?,
            Step::Script { text, is_in_clone: false } => run.script(&text)?,
            Step::Output => run.compare(&block.text),
        };
        if let Err(why) = result {
            return Ok(Err(format!("{}: {why}", block.line)));
        }
    }
    Ok(Ok(()))
}

fn step(block: &Block) -> Option<Step> {
    if block.info == ["text", "output"] {
        return Some(Step::Output);
    }
    // Tidy refuses a wrong mark.
    let Some(Ok(ShellBlock::Tested { interrupt_s, is_in_clone })) = shell_block::read(&block.info) else {
        return None;
    };
    let text = interrupt_s.map(|seconds| interrupted::script(&block.text, seconds));
    Some(Step::Script { text: text.unwrap_or_else(|| block.text.clone()), is_in_clone })
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
    fn marks_give_the_folder_and_an_end() {
        assert_eq!(
            page("```sh tested in=clone\ntest -f Cargo.lock\n```\n```sh tested interrupt=1\ntrue\n```"),
            Ok(())
        );
        assert!(page("```sh tested\ntest -f Cargo.lock\n```").is_err());
        let lasting =
            "```sh tested interrupt=1\nsh -c 'trap \"exit 130\" INT; while :; do sleep 0.05; done'\n```";
        assert_eq!(page(lasting), Ok(()));
    }

    #[test]
    fn a_failed_script_and_a_missing_line_are_named_by_the_line_of_their_block() {
        let failed = page("text\n```sh tested\necho here; false; echo there\n```\n").unwrap_err();
        assert!(failed.starts_with("2: exit code 1") && failed.contains("here"), "{failed}");
        let missing = page("```sh tested\necho a; echo b\n```\n```text output\nb\na\n```\n").unwrap_err();
        assert!(missing.starts_with("4: the output has no line \"a\""), "{missing}");
    }
}
