//! Links between the built pages. Links to other sites are not followed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Pages whose links are relative to other pages: all pages in one, and the answer to a wrong address.
const LEFT_OUT: [&str; 2] = ["print.html", "404.html"];

/// Links of the pages in `folder` without a file, or without a place of their anchor; one line of text each.
pub fn broken(folder: &Path) -> Result<Vec<String>, String> {
    let mut pages = BTreeMap::new();
    read(folder, &mut pages)?;
    let of_page = |(path, html): (&PathBuf, &String)| {
        let name = path.strip_prefix(folder).unwrap_or(path).display().to_string();
        let links = if LEFT_OUT.contains(&name.as_str()) { Vec::new() } else { links(html) };
        let broken = links.into_iter().filter(|link| !leads_somewhere(&pages, path, link));
        broken.map(|link| format!("{name}: the link {link} leads nowhere")).collect::<Vec<_>>()
    };
    Ok(pages.iter().flat_map(of_page).collect())
}

/// Reads the HTML files below a folder.
fn read(folder: &Path, pages: &mut BTreeMap<PathBuf, String>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("cannot list {}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry.map_err(|e| format!("cannot list {}: {e}", folder.display()))?.path();
        if path.is_dir() {
            read(&path, pages)?;
        } else if path.extension().is_some_and(|end| end == "html") {
            let html =
                std::fs::read_to_string(&path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
            pages.insert(path, html);
        }
    }
    Ok(())
}

/// Values of `href` and `src` that lead to files of the book.
fn links(html: &str) -> Vec<String> {
    let values = |name: &str| -> Vec<String> {
        html.split(name).skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned).collect()
    };
    let all = values(" href=\"").into_iter().chain(values(" src=\""));
    all.filter(|link| !link.contains(':') && !link.is_empty() && link != "#").collect()
}

fn leads_somewhere(pages: &BTreeMap<PathBuf, String>, page: &Path, link: &str) -> bool {
    let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
    let target = if path.is_empty() { page.to_path_buf() } else { joined(page, path) };
    let has = |html: &String, anchor: &str| html.contains(&format!("id=\"{anchor}\""));
    match (pages.get(&target), anchor) {
        (Some(html), Some(anchor)) => has(html, anchor),
        (Some(_), None) => true,
        (None, _) => target.is_file(),
    }
}

/// The path of a link, without `..`.
fn joined(page: &Path, link: &str) -> PathBuf {
    let mut target = page.parent().map(Path::to_path_buf).unwrap_or_default();
    for part in link.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                target.pop();
            }
            part => target.push(part),
        }
    }
    target
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_without_page_file_or_anchor_are_found() {
        let folder = std::env::temp_dir().join(format!("trundle-book-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("in")).unwrap();
        let index = "<a href=\"in/a.html#x\"></a><a href=\"in/a.html#y\"></a><img src=\"no.png\"><a href=\"https://a\">";
        std::fs::write(folder.join("index.html"), index).unwrap();
        std::fs::write(
            folder.join("in/a.html"),
            "<h1 id=\"x\"><a href=\"../index.html\"><a href=\"b.html\">",
        )
        .unwrap();
        let found = broken(&folder);
        std::fs::remove_dir_all(&folder).unwrap();
        let lines =
            ["in/a.html: the link b.html", "index.html: the link in/a.html#y", "index.html: the link no.png"];
        assert_eq!(found.unwrap(), lines.map(|line| format!("{line} leads nowhere")));
    }
}
