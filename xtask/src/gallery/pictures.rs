//! Pictures of the docs that commands of the program and examples draw.

use crate::program;
use crate::workspace::Verdict;
use std::path::Path;

/// What draws into a folder.
enum Maker {
    /// A command of the program: its arguments without `--out`.
    Command(&'static [&'static str]),
    /// An example: its package and its name. Its only argument is the folder.
    Example(&'static str, &'static str),
}

/// A maker, and the pictures that it draws.
struct Drawing {
    maker: Maker,
    /// File in the output folder, and file below `docs/pictures`.
    pictures: &'static [(&'static str, &'static str)],
}

/// The pictures in the order of their time: some minutes in all.
const DRAWINGS: &[Drawing] = &[
    Drawing {
        maker: Maker::Example("trundle-planning", "plan_pictures"),
        pictures: &[
            ("field.svg", "planning/field.svg"),
            ("movers.svg", "planning/movers.svg"),
            ("outline.svg", "planning/outline.svg"),
            ("potential.svg", "planning/potential.svg"),
            ("speeds.svg", "planning/speeds.svg"),
            ("way.svg", "planning/way.svg"),
        ],
    },
    Drawing {
        maker: Maker::Example("trundle-sim", "scene_gallery"),
        pictures: &[
            ("scene-house.png", "scene-house.png"),
            ("scene-office.png", "scene-office.png"),
            ("scene-warehouse.png", "scene-warehouse.png"),
        ],
    },
    Drawing {
        maker: Maker::Command(&["experiment", "corridor"]),
        pictures: &[("corridor.png", "docking-scenarios.png")],
    },
    Drawing { maker: Maker::Command(&["demo"]), pictures: &[("map.png", "demo.png")] },
    Drawing {
        maker: Maker::Command(&["demo", "--scene", "house"]),
        pictures: &[("map.png", "exploration.png")],
    },
    Drawing {
        maker: Maker::Command(&["experiment", "poses", "--seeds", "1"]),
        pictures: &[("paths.png", "poses.png")],
    },
    Drawing {
        maker: Maker::Command(&["experiment", "obstacles", "--seeds", "1"]),
        pictures: &[("seed-1.png", "gallery/obstacles.png")],
    },
    Drawing {
        maker: Maker::Command(&["experiment", "barn", "--worlds", "150-150"]),
        pictures: &[("median.png", "gallery/barn.png")],
    },
    Drawing {
        maker: Maker::Command(&["experiment", "mrpb", "--only", "room02 2"]),
        pictures: &[("room02-2-seed-1.png", "gallery/mrpb.png")],
    },
    Drawing {
        maker: Maker::Command(&["map", "../shared/data/laser/killian_g2o.log"]),
        pictures: &[("overview.png", "mapping_killian.png")],
    },
];

/// Draws the pictures whose names contain one of `words`, or all without words. A command that fails is named; the others are drawn.
pub fn draw(root: &Path, words: &[String]) -> Verdict {
    let trundle = program::release_trundle(root)?;
    let is_wanted = |drawing: &&Drawing| {
        let names = || drawing.pictures.iter().map(|(_, file)| *file);
        words.is_empty() || names().any(|name| words.iter().any(|word| name.contains(word.as_str())))
    };
    let mut failures = 0;
    for drawing in DRAWINGS.iter().filter(is_wanted) {
        if let Err(why) = draw_one(root, &trundle, drawing) {
            println!("not drawn: {why}");
            failures += 1;
        }
    }
    Ok(failures == 0)
}

impl Maker {
    /// Draws into a folder. The error names the maker.
    fn run(&self, root: &Path, trundle: &Path, folder: &str) -> Result<(), String> {
        let (is_well, name) = match *self {
            Self::Command(args) => {
                let is_well = program::ends_well(trundle, &[args, &["--quiet", "--out", folder]].concat())?;
                (is_well, args.join(" "))
            }
            Self::Example(package, name) => {
                let run = ["run", "--quiet", "--release", "--package", package, "--example", name];
                (program::cargo(root, &[&run[..], &["--", folder]].concat(), &[])?, format!("example {name}"))
            }
        };
        is_well.then_some(()).ok_or(name)
    }
}

fn draw_one(root: &Path, trundle: &Path, drawing: &Drawing) -> Result<(), String> {
    let out = program::scratch(root, "pictures")?;
    drawing.maker.run(root, trundle, &out.display().to_string())?;
    for (drawn, file) in drawing.pictures {
        let (drawn, file) = (out.join(drawn), root.join("docs/pictures").join(file));
        std::fs::copy(&drawn, &file)
            .map_err(|e| format!("cannot copy {} to {}: {e}", drawn.display(), file.display()))?;
        println!("wrote {}", file.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery::charts;
    use crate::workspace::root;
    use std::collections::BTreeSet;

    /// The test of the live page in a browser: with `UPDATE_PICTURES=1` it writes those of its pictures that docs show.
    const LIVE_TEST: &str = "bench/live/test.mjs";

    /// Paths below `folder`, relative to it.
    fn files(folder: &Path) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() {
                found.extend(files(&path).into_iter().map(|file| format!("{name}/{file}")));
            } else {
                found.insert(name);
            }
        }
        found
    }

    #[test]
    fn every_picture_has_a_maker() {
        let root = root();
        let drawn = DRAWINGS.iter().flat_map(|drawing| drawing.pictures).map(|(_, file)| (*file).to_owned());
        let measurements = crate::results::read(&root).unwrap();
        let chart = |chart: &serde_json::Value| format!("gallery/{}", chart["file"].as_str().unwrap());
        let charts = charts::all(&measurements).unwrap();
        let live = std::fs::read_to_string(root.join(LIVE_TEST)).unwrap();
        let makers: BTreeSet<String> = drawn.chain(charts.iter().map(chart)).collect();
        let orphans = files(&root.join("docs/pictures"))
            .into_iter()
            .filter(|file| !makers.contains(file) && !live.contains(&format!("{file:?}")));
        assert_eq!(orphans.collect::<Vec<_>>(), Vec::<String>::new(), "no maker draws these pictures");
    }

    /// A picture that no page shows would be drawn for nothing.
    #[test]
    fn every_drawn_picture_exists_and_is_shown() {
        let root = root();
        let mut pages = std::fs::read_to_string(root.join("README.md")).unwrap();
        for page in crate::markdown::pages(&root.join("docs")).unwrap() {
            pages.push_str(&std::fs::read_to_string(page).unwrap());
        }
        for (_, file) in DRAWINGS.iter().flat_map(|drawing| drawing.pictures) {
            assert!(root.join("docs/pictures").join(file).is_file(), "docs/pictures/{file} is missing");
            assert!(pages.contains(&format!("pictures/{file})")), "{file} is shown nowhere");
        }
    }
}
