//! The gallery: the papers' experiments and benchmarks beside other programs' figures, as tables, charts and pictures. Every figure comes
//! from `results/*.json`.

mod charts;
pub mod pictures;
mod sections;

use crate::results::model::Measurements;
use crate::results::{self, page};
use crate::workspace::Verdict;
use sections::{SECTIONS, Section};
use std::fmt::Write;
use std::path::Path;

/// The page, relative to the workspace.
pub const PAGE: &str = "docs/gallery.md";

const HEAD: &str = "# Gallery

Written by `cargo xtask gallery` from `results/*.json`. `cargo xtask gallery --measure` first repeats the measurements, which takes
some hours, and draws the pictures; `--measure NAME` repeats one measurement, `cargo xtask pictures` draws the pictures alone. The columns are those of the [results](results.md): figures in **bold** miss their goal, the
ratio says how many times better than the peer, and a peer marked * is a published figure, not one of the same run.
";

/// Writes the page and its charts. With `measured`, first repeats these measurements, or if the list is empty all of the page and draws
/// its pictures. Returns whether all of them gave their figures; the page is written with those that did.
pub fn run(root: &Path, measured: Option<&[String]>) -> Verdict {
    let all: Vec<String> =
        SECTIONS.iter().flat_map(|s| s.measurements).map(|name| (*name).to_owned()).collect();
    let names = measured.map_or(&[][..], |names| if names.is_empty() { &all } else { names });
    if let Some(unknown) = names.iter().find(|name| !all.contains(name)) {
        return Err(format!("--measure {unknown}: the gallery shows {}", all.join(", ")));
    }
    let failures: Vec<String> = names.iter().filter_map(|name| repeat(root, name).err()).collect();
    let are_drawn = measured.is_none_or(|names| !names.is_empty()) || pictures::draw(root, &[])?;
    let measurements = results::read(root)?;
    charts::draw(root, &measurements, &root.join(charts::FOLDER))?;
    let text = render(&measurements)?;
    std::fs::write(root.join(PAGE), &text).map_err(|e| format!("cannot write {PAGE}: {e}"))?;
    println!("wrote {PAGE} and {} charts", charts::all(&measurements)?.len());
    failures.iter().for_each(|failure| println!("not measured: {failure}"));
    Ok(failures.is_empty() && are_drawn)
}

/// Repeats a measurement.
fn repeat(root: &Path, name: &String) -> Result<(), String> {
    let is_written = results::run(root, std::slice::from_ref(name), None)?;
    is_written.then_some(()).ok_or_else(|| format!("{name}: {} is too long", results::PAGE))
}

/// The page.
///
/// # Errors
/// When a measurement of the page is missing.
fn render(measurements: &Measurements) -> Result<String, String> {
    let mut page = HEAD.to_owned();
    for section in SECTIONS {
        let _ = write!(page, "\n## {}\n\n{}\n", section.title, section.text.trim());
        for (file, caption) in section.pictures {
            let _ = write!(page, "\n![{caption}](pictures/{file})\n\n*{caption}*\n");
        }
        page.push_str(&tables(section, measurements)?);
    }
    Ok(page)
}

fn tables(section: &Section, measurements: &Measurements) -> Result<String, String> {
    let named =
        |name: &&str| measurements.get_key_value(*name).ok_or_else(|| format!("no results/{name}.json"));
    let shown = section.measurements.iter().map(named).collect::<Result<Vec<_>, _>>()?;
    let tables: String = shown.iter().map(|(_, m)| (section.table)(m)).collect();
    Ok(if shown.is_empty() { tables } else { format!("{tables}\n{}", page::commands(&shown)) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{program, workspace};

    #[test]
    fn the_page_is_what_the_files_give() {
        let root = workspace::root();
        let page = std::fs::read_to_string(root.join(PAGE)).unwrap();
        let rendered = render(&results::read(&root).unwrap()).unwrap();
        assert!(page == rendered, "run `cargo xtask gallery`: {PAGE} is not made from results/*.json");
    }

    #[test]
    fn the_charts_are_what_the_files_give() {
        let root = workspace::root();
        let measurements = results::read(&root).unwrap();
        let scratch = program::scratch(&root, "gallery-test").unwrap();
        charts::draw(&root, &measurements, &scratch).unwrap();
        for chart in charts::all(&measurements).unwrap() {
            let name = chart["file"].as_str().unwrap();
            let [drawn, stored] =
                [scratch.join(name), root.join(charts::FOLDER).join(name)].map(std::fs::read);
            assert!(
                drawn.unwrap() == stored.unwrap_or_default(),
                "run `cargo xtask gallery`: {name} is another chart"
            );
        }
    }

    #[test]
    fn every_picture_exists_and_every_chart_stands_on_the_page() {
        let root = workspace::root();
        let page = render(&results::read(&root).unwrap()).unwrap();
        let shown: Vec<&str> = SECTIONS.iter().flat_map(|s| s.pictures).map(|(file, _)| *file).collect();
        for file in &shown {
            assert!(root.join("docs/pictures").join(file).is_file(), "docs/pictures/{file} is missing");
        }
        for chart in charts::all(&results::read(&root).unwrap()).unwrap() {
            let name = chart["file"].as_str().unwrap();
            assert!(page.contains(&format!("(pictures/gallery/{name})")), "{name} stands nowhere");
        }
    }

    #[test]
    fn a_missing_measurement_is_named() {
        assert!(render(&Measurements::new()).unwrap_err().contains("results/"));
    }
}
