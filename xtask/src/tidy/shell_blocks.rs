//! Commands in docs: each block of them runs in `cargo xtask book`, or says where else or why not.

use super::finding::Finding;
use super::tree::{File, Tree};
use crate::markdown::{Block, blocks};
use crate::shell_block::{self, ShellBlock};

/// First words of a line that is a command, in a block without a language.
const PROGRAMS: [&str; 4] = ["trundle", "cargo", "bash", "python3"];

/// Checks the marks of the blocks `sh` below `docs`, and that no block without a language holds commands.
pub fn check(tree: &Tree) -> Vec<Finding> {
    let pages = tree.ending(".md").filter(|page| page.path.starts_with("docs/"));
    pages
        .flat_map(|page| blocks(&page.text).into_iter().filter_map(|block| finding(tree, page, &block)))
        .collect()
}

fn finding(tree: &Tree, page: &File, block: &Block) -> Option<Finding> {
    let message = match shell_block::read(&block.info) {
        None => has_hidden_commands(block).then(|| {
            "commands in a block without a language, expected `sh tested` or `sh elsewhere=REASON`".into()
        }),
        Some(Err(why)) => Some(why),
        Some(Ok(ShellBlock::By(script))) if tree.file(&script).is_none() => {
            Some(format!("elsewhere={script:?}: the script is gone, expected one that runs the commands"))
        }
        Some(Ok(_)) => None,
    };
    message.map(|message| Finding::error(&page.path, block.line, message))
}

fn has_hidden_commands(block: &Block) -> bool {
    let is_command = |line: &str| {
        let mut words = line.split(' ');
        words.next().is_some_and(|first| PROGRAMS.contains(&first)) && words.next().is_some()
    };
    block.info.iter().all(String::is_empty) && block.text.lines().any(is_command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::tree::tests::tree;

    #[test]
    fn unmarked_and_hidden_commands_and_lost_scripts_are_found() {
        let page = "```sh\na\n```\n```sh tested\na\n```\n```\ntrundle demo\n```\n```\ntrundle-corridors 1\n```\n\
                    ```sh elsewhere=a/gone.sh\nb\n```\n```sh elsewhere=a/b.sh\nb\n```\n";
        let tree = tree(&[("docs/a.md", page), ("README.md", "```sh\na\n```\n"), ("a/b.sh", "")]);
        let lines: Vec<String> = check(&tree).iter().map(Finding::to_string).collect();
        assert_eq!(lines.len(), 3, "{lines:?}");
        for (line, start) in
            lines.iter().zip(["docs/a.md:1: a block", "docs/a.md:7: commands", "docs/a.md:13: elsewhere"])
        {
            assert!(line.starts_with(start), "{line}");
        }
    }
}
