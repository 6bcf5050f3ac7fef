//! Links, headings and code blocks of a Markdown page.

use std::path::{Path, PathBuf};

/// A link to a file of the repository.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Line of the link, from 1.
    pub line: usize,
    /// Path as written, relative to the page; empty for the page itself.
    pub path: String,
    /// Anchor of a heading, without `#`.
    pub anchor: Option<String>,
}

impl Link {
    fn new(line: usize, link: &str) -> Self {
        let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
        Self { line, path: path.to_owned(), anchor: anchor.map(str::to_owned) }
    }

    /// Path of the linked file relative to the workspace, for a page at `page`.
    pub fn target(&self, page: &str) -> String {
        if self.path.is_empty() { page.to_owned() } else { resolve(page, &self.path) }
    }
}

/// A fenced code block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// Line of the opening fence, from 1.
    pub line: usize,
    /// Words after the opening fence: the language first.
    pub info: Vec<String>,
    /// Text between the fences, without the fences' indentation.
    pub text: String,
}

/// The pages in a folder and the folders below it, in order.
pub fn pages(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut pages = Vec::new();
    collect(folder, &mut pages)?;
    pages.sort();
    Ok(pages)
}

fn collect(folder: &Path, pages: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("cannot list {}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| format!("cannot list {}: {e}", folder.display()))?.path();
        if path.is_dir() {
            collect(&path, pages)?;
        } else if path.extension().is_some_and(|end| end == "md") {
            pages.push(path);
        }
    }
    Ok(())
}

/// Links to files in reading order. Links to web pages, and all links within code, are left out.
pub fn links(text: &str) -> Vec<Link> {
    let mut found = Vec::new();
    for (line, prose) in prose_lines(text) {
        let prose: String = prose.split('`').step_by(2).collect::<Vec<_>>().join("``");
        let pieces = prose.split("](").skip(1).filter_map(|piece| piece.split([')', ' ']).next());
        let pieces = pieces.filter(|link| !link.contains("://") && !link.starts_with("mailto:"));
        found.extend(pieces.filter(|link| !link.is_empty()).map(|link| Link::new(line, link)));
    }
    found
}

/// The text with other links: `replacement` gives the new link, or `None` for an unchanged one.
pub fn replace_links(text: &str, replacement: impl Fn(&Link) -> Option<String>) -> String {
    let mut is_code = false;
    let line = |(i, line): (usize, &str)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        if is_code || is_fence { line.to_owned() } else { replaced_line(i + 1, line, &replacement) }
    };
    text.split('\n').enumerate().map(line).collect::<Vec<_>>().join("\n")
}

fn replaced_line(number: usize, line: &str, replacement: impl Fn(&Link) -> Option<String>) -> String {
    let span = |(i, span): (usize, &str)| {
        if i % 2 == 1 {
            return span.to_owned();
        }
        let mut pieces = span.split("](");
        let mut replaced = pieces.next().unwrap_or("").to_owned();
        for piece in pieces {
            let link = piece.split([')', ' ']).next().unwrap_or("");
            let rest = piece.get(link.len()..).unwrap_or("");
            let is_file = !link.is_empty() && !link.contains("://") && !link.starts_with("mailto:");
            let new = is_file.then(|| replacement(&Link::new(number, link))).flatten();
            replaced += &format!("]({}{rest}", new.as_deref().unwrap_or(link));
        }
        replaced
    };
    line.split('`').enumerate().map(span).collect::<Vec<_>>().join("`")
}

/// Anchors of the headings, as GitHub and mdBook form them: lower case, hyphens for blanks, no punctuation.
pub fn anchors(text: &str) -> Vec<String> {
    let headings = prose_lines(text).filter(|(_, line)| line.trim_start_matches('#').starts_with(' '));
    let mut found: Vec<String> = Vec::new();
    for (_, line) in headings.filter(|(_, line)| line.starts_with('#')) {
        let anchor = anchor(line.trim_start_matches('#').trim());
        let copies = found.iter().filter(|other| **other == anchor).count();
        found.push(if copies == 0 { anchor } else { format!("{anchor}-{copies}") });
    }
    found
}

fn anchor(heading: &str) -> String {
    let heading = heading.to_lowercase();
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || "-_ ".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// Fenced code blocks in reading order. A block without a closing fence ends with the page.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(info) = line.trim_start().strip_prefix("```") else { continue };
        let indent = line.len() - line.trim_start().len();
        let body = lines.by_ref().map(|(_, line)| line).take_while(|line| line.trim() != "```");
        let body = body.map(|line| format!("{}\n", line.get(indent..).unwrap_or("")));
        let info = info.split([' ', ',']).map(str::to_owned).collect();
        found.push(Block { line: number + 1, info, text: body.collect() });
    }
    found
}

/// Lines outside fenced code, with their numbers from 1.
fn prose_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut is_code = false;
    text.lines().enumerate().filter_map(move |(i, line)| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        (!is_code && !is_fence).then_some((i + 1, line))
    })
}

/// A relative path in the file at `from`, relative to the workspace.
fn resolve(from: &str, link: &str) -> String {
    let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in link.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            other => parts.push(other),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_give_the_anchors_of_their_readers() {
        let text = "# Nav2's interfaces\n## Step `a`: b, c\n```\n# no heading\n```\n## Step `a`: b, c\n#tag";
        assert_eq!(anchors(text), ["nav2s-interfaces", "step-a-b-c", "step-a-b-c-1"]);
    }

    #[test]
    fn links_keep_line_path_and_anchor() {
        let found = links("[a](b.md#c) `[code](x)` [web](https://a.b)\n```\n[code](y)\n```\n[here](#d)");
        let link =
            |line, path: &str, anchor: &str| Link { line, path: path.into(), anchor: Some(anchor.into()) };
        assert_eq!(found, [link(1, "b.md", "c"), link(5, "", "d")]);
        assert_eq!(found[0].target("docs/how-to/x.md"), "docs/how-to/b.md");
        assert_eq!(found[1].target("docs/how-to/x.md"), "docs/how-to/x.md");
    }

    #[test]
    fn an_indented_block_loses_its_indentation() {
        let found = blocks("1. Step\n\n   ```sh tested\n   a\n     b\n   ```\n");
        let info = vec!["sh".to_owned(), "tested".to_owned()];
        assert_eq!(found, [Block { line: 3, info, text: "a\n  b\n".into() }]);
    }
}
