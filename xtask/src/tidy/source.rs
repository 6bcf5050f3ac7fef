//! Rust code without comments, strings and tests.

/// Rust code in which comments, strings and test items are blanks: as long as the text, line for line.
pub struct Code {
    text: String,
}

impl Code {
    /// The code of a Rust file.
    pub fn of(text: &str) -> Self {
        let mut chars: Vec<char> = text.chars().collect();
        blank_comments_and_strings(&mut chars);
        blank_tests(&mut chars);
        Self { text: chars.into_iter().collect() }
    }

    /// The code of a Rust file with its tests.
    pub fn with_tests(text: &str) -> Self {
        let mut chars: Vec<char> = text.chars().collect();
        blank_comments_and_strings(&mut chars);
        Self { text: chars.into_iter().collect() }
    }

    /// The code as text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Lines with code, from 1.
    pub fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        self.text.lines().enumerate().map(|(i, line)| (i + 1, line))
    }

    /// Number of lines with code.
    pub fn len(&self) -> usize {
        self.text.lines().filter(|line| !line.trim().is_empty()).count()
    }

    /// The lines with `word` as a whole word.
    pub fn lines_with<'a>(&'a self, word: &'a str) -> impl Iterator<Item = usize> + 'a {
        self.lines().filter(move |(_, line)| has_word(line, word)).map(|(number, _)| number)
    }

    /// The names in every `root::{...}` group, each with its line.
    pub fn group(&self, root: &str) -> Vec<(usize, &str)> {
        let mut names = Vec::new();
        for (start, opening) in self.text.match_indices(&format!("{root}::{{")) {
            let begin = start + opening.len();
            let end = self.text[begin..].find(';').map_or(self.text.len(), |at| begin + at);
            let mut depth = 0;
            let mut at = begin;
            for piece in self.text[begin..end].split_inclusive([',', '{', '}']) {
                let name = piece.trim_end_matches([',', '{', '}']).trim();
                let head = name.split("::").next().unwrap_or(name).split_whitespace().next().unwrap_or("");
                if depth == 0 && !head.is_empty() {
                    let indent = piece.len() - piece.trim_start().len();
                    names.push((self.text[..at + indent].matches('\n').count() + 1, head));
                }
                at += piece.len();
                depth += i32::from(piece.ends_with('{')) - i32::from(piece.ends_with('}'));
                if depth < 0 {
                    break;
                }
            }
        }
        names
    }
}

/// Keywords after which a name is defined.
const KEYWORDS: [&str; 8] = ["mod", "struct", "enum", "trait", "type", "fn", "const", "static"];

/// The words of a line of code: keywords, names and numbers.
pub fn identifiers(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// Definition in a line of code: the keyword and the name.
pub fn definitions(code: &str) -> Vec<(&str, &str)> {
    let words: Vec<&str> = identifiers(code).collect();
    words.windows(2).filter(|pair| KEYWORDS.contains(&pair[0])).map(|pair| (pair[0], pair[1])).collect()
}

/// Whether `line` contains `word`, with boundaries at ends that are letters.
fn has_word(line: &str, word: &str) -> bool {
    let part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + word.len()..].chars().next();
        !(part(word.chars().next()) && part(before) || part(word.chars().next_back()) && part(after))
    })
}

fn blank_comments_and_strings(chars: &mut [char]) {
    let mut i = 0;
    while i < chars.len() {
        let next = chars.get(i + 1).copied();
        let end = match chars[i] {
            '/' if next == Some('/') => line_end(chars, i),
            '/' if next == Some('*') => comment_end(chars, i),
            '"' => string_end(chars, i + 1),
            'r' if !is_part(chars, i) => raw_string_end(chars, i + 1).unwrap_or(i),
            '\'' => char_end(chars, i).unwrap_or(i),
            _ => i,
        };
        blank(&mut chars[i..end]);
        i = end.max(i + 1);
    }
}

fn blank(chars: &mut [char]) {
    for c in chars.iter_mut().filter(|c| **c != '\n') {
        *c = ' ';
    }
}

/// Whether the previous character belongs to the same word (`br"..."` counts as a string).
fn is_part(chars: &[char], i: usize) -> bool {
    i > 0 && (chars[i - 1].is_alphanumeric() || chars[i - 1] == '_') && chars[i - 1] != 'b'
}

