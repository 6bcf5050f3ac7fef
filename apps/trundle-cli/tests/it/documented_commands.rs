//! Every command of `trundle` in the README and in the book is accepted by the command line: an option that was renamed is found. The
//! commands do not run here; `cargo xtask book` runs those of the blocks `sh tested`.

use std::path::{Path, PathBuf};

/// Commands that the command line refuses, each with the reason why a page shows them all the same.
const EXCEPTIONS: [(&str, &str); 0] = [];
/// A smaller number of commands means that they are not found any more. Source: ours, 131 stand in the pages.
const MIN_COMMANDS: usize = 120;
/// Words before the name of the program.
const KEYWORDS: [&str; 6] = ["do", "then", "else", "until", "while", "!"];
/// The program in a clone of its sources.
const CARGO_RUN: [&str; 4] = ["cargo", "run", "--release", "--"];

#[test]
fn every_command_of_the_pages_is_accepted() {
    let mut number = 0;
    let mut refused = Vec::new();
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for command in shell_blocks(&text).iter().flat_map(|block| commands(block)) {
            number += 1;
            let line = command.join(" ");
            let is_exception = EXCEPTIONS.iter().any(|(exception, _)| *exception == line);
            let error = usage_error(&command);
            if error.is_some() != is_exception {
                let why = error.unwrap_or_else(|| "accepted, expected an exception".into());
                refused.push(format!("{}: {line}\n{why}", page.display()));
            }
        }
    }
    assert!(refused.is_empty(), "{}", refused.join("\n"));
    assert!(number >= MIN_COMMANDS, "{number} commands, at least {MIN_COMMANDS} expected");
}

#[test]
fn commands_are_read_as_a_shell_reads_them() {
    let block = "A=1 trundle demo -v  # comment; trundle x\ntrundle run \\\n  --set 'a b' > file && trundle plan \"c d\" | tee x\n\
                 for i in 1; do trundle map $i; done\ncargo run --release -- sim &\necho trundle dock\n";
    let lines = commands(block);
    let expected: [&[&str]; 5] = [
        &["trundle", "demo", "-v"],
        &["trundle", "run", "--set", "a b"],
        &["trundle", "plan", "c d"],
        &["trundle", "map", "$i"],
        &["trundle", "sim"],
    ];
    assert_eq!(lines, expected);
    let wrong = ["trundle", "demo", "--no-such-option"].map(str::to_owned);
    assert!(usage_error(&wrong).is_some());
}

/// Why the command line refuses these words; nothing runs. Help and version are no errors.
fn usage_error(words: &[String]) -> Option<String> {
    let parsed = trundle_cli::command().try_get_matches_from(words);
    parsed.err().filter(clap::Error::use_stderr).map(|usage| usage.to_string())
}

/// The README and the pages of the book.
fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap();
    let mut pages = vec![root.join("README.md")];
    let mut folders = vec![root.join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "md") {
                pages.push(path);
            }
        }
    }
    pages.sort();
    pages
}

/// Texts of the blocks `sh` and `sh tested` of a page, and of those without a language.
fn shell_blocks(page: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(info) = line.trim_start().strip_prefix("```") {
            let body: Vec<&str> = lines.by_ref().take_while(|line| line.trim() != "```").collect();
            if matches!(info.split(' ').next(), Some("sh" | "")) {
                blocks.push(body.join("\n"));
            }
        }
    }
    blocks
}

/// The commands of `trundle` in a script, each as its words.
fn commands(script: &str) -> Vec<Vec<String>> {
    simple_commands(&script.replace("\\\n", " ")).into_iter().filter_map(own_words).collect()
}

/// The words from `trundle` on; `None` for another program.
fn own_words(words: Vec<String>) -> Option<Vec<String>> {
    let is_before = |word: &String| {
        let name = word.split_once('=').map_or("", |(name, _)| name);
        let is_variable = !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c == '_');
        KEYWORDS.contains(&word.as_str()) || is_variable
    };
    let words: Vec<String> = words.into_iter().skip_while(is_before).collect();
    if words.iter().zip(CARGO_RUN).filter(|(word, expected)| word == expected).count() == CARGO_RUN.len() {
        return Some(
            std::iter::once("trundle".into()).chain(words.into_iter().skip(CARGO_RUN.len())).collect(),
        );
    }
    (words.first().is_some_and(|word| word == "trundle")).then_some(words)
}

/// The words of each command: quotes are removed, comments and the files of redirections are left out.
fn simple_commands(script: &str) -> Vec<Vec<String>> {
    let mut commands = vec![Vec::new()];
    let mut rest = script.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\n' | ';' | '|' | '&' => commands.push(Vec::new()),
            // The file of a redirection stands where the words of a command that is not looked at do.
            '<' | '>' => commands.push(vec![">".into()]),
            '#' => while rest.next_if(|c| *c != '\n').is_some() {},
            c if c.is_whitespace() => {}
            c => commands.last_mut().unwrap().push(word(c, &mut rest)),
        }
    }
    commands
}

/// The word that begins with `first`.
fn word(first: char, rest: &mut std::iter::Peekable<std::str::Chars<'_>>) -> String {
    let mut word = String::new();
    let mut quote = None;
    let mut next = Some(first);
    while let Some(c) = next {
        match quote {
            Some(open) if c == open => quote = None,
            None if c == '\'' || c == '"' => quote = Some(c),
            _ => word.push(c),
        }
        next = rest.next_if(|c| quote.is_some() || !(c.is_whitespace() || ";|&<>".contains(*c)));
    }
    word
}
