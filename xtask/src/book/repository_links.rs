//! Links of the book to files outside docs: they lead to the repository's web page, and those to the root of a crate to the crate's reference,
//! which `cargo doc` writes beside the book.
//!
//! mdbook runs this as a preprocessor: `[context, book]` in JSON on standard input, the book on standard output.

use crate::markdown::replace_links;
use crate::workspace::{self, Verdict};
use serde_json::Value;
use std::io::Read;

/// Branch of the linked files.
const BRANCH: &str = "main";
/// Folder of the pages, relative to the workspace.
const DOCS: &str = "docs";
/// The root of a crate: what its path begins and ends with.
const CRATE_ROOT: (&str, &str) = ("crates/", "/src/lib.rs");
/// Folder of the references, beside that of the book.
const REFERENCES: &str = "doc";
/// Name of a folder's first page, and mdbook's name of it.
const README: (&str, &str) = ("README.md", "index.md");

/// Answers mdbook: `supports RENDERER` is true of each renderer; without arguments it converts the book.
pub fn run(question: &[String]) -> Verdict {
    if !question.is_empty() {
        return Ok(true);
    }
    let mut input = String::new();
    std::io::stdin().read_to_string(&mut input).map_err(|e| format!("cannot read the book: {e}"))?;
    let mut input: [Value; 2] = serde_json::from_str(&input)
        .map_err(|e| format!("the book is no JSON array of context and book, as mdbook writes it: {e}"))?;
    convert(&mut input[1], &repository()?);
    println!("{}", input[1]);
    Ok(true)
}

/// Address of the repository, from the workspace's manifest.
fn repository() -> Result<String, String> {
    let file = workspace::root().join("Cargo.toml");
    let text = std::fs::read_to_string(&file).map_err(|e| format!("cannot read {}: {e}", file.display()))?;
    let manifest: toml::Table = text.parse().map_err(|e| format!("{}: {e}", file.display()))?;
    let address = manifest["workspace"]["package"].get("repository").and_then(toml::Value::as_str);
    Ok(address.ok_or("Cargo.toml: no workspace.package.repository")?.to_owned())
}

/// Replaces the links of each chapter in any depth of `value`.
fn convert(value: &mut Value, repository: &str) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| convert(item, repository)),
        Value::Object(fields) => {
            let page = fields.get("source_path").and_then(Value::as_str).map(|path| format!("{DOCS}/{path}"));
            if let (Some(page), Some(Value::String(content))) = (page, fields.get_mut("content")) {
                *content = replace_links(content, |link| {
                    in_book(&page, &link.target(&page), &link.path, link.anchor.as_deref(), repository)
                });
            }
            fields.values_mut().for_each(|field| convert(field, repository));
        }
        _ => {}
    }
}

/// The book's link for a link to `target`; `None` if it is unchanged.
fn in_book(page: &str, target: &str, path: &str, anchor: Option<&str>, repository: &str) -> Option<String> {
    let krate = target.strip_prefix(CRATE_ROOT.0).and_then(|rest| rest.strip_suffix(CRATE_ROOT.1));
    if let Some(krate) = krate {
        let up = "../".repeat(page.matches('/').count());
        return Some(format!("{up}{REFERENCES}/{}/index.html", krate.replace('-', "_")));
    }
    let anchor = anchor.map(|anchor| format!("#{anchor}")).unwrap_or_default();
    if target.starts_with(&format!("{DOCS}/")) {
        let folder = path.strip_suffix(README.0)?;
        return Some(format!("{folder}{}{anchor}", README.1));
    }
    let kind = if workspace::root().join(target).is_dir() { "tree" } else { "blob" };
    Some(format!("{repository}/{kind}/{BRANCH}/{target}{anchor}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_links_out_of_docs_and_to_first_pages_change() {
        let content = "[a](b.md#c) [d](../../ARCHITECTURE.md#e) [f](../README.md) `[g](../../h)` [i](../../bench) \
             [j](../../crates/trundle-core/src/lib.rs)";
        let chapter = serde_json::json!({ "Chapter": { "content": content, "source_path": "how-to/x.md" } });
        let mut book = serde_json::json!({ "items": [chapter] });
        convert(&mut book, "https://r");
        let expected = "[a](b.md#c) [d](https://r/blob/main/ARCHITECTURE.md#e) [f](../index.md) `[g](../../h)` \
                        [i](https://r/tree/main/bench) [j](../../doc/trundle_core/index.html)";
        assert_eq!(book["items"][0]["Chapter"]["content"], expected);
    }
}
