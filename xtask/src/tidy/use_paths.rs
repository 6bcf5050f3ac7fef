//! Paths in Rust code: `use` declarations with expanded groups, and inline paths.

/// A path in code, with its segments from the first on.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPath {
    /// Segments; the last is `*` for a glob.
    pub segments: Vec<String>,
    /// The name bound in the module; `None` for an inline path.
    pub binds: Option<String>,
    /// Whether a visibility precedes the `use`: a re-export.
    pub is_exported: bool,
    /// First line of the path, from 1.
    pub line: usize,
}

/// All paths in `code` (comments, strings and tests blanked).
pub fn paths(code: &str) -> Vec<NamedPath> {
    let mut found = Vec::new();
    let mut in_place = code.to_owned();
    for (start, end, is_exported) in use_statements(code) {
        let line = code[..start].matches('\n').count() + 1;
        let tree: String = code[start..end].split_whitespace().collect::<Vec<_>>().join(" ");
        open_group(&tree, &[], &mut |segments, binds| {
            found.push(NamedPath { segments, binds: Some(binds), is_exported, line });
        });
        in_place.replace_range(start..end, &code[start..end].replace(|c: char| c != '\n', " "));
    }
    found.extend(written_paths(&in_place));
    found
}

/// Begin and end of each use tree (without `use` and `;`), and whether it is exported.
fn use_statements(code: &str) -> Vec<(usize, usize, bool)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("use ") {
        let before = code[..at].trim_end_matches(' ');
        let starts = before.is_empty() || before.ends_with(['\n', '{', '}', ';', ']']);
        let is_exported = before.ends_with("pub") || before.ends_with(')') && code[..at].ends_with(") ");
        if !(starts || is_exported) {
            continue;
        }
        let begin = at + "use ".len();
        if let Some(length) = code[begin..].find(';') {
            found.push((begin, begin + length, is_exported));
        }
    }
    found
}

/// Calls `emit` with each path of a use tree and its bound name.
fn open_group(tree: &str, prefix: &[String], emit: &mut impl FnMut(Vec<String>, String)) {
    let tree = tree.trim();
    if let Some((head, group)) = tree.split_once('{') {
        let mut prefix = prefix.to_vec();
        prefix.extend(head.split("::").map(str::trim).filter(|s| !s.is_empty()).map(str::to_owned));
        let group = group.trim_end().trim_end_matches('}');
        for branch in branches(group) {
            open_group(branch, &prefix, emit);
        }
        return;
    }
    let (path, alias) = tree.split_once(" as ").map_or((tree, None), |(path, alias)| (path, Some(alias)));
    let mut segments = prefix.to_vec();
    segments.extend(path.split("::").map(|s| s.trim().to_owned()).filter(|s| !s.is_empty()));
    if segments.last().is_some_and(|last| last == "self") {
        segments.pop();
    }
    if let Some(last) = segments.last().cloned() {
        emit(segments, alias.map_or(last, |alias| alias.trim().to_owned()));
    }
}

/// The branches of a group, split at commas outside inner groups.
fn branches(group: &str) -> Vec<&str> {
    let (mut found, mut depth, mut start) = (Vec::new(), 0, 0);
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                found.push(&group[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    // An inner group's closing brace may have been trimmed with the outer one's: `open_group` does not need it.
    found.push(&group[start..]);
    found.into_iter().filter(|branch| !branch.trim().is_empty()).collect()
}

/// Paths of two and more segments in code.
fn written_paths(code: &str) -> Vec<NamedPath> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for (i, line) in code.lines().enumerate() {
        for piece in line.split(|c: char| !is_word(c) && c != ':') {
            let segments: Vec<String> = piece.split("::").map(str::to_owned).collect();
            if segments.len() > 1 && segments.iter().all(|s| !s.is_empty() && !s.contains(':')) {
                found.push(NamedPath { segments, binds: None, is_exported: false, line: i + 1 });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(code: &str) -> Vec<String> {
        let show = |p: &NamedPath| {
            let export = if p.is_exported { "pub " } else { "" };
            format!("{export}{} as {}", p.segments.join("::"), p.binds.as_deref().unwrap_or("-"))
        };
        paths(code).iter().map(show).collect()
    }

    #[test]
    fn groups_aliases_and_exports_are_read() {
        let code =
            "use crate::{a::{B, c::D}, e as f};\npub use self::g::{H, self};\npub(crate) use super::i::*;\n";
        assert_eq!(
            shown(code),
            [
                "crate::a::B as B",
                "crate::a::c::D as D",
                "crate::e as f",
                "pub self::g::H as H",
                "pub self::g as g",
                "pub super::i::* as *",
            ]
        );
    }

    #[test]
    fn paths_in_place_are_read() {
        assert_eq!(shown("fn f() -> crate::a::B { c::d(x) }"), ["crate::a::B as -", "c::d as -"]);
        assert!(shown("because; let x: u8 = 1;").is_empty());
    }
}
