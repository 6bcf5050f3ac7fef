//! The Origin of a request: browsers name the page that connects.

use std::str::FromStr;

/// Schemes of pages of programs on this computer: the desktop programs of Foxglove and Lichtblick, and files that a browser opens.
const PROGRAM_SCHEMES: [&str; 4] = ["file", "app", "foxglove", "lichtblick"];
/// Domain of Foxglove's pages.
const FOXGLOVE_DOMAIN: &str = "foxglove.dev";

/// The origin of a page that may connect: `http://localhost:8080`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PageOrigin(String);

impl FromStr for PageOrigin {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let is_page = |rest: &str| !rest.is_empty() && !rest.contains(['/', '*', '?', '#', '@', ' ']);
        let host = text.strip_prefix("http://").or_else(|| text.strip_prefix("https://"));
        if host.is_some_and(is_page) {
            return Ok(Self(text.to_ascii_lowercase()));
        }
        Err(format!("'{text}': expected the origin of a page without a path, as http://localhost:8080"))
    }
}

/// Whether a page of this origin may connect: pages of Foxglove, of programs on this computer, and those in `allowed`.
pub fn is_allowed(origin: &str, allowed: &[PageOrigin]) -> bool {
    is_of_program(origin) || is_of_foxglove(origin) || allowed.iter().any(|known| known.0 == origin)
}

fn is_of_program(origin: &str) -> bool {
    origin.split_once("://").is_some_and(|(scheme, _)| PROGRAM_SCHEMES.contains(&scheme))
}

fn is_of_foxglove(origin: &str) -> bool {
    let sub_domain = origin.strip_prefix("https://").and_then(|host| host.strip_suffix(FOXGLOVE_DOMAIN));
    sub_domain.is_some_and(|name| {
        let is_host = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '.';
        name.is_empty() || name.ends_with('.') && name.chars().all(is_host)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_foxglove_and_programs_and_named_pages_may_connect() {
        let own = ["http://localhost:8080".parse().unwrap()];
        for known in [
            "https://app.foxglove.dev",
            "https://foxglove.dev",
            "https://a.b.foxglove.dev",
            "file://",
            "app://bundle",
            "http://localhost:8080",
        ] {
            assert!(is_allowed(known, &own), "{known}");
        }
        for foreign in [
            "",
            "null",
            "http://evil.example",
            "http://app.foxglove.dev",
            "https://evilfoxglove.dev",
            "https://app.foxglove.dev.evil.example",
            "https://evil.example/.foxglove.dev",
            "https://app.foxglove.dev:444",
            "http://localhost:8081",
            "http://127.0.0.1:8080",
            "chrome-extension://abc",
        ] {
            assert!(!is_allowed(foreign, &own), "{foreign}");
        }
    }

    #[test]
    fn an_origin_has_a_scheme_and_no_path() {
        for wrong in ["", "*", "localhost:8080", "http://", "http://*", "http://a/b", "ftp://a"] {
            assert!(wrong.parse::<PageOrigin>().unwrap_err().contains("expected the origin"), "{wrong}");
        }
    }
}
