//! Size of types: number of fields of a struct, and of methods and their files.

use super::finding::{Finding, Rule};
use super::tree::{Package, Tree};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of fields of a struct; beyond it, fields that belong together form a separate struct. Source: ours.
const MAX_FIELDS: usize = 15;
/// Methods of one type's inherent impls. Source: ours.
const MAX_METHODS: usize = 30;
/// Files over which one type's inherent impls are spread. Source: ours.
const MAX_IMPL_FILES: usize = 2;

/// Checks the structs and inherent impls of every package.
pub fn check(tree: &Tree) -> Vec<Finding> {
    tree.packages.iter().flat_map(|package| check_package(tree, package)).collect()
}

/// The methods of a type, and the files they are in.
#[derive(Default)]
struct Methods {
    count: usize,
    files: BTreeSet<String>,
}

fn check_package(tree: &Tree, package: &Package) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut methods: BTreeMap<String, Methods> = BTreeMap::new();
    for source in tree.sources(package) {
        let text = source.code.text();
        for (line, name, fields) in structs(text) {
            if fields > MAX_FIELDS && !source.is_generated() {
                let message = format!("struct {name} has {fields} fields, {MAX_FIELDS} at most");
                findings.push(Finding::ruled(Rule::StructFields, &source.file.path, line, message));
            }
        }
        for (name, count) in inherent_impls(text) {
            let entry = methods.entry(name).or_default();
            entry.count += count;
            entry.files.insert(source.file.path.clone());
        }
    }
    for (name, Methods { count, files }) in methods {
        let first = files.first().cloned().unwrap_or_default();
        if count > MAX_METHODS {
            let message = format!("{name} has {count} methods, {MAX_METHODS} at most");
            findings.push(Finding::ruled(Rule::ImplMethods, &first, 1, message));
        }
        if files.len() > MAX_IMPL_FILES {
            let message =
                format!("impl {name} is spread over {} files, {MAX_IMPL_FILES} at most", files.len());
            findings.push(Finding::ruled(Rule::ImplFiles, &first, 1, message));
        }
    }
    findings
}

/// Line, name and number of named fields of each struct.
fn structs(code: &str) -> Vec<(usize, String, usize)> {
    items(code, "struct ")
        .into_iter()
        .map(|(at, name, body)| {
            let line = code[..at].matches('\n').count() + 1;
            (line, name, top_level(body).split(',').filter(|field| field.contains(':')).count())
        })
        .collect()
}

/// Type name and number of methods of each inherent impl.
fn inherent_impls(code: &str) -> Vec<(String, usize)> {
    let impls = items(code, "impl").into_iter().filter(|(_, head, _)| !head.contains(" for "));
    impls.map(|(_, head, body)| (type_name(&head), top_level(body).matches("fn ").count())).collect()
}

/// Position, head (the text between keyword and brace) and body of each item with a braced body.
fn items<'a>(code: &'a str, keyword: &str) -> Vec<(usize, String, &'a str)> {
    let mut found = Vec::new();
    let mut line_start = 0;
    for line in code.split_inclusive('\n') {
        let at = line_start;
        line_start += line.len();
        let unindented = line.trim_start();
        let item = ["pub(crate) ", "pub(super) ", "pub "]
            .iter()
            .find_map(|v| unindented.strip_prefix(v))
            .unwrap_or(unindented);
        let Some(rest) = item.strip_prefix(keyword) else { continue };
        if keyword == "impl" && !rest.starts_with([' ', '<']) {
            continue;
        }
        let begin = at + line.len() - rest.len();
        let Some(stop) = code[begin..].find(['{', ';']) else { continue };
        if code.as_bytes()[begin + stop] == b';' {
            continue;
        }
        let head = code[begin..begin + stop].split_whitespace().collect::<Vec<_>>().join(" ");
        let head = if keyword == "impl" {
            head
        } else {
            head.split(['<', ' ', '(']).next().unwrap_or("").to_owned()
        };
        found.push((at, head, body(&code[begin + stop + 1..])));
    }
    found
}

/// The text up to the closing brace of the preceding one.
fn body(code: &str) -> &str {
    let mut depth = 1;
    for (i, c) in code.char_indices() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if depth == 0 {
            return &code[..i];
        }
    }
    code
}

/// Text outside inner brackets of any kind.
fn top_level(body: &str) -> String {
    let mut depth = 0;
    let mut outer = String::new();
    let mut previous = ' ';
    for c in body.chars() {
        let opens = matches!(c, '{' | '(' | '[' | '<');
        let closes = matches!(c, '}' | ')' | ']') || c == '>' && previous != '-' && previous != '=';
        if closes && depth > 0 {
            depth -= 1;
        } else if depth == 0 && !closes {
            outer.push(c);
        }
        depth += i32::from(opens);
        previous = c;
    }
    outer
}

/// The type's name in an impl's head: `<T: X> a::Name<T> where ...` gives `Name`.
fn type_name(head: &str) -> String {
    let mut rest = head.trim();
    if rest.starts_with('<') {
        let mut depth = 0;
        let plain = rest.replace("->", "  ");
        let end = plain.char_indices().find(|(_, c)| {
            depth += i32::from(*c == '<') - i32::from(*c == '>');
            depth == 0
        });
        rest = end.map_or("", |(i, _)| rest[i + 1..].trim());
    }
    let path = rest.split(['<', ' ']).next().unwrap_or(rest);
    path.rsplit("::").next().unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_counted_without_their_types_commas() {
        let code = "pub struct A<T: X> {\n    pub a: Map<u8, u16>,\n    b: (u8, [f64; 3]),\n    c: fn(u8) -> u8,\n}\nstruct B(u8);\nstruct C;\n";
        assert_eq!(structs(code), [(1, "A".to_owned(), 3)]);
    }

    #[test]
    fn methods_are_counted_by_type() {
        let code = "impl<T: Fn() -> u8> a::A<T> {\n    fn f() { fn inner() {} }\n    pub fn g(&self) {}\n}\nimpl X for A {\n    fn h() {}\n}\n";
        assert_eq!(inherent_impls(code), [("A".to_owned(), 2)]);
    }
}