fn line_end(chars: &[char], from: usize) -> usize {
    chars[from..].iter().position(|&c| c == '\n').map_or(chars.len(), |n| from + n)
}

fn comment_end(chars: &[char], from: usize) -> usize {
    let (mut depth, mut i) = (0, from);
    while i < chars.len() {
        match (chars[i], chars.get(i + 1)) {
            ('/', Some('*')) => (depth, i) = (depth + 1, i + 2),
            ('*', Some('/')) => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    chars.len()
}

fn string_end(chars: &[char], from: usize) -> usize {
    let mut i = from;
    while i < chars.len() {
        match chars[i] {
            '\\' => i += 2,
            '"' => return i + 1,
            _ => i += 1,
        }
    }
    chars.len()
}

/// The end of a raw string whose `r` ends before `from`; `None` if it is none.
fn raw_string_end(chars: &[char], from: usize) -> Option<usize> {
    let hashes = chars[from..].iter().take_while(|&&c| c == '#').count();
    if chars.get(from + hashes) != Some(&'"') {
        return None;
    }
    let closes =
        |i: usize| chars[i] == '"' && chars[i + 1..].iter().take_while(|&&c| c == '#').count() >= hashes;
    let end = (from + hashes + 1..chars.len()).find(|&i| closes(i));
    Some(end.map_or(chars.len(), |i| i + 1 + hashes))
}

/// The end of a character literal; `None` for a lifetime.
fn char_end(chars: &[char], from: usize) -> Option<usize> {
    if chars.get(from + 1) == Some(&'\\') {
        let closing = chars.iter().skip(from + 3).position(|&c| c == '\'')?;
        return Some(from + 3 + closing + 1);
    }
    (chars.get(from + 2) == Some(&'\'')).then_some(from + 3)
}

/// Blanks the item after each `#[cfg(test)]`.
fn blank_tests(chars: &mut [char]) {
    let mark: Vec<char> = "#[cfg(test)]".chars().collect();
    let mut i = 0;
    while i + mark.len() <= chars.len() {
        if chars[i..i + mark.len()] == mark[..] {
            let end = item_end(chars, i + mark.len());
            blank(&mut chars[i..end]);
            i = end;
        } else {
            i += 1;
        }
    }
}

fn item_end(chars: &[char], from: usize) -> usize {
    let mut depth = 0;
    for (i, c) in chars.iter().enumerate().skip(from) {
        match c {
            ';' if depth == 0 => return i + 1,
            '{' => depth += 1,
            '}' if depth <= 1 => return i + 1,
            '}' => depth -= 1,
            _ => {}
        }
    }
    chars.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str, word: &str) -> Vec<usize> {
        Code::of(text).lines_with(word).collect()
    }

    #[test]
    fn comments_strings_and_tests_are_not_code() {
        let text = "// std::fs\nlet a = \"std::fs \\\" std::fs\"; /* std::fs /* x */ std::fs */\nlet b = r#\"std::fs\" \"#;\n\
            let c = ('\"', '\\'', 'x'); std::fs::read();\nfn f<'a>(x: &'a str) {}\n#[cfg(test)]\nmod tests { fn g() { std::fs::read(); } }\n\
            #[cfg(test)]\nmod more;\nuse std::fs;\n";
        assert_eq!(words(text, "std::fs"), [4, 10]);
    }

    #[test]
    fn words_are_whole() {
        assert!(words("let x = Instantly; my_Instant();", "Instant").is_empty());
        assert_eq!(words("let x: Instant = y;", "Instant"), [1]);
        assert_eq!(words("println!(); eprintln!();", "println!"), [1]);
        assert!(words("eprintln!();", "println!").is_empty());
    }

    #[test]
    fn groups_are_opened() {
        let code = Code::of(
            "use std::{\n    collections::{fs, x},\n    fs, thread as t,\n    io::Write};\nlet fs = 1;",
        );
        assert_eq!(
            code.group("std"),
            [(2, "collections"), (3, "fs"), (3, "thread"), (4, "io")].map(|(l, n)| (l, n))
        );
    }

    #[test]
    fn lines_of_code_are_counted() {
        assert_eq!(
            Code::of("//! doc\n\nfn f() {\n    // why\n    g()\n}\n#[cfg(test)]\nmod t {\n}\n").len(),
            3
        );
    }
}
